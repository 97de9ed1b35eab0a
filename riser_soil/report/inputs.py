"""Input of a part of a scene as rows of a table: quantities in words with units of the field."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pydantic import BaseModel

from riser_soil.report.parameters import GROUND_WORDS, in_words
from riser_soil.report.tables import given_value, number

_UNITS = {  # units of the scene language: unit of the field, and how many of it are one
    "Pa": ("MPa", 1e-6),
    "N": ("kN", 1e-3),
    "N/m2": ("kN/m²", 1e-3),
    "N/m": ("kN/m", 1e-3),
    "N.m2": ("kN m²", 1e-3),
}
_SHORT = 0.1  # m: lengths below it are given in mm


def input_rows(given: BaseModel, skip: Sequence[str] = (), only: Sequence[str] | None = None) -> list[list[str]]:
    """Words, value and unit of each value that is given, those of nested parts too; what is 0, false or absent has no
    row. skip, only: keys.
    """
    rows: list[list[str]] = []
    for key, value in given:
        if key in skip or (only is not None and key not in only):
            continue
        if isinstance(value, BaseModel):
            rows += input_rows(value)
        elif isinstance(value, tuple) and value and isinstance(value[0], BaseModel):
            for n, each in enumerate(value, 1):
                rows += [[f"{key.removesuffix('s')} {n}: {words}", *rest] for words, *rest in input_rows(each)]
        elif value not in (None, (), {}, False) and (value != 0.0 or key in GROUND_WORDS):
            rows.append(_row(given, key, value))
    return rows


def _row(given: BaseModel, key: str, value: Any) -> list[str]:
    if key == "kind":
        return ["law", given_value(value), ""]
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if key in GROUND_WORDS and is_number:
        words, unit, scale = GROUND_WORDS[key]
        return [words, number(scale * value), unit]
    words, unit = in_words(type(given).model_fields[key].description or key.replace("_", " "))
    if is_number and unit == "m" and abs(value) < _SHORT:
        return [words, number(1e3 * value), "mm"]
    if is_number and unit in _UNITS:
        unit, scale = _UNITS[unit]
        return [words, number(scale * value), unit]
    return [words, given_value(value), unit if is_number or isinstance(value, tuple) else ""]
