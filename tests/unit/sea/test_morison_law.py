"""Morison's formula at one point: derivatives of the drag, also where hardly anything moves."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed
from riser_soil.sea.morison_law import write_drag, write_drag_derivatives

C, WEIGHT = np.array([300.0, 20.0]), 1.7


def drag(v: Array, slope: Array) -> Array:
    f = np.empty(v.size)
    write_drag(v, slope / np.linalg.norm(slope), C, f, fixed(v.size))
    return f


def derivatives(v: Array, slope: Array) -> tuple[Array, Array]:
    by_v, by_slope = np.full((2, v.size, v.size), np.nan)
    stretch = float(np.linalg.norm(slope))
    write_drag_derivatives(v, slope / stretch, stretch, C, WEIGHT, by_v, by_slope, fixed(v.size))
    return by_v, by_slope


@pytest.mark.parametrize("d", [2, 3])
def test_derivatives_are_those_of_the_drag(d: int) -> None:
    v, slope = np.array([0.7, -0.4, 0.9])[:d], np.array([0.6, 0.5, -0.7])[:d]
    by_v, by_slope = derivatives(v, slope)
    for j, h in enumerate(1e-6 * np.eye(d)):
        np.testing.assert_allclose(by_v[:, j], WEIGHT * (drag(v + h, slope) - drag(v - h, slope)) / 2e-6, rtol=1e-7)
        change = WEIGHT * (drag(v, slope + h) - drag(v, slope - h)) / 2e-6
        np.testing.assert_allclose(by_slope[:, j], change, rtol=1e-7)


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("speed", [0.0, 1e-170, 1e-155, 1e-100])
def test_derivatives_vanish_with_the_speed(d: int, speed: float) -> None:
    """Also where its square is too small for a number."""
    v, slope = speed * np.array([0.6, 0.0, 0.8])[:d], np.array([0.0, 1.0, 0.0])[:d]
    for each in derivatives(v, slope):
        assert np.abs(each).max() <= 2.0 * WEIGHT * C.max() * speed
