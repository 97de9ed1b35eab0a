"""Time histories of motions, read from CSV files."""

from itertools import pairwise
from pathlib import Path

from riser_soil.core.quantities import NEAREST
from riser_soil.scene.columns import TIME, CsvColumns, Known, read_columns
from riser_soil.scene.files import wrong_file

# A cubic spline without knots beside its ends needs this many rows.
_LEAST_ROWS = 4


def read_history(file: Path, known: Known, required: tuple[str, ...]) -> CsvColumns:
    """Columns of a file by increasing times t, enough for cubic splines; PydanticCustomError for what is wrong."""
    rows = read_columns(file, {"t": TIME, **known}, required=("t", *required))
    if rows.rows < _LEAST_ROWS:
        raise wrong_file(f"{file}: a table of {rows.rows} rows; cubic splines need at least {_LEAST_ROWS}")
    for line, (a, b) in zip(rows.lines[1:], pairwise(rows.values["t"]), strict=True):
        if b - a < NEAREST:
            how = f"times must increase, but {b:g} s follows {a:g} s"
            raise wrong_file(f"{file}:{line}: {how}; sort the rows, {NEAREST:g} s apart or more")
    return rows
