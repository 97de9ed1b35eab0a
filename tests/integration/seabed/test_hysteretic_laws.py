"""What both hysteretic laws of the seabed share: continuity, exact slopes, steps, passivity."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from riser_soil.contact.seabed_contact import SeabedContact
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.seabed.bearing import Strength
from riser_soil.seabed.grounds import Plane
from riser_soil.seabed.law import NormalLaw
from riser_soil.seabed.pipe_bearing import PowerLaw, displaced
from tests.support.dense_chain import tangent
from tests.support.differences import WEIGHTS, difference_tangent, error
from tests.support.sample_line import START, Sample, sample
from tests.support.soil_loops import after, at, aubeny_biscontin, forces, randolph_quiggin, through, work

D, SU, GRADIENT = 0.3, 2000.0, 1500.0
LAWS: dict[str, NormalLaw] = {
    "randolph-quiggin": randolph_quiggin(D, SU, GRADIENT, unit_weight=4.0e3),
    "randolph-quiggin, even, light": randolph_quiggin(D, SU, f_suc=0.3, lambda_suc=0.4, lambda_rep=0.5),
    "aubeny-biscontin": aubeny_biscontin(D, SU, GRADIENT),
    "aubeny-biscontin, even": aubeny_biscontin(D, SU, omega=0.8, phi=0.3, psi=0.4),
}
WAYS = {
    "first": (0.0,),
    "pressed": (0.0, 0.07),
    "lifted": (0.0, 0.07, 0.064),
    "in suction": (0.0, 0.07, 0.055),
    "pressed again": (0.0, 0.07, 0.055, 0.06),
    "lifted again": (0.0, 0.07, 0.055, 0.066, 0.061),
    "left and back": (0.0, 0.07, -0.01, 0.03),
    "shallow": (0.0, 4e-4, 2e-4),
}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
every_way = pytest.mark.parametrize("way", WAYS.values(), ids=WAYS.keys())
paths = st.lists(st.floats(-0.02, 0.1), min_size=2, max_size=25)
trembling = st.lists(st.floats(-0.003, 0.003), min_size=2, max_size=40)


@every_law
@every_way
def test_slope_is_the_derivative_but_where_branches_meet(law: NormalLaw, way: tuple[float, ...]) -> None:
    history = after(law, through(*way)) if len(way) > 1 else law.initial_history((1,))
    z, h = np.linspace(-0.01, 0.12, 1001), 1e-8
    ahead, behind = at(law, z + h, history)[0], at(law, z - h, history)[0]
    error = np.abs(at(law, z, history)[1] - (ahead - behind) / (2 * h))
    wrong = error > 1e-5 * np.abs(at(law, z, history)[1]).max()
    assert np.count_nonzero(wrong) <= 5


@every_law
@every_way
def test_force_is_continuous_within_a_step(law: NormalLaw, way: tuple[float, ...]) -> None:
    """Turning back, leaving the ground and passing the deepest point within one step make no jump."""
    history = after(law, through(*way)) if len(way) > 1 else law.initial_history((1,))
    z = np.linspace(-0.01, 0.12, 100_001)
    force, slope = at(law, z, history)
    rise = np.abs(np.diff(force))
    bound = 1.01 * (z[1] - z[0]) * np.maximum(np.abs(slope[1:]), np.abs(slope[:-1])) + 1e-6 * SU * D
    surface = np.abs(z[1:]) < 1e-5  # suction ends upright at the surface, as the square root of the depth
    assert np.all(rise[~surface] < 3.0 * bound[~surface])
    assert np.all(rise < 5e-2 * SU * D)


@every_law
@every_way
def test_a_way_without_turns_does_not_depend_on_its_steps(law: NormalLaw, way: tuple[float, ...]) -> None:
    history = after(law, through(*way)) if len(way) > 1 else law.initial_history((1,))
    for end in (0.11, 1e-3):
        once = at(law, np.array([end]), history)[0][0]
        begin = way[-1]
        assert forces(law, through(begin, end, steps=37), history)[-1] == pytest.approx(once, rel=1e-9, abs=1e-6)


@every_law
@every_way
def test_a_response_keeps_nothing(law: NormalLaw, way: tuple[float, ...]) -> None:
    history = after(law, through(*way)) if len(way) > 1 else law.initial_history((1,))
    kept, here = history.copy(), np.array([0.05])
    before = law.update(here, history)
    law.update(np.array([0.1]), history)
    np.testing.assert_array_equal(history, kept)
    for first, again in zip(before, law.update(here, history), strict=True):
        np.testing.assert_array_equal(first, again)


@every_law
def test_each_column_of_the_history_has_a_name(law: NormalLaw) -> None:
    history = law.initial_history((2, 3))
    assert history.shape == law.update(np.full((2, 3), 0.05), history).history.shape == (2, 3, len(law.columns))
    assert len(set(law.columns)) == len(law.columns)


@every_law
def test_force_is_zero_out_of_contact(law: NormalLaw) -> None:
    normal = np.array([-np.inf, -1.0, -1e-9, 0.0])
    for history in (law.initial_history((1,)), after(law, through(0.0, 0.07, 0.05))):
        np.testing.assert_array_equal(at(law, normal, history), np.zeros((2, 4)))
        assert not law.update(normal, np.repeat(history, 4, axis=0)).stored.any()


@every_law
@settings(max_examples=60, deadline=None)
@given(path=paths, tremble=trembling)
def test_no_path_from_untouched_ground_gains_work(law: NormalLaw, path: list[float], tremble: list[float]) -> None:
    whole = np.array([*path, *(0.05 + np.array(tremble))])
    assert work(whole, forces(law, whole)).min() >= -1e-9


@pytest.mark.parametrize("make", [randolph_quiggin, aubeny_biscontin])
def test_stored_is_what_comes_back_along_the_slope_with_which_the_pipe_turns(
    make: Callable[[float, float, float], NormalLaw],
) -> None:
    law, deep = make(D, SU, GRADIENT), np.array([0.07])
    update = law.update(deep, law.initial_history((1,)))
    force, slope = update.force[0], at(law, deep - 1e-9, update.history)[1][0]
    assert update.stored[0] == pytest.approx(0.5 * force**2 / slope, rel=1e-5)


def lost_per_cycle(law: NormalLaw, cycle: Array, times: int) -> Array:
    """Work of each repetition but the first, less the change of what is stored."""
    path = np.tile(cycle, times)
    histories = [law.initial_history((1,))]
    for z in path:
        histories.append(law.update(np.array([z]), histories[-1]).history)
    ends = slice(cycle.size - 1, None, cycle.size)
    stored = [law.update(cycle[-1:], h).stored[0] for h in histories[cycle.size :: cycle.size]]
    return np.asarray(np.diff(work(path, forces(law, path))[ends]) - np.diff(stored))


@every_law
@settings(max_examples=40, deadline=None)
@given(path=paths)
def test_cycles_dissipate(law: NormalLaw, path: list[float]) -> None:
    assert np.all(lost_per_cycle(law, np.array(path), 5) >= -1e-9)


@every_law
def test_dissipation_per_cycle_grows_with_its_amplitude(law: NormalLaw) -> None:
    cycles = [through(0.06, 0.06 - amplitude, 0.06, steps=50) for amplitude in (1e-4, 3e-4, 1e-3, 3e-3)]
    lost = [lost_per_cycle(law, cycle, 4)[-1] for cycle in cycles]
    assert lost[0] > 0.0
    assert np.all(np.diff(lost) > 0.0)


@pytest.mark.parametrize("dimension", [pytest.param(2, marks=pytest.mark.verify), 3])
@pytest.mark.parametrize("rise", [-0.16, 0.1], ids=["sinking", "rising"])
@pytest.mark.parametrize("kind", ["randolph-quiggin", "aubeny-biscontin"])
def test_tangent_along_a_riser_with_a_history(kind: str, rise: float, dimension: int) -> None:
    """Pressed in, lifted a little, then on or back: laws softer than clay, that differences are smooth."""
    law = randolph_quiggin(D, SU, 50.0, K_max=2.0) if kind[0] == "r" else aubeny_biscontin(D, SU, k_over_su=5.0)
    riser = sample(dimension)
    part = SeabedContact(riser.line, np.zeros(riser.line.length.size), Plane.level(START[2] + 5.0), law)
    for lift, size in ((-0.5, 0.0), (0.1, 0.0)):
        state = lifted(riser, lift, size)
        part.commit(state)
        riser.line.commit(state)
    state = lifted(riser, rise, 0.01)
    assert error(tangent([part], state, WEIGHTS), difference_tangent(part, state, WEIGHTS)) < 1e-7


def lifted(riser: Sample, lift: float, size: float) -> State:
    state = riser.state(4, size)
    riser.line.nodal(state.u)[:, riser.line.dimension - 1] += lift
    return state


def test_bearing_resistance() -> None:
    clay = PowerLaw(D, Strength(SU, GRADIENT), 6.0, 0.25, shallow=0.1)
    z = np.array([0.03, 0.0075, 0.3, 0.0, -1.0])
    Nc = np.array([6.0 * 0.1**0.25, 3.0 * 0.1**0.25, 6.0, 0.0, 0.0])
    np.testing.assert_allclose(clay.resistance(z)[0], Nc * (SU + GRADIENT * z) * D, rtol=1e-13)


def test_displaced_area_of_half_a_pipe_and_of_a_whole_one() -> None:
    depths = np.array([-0.1, 0.5 * D, D, 2.0 * D])
    integral, area, width = np.vectorize(displaced)(depths, D)
    half = 0.125 * np.pi * D**2
    np.testing.assert_allclose(area, [0.0, half, 2.0 * half, 2.0 * half], atol=1e-15)
    np.testing.assert_allclose(width, [0.0, D, 0.0, 0.0], atol=1e-15)
    below = [quad(lambda z: displaced(z, D)[1], 0.0, depth, points=[D])[0] for depth in depths[1:]]
    assert integral == pytest.approx([0.0, *below])
