"""Current and linear waves against textbook formulas, and their derivatives against finite differences."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.sea import waves
from riser_soil.sea.components import Components, regular, wave_number
from riser_soil.sea.current import SteadyCurrent, at_heights
from riser_soil.sea.flows import Sea, WaterMotion
from riser_soil.sea.waves import linear_waves

pytestmark = pytest.mark.usefixtures("uncompiled")

G, LEVEL = 9.81, 7.0
DEPTHS = [np.inf, 400.0, 30.0, 4.0]
STRETCHINGS: list[Literal["wheeler", "vertical"]] = ["wheeler", "vertical"]


def one(height: float, period: float, h: float, direction: float = 0.0, phase: float = 0.0) -> Components:
    return regular(height, period, direction, phase, G, h)


def several(h: float) -> Components:
    """Waves of all lengths that cross one another."""
    w = np.array([0.3, 0.7, 1.1, 2.3, 0.5])
    k = wave_number(w, G, h)
    draw = np.random.default_rng(3)
    steepness = 0.02 if h > 10.0 else 0.003
    return Components(steepness / k, w, k, draw.uniform(-3.0, 3.0, 5), draw.uniform(-3.0, 3.0, 5))


def points(h: float) -> Array:
    """Under water, some in the topmost decimetres and some a little above the surface."""
    draw = np.random.default_rng(4)
    x = draw.uniform(-80.0, 80.0, (60, 3))
    reach = min(h, 60.0)
    x[:, 2] = LEVEL + np.concatenate([draw.uniform(-0.99 * reach, -0.02 * reach, 40), draw.uniform(-0.4, 0.4, 20)])
    return x


def sheared() -> SteadyCurrent:
    level = np.array([-30.0, -2.0, 20.0])
    return SteadyCurrent(level, np.array([[0.1, 0.0], [0.5, -0.2], [1.2, 0.4]]), grows=True)


@pytest.mark.parametrize("h", [1e-3, 0.5, 8.0, 100.0, 3000.0])
def test_dispersion_leaves_no_residual(h: float) -> None:
    w = np.geomspace(1e-3, 30.0, 200)
    k = wave_number(w, G, h)
    assert G * k * np.tanh(k * h) == pytest.approx(w * w, rel=4e-15)


def test_dispersion_in_deep_and_shallow_water() -> None:
    w = np.array([0.5, 1.0])
    assert np.array_equal(wave_number(w, G, np.inf), w * w / G)
    assert wave_number(w, G, 1e4) == pytest.approx(w * w / G, rel=1e-14)
    slow = np.array([1e-5, 1e-4])
    assert wave_number(slow, G, 10.0) == pytest.approx(slow / np.sqrt(G * 10.0), rel=1e-8)


def test_current_is_linear_between_levels_and_constant_beyond() -> None:
    level, velocity = np.array([-100.0, -20.0, 0.0]), np.array([[0.1, 0.0], [0.5, 0.8], [1.0, 0.6]])
    u, slope = at_heights(np.array([-150.0, -100.0, -60.0, -20.0, -5.0, 0.0, 3.0]), level, velocity)
    assert u == pytest.approx(
        np.array([[0.1, 0.0], [0.1, 0.0], [0.3, 0.4], [0.5, 0.8], [0.875, 0.65], [1.0, 0.6], [1.0, 0.6]])
    )
    deep, shallow, none = [0.005, 0.01], [0.025, -0.01], [0.0, 0.0]
    assert slope == pytest.approx(np.array([none, deep, deep, shallow, shallow, none, none]))


def test_current_of_one_level_is_uniform() -> None:
    u, slope = at_heights(np.array([-9.0, 0.0, 9.0]), np.array([0.0]), np.array([[0.3, -0.4]]))
    assert np.array_equal(u, [[0.3, -0.4]] * 3)
    assert not slope.any()


def test_current_grows_by_its_factor() -> None:
    motion = Sea(None, [SteadyCurrent(np.array([0.0]), np.array([[0.4, 0.2]]), grows=True)])(0.25, np.zeros((1, 3)))
    assert motion.velocity[0] == pytest.approx([0.1, 0.05, 0.0])
    assert not motion.acceleration.any()
    assert np.isposinf(motion.immersion).all()
    assert not motion.immersion_gradient.any()


def test_calm_water_has_a_level_surface() -> None:
    motion = Sea(LEVEL)(0.0, points(30.0))
    assert motion.immersion == pytest.approx(LEVEL - points(30.0)[:, 2])
    assert np.array_equal(motion.immersion_gradient, np.tile([0.0, 0.0, -1.0], (60, 1)))
    assert not any(part.any() for part in motion[:4])


@pytest.mark.parametrize("h", DEPTHS)
def test_one_wave_moves_as_in_the_textbook(h: float) -> None:
    height, period, direction, phase, t = 0.2, 6.0, np.radians(30.0), 0.4, 2.3
    wave, x = one(height, period, h, direction, phase), points(h)
    x[:, 2] = np.minimum(x[:, 2], LEVEL)
    motion = Sea(LEVEL, [linear_waves(wave, h, LEVEL, "vertical")])(t, x)
    k, w, z = wave.wave_number[0], 2.0 * np.pi / period, x[:, 2] - LEVEL
    theta = k * (x[:, 0] * np.cos(direction) + x[:, 1] * np.sin(direction)) - w * t + phase
    if np.isinf(h):
        across, up = np.exp(k * z), np.exp(k * z)
    else:
        across, up = np.cosh(k * (z + h)) / np.sinh(k * h), np.sinh(k * (z + h)) / np.sinh(k * h)
    a = 0.5 * height
    u, fall = a * w * across * np.cos(theta), a * w * up * np.sin(theta)
    u_rate, fall_rate = a * w**2 * across * np.sin(theta), -a * w**2 * up * np.cos(theta)
    assert motion.velocity == pytest.approx(_turned(u, fall, direction), abs=1e-14)
    assert motion.acceleration == pytest.approx(_turned(u_rate, fall_rate, direction), abs=1e-14)
    assert motion.immersion == pytest.approx(a * np.cos(theta) - z, abs=1e-13)


def _turned(along: Array, up: Array, direction: float) -> Array:
    return np.stack([along * np.cos(direction), along * np.sin(direction), up], axis=-1)


@pytest.mark.parametrize("h", DEPTHS)
def test_flow_has_neither_divergence_nor_curl(h: float) -> None:
    motion = Sea(LEVEL, [linear_waves(several(h), h, LEVEL, "vertical")])(3.0, np.minimum(points(h), [1e9, 1e9, LEVEL]))
    for gradient in (motion.velocity_gradient, motion.acceleration_gradient):
        size = np.abs(gradient).max()
        assert size > 1e-4
        assert np.abs(np.trace(gradient, axis1=1, axis2=2)).max() < 1e-15 * size
        assert np.abs(gradient - gradient.transpose(0, 2, 1)).max() < 1e-15 * size


@pytest.mark.parametrize("h", DEPTHS)
@pytest.mark.parametrize("stretching", STRETCHINGS)
def test_gradients_are_those_of_what_is_returned(h: float, stretching: Literal["wheeler", "vertical"]) -> None:
    sea = Sea(LEVEL, [sheared(), linear_waves(several(h), h, LEVEL, stretching, ramp=5.0, clock=1.0)])
    x, step, t = points(h), 1e-4, 1.7
    motion = sea(t, x)
    assert np.abs(motion.velocity_gradient[:, 2, 0]).max() > 1e-4
    for axis in range(3):
        shift = step * np.eye(3)[axis]
        before, after = sea(t, x - shift), sea(t, x + shift)
        for part, gradient in ((0, 2), (1, 3), (4, 5)):
            difference = (after[part] - before[part]) / (2.0 * step)
            assert motion[gradient][..., axis] == pytest.approx(difference, abs=1e-8)


@pytest.mark.parametrize("h", DEPTHS)
@pytest.mark.parametrize("t", [0.5, 3.0, 8.0])
def test_acceleration_is_the_rate_of_velocity(h: float, t: float) -> None:
    """At fixed points, before, in and after the ramp; without stretching."""
    sea, step = Sea(LEVEL, [linear_waves(several(h), h, LEVEL, "vertical", ramp=5.0, clock=-1.0)]), 1e-4
    x = points(h)
    rate = (sea(t + step, x).velocity - sea(t - step, x).velocity) / (2.0 * step)
    acceleration = sea(t, x).acceleration
    assert (np.abs(acceleration).max() > 1e-4) == (t > 1.0)
    assert acceleration == pytest.approx(rate, abs=1e-8)


def test_ramp_is_the_smooth_step_on_the_waves_clock() -> None:
    wave, x = one(3.0, 8.0, 50.0), np.array([[4.0, 0.0, LEVEL - 20.0]])
    full = Sea(LEVEL, [linear_waves(wave, 50.0, LEVEL, "vertical")])
    ramped = Sea(LEVEL, [linear_waves(wave, 50.0, LEVEL, "vertical", ramp=10.0, clock=4.0)])
    assert ramped(1.0, x).velocity == pytest.approx(0.5 * full(5.0, x).velocity)
    assert ramped(1.0, x).immersion - 20.0 == pytest.approx(0.5 * (full(5.0, x).immersion - 20.0))
    assert ramped(1.0, x).immersion_gradient[:, :2] == pytest.approx(0.5 * full(5.0, x).immersion_gradient[:, :2])
    assert not ramped(-4.0, x).velocity.any()
    assert ramped(6.0, x).acceleration == pytest.approx(full(10.0, x).acceleration, rel=1e-13)


@pytest.mark.parametrize("h", [np.inf, 30.0])
def test_wheeler_gives_crest_and_trough_what_the_mean_level_has(h: float) -> None:
    height, period = 4.0, 9.0
    wave = one(height, period, h)
    sea, w, k = Sea(LEVEL, [linear_waves(wave, h, LEVEL)]), 2.0 * np.pi / period, wave.wave_number[0]
    speed = 0.5 * height * w / np.tanh(k * h)
    crest = sea(0.0, np.array([[0.0, 0.0, LEVEL + 2.0]]))
    trough = sea(0.0, np.array([[np.pi / k, 0.0, LEVEL - 2.0]]))
    assert crest.velocity[0] == pytest.approx([speed, 0.0, 0.0], abs=1e-13)
    assert trough.velocity[0] == pytest.approx([-speed, 0.0, 0.0], abs=1e-13)
    assert crest.immersion[0] == pytest.approx(0.0, abs=1e-13)


def test_wheeler_keeps_the_bottom() -> None:
    eta, slope = np.array([-1.5, 0.0, 2.0]), np.array([[0.1, 0.2]] * 3)
    at = waves.wheeler(np.full(3, -20.0), eta, slope, 20.0)
    assert at.z == pytest.approx([-20.0] * 3)
    assert at.gradient[:, :2] == pytest.approx(np.zeros((3, 2)), abs=1e-14)


@pytest.mark.parametrize("stretching", STRETCHINGS)
@pytest.mark.parametrize("h", [np.inf, 50.0])
def test_nothing_overflows(stretching: Literal["wheeler", "vertical"], h: float) -> None:
    """Far above the surface, far below the bottom, far away and after a long time."""
    sea = Sea(LEVEL, [linear_waves(several(h), h, LEVEL, stretching)])
    x = np.array([[0.0, 0.0, 1e3], [1e5, -1e5, -1e4], [0.0, 0.0, LEVEL - 50.0], [0.0, 0.0, LEVEL - 51.0]])
    with np.errstate(over="raise", invalid="raise"):
        motion = sea(1e5, x)
    assert all(np.isfinite(part).all() for part in motion)
    assert np.abs(motion.velocity).max() < 5.0
    if np.isfinite(h):
        assert motion.velocity[2] == pytest.approx(motion.velocity[3], rel=1e-12, abs=1e-14)


@pytest.mark.parametrize("h", [np.inf, 200.0])
def test_waves_are_followed_down_to_round_off(h: float) -> None:
    """A short wave beside a long one, where the short one has decayed to 1e-11; much deeper it is left out."""
    short, long = one(1.0, 3.0, h), one(2.0, 20.0, h)
    w, k = 2.0 * np.pi / 3.0, short.wave_number[0]
    flow = Sea(LEVEL, [linear_waves(short, h, LEVEL, "vertical")])
    x = np.array([[0.0, 0.0, LEVEL - 25.0 / k], [0.0, 0.0, LEVEL - 35.0 / k]])
    assert flow(0.0, x).velocity[:, 0] == pytest.approx([0.5 * w * np.exp(-25.0), 0.0], rel=1e-12)
    both = Components(*(np.concatenate(pair) for pair in zip(short, long, strict=True)))
    alone, together = (Sea(LEVEL, [linear_waves(part, h, LEVEL, "vertical")])(1.0, x).velocity for part in (long, both))
    assert together == pytest.approx(alone, rel=1e-9)
    assert np.abs(alone).max() > 1e-2


def test_motion_in_a_plane_sees_the_derivative_along_it() -> None:
    """A riser in a turned vertical plane: the plane's own gradient is that of the motion along it."""
    d = np.array([0.6, 0.8, 0.0])
    sea, s = Sea(LEVEL, [linear_waves(several(30.0), 30.0, LEVEL)]), np.linspace(-5.0, 5.0, 11)
    x = s[:, None] * d + [0.0, 0.0, LEVEL - 3.0]

    def along(motion: WaterMotion) -> Array:
        return motion.velocity @ d

    difference = (along(sea(1.0, x + 1e-4 * d)) - along(sea(1.0, x - 1e-4 * d))) / 2e-4
    assert np.einsum("i,nij,j->n", d, sea(1.0, x).velocity_gradient, d) == pytest.approx(difference, abs=1e-9)
