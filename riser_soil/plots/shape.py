"""The riser's shape: its extremes and one cycle, whole, near touchdown, and from above where it leaves its plane."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from riser_soil.core.arrays import Array, IntArray
from riser_soil.errors import ResultsError, RiserSoilError
from riser_soil.plots.curves import PAGE, sheet
from riser_soil.results import Run
from riser_soil.results.cycles import cycles, period_of
from riser_soil.results.stage_records import StageRecords, along
from riser_soil.scene.bathymetry import ground_height

SNAPSHOTS = 9  # snapshots of one cycle
_MOVES = 1e-6  # of the riser's length: what moves by less is at rest
_ASIDE = 0.002  # of the riser's length: what goes out of the plane less is not drawn from above
_ZONE = 0.06  # of the riser's length: to either side of the touchdown point
_UNDER = 0.04  # of the height shown: how much of the ground is seen
_AHEAD, _UP = "horizontal distance from end A [m]", "z [m], upwards"


def filmed_records(stage: StageRecords, most: int) -> IntArray:
    """Records of the last whole cycle of the stage's motion; where it has no one period, those around the largest
    bending moment, at most `most` of them in either case.
    """
    of_cycle = _last_cycle(stage)
    if of_cycle is not None:
        return of_cycle[:: -(-len(of_cycle) // most)]
    first = max(0, min(_worst(stage) - most // 2, len(stage.records) - most))
    return stage.records[first : first + most]


def _last_cycle(stage: StageRecords) -> IntArray | None:
    """Records of the last whole cycle of the stage's motion; None where it has no one period."""
    try:
        return cycles(stage.run, stage.number, period_of(stage.run, stage.number))[-1].records
    except ResultsError:
        return None


def _worst(stage: StageRecords) -> int:
    """Which of the stage's records has the largest bending moment; the first where moments were left out."""
    return int(stage["bending_moment"].max(axis=1).argmax()) if "bending_moment" in stage.run.variables else 0


def snapshots(stage: StageRecords) -> Figure:
    """The axis in the vertical plane from start to end: at extremes, and thin lines through one cycle."""
    run, extremes, cycle = stage.run, _extremes(stage), _one_cycle(stage)
    at = np.concatenate([[record for record, _ in extremes], cycle]).astype(int)
    position = run["position"]
    aside = _aside(position[at])
    figure, panels = sheet(1 + (aside is not None), 2, width=PAGE, height=3.2)
    if aside is not None:
        panels[3].remove()
    ahead, origin = along(position[0]), position[0, 0]
    lines: list[tuple[int, dict[str, Any]]] = [(record, {"color": "0.6", "linewidth": 0.6}) for record in cycle]
    if len(cycle):
        first, last = run.time[cycle[[0, -1]]]
        lines[0][1]["label"] = f"one cycle, {first:.4g} to {last:.4g} s"
    for n, (record, words) in enumerate(extremes):
        lines.append((record, {"color": f"C{n}", "linewidth": 1.5, "label": words}))
    for record, style in lines:
        x, z = _in_plane(position[record], origin, ahead), position[record, :, 2]
        for axes in panels[:2]:
            axes.plot(x, z, **style)
        if aside is not None:
            panels[2].plot(x, (position[record] - origin) @ aside, **style)
    _whole(panels[0])
    _add_surface_and_floater(panels[0], run, _in_plane(position[at, -1], origin, ahead), position[at, -1, 2])
    _zone(panels[1], stage, position[at], ahead)
    _draw_seabed(panels[:2], run, position[at], ahead)
    figure.legend(*panels[0].get_legend_handles_labels(), fontsize="small", loc="outside lower center", ncols=2)
    if aside is not None:
        panels[2].set(title="from above", xlabel=_AHEAD, ylabel="to the left of the plane [m]")
    return figure


def _extremes(stage: StageRecords) -> list[tuple[int, str]]:
    """Records of the stage's extremes with words for them, each record once; the last one of a stage at rest."""
    if not stage.moves:
        return [(int(stage.records[-1]), "static")]
    end, marks = stage["position"][:, -1], dict[int, list[str]]()
    ways = end @ along(stage.run["position"][0])
    asked: list[tuple[str, Any]] = [("least tension", stage["min_effective_tension"].argmin())]
    if "bending_moment" in stage.run.variables:
        asked.insert(0, ("largest bending moment", _worst(stage)))
    for words, motion in (("end B {} end A", ways), ("end B {}", end[:, 2])):
        near, far = ("nearest to", "farthest from") if motion is ways else ("lowest", "highest")
        if np.ptp(motion) > _MOVES * stage.run.arc[-1]:
            asked += [(words.format(near), motion.argmin()), (words.format(far), motion.argmax())]
    for words, n in asked:
        marks.setdefault(int(stage.records[n]), []).append(words)
    return [(record, f"{', '.join(words)}: {stage.run.time[record]:.4g} s") for record, words in marks.items()]


def _one_cycle(stage: StageRecords) -> IntArray:
    """Records through the last whole cycle of a periodic motion, else through the cycle of the end's motion around the
    largest bending moment, from one upcrossing of its mean to the next; none of a stage at rest.
    """
    if not stage.moves:
        return np.zeros(0, dtype=int)
    records = _last_cycle(stage)
    if records is None:
        records = stage.records[_around_the_worst(stage)]
    return records[np.unique(np.linspace(0, len(records) - 1, SNAPSHOTS).round().astype(int))]


def _around_the_worst(stage: StageRecords) -> slice:
    end = stage["position"][:, -1]
    motion = end[:, int(np.ptp(end, axis=0).argmax())]
    above = motion > motion.mean()
    up = np.flatnonzero(~above[:-1] & above[1:])
    worst = _worst(stage)
    before, after = up[up <= worst], up[up > worst]
    return slice(int(before[-1]) if before.size else 0, int(after[0]) + 2 if after.size else len(end))


def _add_surface_and_floater(axes: Axes, run: Run, x: Array, z: Array) -> None:
    """The water's surface, and the place of the end (n,) [m] where it is carried by something that moves."""
    level = surface_level(run)
    if level is not None:
        axes.axhline(level, color="C0", linewidth=0.8, linestyle="-.", label="water surface")
    if np.ptp(x) + np.ptp(z) > 0.0:
        axes.plot(x.mean(), z.mean(), "v", markersize=9, color="0.3", label="floater, at the riser's end")


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
    view, (low, high) = panels[-1].get_xlim(), panels[-1].get_ylim()
    for axes in panels:
        axes.plot(x, level, color="saddlebrown", linewidth=1.0, label="seabed")
        axes.fill_between(x, level, level - 0.05 * np.ptp(position[..., 2]), color="tan", alpha=0.5, linewidth=0.0)
    under = level[(x >= view[0]) & (x <= view[1])].min(initial=np.inf)
    panels[-1].set(xlim=view, ylim=(min(low, under - _UNDER * (high - low)), high))


def surface_level(run: Run) -> float | None:
    """z [m] of the water's surface; None where there is none, or the scene can't be read."""
    try:
        return float(run.scene["water"]["surface_level"])
    except (ResultsError, KeyError, TypeError, ValueError):
        return None


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
    shown = (arc >= places.min() - side) & (arc <= places.max() + side)
    low, high = float(z[:, shown].min()), float(z[:, shown].max())
    margin = 0.08 * (high - low)
    axes.set_xlim(*_apart(float(x[:, shown].min()), float(x[:, shown].max()), side))
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
