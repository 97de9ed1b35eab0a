"""A pipe falls on the ground: no energy appears beyond what gravity and supports put in.

Stiffnesses and time steps are those at which average acceleration of the contact force gains several times the
energy of the fall (see riser_soil.time_scheme).
"""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pytest

from riser_soil.arrays import Array
from riser_soil.contact.seabed_contact import SeabedContact
from riser_soil.march import Accepted
from riser_soil.newton import Newton, Solution, Step
from riser_soil.part import Forces, State, Weights
from riser_soil.run import run_stage
from riser_soil.system import Clock, System
from riser_soil.time_scheme import GeneralizedAlpha
from tests.coupled_scenes import Mapping
from tests.driven_stage import Watcher, before_commit, built, take
from tests.riser_scenes import tell

WEIGHT, LENGTH, DROP = 700.0, 20.0, 1.0  # N/m, m, m
FALL = WEIGHT * LENGTH * DROP  # J, a measure of the energy in play
AVERAGE = {"newmark": {"beta": 0.25, "gamma": 0.5}}
PAIRS = list(product((1e6, 1e7, 1e8), (0.1, 0.02, 0.005)))
TILTED = {"points": [[0.0, 0.0, 0.0], [19.9, 0.0, 1.9974984]]}


def fall(seabed: str, start: Any, initial: Any, k: float, dt: float) -> Mapping:
    """A pipe of 20 m comes down by its weight on a floor 1 m below its start; k [N/m2]."""
    pipe = {"EA": 3e7, "EI": 5e4, "mass": 120.0, "outer_diameter": 0.3, "submerged_weight": WEIGHT}
    scene: Mapping = {
        "title": "A pipe falls on the ground",
        "gravity": 9.81,
        "dimension": 2,
        "line_types": {"pipe": pipe},
        "riser": {
            "segments": [{"line_type": "pipe", "length": LENGTH, "elements": 20}],
            "start": start,
            "end": "free",
            "initial": initial,
        },
        "seabed": {"kind": seabed, "level": -DROP},
        "stages": [{"name": "fall", "kind": "dynamic", "duration": 3.0, "time_step": dt}],
        "solver": {"tolerance": 1e-9},
    }
    (scene["seabed"] if seabed == "spring" else scene.setdefault("contact", {}))["stiffness"] = k
    return scene


def pinned(k: float, dt: float) -> Mapping:
    """Hinged at its start, the pipe swings down on springs."""
    return fall("spring", {"position": [0.0, 0.0, 0.0], "rotation": "free"}, TILTED, k, dt)


def flat(k: float, dt: float) -> Mapping:
    """Free at both ends, level: all nodes strike a rigid floor at once."""
    return fall("rigid", "free", "straight", k, dt)


def tilted(k: float, dt: float) -> Mapping:
    """Free at both ends, one end strikes a rigid floor first."""
    return fall("rigid", "free", TILTED, k, dt)


class Fall:
    """Energies over a fall [J], one entry a step: the model's `gain` since the start beyond the work of supports, and
    the ledger's residual `appeared`, > 0 for energy from nowhere.
    """

    def __init__(self, scene: Mapping) -> None:
        world, steps = built(scene), list[Accepted]()
        self.least_dissipated_by_contact = np.inf

        def watch(system: System, step: Accepted) -> None:
            steps.append(step)
            assert world.seabed is not None
            after = step.solution.state
            taken = world.seabed.work(State.at_rest(0.0, after.u.size), after).dissipated
            self.least_dissipated_by_contact = min(self.least_dissipated_by_contact, taken)

        watcher = Watcher()
        with before_commit(watch):
            run_stage(world, world.scene.stages[0], State.at_rest(0.0, world.size), watcher, Clock.new())
        change = np.array([s.energy.total for s in steps]) - watcher.energy_at_start.total
        work = np.cumsum([s.work for s in steps])
        self.gain: Array = change - work
        self.appeared: Array = self.gain + np.cumsum([s.dissipated for s in steps])


