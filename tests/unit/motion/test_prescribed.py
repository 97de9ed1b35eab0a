"""Prescribed motions: closed forms, rates that are the derivatives of the positions, and smooth beginnings."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.motion.prescribed import (
    AngleOscillation,
    HarmonicMotion,
    RockingSupport,
    SmoothMove,
    SwingingEnd,
    TabulatedMotion,
)
from riser_soil.motion.rigid_body import CarriedEnd, CarriedSupport
from riser_soil.riser import rotations
from riser_soil.riser.line_ends import Motion, SupportRotation

ORIGIN, AMPLITUDE = np.array([1.0, 2.0, 3.0]), np.array([0.5, 0.0, -1.5])
PHASES = np.array([0.7, -0.2, 2.0])
RAMP = 4.0
SWING = AngleOscillation(0.6, period=8.0, ramp=RAMP, phase=0.7)
TIMES = np.array([0.0, 1.0, 2.5, 4.0, 5.5, 7.0, 9.0, 12.0])
ROWS = np.random.default_rng(5).normal(size=(TIMES.size, 6))
TABLE = TabulatedMotion(TIMES, ROWS, ramp=RAMP)
MOTIONS: dict[str, Motion] = {
    "harmonic": HarmonicMotion(ORIGIN, AMPLITUDE, 8.0, RAMP, 0.7),
    "harmonic with phases": HarmonicMotion(ORIGIN, AMPLITUDE, 8.0, RAMP, PHASES),
    "arc": SwingingEnd(ORIGIN, np.array([0.5, -1.0, 4.0]), np.array([0.0, -1.0, 0.0]), SWING),
    "table": CarriedEnd(ORIGIN, TABLE),
}
TURNINGS: dict[str, Callable[[float], SupportRotation]] = {
    "rocking": RockingSupport(np.array([0.6, 0.0, 0.8]), SWING),
    "table": CarriedSupport(TABLE),
    "table without a ramp": CarriedSupport(TabulatedMotion(TIMES, ROWS)),
}


def test_full_motion_is_a_sine() -> None:
    motion = HarmonicMotion(ORIGIN, AMPLITUDE, period=8.0, ramp=4.0)
    position, velocity, acceleration = motion(10.0)
    w = 2.0 * np.pi / 8.0
    assert position == pytest.approx(ORIGIN + AMPLITUDE * np.sin(10.0 * w))
    assert velocity == pytest.approx(AMPLITUDE * w * np.cos(10.0 * w))
    assert acceleration == pytest.approx(-AMPLITUDE * w**2 * np.sin(10.0 * w))


def test_each_component_has_its_phase() -> None:
    """A quarter of a period apart, two components draw an ellipse."""
    motion = HarmonicMotion(ORIGIN, np.array([2.0, 0.0, 1.0]), period=8.0, phase=np.radians([0.0, 0.0, 90.0]))
    x, _, z = motion(3.3)[0] - ORIGIN
    assert (x / 2.0) ** 2 + z**2 == pytest.approx(1.0)
    assert [x, z] == pytest.approx([2.0 * np.sin(3.3 * np.pi / 4.0), np.cos(3.3 * np.pi / 4.0)])


@pytest.mark.parametrize("name", MOTIONS)
def test_starts_at_rest_at_the_origin(name: str) -> None:
    position, velocity, acceleration = MOTIONS[name](0.0)
    assert position == pytest.approx(ORIGIN, abs=1e-15)
    assert velocity == pytest.approx(np.zeros(3), abs=1e-15)
    assert acceleration == pytest.approx(np.zeros(3), abs=1e-15)


def derivative(f: Callable[[float], Array], t: float, h: float = 1e-3) -> Array:
    """Difference of fourth order; where f is twice continuously differentiable only, of the first."""
    return (8.0 * (f(t + h) - f(t - h)) - f(t + 2.0 * h) + f(t - 2.0 * h)) / (12.0 * h)


def order(motion: Motion, k: int, t: float) -> Array:
    return motion(t)[k]


@pytest.mark.parametrize("t", [0.3, 2.0, 3.9, 4.1, 11.0])
@pytest.mark.parametrize("name", MOTIONS)
def test_rates_are_derivatives(name: str, t: float) -> None:
    motion = MOTIONS[name]
    for k in (0, 1):
        assert derivative(partial(order, motion, k), t) == pytest.approx(motion(t)[k + 1], abs=1e-9)


@pytest.mark.parametrize("name", MOTIONS)
def test_nothing_jumps_where_the_ramp_ends(name: str) -> None:
    """The acceleration neither, to which a rate of some m/s3 adds 1e-7 here."""
    for before, after in zip(MOTIONS[name](RAMP - 1e-8), MOTIONS[name](RAMP + 1e-8), strict=True):
        assert before == pytest.approx(after, abs=1e-6)


@pytest.mark.parametrize("t", [0.3, 2.0, 3.9, 4.1, 11.0])
@pytest.mark.parametrize("name", TURNINGS)
def test_angular_rates_are_those_of_the_frame(name: str, t: float) -> None:
    turning = TURNINGS[name]

    def frame(s: float) -> Array:
        return np.array(rotations.exp(tuple(turning(s).rotation)))

    _, velocity, acceleration = turning(t)
    spin = derivative(frame, t) @ frame(t).T
    assert spin == pytest.approx(np.cross(np.eye(3), velocity), abs=1e-8)
    assert derivative(lambda s: turning(s).angular_velocity, t) == pytest.approx(acceleration, abs=1e-8)


@pytest.mark.parametrize("name", TURNINGS)
def test_supports_turn_from_where_they_are(name: str) -> None:
    assert TURNINGS[name](0.0).rotation == pytest.approx(np.zeros(3), abs=1e-15)


@pytest.mark.parametrize(("plane", "axis"), [("xz", (0, -1, 0)), ("yz", (1, 0, 0)), ("xy", (0, 0, 1))])
def test_arc_turns_the_first_axis_of_its_plane_towards_the_second(plane: str, axis: Array) -> None:
    first, second = (np.eye(3)["xyz".index(letter)] for letter in plane)
    hub = np.array([4.0, 5.0, 6.0])
    arc = SwingingEnd(hub - 2.0 * second + 0.3 * np.asarray(axis), hub, np.asarray(axis), AngleOscillation(0.35, 10.0))
    phi = 0.35 * np.sin(0.2 * np.pi * 3.7)
    expected = hub + 2.0 * (np.sin(phi) * first - np.cos(phi) * second) + 0.3 * np.asarray(axis)
    assert arc(3.7)[0] == pytest.approx(expected, abs=1e-14)


def test_table_goes_through_its_rows_and_reproduces_a_cubic() -> None:
    for t, row in zip(TIMES[3:], ROWS[3:], strict=True):
        assert TABLE(t)[0] == pytest.approx(row, abs=1e-14)
    cubic = np.polynomial.Polynomial([0.3, -1.0, 0.5, 0.1])
    spline = TabulatedMotion(TIMES, np.tile(cubic(TIMES)[:, None], 6))
    for t in (0.2, 3.3, 11.7):
        for order, values in enumerate(spline(t)):
            expected = cubic.deriv(order)(t) if order else cubic(t)
            assert values == pytest.approx(np.full(6, expected), rel=1e-10)


def test_table_is_of_fourth_order() -> None:
    def worst(rows: int) -> float:
        time = np.linspace(0.0, 10.0, rows)
        table = TabulatedMotion(time, np.tile(np.cos(time)[:, None], 6))
        return max(abs(table(t)[0][0] - np.cos(t)) for t in np.linspace(0.0, 10.0, 2377))

    errors = [worst(rows) for rows in (101, 201, 401)]
    assert [a / b for a, b in pairwise(errors)] == pytest.approx([16.0, 16.0], rel=0.15)


def test_move_is_linear_in_the_load_factor() -> None:
    assert SmoothMove(ORIGIN, ORIGIN + AMPLITUDE)(0.25)[0] == pytest.approx(ORIGIN + 0.25 * AMPLITUDE)


