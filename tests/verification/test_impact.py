"""A pipe falls on the ground: no energy appears beyond what gravity and supports put in.

Stiffnesses and time steps are those at which average acceleration of the contact force gains several times the
energy of the fall (see riser_soil.solve.time_scheme).
"""

from __future__ import annotations

from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from benchmarks.impact import (
    AVERAGED,
    DEFAULT,
    DISCRETE,
    STIFFNESSES,
    TIME_STEPS,
    Method,
    full_table,
    outcome,
    pair_table,
)
from riser_soil.assembly import build
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.results.riser_record import riser_record
from riser_soil.scene.reader import read_scene
from riser_soil.scene.scene import Scene
from riser_soil.solve.newton import Newton
from riser_soil.solve.step import Solution, Step
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from tests.support.driven_stage import Watcher, built, take
from tests.support.scenes import FALL, Mapping, flat, pinned, tilted
from tests.support.stage_histories import Energies, stage_histories

AVERAGE = {"newmark": {"beta": 0.25, "gamma": 0.5}}
PAGE = Path(__file__).parents[2] / "docs" / "impact.md"
TANK = Path(__file__).parents[1] / "scenes" / "tank.yaml"
PAIRS = list(product((1e6, 1e7, 1e8), (0.1, 0.02, 0.005)))


def energies(scene: Mapping) -> Energies:
    """Energies of a scene's only stage."""
    assembly, watch = built(scene), Energies()
    run_stage(assembly, assembly.scene.stages[0], State.at_rest(0.0, assembly.size), watch, Timer.new())
    return watch


@pytest.mark.parametrize("scene", [pinned, flat, tilted])
@pytest.mark.parametrize(("k", "dt"), PAIRS)
def test_default_scheme_gains_no_energy_by_impact(scene: Any, k: float, dt: float) -> None:
    watch = energies(scene(k, dt))
    assert watch.gain[-1] < -0.5 * FALL, "the pipe has not come to rest on the ground"
    assert watch.gain.max() < 1e-4 * FALL
    assert watch.by_contact.min() > -1e-9 * FALL
    assert watch.appeared.max() < 0.1 * FALL


@pytest.mark.parametrize(("k", "dt"), PAIRS)
def test_average_acceleration_gains_no_energy_by_impact(k: float, dt: float) -> None:
    """Without numerical damping of the pipe, at finer steps what it rings with stays; it never exceeds the start."""
    scene = flat(k, dt)
    scene["stages"][0]["scheme"] = AVERAGE
    watch = energies(scene)
    assert watch.gain.max() < 1e-4 * FALL
    assert watch.by_contact.min() > -1e-9 * FALL


def test_step_that_makes_energy_out_of_nothing_is_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    """Steps have roots far from the motion that they continue. The fourth step is given one: the pipe blown apart."""
    usual, calls = Newton.solve, list[float]()

    def solve(self: Newton, step: Step) -> Solution:
        solution = usual(self, step)
        calls.append(step.t)
        if len(calls) != 4:
            return solution
        far = step.scheme.trial(step.before, step.t, step.dt, 50.0 * solution.state.u)
        self.system.prescribe(far)
        return Solution(far, self.system.forces(far), solution.norms)

    monkeypatch.setattr(Newton, "solve", solve)
    assembly, cuts = built(pinned(1e6, 0.1) | {"solver": {"tolerance": 1e-9, "newton": "snes"}}), list[int]()
    take(assembly, assembly.scene.stages[0], watch=lambda _, step: cuts.append(step.cuts))
    assert cuts[:5] == [0, 0, 0, 1, 0]
    np.testing.assert_allclose(calls[3:5], [0.4, 0.35], atol=1e-12)


def automatic(tolerance: float) -> Mapping:
    """The swinging pipe on the stiffest springs, with automatic steps until soon after it has struck."""
    scene = pinned(1e8, 0.1)
    scene["stages"][0] |= {"time_step": "auto", "tolerance": tolerance, "duration": 0.8}
    return scene


