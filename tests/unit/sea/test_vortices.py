"""Force of shed vortices: its formula, its phase, its tangent, its kernels and its scene."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State, Weights
from riser_soil.errors import SceneError
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.sea import vortex_law as law
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.stream_kernels import FlowAtStations
from riser_soil.sea.vortices import Push, Vortices
from tests.support import sample_water
from tests.support.dense_chain import residual, tangent
from tests.support.differences import WEIGHTS, difference_tangent, error
from tests.support.driven_stage import built
from tests.support.sample_line import RHO, Sample, sample
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene, static
from tests.support.through_water import resistance

pytestmark = pytest.mark.usefixtures("uncompiled")

D, U, MIDDLE, WIDTH = 0.3, 0.8, 0.18, 0.08
TAU = np.array([0.0, 0.0, 1.0])
ALONG_X = np.array([1.0, 0.0, 0.0])


def shedding(n: int = 1, Cv: float = 1.2) -> law.Shedding:
    lift = 0.5 * RHO * D * Cv
    return law.Shedding(*(np.full(n, value) for value in (lift, D, MIDDLE, WIDTH)))


def underway(part: Vortices, at: Sample) -> Vortices:
    """After a first step, so that phases, rates and their growth are all there."""
    part.begin_stage(at.state(7, size=0.0, t=0.0))
    part.commit(at.state(8, size=0.0, t=0.05))
    return part


def in_water(at: Sample, half_out: bool) -> Vortices:
    """In uneven, unsteady water."""
    pipe = Pipe(at.line)
    water, span = FlowAtStations(pipe, sample_water.water), pipe.span if half_out else None
    return underway(Vortices(water, shedding(at.line.length.size), span=span), at)


def behind(at: Sample) -> Vortices:
    return in_water(at, half_out=False)


def behind_half_out(at: Sample) -> Vortices:
    return in_water(at, half_out=True)


def in_line(at: Sample) -> Vortices:
    pipe = Pipe(at.line)
    water = FlowAtStations(pipe, sample_water.water)
    return underway(Vortices(water, shedding(at.line.length.size), in_line=True, span=pipe.span), at)


every_one = pytest.mark.parametrize("make", [behind, behind_half_out, in_line])


@pytest.mark.parametrize("phase", [0.0, 0.4, 2.0])
def test_the_force_acts_across_flow_and_pipe(phase: float) -> None:
    """An upright pipe in a flow along x is pushed towards y by at most 1/2 rho D Cv U^2; flow along it does nothing."""
    push = Push(shedding().lift, np.full((2, 1, 1), phase), in_line=False)

    def force(v: Array) -> Array:
        return -resistance(push, v, TAU)

    computed = force(-U * ALONG_X)
    np.testing.assert_allclose(computed, [0.0, 0.5 * RHO * D * 1.2 * U**2 * np.cos(phase), 0.0], atol=1e-12)
    np.testing.assert_allclose(force(-U * (ALONG_X + 2.0 * TAU)), computed, rtol=1e-12, atol=1e-12)
    assert not force(-U * TAU).any()


@pytest.mark.parametrize("phase", [0.0, 0.4, 2.0])
def test_in_line_it_is_a_drag_that_swings(phase: float) -> None:
    """Along the flow across the pipe, 1/2 rho D C U^2 cos(phi); flow along the pipe does nothing."""
    push = Push(shedding(Cv=0.3).lift, np.full((2, 1, 1), phase), in_line=True)
    for along in (0.0, 2.0):
        computed = -resistance(push, -U * (ALONG_X + along * TAU), TAU)
        np.testing.assert_allclose(computed, 0.5 * RHO * D * 0.3 * U**2 * np.cos(phase) * ALONG_X, atol=1e-12)


def new_wake() -> law.Wake:
    return law.Wake(np.zeros(1), *(np.zeros((1, 1)) for _ in range(3)))


def advance(wake: law.Wake, t: float, v: Array, own: Array, a: Array, in_line: bool = False) -> None:
    """Advance to the end of an accepted step: velocity through the water, own velocity and acceleration, each (3,)."""
    law.advance(wake, shedding(), in_line, t, law.phases_at(wake, t)[0, 0], 0, 0, v, own, a, TAU)
    wake.time[0] = t


def locked(frequency: float, steps: int, amplitude: float = 0.05, in_line: bool = False) -> tuple[Array, Array]:
    """Phase of an oscillation's velocity less that of the vortices, and the latter's frequency times D/U, over the last
    of thirty periods; steps: of a period; amplitude: over D.
    """
    wake = new_wake()
    w, v, y = 2.0 * np.pi * frequency * U / D, -U * ALONG_X, ALONG_X if in_line else np.array([0.0, 1.0, 0.0])
    ahead, rates = [], []
    for t in np.arange(30 * steps) * (2.0 * np.pi / w / steps):
        own, a = (amplitude * D * w * s * y for s in (np.cos(w * t), -w * np.sin(w * t)))
        advance(wake, t, v, own, a, in_line)
        ahead.append(w * t - wake.phase[0, 0])
        rates.append(wake.rate[0, 0] * D / (2.0 * np.pi * U))
    return np.array(ahead[-steps:]), np.array(rates[-steps:])


@pytest.mark.parametrize("frequency", [0.11, 0.15, 0.18, 0.22, 0.25])
def test_the_phase_locks_where_its_frequency_is_the_oscillations(frequency: float) -> None:
    """sin(theta) = (f - f0)/df, but for LEAST_MOTION; of the second order in the step."""
    expected = (frequency - MIDDLE) / WIDTH
    errors = []
    for steps in (40, 80):
        ahead, rates = locked(frequency, steps)
        errors.append(np.abs(np.sin(ahead) - expected).max())
        assert np.cos(ahead).min() > 0.0
        np.testing.assert_allclose(rates, frequency, rtol=2e-3)
    assert errors[1] < 1e-3
    assert errors[1] < 0.35 * errors[0] or errors[0] < 1e-3


@pytest.mark.parametrize("frequency", [0.15, 0.22])
def test_in_line_the_phase_follows_the_motion_along_the_flow(frequency: float) -> None:
    """The phase follows as it does across; the flow's velocity through the water is taken for steady here."""
    ahead, rates = locked(frequency, 80, in_line=True)
    np.testing.assert_allclose(np.sin(ahead), (frequency - MIDDLE) / WIDTH, atol=1e-3)
    assert np.cos(ahead).min() > 0.0
    np.testing.assert_allclose(rates, frequency, rtol=2e-3)