@pytest.mark.parametrize("scene", [pinned, flat, tilted])
@pytest.mark.parametrize(("k", "dt"), PAIRS)
def test_default_scheme_gains_no_energy_by_impact(scene: Any, k: float, dt: float) -> None:
    seen = Fall(scene(k, dt))
    assert seen.gain[-1] < -0.5 * FALL, "the pipe has not come to rest on the ground"
    assert seen.gain.max() < 1e-4 * FALL
    assert seen.least_dissipated_by_contact > -1e-9 * FALL
    assert seen.appeared.max() < 0.1 * FALL


@pytest.mark.parametrize(("k", "dt"), PAIRS)
def test_average_acceleration_gains_no_energy_by_impact(k: float, dt: float) -> None:
    """Without numerical damping of the pipe, at finer steps what it rings with stays; it never exceeds the start."""
    scene = flat(k, dt)
    scene["stages"][0]["scheme"] = AVERAGE
    seen = Fall(scene)
    assert seen.gain.max() < 1e-4 * FALL
    assert seen.least_dissipated_by_contact > -1e-9 * FALL


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
    world, cuts = built(pinned(1e6, 0.1)), list[int]()
    take(world, world.scene.stages[0], watch=lambda _, step: cuts.append(step.cuts))
    assert cuts[:5] == [0, 0, 0, 1, 0]
    np.testing.assert_allclose(calls[3:5], [0.4, 0.35], atol=1e-12)


def test_contact_averaged_with_the_pipe_would_gain_energy(monkeypatch: pytest.MonkeyPatch) -> None:
    """The cure is what keeps the energy: contact weighed as the pipe's other forces fails the same bound."""
    at_the_end, exact = SeabedContact.residual, SeabedContact.tangent

    def averaged(self: SeabedContact, state: State, forces: Forces) -> None:
        at_the_end(self, state, Forces(forces.inertia, forces.force, end=forces.force))

    def tangent(self: SeabedContact, state: State, weights: Weights, values: dict[str, Array]) -> None:
        own = {key: np.zeros_like(v) for key, v in values.items()}
        exact(self, state, weights, own)
        for key, value in own.items():
            values[key] += weights.force * value

    monkeypatch.setattr(SeabedContact, "residual", averaged)
    monkeypatch.setattr(SeabedContact, "tangent", tangent)
    monkeypatch.setattr(GeneralizedAlpha, "split_contact", lambda self, state, contact, dt: state)
    monkeypatch.setattr("riser_soil.march.WRONG_ROOT", np.inf)  # or its steps would be cut
    scene = flat(1e8, 0.005)
    scene["stages"][0]["scheme"] = AVERAGE
    assert Fall(scene).gain.max() > 2.0 * FALL


def automatic(tolerance: float) -> Mapping:
    """The swinging pipe on the stiffest springs, with automatic steps until soon after it has struck."""
    scene = pinned(1e8, 0.1)
    scene["stages"][0] |= {"time_step": "auto", "tolerance": tolerance, "duration": 0.8}
    return scene


def test_automatic_steps_find_the_impact() -> None:
    """Before it steps are long; the impact, whose contact lasts about pi sqrt(m/k) = 3.4 ms, is as finely resolved as
    the tolerance asks. Its energy is still kept.
    """
    coarse, fine = tell(automatic(2e-2))[0], tell(automatic(2e-3))[0]
    for told in (coarse, fine):
        assert max(told.dt[: len(told.dt) // 4]) > 5.0 * min(told.dt)
        assert sum(told.cuts) < 0.15 * len(told.dt)
    assert min(coarse.dt) > 2.0 * min(fine.dt)
    assert min(fine.dt) < 2e-3
    assert Fall(automatic(2e-2)).gain.max() < 1e-4 * FALL


def test_a_pipe_that_lies_still_needs_no_cuts() -> None:
    """At rest on the floor no energy moves; what contact gives and takes within a step is none from nowhere."""
    for k, dt in ((1e6, 0.02), (1e8, 0.005)):
        assert sum(tell(flat(k, dt))[0].cuts) == 0
    scene = flat(1e8, 0.1)
    scene["stages"][0] |= {"time_step": "auto"}
    told = tell(scene)[0]
    assert sum(told.cuts) < 15
    assert max(told.dt) > 0.05
