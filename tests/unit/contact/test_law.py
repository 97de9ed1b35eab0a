"""The penalty law, its potential and its automatic stiffness."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from riser_soil.contact.law import Penalty, automatic_stiffness

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
