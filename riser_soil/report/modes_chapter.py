"""Chapter on modes: natural periods, and the shapes of the first ones."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import h5py
import numpy as np

from riser_soil.plots.curves import Curves
from riser_soil.plots.mode_shapes import mode_sheet
from riser_soil.report.document import Block, Paragraph, PictureBlock, ReportSection, TableBlock
from riser_soil.report.sources import Sources
from riser_soil.report.tables import ReportTable, compact, number

MOST_SHAPES = 4
_LEAST = 0.05  # %: shares that are less are not shown


def chapter(sources: Sources) -> ReportSection:
    return ReportSection("Modes", [] if sources.modes is None else [*_blocks(sources)])


def _blocks(sources: Sources) -> Iterator[Block]:
    assert sources.modes is not None
    with h5py.File(sources.modes) as file:
        frequency, share = (np.asarray(file[name]) for name in ("frequency", "share"))
        directions = [str(each) for each in file["direction"].asstr()]
        lines = {
            name: tuple(np.asarray(file[f"{name}/{key}"]) for key in ("arc", "position", "shape"))
            for name in _lines(file)
        }
        stage = str(file.attrs["stage"])
    yield Paragraph(
        f"Natural frequencies about the line at rest after the load step {stage}, with added mass, without damping."
    )
    rows = [
        [str(n), number(f, 4), number(1.0 / f, 4), *(_percent(part) for part in parts)]
        for n, (f, parts) in enumerate(zip(frequency.tolist(), share.tolist(), strict=True), 1)
    ]
    head = ("mode", "frequency [Hz]", "period [s]", *(f"{name} [%]" for name in directions))
    note = "Shares of the squared displacement by direction: in the vertical plane of the ends, out of it, along."
    yield TableBlock("Natural frequencies and periods", compact(ReportTable(head, rows, note)), words=0, key="modes")
    few = min(MOST_SHAPES, len(frequency))
    titles = [f"mode {n + 1}: {1.0 / frequency[n]:.4g} s" for n in range(few)]
    shown = {name: (arc, position, shape[:few]) for name, (arc, position, shape) in lines.items()}
    yield PictureBlock(
        f"Shapes of the first {few} modes: over the shape at rest, and components along the line",
        Curves(partial(mode_sheet, shown, titles)),
    )


def _lines(file: h5py.File) -> list[str]:
    """Groups that have a line's shapes; of the only one the root."""
    if "arc" in file and "position" in file:
        return [""]
    return [name for name in file if isinstance(file[name], h5py.Group) and "arc" in file[name]]


def _percent(part: float) -> str:
    return number(100.0 * part, 3) if np.isfinite(part) and 100.0 * part >= _LEAST else ""


