"""The penalty law, its potential and its automatic stiffness; suction: cap, reach, breakaway, and stored energy."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from riser_soil.contact.law import Penalty, SuctionLaw, automatic_stiffness
from tests.support.soil_loops import after, at, forces, through, work

K, S = 2.0e5, 1.5e-3
LAWS = [Penalty(K, S), Penalty(K, 0.0)]
penetrations = st.floats(-5e-3, 5e-3)


def test_smoothed_ramp_at_its_joints_and_middle() -> None:
    delta = np.array([-2 * S, -S, 0.0, S, 2 * S])
    np.testing.assert_allclose(Penalty(K, S).force(delta), K * S * np.array([0, 0, 0.25, 1, 2]), rtol=1e-14)
    np.testing.assert_allclose(
        Penalty(K, S).potential(delta), K * S**2 * np.array([0, 0, 1 / 12, 2 / 3, 13 / 6]), rtol=1e-14
    )


def test_without_smoothing_it_is_the_plain_ramp() -> None:
    delta = np.array([-1e-3, 0.0, 1e-3])
    np.testing.assert_array_equal(Penalty(K).force(delta), [0.0, 0.0, K * 1e-3])
    np.testing.assert_array_equal(Penalty(K).slope(delta), [0.0, 0.0, K])
    np.testing.assert_array_equal(Penalty(K).potential(delta), [0.0, 0.0, 0.5 * K * 1e-6])


@pytest.mark.parametrize("law", LAWS)
def test_force_and_slope_are_derivatives(law: Penalty) -> None:
    delta, h = np.linspace(-2.03 * S, 2.07 * S, 41), 1e-7
    force = (law.potential(delta + h) - law.potential(delta - h)) / (2 * h)
    slope = (law.force(delta + h) - law.force(delta - h)) / (2 * h)
    np.testing.assert_allclose(law.force(delta), force, atol=1e-7 * K * S)
    np.testing.assert_allclose(law.slope(delta), slope, atol=1e-7 * K)


@pytest.mark.parametrize("law", LAWS)
@given(a=penetrations, b=penetrations)
def test_potential_is_convex(law: Penalty, a: float, b: float) -> None:
    before, after = law.potential(np.array([a, b]))
    force = law.force(np.array([b]))[0]
    assert force * (b - a) - (after - before) >= -1e-15 * K


def test_smoothing_vanishes_far_from_the_corner() -> None:
    delta = np.array([1.01 * S, 0.3])
    np.testing.assert_array_equal(Penalty(K, S).force(delta), Penalty(K).force(delta))


def test_automatic_stiffness_takes_the_stiffer_of_soil_and_weight() -> None:
    assert automatic_stiffness(None, 147.0, 0.147) == pytest.approx(1.0e6)
    assert automatic_stiffness(1.2e6, 728.0, 0.30) == pytest.approx(1.2e7)
    assert automatic_stiffness(1.0e3, 728.0, 0.30) == pytest.approx(728.0 / 3e-4)


K_SUCTION, CAP, REACH = 1.0e5, 500.0, 0.02
SHARP = SuctionLaw(Penalty(K_SUCTION), CAP, REACH)
SUCTION_LAWS = [SHARP, SuctionLaw(Penalty(K_SUCTION, 1e-3), CAP, REACH)]
PEAK = CAP / K_SUCTION


def test_tension_rises_to_the_cap_and_falls_to_nothing_at_its_reach() -> None:
    touching = after(SHARP, np.array([0.001]))
    w = np.array([0.5 * PEAK, PEAK, 0.5 * (PEAK + REACH), REACH, 2.0 * REACH])
    np.testing.assert_allclose(at(SHARP, -w, touching)[0], -CAP * np.array([0.5, 1.0, 0.5, 0.0, 0.0]), atol=1e-9)
    np.testing.assert_allclose(at(SHARP, np.array([0.002]), touching)[0], K_SUCTION * 0.002)


def test_ground_that_was_never_touched_does_not_hold() -> None:
    assert not at(SHARP, -np.linspace(0.0, REACH, 9), SHARP.initial_history((1,)))[0].any()
    assert not SHARP.answers(np.array([-0.001]), SHARP.initial_history((1,))).acts.any()


def test_what_is_broken_stays_so_until_the_next_touch() -> None:
    half = after(SHARP, through(0.0, 0.001, -0.5 * (PEAK + REACH)))
    w = np.linspace(0.0, 0.5 * (PEAK + REACH), 5)
    np.testing.assert_allclose(at(SHARP, -w, half)[0], -0.5 * CAP * np.linspace(0.0, 1.0, 5), atol=1e-9)
    broken = after(SHARP, through(0.0, 0.001, -1.1 * REACH))
    assert not at(SHARP, -w, broken)[0].any()
    healed = after(SHARP, through(0.0, 0.001, -1.1 * REACH, 0.001))
    assert at(SHARP, np.array([-PEAK]), healed)[0][0] == pytest.approx(-CAP)


def test_breaking_away_takes_half_the_cap_times_the_reach() -> None:
    path = through(0.001, -1.5 * REACH, steps=20000)
    history = after(SHARP, np.array([0.001]))
    force = forces(SHARP, path, history)
    pulled = np.where(path < 0.0, force, 0.0)
    assert work(path, pulled, 0.001)[-1] == pytest.approx(0.5 * CAP * REACH, rel=1e-3)


@pytest.mark.parametrize("law", SUCTION_LAWS)
@pytest.mark.parametrize("way", [(0.0, 0.001), (0.0, 0.001, -0.003), (0.0, 0.001, -0.01), (0.0, 0.001, -0.03)])
def test_force_is_continuous_and_slope_its_derivative(law: SuctionLaw, way: tuple[float, ...]) -> None:
    history = after(law, through(*way))
    w, h = np.linspace(-0.03, 0.01, 2003), 1e-8
    slope = (at(law, w + h, history)[0] - at(law, w - h, history)[0]) / (2 * h)
    assert np.count_nonzero(np.abs(at(law, w, history)[1] - slope) > 1e-4 * K_SUCTION) <= 2
    assert np.abs(np.diff(at(law, w, history)[0])).max() < 1.6 * K_SUCTION * (w[1] - w[0])


@pytest.mark.parametrize("law", SUCTION_LAWS)
@settings(max_examples=100, deadline=None)
@given(path=st.lists(st.floats(-0.03, 0.01), min_size=2, max_size=30))
def test_every_step_dissipates_unless_it_tears(law: SuctionLaw, path: list[float]) -> None:
    """Sum over any path from the first touch: work extracted less energy stored is never negative, step by step."""
    history, begin = after(law, np.array([0.0])), np.array([0.0])
    for z in np.array(path)[:, None]:
        answer = law.update(z, history)
        work = answer.force * (z - begin)
        change = answer.stored - law.update(begin, history).stored
        assert work[0] - change[0] >= -1e-12
        history, begin = answer.history, z


def test_a_reach_short_of_the_peak_is_refused() -> None:
    with pytest.raises(ValueError, match="farther than"):
        SuctionLaw(Penalty(K_SUCTION), CAP, 0.5 * PEAK)
