"""Soil that is stronger the faster it is sheared: time of a step, tangent, energy, state, new meshes, stages."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from riser_soil.checks.ground_plausibility import ground_warnings
from riser_soil.core.part import State
from riser_soil.core.system import System, Timer
from riser_soil.soil.iwan import IwanOverlay
from riser_soil.soil.kinematic_hardening import KinematicHardening
from riser_soil.soil.rate import Rate
from riser_soil.soil.remoulding import Remoulding
from riser_soil.soil.soil import Soil
from riser_soil.soil.von_mises import VonMises
from riser_soil.solve.newton import balance_under_fixed_lines
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.time_stepper import AcceptedStep
from tests.support.driven_stage import built, soil_under, take
from tests.support.scenes import LAY, Mapping, heave, touchdown
from tests.support.soil_bench import assemble, force
from tests.support.soil_cases import distorted, moved, sheared, small_block

SU, MU, SLOW = 4.0e3, 0.1, 1.0e-5
GIVEN: dict[str, Any] = {"su": SU, "E_over_su": 300.0, "rate": Rate(mu=MU, reference=SLOW)}
VISCOUS = VonMises(kind="von-mises", **GIVEN)
LAWS = (
    VISCOUS,
    KinematicHardening(kind="kinematic-hardening", **GIVEN, remoulding=Remoulding(sensitivity=3.0, xi_95=1.0)),
    IwanOverlay(kind="iwan", elements=6, **GIVEN),
)


def block(law: Any = VISCOUS, moves: bool = False, unit_weight: float = 0.0) -> Soil:
    return Soil(distorted(small_block("hex")), law.at_points, level=0.0, unit_weight=unit_weight, moves=moves)


def accept(soil: Soil, state: State) -> None:
    soil.commit(state)
    soil.field.commit(state)


def shear_stress(soil: Soil) -> float:
    stress = soil.state()["law/stress"]
    assert np.ptp(stress[:, 4]) < 1e-9 * SU
    return float(stress[:, 4].mean()) / math.sqrt(2.0)


def strength_used(soil: Soil) -> float:
    """Most of its strength in slow shear that any point bears."""
    return float(soil.law.overstress(soil.state()["law/stress"]).max())


@pytest.mark.parametrize("moves", [False, True])
def test_a_block_sheared_in_time_bears_the_strength_of_its_rate(moves: bool) -> None:
    """At large strain, too, where the law is asked again when a step is accepted."""
    for times, gain in ((1.0, 0.0), (100.0, 2.0 * MU), (math.inf, math.inf)):
        soil = block(moves=moves)
        for _ in range(40):
            accept(soil, replace(sheared(soil, 1e-3), dt=1e-3 / (times * SLOW)))
        if times < math.inf:
            assert shear_stress(soil) == pytest.approx(SU * (1.0 + gain), rel=2e-3 if moves else 1e-6)
        else:
            assert shear_stress(soil) == pytest.approx(0.04 * soil.law.shear[0], rel=2e-2)  # at once is elastic


def test_statics_are_slow_and_an_accepted_state_rests_in_no_time() -> None:
    soil = block()
    for _ in range(40):
        accept(soil, replace(sheared(soil, 1e-3), dt=1.0))
    fast = force(soil, State.at_rest(0.0, soil.field.size))
    assert shear_stress(soil) > 1.19 * SU
    slow = force(soil, replace(State.at_rest(0.0, soil.field.size), dt=math.inf))
    np.testing.assert_allclose(slow, fast * SU / shear_stress(soil), atol=1e-9 * np.abs(fast).max())


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.kind)
def test_the_tangent_is_the_slope_of_the_force_within_the_step(law: Any) -> None:
    soil = block(law)
    accept(soil, replace(moved(soil, 2e-3, seed=1), dt=0.5))
    state = replace(moved(soil, 4e-3, seed=2), dt=2.0)
    tangent, slow = assemble(soil, state), assemble(soil, replace(state, dt=math.inf))
    for seed in range(3):
        direction = moved(soil, 1.0, seed=10 + seed).u
        ahead, behind = (force(soil, replace(state, u=state.u + s * 1e-8 * direction)) for s in (1.0, -1.0))
        numeric = (ahead - behind) / 2e-8
        assert np.linalg.norm(tangent @ direction - numeric) < 1e-6 * np.linalg.norm(numeric)
        assert np.linalg.norm(slow @ direction - numeric) > 1e-3 * np.linalg.norm(numeric)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.kind)
@pytest.mark.parametrize("moves", [False, True])
def test_energy_is_balanced_in_steps_of_any_time(law: Any, moves: bool) -> None:
    soil = block(law, moves, unit_weight=5.0e3)
    rest = State.at_rest(0.0, soil.field.size)
    stored = soil.energy(rest).total
    for seed, dt in enumerate((1.0, 1e-2, 1e3, math.inf, 0.1)):
        state = replace(moved(soil, 2e-3, seed=seed), dt=dt)
        put_in, work = float(force(soil, state) @ state.u), soil.work(rest, state)
        after = soil.energy(state).total
        assert work.dissipated - work.by_scheme > 0.0
        assert after - stored + work.dissipated == pytest.approx(put_in, rel=1e-9)
        accept(soil, state)
        assert soil.energy(rest).total == pytest.approx(after, rel=1e-9) or moves
        stored = after


def test_the_state_that_was_saved_goes_on_with_the_stress_that_it_had() -> None:
    first, again = block(), block()
    accept(first, replace(moved(first, 4e-3), dt=1.0))
    again.restore(first.state())
    again.field.restore(first.field.state())
    state = replace(moved(first, 1e-3, seed=3), dt=0.2)
    np.testing.assert_array_equal(force(again, state), force(first, state))


def test_a_new_mesh_takes_over_what_fast_shear_has_left() -> None:
    soil = block(moves=True)
    for _ in range(30):
        accept(soil, replace(sheared(soil, 1e-3), dt=1.0))
    before = shear_stress(soil)
    soil.take_mesh(soil.points[np.argsort(soil.grid.nodes.number)])
    assert before > 1.19 * SU
    assert shear_stress(soil) == pytest.approx(before, rel=1e-12)


@pytest.mark.parametrize(
    ("stages", "reference", "message"),
    [
        ([LAY], 1e-5, "has no other"),
        ([LAY, heave(3.0)], 10.0, "10 1/s, is more than the fastest end makes over a diameter, 2.09 1/s"),
        ([LAY, heave(3.0)], 2.0, ""),
    ],
)
def test_a_rate_that_changes_nothing_is_reported(stages: list[Mapping], reference: float, message: str) -> None:
    """The end heaves by up to 0.3 m * 2 pi / 3 s = 0.628 m/s, over a diameter of 0.3 m."""
    scene = touchdown(*stages)
    scene["soil"]["law"]["rate"] = {"mu": 0.1, "reference": reference}
    texts = [text for text in ground_warnings(built(scene).riser) if "soil.law.rate" in text]
    assert (message in texts[0]) if message else not texts


def test_steps_tell_their_time_and_held_lines_leave_the_soil_none() -> None:
    """A new mesh is balanced at once: what fast flow has borne stays."""
    scene = touchdown(LAY, heave(1.5, 0.15), su=450.0)
    scene["soil"]["law"]["rate"] = {"mu": 0.2, "reference": 1e-5}
    scene["soil"]["strain"] = "small"
    assembly, times = built(scene), list[float]()
    soil, (lay, last) = soil_under(assembly).whole, assembly.scene.stages

    def watch(system: System, step: AcceptedStep) -> None:
        times.append(step.solution.state.dt)

    state = take(assembly, lay, None, watch)
    assert {*times} == {math.inf}
    assert state.dt == 0.0
    times.clear()
    take(assembly, last, state, watch)
    assert times == pytest.approx([0.15] * 10)
    used = strength_used(soil)
    settings = NewtonSettings(assembly.scene.solver.tolerance, 20, assembly.scales.force_floor)
    balance_under_fixed_lines(assembly.comm, assembly.begin(last), 1.5, settings, Timer.new())
    assert used > 1.05
    assert strength_used(soil) == pytest.approx(used, rel=1e-6)
