"""The surging riser's extremes over the last three of its ten periods, and how far two runs are apart."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from demos.catenary.statics import SCENE
from demos.compute import timed
from riser_soil.core.arrays import Array
from riser_soil.results import Run
from riser_soil.results.stage_records import peak, reactions

SINCE = 98.0  # s, seven periods: the motion repeats itself by then
FORCES = ("H1", "V1", "H2", "V2")
EXTREMES = (*(f"{name} {kind}" for name in FORCES for kind in ("min", "max")), "M max")
# Records are at least this far apart [s]: fine enough for the parabola of `peak`.
RECORDS = 0.025
COMMON = 0.2  # s between the instants at which runs of different steps are compared

UNIFORM = "riser.segments.0.elements={}"
# 10 m, but 2.5 m in the sag bend (60 to 140 m), and 0.5 m over the 2 m next to the ends: 73 elements.
GRADED = "riser.segments=[{}]".format(
    ", ".join(
        f"{{line_type: flexible, length: {length}, elements: {count}}}"
        for length, count in ((2, 4), (8, 4), (50, 5), (80, 32), (200, 20), (8, 4), (2, 4))
    )
)


@dataclass(frozen=True, eq=False)
class Surge:
    """One run: what was asked, what it cost [s of processor time], its extremes by EXTREMES [kN, N.m]."""

    elements: int
    time_step: float
    seconds: float
    extremes: dict[str, float]
    arc: float  # m, node of the largest moment
    run: Run


def surge(folder: Path, mesh: str, time_step: float, *overrides: str) -> Surge:
    """The scene with a mesh (an override) and a time step [s]."""
    interval = f"output.interval={max(time_step, RECORDS)}"
    output = (interval, "output.xdmf_interval=14.0", "output.fields=[bending_moment]")
    run, seconds = timed(SCENE, folder, mesh, f"stages.1.time_step={time_step}", *output, *overrides)
    moment = run["bending_moment"][_window(run)]
    return Surge(run.arc.size - 1, time_step, seconds, extremes(run), float(run.arc[moment.max(axis=0).argmax()]), run)


def extremes(run: Run) -> dict[str, float]:
    """Extremes from SINCE on, between records and nodes: reactions [kN] as in Table 1, largest bending moment [N.m]."""
    window, forces, values = _window(run), reactions(run), {}
    for name in FORCES:
        series = 1e-3 * getattr(forces, name)[window]
        values[f"{name} min"] = -float(peak(run.time[window], -series))
        values[f"{name} max"] = float(peak(run.time[window], series))
    values["M max"] = float(peak(run.time[window], peak(run.arc, run["bending_moment"][window])))
    return values


def error(of: Surge, best: Surge, names: tuple[str, ...]) -> float:
    """Largest relative difference of some extremes."""
    return max(abs(of.extremes[name] / best.extremes[name] - 1.0) for name in names)


def series(run: Run, arcs: Array) -> dict[str, Array]:
    """Reactions, and moments and positions at the nodes of these arcs, at instants common to all runs."""
    computed = reactions(run)
    instants = np.arange(SINCE, 140.0, COMMON)
    rows, nodes = (np.abs(a[:, None] - b).argmin(axis=0) for a, b in ((run.time, instants), (run.arc, arcs)))
    forces = {name: getattr(computed, name)[rows] for name in FORCES}
    return forces | {"M": run["bending_moment"][rows][:, nodes], "position": run["position"][rows][:, nodes]}


def orders(coarse: Surge, middle: Surge, fine: Surge) -> dict[str, float]:
    """Observed order of each series: log2 of the ratio of the root mean square differences of neighbouring runs."""
    a, b, c = (series(each.run, coarse.run.arc) for each in (coarse, middle, fine))
    return {name: float(np.log2(np.linalg.norm(b[name] - a[name]) / np.linalg.norm(c[name] - b[name]))) for name in a}


def _window(run: Run) -> Array:
    return np.asarray(run.time >= SINCE - 1e-9)
