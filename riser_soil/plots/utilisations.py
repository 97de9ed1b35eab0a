"""Matplotlib plot of utilisations: the largest of each check along the line over a stage, with their limit."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from riser_soil.plots.curves import ARC, PAGE, legend_below, sheet
from riser_soil.results.stage_records import StageRecords


def utilisation_sheet(stage: StageRecords, names: Mapping[str, str]) -> Figure:
    """Maxima over the stage's records of recorded utilisations, by their variables with the words of their checks."""
    figure, (axes,) = sheet(1, 1, width=PAGE, height=3.0)
    for n, (name, words) in enumerate(names.items()):
        values = stage[name]
        known = np.isfinite(values).any(axis=0)
        most = np.full(values.shape[1], np.nan)
        most[known] = np.nanmax(values[:, known], axis=0)
        axes.plot(stage.run.arc, most, color=f"C{n % 10}", label=words)
    axes.axhline(1.0, color="k", linestyle="--", linewidth=1.0, label="limit")
    axes.set(xlabel=ARC, ylabel="utilisation [-]", ylim=(min(0.0, axes.get_ylim()[0]), None))
    axes.set_xlim(float(stage.run.arc[0]), float(stage.run.arc[-1]))
    legend_below(axes)
    return figure
