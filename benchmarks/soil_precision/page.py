"""The page docs/soil_precision.md: its table, picture and CSV, of measured runs."""

from __future__ import annotations

import importlib.metadata
import platform
from collections.abc import Sequence
from datetime import date
from pathlib import Path

from benchmarks.soil_precision.draw import PANELS, Panel, draw
from benchmarks.soil_precision.errors import Row, cheapest, csv_of, judged, rows_of, series, uncertainty
from benchmarks.soil_precision.measure import Measured
from demos.page import filled, table
from riser_soil import __version__

DOCS = Path(__file__).parents[2] / "docs"
PAGE, PLOT, ROWS = (DOCS / f"soil_precision.{ending}" for ending in ("md", "svg", "csv"))
ACCURACIES = (0.1, 0.03)


def write(runs: Sequence[Measured]) -> None:
    """All three from the runs; what failed is told on the screen."""
    for run in runs:
        if run.reason:
            print(f"{run.scene}, {run.method}, n = {run.n} failed: {run.reason}")
    ROWS.write_text(csv_of(judged(runs)), encoding="utf-8")
    rows = rows_of(ROWS.read_text(encoding="utf-8"))
    draw(rows, (DOCS / "peers.md").read_text(encoding="utf-8"), PLOT)
    blocks = {"cheapest": cheapest_table(rows), "made": made(runs)}
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), blocks), encoding="utf-8")


def cheapest_table(rows: Sequence[Row]) -> str:
    """Table by figure: the reference's uncertainty and the cheapest method of each accuracy."""
    head = ["figure", "±", *(f"{100.0 * accuracy:g} % by" for accuracy in ACCURACIES)]
    return table(head, [_line(rows, panel) for panel in PANELS if panel.told])


def _line(rows: Sequence[Row], panel: Panel) -> list[str]:
    known = [row for group in series(rows, *panel[:3]).values() for row in group]
    own = uncertainty(rows, *panel[:3])
    cells = [_cell(cheapest(known, accuracy)) if accuracy > own else "–" for accuracy in ACCURACIES]
    return [panel.figure, f"{100.0 * own:.1f} %", *cells]


def _cell(row: Row | None) -> str:
    return "none" if row is None else f"{row.method}, D/{row.n}, {row.seconds:.1f}"


def made(runs: Sequence[Measured]) -> str:
    """Line on how the page was made: command, machine and versions, in what time."""
    seconds = sum(run.seconds for run in runs)
    dolfinx = importlib.metadata.version("fenics-dolfinx")
    return (
        f"`make precision`, {seconds / 60.0:.0f} minutes on a shared core ({_processor()}), "
        f"{date.today()}; riser_soil {__version__}, Python {platform.python_version()}, dolfinx {dolfinx}."
    )


def _processor() -> str:
    """The processor's name by Linux's list, else its kind."""
    listed = Path("/proc/cpuinfo")
    lines = listed.read_text(encoding="utf-8").splitlines() if listed.exists() else []
    return next((line.partition(": ")[2] for line in lines if line.startswith("model name")), platform.machine())
