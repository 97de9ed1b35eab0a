"""Tables of a report: heads, rows of text, and numbers as they are written in them."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

NOTHING = "–"
BREAK = "\u200b"  # without width: where a long name may be broken
_NUMERIC = re.compile(r"([+−-]?[0-9][0-9.,e+−-]*( ?[%m°]| ± .*| \(.*\)| to .*| [0-9−-].*)?$|[–>]|$)")
_PATH = re.compile(r"(?<![\w.])(?:/[\w.+=-]+)+/(?=[\w.+=-])")


@dataclass(frozen=True)
class ReportTable:
    """A table of text; note: below it."""

    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    note: str = ""

    def has_words(self, column: int) -> bool:
        """Whether a column has words, and is aligned to the left; one of numbers and dashes is not."""
        return any(not is_number(row[column]) for row in self.rows)

    def __bool__(self) -> bool:
        return bool(self.rows)


def compact(table: ReportTable) -> ReportTable:
    """The table without columns in which there is nothing."""
    kept = [n for n in range(len(table.head)) if any(row[n] not in ("", NOTHING) for row in table.rows)]
    rows = [[row[n] for n in kept] for row in table.rows]
    return ReportTable([table.head[n] for n in kept], rows, table.note)


def number(value: float | None, digits: int = 5) -> str:
    """A number with so many figures, without an exponent where it reads well; a dash for none."""
    if value is None or not math.isfinite(value):
        return NOTHING
    if value == 0.0:
        return "0"
    if 1e-4 <= abs(value) < 1e7:
        whole = f"{value:.{digits}g}"
        return f"{value:.0f}" if "e" in whole else whole
    return f"{value:.{digits}g}"


def given_value(value: Any) -> str:
    """A value of a scene, or its text in a table of cases, in short words: a list without brackets, a plain number."""
    if isinstance(value, str):
        try:
            value = json.loads(value)
        except ValueError:
            return without_paths(value) or NOTHING
    if isinstance(value, bool) or value is None:
        return {True: "yes", False: "no"}.get(value, NOTHING) if value is not None else NOTHING
    if isinstance(value, int | float):
        return number(float(value))
    if isinstance(value, list | tuple):
        return ", ".join(map(given_value, value)) if len(value) <= 6 else f"{len(value)} values"
    return without_paths(str(value))


def is_number(text: str) -> bool:
    """Whether a cell is aligned as a number: it begins with one, or is a dash."""
    return bool(_NUMERIC.match(text))


def value_at(nested: Mapping[str, Any] | None, path: Sequence[str]) -> Any:
    """The entry of nested mappings at a path, or None."""
    value: Any = nested
    for key in path:
        value = value.get(key) if isinstance(value, Mapping) else None
    return value


def without_paths(text: str) -> str:
    """The text with the last names alone of absolute paths, which are no reader's business."""
    return _PATH.sub("", text)
