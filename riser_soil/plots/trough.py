"""The trough that the riser presses into the soil, in sections across it."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from riser_soil.plots.curves import sheet
from riser_soil.results.stage_records import StageRecords


def trough(stage: StageRecords) -> Figure:
    """Settlement of the soil's surface across the riser, as the stage begins and ends, and the deepest in between."""
    settlement, offset = 1e3 * stage["settlement_across"], stage.run["offset"]
    arc = stage["section_arc"][-1]
    figure, panels = sheet(1, len(arc), width=max(6.0, 4.0 * len(arc)))
    for n, axes in enumerate(panels):
        if stage.moves:
            axes.plot(offset, settlement[0, n], color="0.5", label="as the stage begins")
        axes.plot(offset, settlement[-1, n], color="C0", label="at its end")
        if stage.moves:
            deepest = settlement[:, n].max(axis=0)
            axes.plot(offset, deepest, color="C3", linestyle=":", label="deepest")
        axes.invert_yaxis()
        axes.set(title=f"section at arc {arc[n]:.4g} m", xlabel="offset to the left of the riser [m]")
    panels[0].set_ylabel("settlement of the soil's\nsurface [mm], + down")
    panels[0].legend(fontsize="small")
    return figure


def has_trough(stage: StageRecords) -> bool:
    """Whether sections are recorded, and lie on the soil."""
    there = "settlement_across" in stage.run.variables
    return there and bool(np.isfinite(stage["settlement_across"][-1]).any())
