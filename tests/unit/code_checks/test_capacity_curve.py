"""A capacity curve of tension and curvature: used up on itself, its ends, what it leaves open."""

import numpy as np
import pytest

from riser_soil.code_checks import capacity_curve

CURVE = np.array([[-2.0e4, 0.1], [0.0, 0.4], [1.0e5, 0.3], [2.0e5, 0.0]])


def test_capacity_curve_is_used_up_on_itself() -> None:
    first, second = CURVE[:-1, None], CURVE[1:, None]
    share = np.linspace(0.0, 1.0, 5)[:, None]
    T, kappa = np.moveaxis(first + share * (second - first), -1, 0)
    assert capacity_curve.utilisation(T, kappa, CURVE) == pytest.approx(np.ones((3, 5)))
    assert capacity_curve.utilisation(2.0 * T, 2.0 * kappa, CURVE) == pytest.approx(2.0 * np.ones((3, 5)))
    assert capacity_curve.utilisation(np.zeros(1), np.zeros(1), CURVE) == pytest.approx([0.0])


def test_capacity_curve_bounds_tension_and_compression_alone() -> None:
    used = capacity_curve.utilisation(np.array([1.0e5, -1.0e4, -4.0e4]), np.zeros(3), CURVE)
    assert used == pytest.approx([0.5, 0.5, 2.0])


def test_capacity_curve_from_no_tension_says_nothing_of_compression() -> None:
    used = capacity_curve.utilisation(np.array([-1.0e6, -1.0e6]), np.array([0.0, 0.2]), CURVE[1:])
    assert used == pytest.approx([0.0, 0.5])


def test_capacity_curve_with_an_upright_end() -> None:
    curve = np.array([[0.0, 0.4], [1.0e5, 0.2]])
    assert capacity_curve.utilisation(np.array([2.0e5]), np.array([0.1]), curve) == pytest.approx([2.0])
