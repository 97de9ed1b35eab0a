"""Tables of a report: heads, rows of text, and numbers as they are written in them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

NOTHING = "–"


@dataclass(frozen=True)
class ReportTable:
    """A table of text; note: below it."""

    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    note: str = ""

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


def found(nested: Mapping[str, Any] | None, path: Sequence[str]) -> Any:
    """The entry of nested mappings at a path, or None."""
    value: Any = nested
    for key in path:
        value = value.get(key) if isinstance(value, Mapping) else None
    return value