@pytest.mark.parametrize("frequency", [0.06, 0.32])
def test_beyond_its_range_the_phase_slips(frequency: float) -> None:
    ahead, _ = locked(frequency, 80)
    assert np.ptp(ahead) > 1.0


def test_a_pipe_at_rest_sheds_at_the_middle_frequency() -> None:
    """A motion of a billionth of the diameter changes nothing that counts."""
    for amplitude, changes in ((0.0, 0.0), (1e-9, 1e-5), (0.05, 1.0)):
        _, rates = locked(0.2, 80, amplitude)
        assert np.abs(rates - MIDDLE).max() <= changes
    assert np.abs(rates - 0.2).max() < 1e-3


def test_the_phase_of_a_flow_that_grows_steadily_is_exact() -> None:
    """Once two rates are known: then of the second order in time, behind a pipe at rest."""
    wake, still, dt = new_wake(), np.zeros(3), 0.1
    for t in dt * np.arange(10):
        advance(wake, t, -(U + t) * ALONG_X, still, still)
    turned = 2.0 * np.pi * MIDDLE / D * (U * t + 0.5 * t**2)
    first = 0.5 * 2.0 * np.pi * MIDDLE / D * dt**2  # of the first step, whose rate stays as it begins
    assert wake.phase[0, 0] == pytest.approx((turned - first) % (2.0 * np.pi), rel=1e-12)


