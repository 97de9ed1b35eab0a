"""CSV tables whose header gives the unit of each column: `t [s], x [m], y [m], z [m]`.

Separated by commas or, where the header has any, by semicolons; empty lines and lines that begin with # don't count.
Cells may stand in double quotes.
"""

import csv
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from riser_soil.core.quantities import FARTHEST, NEAREST
from riser_soil.scene.files import content, wrong_file
from riser_soil.scene.problem import hint, shown

Units = Mapping[str, float]
LEAST_ROWS = 4  # rows that a cubic spline without knots beside its ends needs
COUNT = "-"  # the unit of a t that is no time


"""Accepted units of a column, each with its size in SI units."""

TIME: Units = {"s": 1.0, "min": 60.0, "ms": 1e-3}
LENGTH: Units = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "ft": 0.3048}
ANGLE: Units = {"deg": math.pi / 180.0, "rad": 1.0}

_MOST_BYTES = 100_000_000  # a million rows or more

Known = Mapping[str, Units]
_Line = tuple[int, list[str]]


@dataclass(frozen=True)
class CsvColumns:
    """A file's columns by name, in SI units, the units that it gives them in, and the lines of its header and of each
    row in the file.
    """

    file: Path
    header: int
    values: Mapping[str, tuple[float, ...]]
    units: Mapping[str, str]
    lines: tuple[int, ...]

    @property
    def rows(self) -> int:
        return len(self.lines)

    def get(self, name: str) -> tuple[float, ...]:
        """A column; zeros where the file has none of this name."""
        return self.values.get(name, (0.0,) * self.rows)


def read_columns(file: Path, known: Known, required: tuple[str, ...]) -> CsvColumns:
    """Read a file that may have the known columns and must have the required ones; PydanticCustomError, with the file
    and its line, for what is wrong."""
    lines = list(lines_of(file))
    if not lines:
        raise wrong_file(f"{file}: the file is empty; its first line must name the columns: {_header(known)}")
    units = _columns(file, lines[0], known)
    missing = [name for name in required if name not in units]
    if missing:
        text = f"there is no column {missing[0]}; the header must be like {_header(known)}"
        raise wrong_file(f"{file}:{lines[0][0]}: {text}")
    rows = [_row(file, line, [*units]) for line in lines[1:]]
    sizes = [known[name][unit] for name, unit in units.items()]
    values = {name: tuple(row[i] * sizes[i] for row in rows) for i, name in enumerate(units)}
    return CsvColumns(file, lines[0][0], values, units, tuple(number for number, _ in lines[1:]))


def increasing(columns: CsvColumns, values: tuple[float, ...], name: str) -> None:
    """PydanticCustomError, with the line, where a column's values do not increase."""
    for line, (a, b) in zip(columns.lines[1:], pairwise(values), strict=True):
        if b - a < NEAREST:
            raise wrong_file(f"{columns.file}:{line}: {name} must increase, but {b:g} follows {a:g}; sort the rows")


def lines_of(file: Path) -> Iterator[_Line]:
    """Numbers and cells of the lines that count; PydanticCustomError where the file can't be read."""
    separator = ""
    for number, line in enumerate(_text(file).splitlines(), start=1):
        if line.strip() and not line.lstrip().startswith("#"):
            separator = separator or (";" if ";" in line else ",")
            yield number, _cells(f"{file}:{number}", line, separator)


def _cells(place: str, line: str, separator: str) -> list[str]:
    try:
        (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=True)
    except csv.Error as err:
        raise wrong_file(f"{place}: the row can't be read ({err}); write plain numbers between {separator}") from err
    return [cell.strip() for cell in cells]


def _text(file: Path) -> str:
    try:
        return content(file, _MOST_BYTES).decode("utf-8-sig")
    except UnicodeDecodeError as err:
        line = err.object.count(b"\n", 0, err.start) + 1
        raise wrong_file(f"{file}:{line}: not UTF-8 text; save the table as CSV in UTF-8") from err
    except OSError as err:
        raise wrong_file(f"{file}: can't be read ({err.strerror}); check the file and its permissions") from err


def _columns(file: Path, header: _Line, known: Known) -> dict[str, str]:
    """Units of the columns by their names."""
    number, cells = header
    units: dict[str, str] = {}
    for cell in cells:
        name, unit = _name_and_unit(f"{file}:{number}", cell, known)
        if name in units:
            raise wrong_file(f"{file}:{number}: there are two columns {name}; remove one of them")
        units[name] = unit
    return units


def _name_and_unit(place: str, cell: str, known: Known) -> tuple[str, str]:
    match = re.fullmatch(r"(.*\S)\s*\[\s*(.*\S)\s*\]", cell)
    if not match:
        raise wrong_file(f"{place}: {shown(cell)} names no column with its unit; write them like {_header(known)}")
    name, unit = " ".join(match[1].lower().split()), match[2]
    if name not in known:
        text = f'no such column as {shown(name)}, known are {", ".join(known)}; correct or remove it{hint(name, known)}'
        raise wrong_file(f"{place}: {text}")
    if unit not in known[name]:
        accepted = ", ".join(known[name])
        raise wrong_file(f"{place}: {name} can't be in [{unit}], accepted are {accepted}; convert the column")
    return name, unit


def _header(known: Known) -> str:
    return ", ".join(f"{name} [{next(iter(units))}]" for name, units in known.items())


def _row(file: Path, line: _Line, names: list[str]) -> list[float]:
    number, cells = line
    if len(cells) != len(names):
        raise wrong_file(
            f"{file}:{number}: the row has {len(cells)} values, but the header names {len(names)} columns; complete it"
        )
    return [_number(f"{file}:{number}: {name}", cell) for name, cell in zip(names, cells, strict=True)]


def _number(place: str, cell: str) -> float:
    try:
        value = math.nan if "_" in cell else float(cell)  # Python's own digit separators are no plain numbers
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        text = f"{shown(cell)} is not a finite number; write plain numbers, with a point for decimals"
        raise wrong_file(f"{place}: {text}")
    if abs(value) > FARTHEST:
        raise wrong_file(f"{place}: {cell} is larger than {FARTHEST:g}; check unit and power of ten")
    return value


def read_history(file: Path, known: Known, required: tuple[str, ...]) -> CsvColumns:
    """Columns of a file by increasing times t, two at least; PydanticCustomError for what is wrong."""
    rows = read_columns(file, {"t": {**TIME, COUNT: 1.0}, **known}, required=("t", *required))
    if rows.rows < 2:
        raise wrong_file(f"{file}: a table of {rows.rows} rows; a motion needs two at least, cubic splines in time 4")
    for line, (a, b) in zip(rows.lines[1:], pairwise(rows.values["t"]), strict=True):
        if b - a < NEAREST:
            t = "" if rows.units["t"] == COUNT else " s"
            how = f"times must increase, but {b:g}{t} follows {a:g}{t}"
            raise wrong_file(f"{file}:{line}: {how}; sort the rows, {NEAREST:g}{t} apart or more")
    return rows
