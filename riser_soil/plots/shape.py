"""Snapshots of the riser's shape through a cycle: whole, near touchdown, and from above where it leaves its plane."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from riser_soil.core.arrays import Array, IntArray
from riser_soil.errors import ResultsError, RiserSoilError
from riser_soil.plots.curves import sheet
from riser_soil.results import Run
from riser_soil.results.cycles import cycles, period_of
from riser_soil.results.stage_records import StageRecords, along
from riser_soil.scene.bathymetry import ground_height

SNAPSHOTS = 9
_ASIDE = 0.002  # of the riser's length: what goes out of the plane less is not drawn from above
_ZONE = 0.06  # of the riser's length: to either side of the touchdown point
_UNDER = 0.04  # of the height shown: how much of the ground is seen
_AHEAD, _UP = "horizontal distance from the start [m]", "z [m], upwards"


def filmed_records(stage: StageRecords, most: int) -> IntArray:
    """Records of the last whole cycle of the stage's motion; where it has no one period, those around the largest
    bending moment, at most `most` of them in either case.
    """
    try:
        of_cycle = cycles(stage.run, stage.number, period_of(stage.run, stage.number))[-1].records
        return of_cycle[:: -(-len(of_cycle) // most)]
    except ResultsError:
        worst = int(stage["bending_moment"].max(axis=1).argmax()) if "bending_moment" in stage.run.variables else 0
        first = max(0, min(worst - most // 2, len(stage.records) - most))
        return stage.records[first : first + most]


def snapshots(stage: StageRecords) -> Figure:
    """The axis at some instants, in the vertical plane from start to end."""
    run, at = stage.run, _instants(stage)
    position = run["position"]
    aside = _aside(position[at])
    figure, panels = sheet(1, 2 + (aside is not None), width=10.0 if aside is None else 13.0, height=4.6)
    colours = colormaps["viridis"](np.linspace(0.0, 0.9, len(at)))
    ahead = along(position[0])
    for record, colour in zip(at, colours, strict=True):
        x, z = _in_plane(position[record], position[0, 0], ahead), position[record, :, 2]
        for axes in panels[:2]:
            axes.plot(x, z, color=colour, linewidth=1.2, label=f"{run.time[record]:.4g} s")
        if aside is not None:
            panels[2].plot(x, (position[record] - position[0, 0]) @ aside, color=colour, linewidth=1.2)
    _whole(panels[0])
    _zone(panels[1], stage, position[at], ahead)
    _draw_seabed(panels[:2], run, position[at], ahead)
    panels[0].legend(fontsize="x-small", title="t")
    if aside is not None:
        panels[2].set(title="from above", xlabel=_AHEAD, ylabel="to the left of the plane [m]")
    return figure


def _instants(stage: StageRecords) -> IntArray:
    if not stage.moves:
        return stage.records[-1:]
    filmed = filmed_records(stage, 200)
    return filmed[np.unique(np.linspace(0, len(filmed) - 1, SNAPSHOTS).round().astype(int))]


def _aside(position: Array) -> Array | None:
    """Horizontal unit vector (3,) across the plane; None where the riser (n, nn, 3) stays in it."""
    across = np.cross([0.0, 0.0, 1.0], along(position[0]))
    out = np.abs((position - position[0, 0]) @ across).max()
    return across if out > _ASIDE * np.ptp(position, axis=(0, 1)).max() else None


def _in_plane(axis: Array, origin: Array, ahead: Array) -> Array:
    return np.asarray((axis - origin) @ ahead)


def _draw_seabed(panels: Sequence[Axes], run: Run, position: Array, ahead: Array) -> None:
    """Below the riser; the last panel, which is not all of it, shows some of it."""
    origin = position[0, 0]
    x = np.linspace(*_limits((position - origin) @ ahead), 200)
    level = seabed_under(run, origin + x[:, None] * ahead)
    if level is None:
        return
    seen, (low, high) = panels[-1].get_xlim(), panels[-1].get_ylim()
    for axes in panels:
        axes.plot(x, level, color="saddlebrown", linewidth=1.0, label="seabed")
        axes.fill_between(x, level, level - 0.05 * np.ptp(position[..., 2]), color="tan", alpha=0.5, linewidth=0.0)
    under = level[(x >= seen[0]) & (x <= seen[1])].min(initial=np.inf)
    panels[-1].set(xlim=seen, ylim=(min(low, under - _UNDER * (high - low)), high))


def _limits(x: Array) -> tuple[float, float]:
    side = 0.03 * float(np.ptp(x))
    return float(x.min()) - side, float(x.max()) + side


def _whole(axes: Axes) -> None:
    axes.set(title="whole riser", xlabel=_AHEAD, ylabel=_UP)
    axes.set_aspect("equal", adjustable="datalim")


def _zone(axes: Axes, stage: StageRecords, position: Array, ahead: Array) -> None:
    """Around the touchdown point, or the lowest one; heights are drawn larger than lengths."""
    x, z = (position - position[0, 0]) @ ahead, position[..., 2]
    arc, touchdown = stage.run.arc, stage["touchdown_arc"]
    lowest = np.array([arc[z[0].argmin()]])
    places = touchdown[~np.isnan(touchdown)] if not np.isnan(touchdown).all() else lowest
    side = _ZONE * arc[-1]
    seen = (arc >= places.min() - side) & (arc <= places.max() + side)
    low, high = float(z[:, seen].min()), float(z[:, seen].max())
    margin = 0.08 * (high - low)
    axes.set_xlim(*_apart(float(x[:, seen].min()), float(x[:, seen].max()), side))
    axes.set_ylim(*_apart(low - margin, high + margin, side))
    where = "touchdown zone" if not np.isnan(touchdown).all() else "lowest point"
    axes.set(title=f"{where}, heights drawn larger", xlabel=_AHEAD, ylabel=_UP)


def _apart(low: float, high: float, side: float) -> tuple[float, float]:
    """Limits of an axis, to either side of what is in one place, as a single node is."""
    return (low, high) if high - low > 1e-9 * side else (low - side, high + side)


def seabed_under(run: Run, points: Array) -> Array | None:
    """Height (n,) [m] of the undeformed seabed or soil under points (n, 3) [m]; None where there is none, or the scene
    can't be read.
    """
    try:
        scene = run.read_scene()
    except (RiserSoilError, OSError):
        return None
    if not scene.has_ground:
        return None
    return np.array([ground_height(scene, (float(x), float(y), float(z))) for x, y, z in points])