def test_nothing_is_shed_without_flow() -> None:
    wake, still = new_wake(), np.zeros(3)
    for t in (0.0, 0.1, 0.2):
        advance(wake, t, still, still, still)
    assert not any(values.any() for values in wake[1:])


@every_one
def test_tangent_is_the_derivative_of_the_residual(make: Callable[[Sample], Vortices]) -> None:
    at = sample(3)
    part, state = make(at), at.state(1)
    assert error(tangent([part], state, WEIGHTS), difference_tangent(part, state, WEIGHTS)) < 1e-7


def test_a_stage_begins_with_the_rate_of_its_motion() -> None:
    """A step of no length that knows the rate does so; a pipe at rest sheds at the middle frequency."""
    at = sample(3)
    part, state = behind(at), at.state(2, size=0.0, t=0.0)
    rest = State(0.0, 0.0 * state.u, 0.0 * state.v, 0.0 * state.a)
    part.begin_stage(rest)
    trial, stations_at = at.line.trial(rest), Pipe(at.line).at
    tau = np.einsum("ega,eai->egi", stations_at.dN, trial.q)
    tau /= np.linalg.norm(tau, axis=-1, keepdims=True)
    u = sample_water.water(0.0, np.einsum("ega,eai->egi", stations_at.N, trial.q).reshape(-1, 3)).velocity
    speed = np.linalg.norm(np.cross(u.reshape(tau.shape), tau), axis=-1)
    np.testing.assert_allclose(part.state()["rate"], 2.0 * np.pi * MIDDLE * speed / D, rtol=1e-12)
    part.begin_stage(state)
    begun = part.state()
    part.commit(state)
    np.testing.assert_allclose(part.state()["rate"], begun["rate"], rtol=0.2)
    assert not begun["growth"].any()


def test_a_trial_leaves_no_trace_and_a_commit_continues() -> None:
    """Forces depend on the trial alone; those of an accepted step are those that the next one starts from."""
    at = sample(3)
    part, state = behind(at), at.state(5, t=0.05)
    first = residual([part], state, WEIGHTS)
    residual([part], at.state(6, t=0.3), WEIGHTS)
    np.testing.assert_array_equal(residual([part], state, WEIGHTS), first)
    part.commit(state)
    at.line.commit(state)
    anew = residual([part], State(state.t, 0.0 * state.u, state.v, state.a), WEIGHTS)
    assert error(at.line.in_new_axes(first, state.u), anew) < 1e-12


def test_the_power_of_the_force_is_external_work() -> None:
    """Over a short step: minus the resistance times the way."""
    at = sample(3)
    part, start, h = behind(at), at.state(3), 1e-4
    before = State(0.05, 0.0 * start.u, start.v, start.a)
    after = State(0.05 + h, h * start.v, start.v, start.a)
    work = part.work(before, after)
    expected = -residual([part], before, Weights(0.0, 1.0, 0.0, 0.0)) @ start.v * h
    assert work.external == pytest.approx(expected, rel=1e-3)
    assert work.dissipated == work.inertial == 0.0


def test_element_forces_add_up_to_the_residual() -> None:
    at = sample(3)
    part, state, total = behind(at), at.state(6), Forces.zeros(at.line.size)
    part.residual(state, total)
    force = part.element_forces(state)
    assert force is not None
    collected = np.zeros(at.line.size)
    at.line.scatter(force, collected)
    np.testing.assert_allclose(collected, total.force, atol=1e-12 * np.abs(total.force).max())


# Scenes

PIPE: dict[str, Any] = {"EA": 1.0e8, "EI": 1.0e4, "GJ": 1.0e4, "mass": 80.0, "outer_diameter": D}
PIPE |= {"drag": {"normal": 1.2, "tangential": 0.05}}
STRAKED = {"drag": 1.8, "cover": 0.8, "suppression": 0.9}
CROSS, IN_LINE = "vortices", "vortices in line"


def scene(**more: Any) -> Mapping:
    """A riser in a current, its pipe with more keys."""
    return riser_scene(
        *(static(), dynamic(1.0, 0.1)),
        pipe=PIPE | more,
        length=20.0,
        elements=4,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(0.0, 0.0, 20.1),
        water={"density": RHO, "current": {"profile": [[0.0, U, 0.0]]}},
        riser={"initial": "straight"},
    )


