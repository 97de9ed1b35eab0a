"""Time histories of motions, read from CSV files."""

from itertools import pairwise
from pathlib import Path

from riser_soil.core.quantities import NEAREST
from riser_soil.scene.columns import TIME, CsvColumns, Known, read_columns
from riser_soil.scene.files import wrong_file

LEAST_ROWS = 4  # of a cubic spline without knots beside its ends
COUNT = "-"  # the unit of a t that is no time


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