def test_automatic_steps_find_the_impact() -> None:
    """Before it steps are long; the impact, whose contact lasts about pi sqrt(m/k) = 3.4 ms, is as finely resolved as
    the tolerance asks. Its energy is still kept.
    """
    coarse, fine = stage_histories(automatic(2e-2))[0], stage_histories(automatic(2e-3))[0]
    for history in (coarse, fine):
        assert max(history.dt[: len(history.dt) // 4]) > 5.0 * min(history.dt)
        assert sum(history.cuts) < 0.15 * len(history.dt)
    assert min(coarse.dt) > 2.0 * min(fine.dt)
    assert min(fine.dt) < 2e-3
    assert energies(automatic(2e-2)).gain.max() < 1e-4 * FALL


def test_a_pipe_that_lies_still_needs_no_cuts() -> None:
    """At rest on the floor no energy moves; what contact gives and takes within a step is none from nowhere."""
    for k, dt in ((1e6, 0.02), (1e8, 0.005)):
        assert sum(stage_histories(flat(k, dt))[0].cuts) == 0
    scene = flat(1e8, 0.1)
    scene["stages"][0] |= {"time_step": "auto"}
    history = stage_histories(scene)[0]
    assert sum(history.cuts) < 15
    assert max(history.dt) > 0.05


def test_contact_averaged_with_the_pipe_would_gain_energy() -> None:
    """The cure is what keeps the energy: contact weighed as the pipe's other forces fails the same bound."""
    assert outcome(("average acceleration", AVERAGED), flat, 1e8, 0.005).gain > 2.0


@pytest.mark.parametrize(
    "method",
    [
        DEFAULT,
        *(pytest.param(("average acceleration", each), marks=pytest.mark.verify) for each in (AVERAGED, DISCRETE)),
    ],
    ids=["default", "averaged", "discrete gradient"],
)
def test_page_tells_what_the_methods_do(method: Method) -> None:
    *_, row = pair_table([method])
    shown = next(line for line in PAGE.read_text().splitlines() if line.startswith(row[: row.index("%") - 8]))
    np.testing.assert_allclose(figures(shown), figures(row), rtol=0.02, atol=1e-6)


def figures(row: str) -> list[float]:
    """The cells [%] of a row of a table behind its two names."""
    return [float(cell.removesuffix("% ")) for cell in row.split("|")[3:-1]]


def test_tanks_top_tension_is_of_second_order() -> None:
    """The hose lifts off and lies down all the time. Below a thousandth its contact shows, which is of first order."""
    reference, *coarser = (top_tension(dt) for dt in (0.005, 0.08, 0.04, 0.02))
    errors = [np.abs(T - reference[(i := reference.size // T.size) - 1 :: i]).max() for T in coarser]
    assert errors[-1] < 2e-3 * np.ptp(reference)
    assert np.log2(errors[0] / errors[-1]) / 2.0 > 1.8


def top_tension(dt: float) -> Array:
    """Top tension of the hose in the tank through the first seconds of its swing [N]."""
    tension = list[float]()
    scene = tank(1e6, dt, duration=2.4, ramp=2.4)
    assembly = build(scene, MPI.COMM_SELF)
    before = take(assembly, scene.stages[0])

    def watch(stepper: TimeStepper, _: AcceptedStep) -> None:
        tension.append(float(riser_record(assembly.riser, stepper).effective_tension[-1]))

    run_stage(assembly, scene.stages[1], before, Watcher(watch), Timer.new())
    return np.array(tension)


def tank(k: float, dt: float, duration: float, ramp: float) -> Scene:
    """The hose in a tank with fewer elements and a contact stiffness k [N/m2]."""
    stage = {"time_step": dt, "duration": duration, "motion.end.arc.ramp": ramp}
    overrides = [f"stages.1.{key}={value}" for key, value in stage.items()]
    return read_scene(
        TANK,
        [
            *overrides,
            f"contact.stiffness={k}",
            "contact.smoothing=1e-3",
            "riser.segments.0.elements=60",
            "solver.tolerance=1e-9",
        ],
    )


@pytest.mark.parametrize(("k", "dt"), [(1e4, 0.2), (1e9, 0.1)])
def test_tank_gains_no_energy(k: float, dt: float) -> None:
    no_energy_appears_in_the_tank(k, dt)


@pytest.mark.verify
@pytest.mark.parametrize("k", STIFFNESSES)
def test_tank_gains_no_energy_at_any_step(k: float) -> None:
    for dt in TIME_STEPS:
        no_energy_appears_in_the_tank(k, dt)


def no_energy_appears_in_the_tank(k: float, dt: float) -> None:
    """Beyond the work of the arm; the hose's own motion is integrated to (dt/period)^2."""
    scene = tank(k, dt, duration=6.0, ramp=2.0)
    assembly, watch = build(scene, MPI.COMM_SELF), Energies()
    before = take(assembly, scene.stages[0])
    run_stage(assembly, scene.stages[1], before, watch, Timer.new())
    print(f"tank, k {k:.0e} N/m2, dt {dt:g} s: {watch.report()}")
    turned_over = np.ptp(watch.gain)
    assert watch.gain.max() < 1e-4 * turned_over
    assert watch.appeared.max() < 1e-3 * turned_over
    assert watch.by_contact.min() > -1e-9 * turned_over


@pytest.mark.verify
@pytest.mark.parametrize("scene", [pinned, flat, tilted])
@pytest.mark.parametrize("k", STIFFNESSES)
def test_default_scheme_gains_no_energy_at_any_step(scene: Any, k: float) -> None:
    for dt in TIME_STEPS:
        watch = energies(scene(k, dt))
        print(f"{scene.__name__}, k {k:.0e} N/m2, dt {dt:g} s: {watch.report()}")
        landed = int(np.flatnonzero(watch.by_contact)[0])
        assert watch.gain[landed:].max() < 1e-9 * FALL
        assert watch.gain.max() < 2e-4 * FALL, "in free swing, of second order in the step"
        assert watch.by_contact.min() > -1e-9 * FALL
        assert watch.appeared.max() < 0.1 * FALL


@pytest.mark.verify
def test_page_tells_what_the_default_does_at_any_step() -> None:
    *_, row = full_table([DEFAULT])
    print(row)
    assert row in PAGE.read_text().splitlines()
    assert row.split("|")[3].strip() == "0 %"