def forces(**more: Any) -> dict[str, law.Shedding]:
    """Parts of the dynamic stage, by name."""
    assembly = built(scene(**more))
    parts: dict[str, Any] = {part.name: part for part in assembly.begin(assembly.scene.stages[1]).parts}
    return {name: parts[name].kernel_data().shed for name in (CROSS, IN_LINE) if name in parts}


def test_each_direction_is_built_where_it_has_a_coefficient() -> None:
    assert forces() == {}
    assert list(forces(vortex_force={})) == [CROSS]
    assert list(forces(vortex_force={"in_line": {"coefficient": 0.2}})) == [CROSS, IN_LINE]
    assert list(forces(vortex_force={"coefficient": 0.0, "in_line": {"coefficient": 0.2}})) == [IN_LINE]
    assert list(forces(vortex_force={"in_line": {"coefficient": 0.0}})) == [CROSS]


def test_in_line_vortices_lock_to_twice_the_frequencies_by_default() -> None:
    default = forces(vortex_force={"frequency": 0.2, "width": 0.05, "in_line": {"coefficient": 0.2}})[IN_LINE]
    assert default.lift[0] == pytest.approx(0.5 * RHO * D * 0.2)
    assert (default.middle[0], default.width[0]) == pytest.approx((0.4, 0.1))
    given = {"coefficient": 0.2, "frequency": 0.3, "width": 0.02}
    vortices = forces(vortex_force={"in_line": given})[IN_LINE]
    assert (vortices.middle[0], vortices.width[0]) == (0.3, 0.02)


def test_strakes_take_from_the_vortices_and_add_to_the_drag() -> None:
    """Strakes act by their cover: what is left of the force, and the mean of both coefficients of drag."""
    force = {"coefficient": 1.1, "in_line": {"coefficient": 0.3}}
    bare, straked = forces(vortex_force=force), forces(vortex_force=force, strakes=STRAKED)
    for name in (CROSS, IN_LINE):
        np.testing.assert_allclose(straked[name].lift, (1.0 - 0.8 * 0.9) * bare[name].lift, rtol=1e-14)
    elements = built(scene(strakes=STRAKED)).riser.elements
    np.testing.assert_allclose(elements.drag, [[0.8 * 1.8 + 0.2 * 1.2, 0.05]] * 4, rtol=1e-14)
    assert forces(vortex_force=force, strakes={"drag": 1.8, "suppression": 1.0}) == {}
    by_default = forces(vortex_force=force, strakes={"drag": 1.8})[CROSS]
    np.testing.assert_allclose(by_default.lift, 0.05 * bare[CROSS].lift)


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"vortex_force": {"in_line": {}}}, r"vortex_force\.in_line\.coefficient: missing"),
    ({"vortex_force": {"in_line": {"coefficient": 0.2, "width": 0.4}}}, r"its width \(0\.4\) must be below"),
    ({"vortex_force": {"in_lien": {"coefficient": 0.2}}}, 'did you mean "in_line"'),
    ({"strakes": {}}, r"strakes\.drag: missing"),
    ({"strakes": {"drag": 1.8, "cover": 1.2}}, r"strakes\.cover"),
    ({"strakes": {"drag": 1.8, "efficiency": 0.9}}, r"strakes\.efficiency"),
    ({"strakes": STRAKED, "drag": {"by_reynolds": [[1e4, 1.2]]}}, "strakes have one drag coefficient"),
]


@pytest.mark.parametrize(("more", "message"), WRONG)
def test_what_can_not_be_is_reported(more: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError, match=message):
        scene_from_mapping(scene(**more))


def test_strakes_act_in_water_only() -> None:
    given = scene(strakes=STRAKED)
    del given["water"], given["line_types"]["pipe"]["drag"]
    with pytest.raises(SceneError, match=r"strakes.*acts in water only"):
        scene_from_mapping(given)
