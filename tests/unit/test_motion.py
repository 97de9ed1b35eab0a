"""Prescribed motions: closed forms, and rates that are the derivatives of the positions."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.motion.harmonic import Harmonic
from riser_soil.motion.move import Move

ORIGIN, AMPLITUDE = np.array([1.0, 2.0, 3.0]), np.array([0.5, 0.0, -1.5])


def test_full_motion_is_a_sine() -> None:
    motion = Harmonic(ORIGIN, AMPLITUDE, period=8.0, ramp=4.0)
    position, velocity, acceleration = motion(10.0)
    w = 2.0 * np.pi / 8.0
    assert position == pytest.approx(ORIGIN + AMPLITUDE * np.sin(10.0 * w))
    assert velocity == pytest.approx(AMPLITUDE * w * np.cos(10.0 * w))
    assert acceleration == pytest.approx(-AMPLITUDE * w**2 * np.sin(10.0 * w))


def test_starts_at_rest_at_the_origin() -> None:
    position, velocity, acceleration = Harmonic(ORIGIN, AMPLITUDE, 8.0, ramp=4.0, phase=0.7)(0.0)
    assert position == pytest.approx(ORIGIN, abs=1e-15)
    assert velocity == pytest.approx(np.zeros(3), abs=1e-15)
    assert acceleration == pytest.approx(np.zeros(3), abs=1e-15)


@pytest.mark.parametrize("t", [0.3, 2.0, 3.9, 4.0, 4.1, 11.0])
def test_rates_are_derivatives(t: float) -> None:
    motion = Harmonic(ORIGIN, AMPLITUDE, period=8.0, ramp=4.0, phase=0.7)
    h = 1e-5
    for k in (0, 1):
        slope = (motion(t + h)[k] - motion(t - h)[k]) / (2.0 * h)
        assert slope == pytest.approx(motion(t)[k + 1], rel=1e-7, abs=1e-5 if k else 1e-8)


def test_move_is_linear_in_the_load_factor() -> None:
    assert Move(ORIGIN, ORIGIN + AMPLITUDE)(0.25)[0] == pytest.approx(ORIGIN + 0.25 * AMPLITUDE)
