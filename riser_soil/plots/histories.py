"""Histories of a stage: motion of the ends and the forces there, touchdown, energy, what the solver did."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from riser_soil.core.arrays import Array
from riser_soil.plots.curves import PAGE, TIME, sheet
from riser_soil.results.stage_records import StageRecords, along

_STILL = 1e-9  # of the riser's length: an end that moves less stays
_ENDS = (("start", 0, "end A"), ("end", -1, "end B"))
_ENERGIES = {
    "kinetic_energy": "kinetic",
    "strain_energy": "elastic",
    "potential_energy": "potential",
    "dissipated": "dissipated",
    "work": "work",
}
_SIZES = ((1e9, "GJ"), (1e6, "MJ"), (1e3, "kJ"), (1.0, "J"))


def ends(stage: StageRecords) -> Figure:
    """Motion of both ends since the load step began, effective tension there where it is recorded, and what the
    supports exert.
    """
    tensions = stage.run.has("effective_tension")
    figure, panels = sheet(3 + tensions, 1, width=PAGE, height=1.45)
    moved, upright, level = panels[0], panels[-2], panels[-1]
    position, t = stage["position"], stage.time
    direction = along(stage.run["position"][0])
    _draw_motion(moved, t, position)
    for n, (name, at, label) in enumerate(_ENDS):
        force = stage[f"{name}_force"]
        toward = -1.0 if name == "start" else 1.0
        if tensions:
            panels[1].plot(t, 1e-3 * stage["effective_tension"][:, at], color=f"C{n}", label=label)
        upright.plot(t, 1e-3 * force[:, 2], color=f"C{n}", label=label)
        level.plot(t, 1e-3 * toward * (force @ direction), color=f"C{n}", label=label)
    _name(moved, "displacement\nof the ends [m]")
    if tensions:
        _name(panels[1], "effective tension\n[kN], + pulls")
    _name(upright, "support's vertical\nforce [kN], + up")
    _name(level, "support's horizontal\nforce [kN], + taut")
    return _in_time(figure)


def touchdown(stage: StageRecords) -> Figure:
    """Arc length of the touchdown point, contact force and deepest penetration."""
    figure, (arc, force, deep) = sheet(3, 1, width=PAGE, height=1.35)
    arc.plot(stage.time, stage["touchdown_arc"])
    force.plot(stage.time, 1e-3 * stage["contact_force_sum"][:, 2])
    deep.plot(stage.time, 1e3 * stage["max_penetration"])
    _name(arc, "TDP,\narc length [m]")
    _name(force, "sum of contact\nforces [kN], + up")
    _name(deep, "deepest\npenetration [mm]")
    return _in_time(figure)


def least_and_tightest(stage: StageRecords) -> Figure:
    """Minimum effective tension and bend radius along the riser, the least of each marked with its time and place."""
    figure, panels = sheet(2, 1, width=PAGE, height=1.8)
    for axes, name, factor, unit, words in (
        (panels[0], "min_effective_tension", 1e-3, "kN", "minimum effective\ntension [kN]"),
        (panels[1], "min_bend_radius", 1.0, "m", "minimum bend\nradius (MBR) [m]"),
    ):
        values, arcs = factor * stage[name], stage[f"{name}_arc"]
        axes.plot(stage.time, values)
        if np.isfinite(values).any():
            n = int(np.nanargmin(values))
            axes.plot(stage.time[n], values[n], "o", color="C3", markersize=4.0)
            at = f"{values[n]:.4g} {unit} at {stage.time[n]:.4g} s, arc length {arcs[n]:.4g} m"
            axes.set_title(at, loc="right", color="C3", fontsize="small")
        _name(axes, words)
    return _in_time(figure)


def energy(stage: StageRecords) -> Figure:
    """Energy stored, dissipated and put in since the stage began; the balance's residual over what was turned over."""
    figure, (stored, residual) = sheet(2, 1, width=PAGE, height=2.1)
    of_step = stage.run["step_stage"] == stage.number
    t = stage.run["step_time"][of_step]
    curves = {words: stage.run[name][of_step] for name, words in _ENERGIES.items()}
    curves["potential"] = curves["potential"] - curves["potential"][0]
    largest = max(float(np.abs(values).max()) for values in curves.values())
    size, unit = next((each for each in _SIZES if largest >= each[0]), _SIZES[-1])
    for words, values in curves.items():
        stored.plot(t, values / size, linewidth=1.0, label=words if words != "potential" else "potential, changed by")
    residual.plot(t, 100.0 * stage.run["relative_energy_residual"][of_step], color="k", linewidth=1.0)
    _name(stored, f"energy [{unit}]")
    above = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0)}
    stored.legend(fontsize="small", ncols=5, frameon=False, **above)
    _name(residual, "residual, % of the\nlargest energy")
    return _in_time(figure)


def solver(stage: StageRecords) -> Figure:
    """Newton iterations, time step and failed attempts of every step."""
    figure, (iterations, length, cuts) = sheet(3, 1, width=PAGE, height=1.5)
    of_step = stage.run["step_stage"] == stage.number
    t = stage.run["step_time"][of_step]
    for axes, name, words in (
        (iterations, "newton_iterations", "Newton\niterations"),
        (length, "time_step", "time step [s]"),
        (cuts, "step_cuts", "failed\nattempts"),
    ):
        values = stage.run[name][of_step]
        axes.plot(t, values, ".", markersize=3)
        axes.set_ylim(0.0, 1.15 * float(values.max()) or 1.0)
        _name(axes, words)
    for axes in (iterations, cuts):
        axes.yaxis.set_major_locator(MaxNLocator(integer=True, nbins=5))
    return _in_time(figure)


def compare(axes: Axes, stages: dict[str, StageRecords], values: dict[str, Array], words: str) -> None:
    """One quantity (nr,) of several runs by their labels."""
    for label, stage in stages.items():
        axes.plot(stage.time, values[label], linewidth=1.0, label=label)
    axes.set_xlabel(TIME)
    _name(axes, words)


def _draw_motion(axes: Axes, t: Array, position: Array) -> None:
    length = float(np.ptp(position, axis=(0, 1)).max())
    for _, at, label in _ENDS:
        moved = position[:, at] - position[0, at]
        for axis, direction in enumerate("xyz"):
            if np.ptp(moved[:, axis]) > _STILL * length:
                axes.plot(t, moved[:, axis], label=f"{label}, {direction}")


def _name(axes: Axes, words: str) -> None:
    axes.set_ylabel(words)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize="small", ncols=3)


def _in_time(figure: Figure) -> Figure:
    """One axis of time below all panels."""
    for axes in figure.axes:
        axes.sharex(figure.axes[-1])
        axes.label_outer()
    figure.axes[-1].set_xlabel(TIME)
    figure.align_ylabels()
    return figure
