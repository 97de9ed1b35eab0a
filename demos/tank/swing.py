"""The swinging hose's extremes over the last four of its six periods, and how far two runs are apart."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from demos.compute import timed
from demos.tank.statics import HERE, ROUNDED, WEIGHT
from riser_soil.core.arrays import Array
from riser_soil.results import Run
from riser_soil.results.stage_records import peak

SCENE = HERE / "scene.yaml"
SINCE, UNTIL = 20.0, 60.0  # s, periods 3 to 6: the first is the ramp
EXTREMES = ("top min", "top max", "bottom min", "bottom max", "M max", "touchdown min", "touchdown max")
FORCES, MOMENT, TOUCHDOWN = EXTREMES[:4], EXTREMES[4:5], EXTREMES[5:]
# Records are at least this far apart [s]: fine enough for the parabola of `peak`.
RECORDS = 0.025
COMMON = 0.1  # s between the instants at which runs of different steps are compared
NEAR_TOUCHDOWN = 23.0  # m of arc: the point whose motion the paper's figure 6 shows, as far as one can tell
OUTPUT = ("output.xdmf_interval=10.0", "output.fields=[effective_tension, bending_moment]")


@dataclass(frozen=True, eq=False)
class Swing:
    """One run: what was asked, what it cost [s of processor time], its extremes by EXTREMES [N, N.m, m]."""

    elements: int
    time_step: float
    stiffness: float
    seconds: float
    extremes: dict[str, float]
    run: Run

    @property
    def stage(self) -> dict[str, float]:
        """Newton iterations a step, step cuts, largest energy residual over the energy exchanged; of the motion."""
        stage = self.run.summary["stages"][-1]
        residual = abs(stage["energy"]["worst_residual"]["value"]) / stage["energy"]["turned_over"]
        return {
            "iterations": stage["newton_iterations"] / stage["steps"],
            "cuts": stage["step_cuts"],
            "energy": residual,
        }


def swing(folder: Path, elements: int, time_step: float, stiffness: float, *overrides: str) -> Swing:
    """The scene with a number of elements, a time step [s] and a contact stiffness [N/m2], whose corner is rounded over
    a tenth of the depth at rest.
    """
    run, seconds = timed(
        SCENE,
        folder,
        f"riser.segments.0.elements={elements}",
        f"stages.1.time_step={time_step}",
        f"contact.stiffness={stiffness!r}",
        f"contact.smoothing={ROUNDED * WEIGHT / stiffness!r}",
        f"output.interval={max(time_step, RECORDS)}",
        *OUTPUT,
        *overrides,
    )
    return Swing(elements, time_step, stiffness, seconds, extremes(run), run)


def extremes(run: Run) -> dict[str, float]:
    """Extremes from SINCE on, between records and nodes: tension at top and bottom [N], bending moment [N.m], touchdown
    arc [m].
    """
    window = run.time >= SINCE - 1e-9
    t, tension = run.time[window], run["effective_tension"][window]
    values: dict[str, float] = {}
    for name, q in (("top", tension[:, -1]), ("bottom", tension[:, 0]), ("touchdown", run["touchdown_arc"][window])):
        values |= {f"{name} min": -float(peak(t, -q)), f"{name} max": float(peak(t, q))}
    values["M max"] = float(peak(t, peak(run.arc, run["bending_moment"][window])))
    return {name: values[name] for name in EXTREMES}


def error(of: Swing, best: Swing, names: tuple[str, ...]) -> float:
    """Largest difference of some extremes: of tensions over the greatest at that end, of the moment over itself, of the
    touchdown arc in metres.
    """
    return max(abs(of.extremes[name] - best.extremes[name]) / _scale(best, name) for name in names)


def _scale(best: Swing, name: str) -> float:
    if name in TOUCHDOWN:
        return 1.0
    return best.extremes[f"{name.split()[0]} max"]


def series(run: Run, arcs: Array) -> dict[str, Array]:
    """Tensions, touchdown arc, and moments and positions at the nodes of these arcs, at instants common to all runs."""
    instants = np.arange(SINCE, UNTIL - 1e-9, COMMON)
    rows, nodes = (np.abs(a[:, None] - b).argmin(axis=0) for a, b in ((run.time, instants), (run.arc, arcs)))
    tension = run["effective_tension"][rows]
    return {
        "top": tension[:, -1],
        "bottom": tension[:, 0],
        "touchdown": run["touchdown_arc"][rows],
        "M": run["bending_moment"][rows][:, nodes],
        "position": run["position"][rows][:, nodes],
    }


def orders(coarse: Swing, middle: Swing, fine: Swing) -> dict[str, float]:
    """Observed order of each series: log2 of the ratio of the root mean square differences of neighbouring runs."""
    a, b, c = (series(each.run, coarse.run.arc) for each in (coarse, middle, fine))
    return {name: float(np.log2(np.linalg.norm(b[name] - a[name]) / np.linalg.norm(c[name] - b[name]))) for name in a}
