"""A pipe segment pressed into moving clay, up and down again: what rate and remoulding do to later cycles."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.system import System
from riser_soil.scene.reader import read_scene
from riser_soil.solve.time_stepper import AcceptedStep
from tests.support.driven_stage import built_of, take

pytestmark = pytest.mark.verify
SCENE = Path(__file__).parents[2] / "demos" / "pipe_segment" / "scene.yaml"
RATE, REMOULDING = "rate: {mu: 0.1, reference: 1.0e-5}", "remoulding: {sensitivity: 3.0, xi_95: 2.0}"
DOWN, UP, CYCLES = 0.03, 0.004, 4  # m


def lowest(place: Path, law: str, seconds: float = 1.0) -> tuple[Array, float]:
    """Force [N] each time that the pipe is deepest, ways of 2 mm taking so many seconds; the least that clay took in a
    step over the most.
    """
    z = np.concatenate([np.linspace(0.0, -DOWN, 16), *[-DOWN + UP * np.array([0.5, 1.0, 0.5, 0.0])] * CYCLES])
    rows = [f"{seconds * n!r}, 0, 0, {height!r}" for n, height in enumerate(z.tolist())]
    (place / "path.csv").write_text("\n".join(["t [s], x [m], y [m], z [m]", *rows]) + "\n")
    table = [f"stages.0.motion.{end}.table={place / 'path.csv'}" for end in ("start", "end")]
    times = [f"stages.0.duration={seconds * (len(z) - 1)!r}", f"stages.0.time_step={0.25 * seconds!r}"]
    times.append("stages.0.kind=dynamic")  # equilibria know no rate
    clay = f"soil.law={{kind: von-mises, su: 5.0e3, E_over_su: 300.0, {law}}}"
    scene = read_scene(SCENE, (*table, *times, clay, "contact.method=surface"))
    assembly = built_of(scene)
    forces, lost = {0.0: 0.0}, list[float]()

    def watch(system: System, step: AcceptedStep) -> None:
        acting = step.solution.forces.end[: assembly.riser.line.size]
        forces[round(step.t / seconds, 3)] = abs(float(assembly.riser.line.nodal(acting)[:, 1].sum()))
        lost.append(step.turned["soil"].dissipated)

    take(assembly, scene.stages[0], None, watch)
    return np.array([forces[15.0 + 4.0 * n] for n in range(CYCLES + 1)]), min(lost) / max(lost)


def test_a_segment_driven_ten_times_as_fast_meets_mu_times_the_resistance_more(tmp_path: Path) -> None:
    slow = lowest(tmp_path, "nu: 0.49")[0][0]
    (first, one), (faster, other) = (lowest(tmp_path, RATE, seconds) for seconds in (1.0, 0.1))
    assert (faster - first)[0] == pytest.approx(0.1 * slow, rel=0.1)
    assert first[0] > 1.2 * slow
    assert min(one, other) > -1e-9


def test_rate_and_remoulding_leave_later_cycles_less(tmp_path: Path) -> None:
    """A tenth within four of them, from a first penetration between those of either alone."""
    rate, remoulding, both = (lowest(tmp_path, law)[0] for law in (RATE, REMOULDING, f"{RATE}, {REMOULDING}"))
    assert remoulding[0] < both[0] < rate[0]
    assert (np.diff(both) < 0.0).all()
    assert both[-1] < 0.92 * both[0]
