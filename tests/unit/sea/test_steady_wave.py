"""Regular waves of finite height: against the library that finds their coefficients, the equations that they must
fulfil, and linear theory.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import raschii

from riser_soil.assembly.sea import sea_of
from riser_soil.checks.wave_plausibility import regular_wave_theory, wave_warnings
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.plane import resolved_dimension
from riser_soil.scene.reader import read_scene
from riser_soil.sea.components import regular
from riser_soil.sea.flows import Sea, WaterMotion
from riser_soil.sea.steady_flow import steady_flow
from riser_soil.sea.steady_wave import SteadyWave, choose, highest, steady_wave
from riser_soil.sea.waves import linear_waves
from tests.support import sample_water
from tests.support.dense_chain import tangent
from tests.support.differences import WEIGHTS, difference_tangent, error
from tests.support.said import telling
from tests.support.sample_line import sample
from tests.support.scenes import in_water
from tests.support.seas import components_of, water_of

pytestmark = pytest.mark.usefixtures("uncompiled")

G, T, LEVEL, DIRECTION = 9.81, 10.0, 7.0, 0.6
CASES = [
    ("stokes", 6.0, 25.0),
    ("stokes", 10.0, math.inf),
    ("stream-function", 9.0, 20.0),
    ("stream-function", 4.0, 7.0),
]
cases = pytest.mark.parametrize(("theory", "H", "h"), CASES)


def sea(wave: SteadyWave, ramp: float = 0.0, phase: float = 0.4, direction: float = DIRECTION) -> Sea:
    return Sea(LEVEL, [steady_flow(wave, direction, phase, LEVEL, ramp, 0.0, 0.0)])


def made(theory: str, H: float, h: float) -> SteadyWave:
    return steady_wave(theory, H, T, G, h)


def along(s: Array, z: Array) -> Array:
    """Points at distances along the wave and heights above the mean surface."""
    return np.stack([s * math.cos(DIRECTION), s * math.sin(DIRECTION), LEVEL + z], axis=-1)


def surface(wave: SteadyWave, s: Array) -> Array:
    """Height of the surface at the time 0 and phase 0."""
    j = np.arange(1, wave.rise.size + 1)
    return np.asarray(np.cos(np.outer(s, j) * wave.k) @ wave.rise)


def points(wave: SteadyWave, above: float = 0.0) -> Array:
    """In the water, and `above` metres above its surface."""
    draw = np.random.default_rng(5)
    x = draw.uniform(-300.0, 300.0, (40, 3))
    x[:, 2] = LEVEL
    rise = sea(wave)(0.0, x).immersion
    x[:, 2] += rise + (above or -draw.uniform(0.01, 1.0, 40) * min(wave.depth, 40.0) * 0.7)
    return x


def turned(motion: WaterMotion) -> tuple[Array, Array, Array]:
    """Velocity and acceleration (n, 2) along the wave and upwards; velocity across it."""
    to = np.array([[math.cos(DIRECTION), math.sin(DIRECTION), 0.0], [0.0, 0.0, 1.0]])
    across = np.array([-math.sin(DIRECTION), math.cos(DIRECTION), 0.0])
    return motion.velocity @ to.T, motion.acceleration @ to.T, motion.velocity @ across


@cases
def test_surface_and_velocity_are_the_librarys(theory: str, H: float, h: float) -> None:
    """The library's wave has the same length and as many terms."""
    wave, deep = made(theory, H, h), min(h, 300.0)
    kinds: dict[str, Any] = {"stokes": raschii.StokesWave, "stream-function": raschii.FentonWave}
    theirs = kinds[theory](H, deep, wave.length, N=wave.rise.size, g=G)
    assert theirs.c == pytest.approx(wave.w / wave.k, rel=1e-6)
    s = np.linspace(0.0, wave.length, 41)
    elevation = np.asarray(theirs.surface_elevation(s, include_depth=False)).ravel()
    motion = sea(wave, phase=0.0)(0.0, along(s, 0.0 * s))
    assert motion.immersion == pytest.approx(elevation, abs=1e-6 * H)
    for z in (-wave.trough - 0.01, -0.7 * min(h, 40.0)):
        velocity = np.asarray(theirs.velocity(s, np.full_like(s, deep + z), 0.0, all_points_wet=True)).reshape(-1, 2)
        mine, _, across = turned(sea(wave, phase=0.0)(0.0, along(s, np.full_like(s, z))))
        assert mine == pytest.approx(velocity, abs=1e-6 * np.abs(velocity).max())
        assert across == pytest.approx(0.0 * s, abs=1e-12)


@cases
def test_flow_has_neither_divergence_nor_curl(theory: str, H: float, h: float) -> None:
    wave = made(theory, H, h)
    gradient = sea(wave)(0.0, points(wave)).velocity_gradient
    size = np.abs(gradient).max()
    assert size > 1e-2
    assert np.abs(np.trace(gradient, axis1=1, axis2=2)).max() < 1e-14 * size
    assert np.abs(gradient - gradient.transpose(0, 2, 1)).max() < 1e-14 * size


@cases
def test_nothing_flows_through_the_bottom(theory: str, H: float, h: float) -> None:
    wave = made(theory, H, h)
    s = np.linspace(0.0, 200.0, 30)
    velocity, _, _ = turned(sea(wave)(1.0, along(s, np.full_like(s, -min(h, 1000.0)))))
    assert np.abs(velocity[:, 1]).max() < 1e-13


def unbalanced(wave: SteadyWave, H: float) -> tuple[float, float]:
    """Flow through the surface over the wave's speed, and what of Bernoulli's sum differs along it, over g H."""
    s = np.linspace(0.0, wave.length, 60, endpoint=False)
    eta, step, c = surface(wave, s), 1e-5 * wave.length, wave.w / wave.k
    slope = (surface(wave, s + step) - surface(wave, s - step)) / (2.0 * step)
    (u, w), _, _ = (part.T for part in turned(sea(wave, phase=0.0)(0.0, along(s, eta))))
    head = 0.5 * ((u - c) ** 2 + w**2) + G * eta
    return float(np.abs((u - c) * slope - w).max() / c), float(np.ptp(head) / (G * H))


@pytest.mark.parametrize(("H", "h"), [(3.0, 7.0), (4.0, 7.0), (9.0, 20.0), (14.0, math.inf), (20.0, math.inf)])
def test_a_stream_function_fulfils_the_conditions_at_the_surface(H: float, h: float) -> None:
    assert max(unbalanced(made("stream-function", H, h), H)) < 2e-5


@pytest.mark.parametrize("h", [15.0, 40.0, math.inf])
def test_the_fifth_order_misses_them_by_the_sixth(h: float) -> None:
    """Relative to the speed; Bernoulli's sum relative to g H, by the fifth power of the height."""
    for number, power in ((0, 6.0), (1, 5.0)):
        large, small = (unbalanced(made("stokes", H, h), H)[number] for H in (4.0, 2.0))
        assert math.log2(large / small) == pytest.approx(power, abs=0.35)


@cases
def test_low_waves_are_linear(theory: str, H: float, h: float) -> None:
    """What differs from linear theory, over the waves, falls with their height."""
    x = points(made(theory, H, h)) - [0.0, 0.0, 1.0]
    off = []
    for height in (0.1, 0.05):
        linear = Sea(LEVEL, [linear_waves(regular(height, T, DIRECTION, 0.4, G, h), h, LEVEL, "vertical")])(3.0, x)
        finite = sea(made(theory, height, h))(3.0, x)
        off.append([np.abs(finite[n] - linear[n]).max() / np.abs(linear[n]).max() for n in (0, 1, 2, 3)])
        rise = np.abs(finite.immersion - linear.immersion).max() / height
    first, second = np.array(off)
    assert second.max() < 0.05
    assert rise < 0.02
    assert first / second == pytest.approx(2.0, rel=0.05)


@cases
@pytest.mark.parametrize("above", [0.0, 0.3])
def test_gradients_are_those_of_what_is_returned(theory: str, H: float, h: float, above: float) -> None:
    wave, step, t = made(theory, H, h), 1e-4, 1.7
    ramped, x = sea(wave, ramp=5.0), points(made(theory, H, h), above)
    motion = ramped(t, x)
    assert np.abs(motion.velocity_gradient[:, 2, 0]).max() > 1e-3
    for axis in range(3):
        shift = step * np.eye(3)[axis]
        before, after = ramped(t, x - shift), ramped(t, x + shift)
        for part, gradient in ((0, 2), (1, 3), (4, 5)):
            difference = (after[part] - before[part]) / (2.0 * step)
            assert motion[gradient][..., axis] == pytest.approx(difference, abs=2e-7)


@cases
def test_acceleration_follows_the_water(theory: str, H: float, h: float) -> None:
    """Rate at a fixed point, and what the velocity carries along; in the ramp and after it."""
    wave, step = made(theory, H, h), 1e-4
    x = points(wave) - [0.0, 0.0, H]
    for t in (2.0, 9.0):
        ramped = sea(wave, ramp=5.0)
        motion = ramped(t, x)
        rate = (ramped(t + step, x).velocity - ramped(t - step, x).velocity) / (2.0 * step)
        carried = np.einsum("nij,nj->ni", motion.velocity_gradient, motion.velocity)
        assert np.abs(carried).max() > 1e-2 * np.abs(rate).max()
        assert motion.acceleration == pytest.approx(rate + carried, abs=1e-7)


def test_above_the_surface_the_water_moves_as_at_it() -> None:
    wave = made("stream-function", 9.0, 20.0)
    x = points(wave, above=1e-9)
    at, high = sea(wave)(0.0, x), sea(wave)(0.0, x + np.array([0.0, 0.0, 50.0]))
    assert high.velocity == pytest.approx(at.velocity)
    assert high.acceleration == pytest.approx(at.acceleration)
    low, bottom = (sea(wave)(1e6, np.array([[3.0, 4.0, LEVEL - z]])).velocity for z in (1e4, 20.0))
    assert low == pytest.approx(bottom)


def test_tangent_of_the_loads() -> None:
    """The tangent is checked by differences, on a riser that goes through the wave."""
    at = sample(3)
    wave = steady_wave("stream-function", 0.9, 3.0, G, 6.0)
    sea = Sea(sample_water.LEVEL, [steady_flow(wave, 0.3, 0.2, 5.2, 2.0, 0.0, 0.0)])
    part = sample_water.driven(sample_water.resistance(at), sea)
    state = at.state(2)
    K = difference_tangent(part, state, WEIGHTS)
    assert error(tangent([part], state, WEIGHTS), K) < 1e-8


def test_theories_by_height_and_depth() -> None:
    """Le Mehaute's line of H/g T^2 = 0.001 in deep water; long and steep waves by the stream function."""
    assert choose(2.0 * math.pi * 0.00099, math.inf) == "airy"
    assert choose(2.0 * math.pi * 0.00105, math.inf) == "stokes"
    assert choose(0.59 * 0.1413, math.inf) == "stokes"
    assert choose(0.62 * 0.1413, math.inf) == "stream-function"
    assert choose(0.01, 0.03) == "stream-function"
    assert made("auto", 0.05, math.inf).theory == "airy"


@pytest.mark.parametrize(("H", "h"), [(12.0, math.inf), (9.5, 31.0), (3.0, 16.0), (1.9, 13.0)])
def test_where_the_fifth_order_is_chosen_it_is_near_the_stream_function(H: float, h: float) -> None:
    wave, other = made("auto", H, h), made("stream-function", H, h)
    assert wave.theory == "stokes"
    fast, right = (
        turned(sea(each, phase=0.0)(0.0, along(np.zeros(1), np.array([each.crest]))))[0][0, 0] for each in (wave, other)
    )
    assert fast == pytest.approx(right, rel=3e-3)
    assert wave.length == pytest.approx(other.length, rel=1e-3)


@pytest.mark.parametrize("theory", ["stokes", "stream-function"])
def test_no_unit_of_length_and_time_matters(theory: str) -> None:
    wave, small = steady_wave(theory, 6.0, 10.0, 9.81, 25.0), steady_wave(theory, 6e-6, 10.0, 9.81e-6, 25e-6)
    assert small.k * 1e-6 == pytest.approx(wave.k, rel=1e-12)
    assert small.speed * 1e6 == pytest.approx(wave.speed, rel=1e-10, abs=1e-12)


@pytest.mark.verify
def test_the_highest_waves() -> None:
    """Williams's (1981): 0.1412 of the length in deep water, 0.833 of the depth of the longest."""
    assert highest(1.0, math.inf) == pytest.approx(0.1412, rel=2e-3)
    assert highest(1e5, 1.0) == pytest.approx(0.833, rel=2e-3)
    steep = made("stream-function", 25.0, math.inf)
    assert 25.0 / highest(steep.length, math.inf) == pytest.approx(0.955, abs=1e-3)


REGULAR = {"regular": {"height": 8.0, "period": 10.0, "direction_deg": 180.0}}


def test_a_scene_says_which_theory_it_takes_and_is_echoed(tmp_path: Path) -> None:
    scene = in_water({"surface_level": 100.0, "waves": REGULAR})
    sea = sea_of(scene)
    assert sea is not None
    assert sea.waves is not None
    (line,) = regular_wave_theory(sea.waves)
    assert "fifth order: 160" in line
    assert list(wave_warnings(scene)) == []
    assert resolved_dimension(scene) == 2
    echo = tmp_path / "scene.yaml"
    echo.write_text(dump_scene(scene))
    assert read_scene(echo) == scene
    water = water_of(scene, scene.stages[1])
    assert water is not None
    motion = water(12.0, np.array([[10.0, 0.0, 60.0]]))
    direct = Sea(100.0, [steady_flow(made("stokes", 8.0, math.inf), math.pi, 0.0, 100.0, 10.0, 0.0, 0.0)])
    assert motion.velocity == pytest.approx(direct(12.0, np.array([[10.0, 0.0, 60.0]])).velocity)


def test_a_vessel_follows_the_first_harmonic() -> None:
    (waves,) = zip(*components_of(in_water({"surface_level": 100.0, "waves": REGULAR})) or (), strict=True)
    a, w, k, toward, _ = waves
    assert (a, w, toward) == pytest.approx((4.0, 0.2 * math.pi, math.pi))
    assert k == pytest.approx(made("stokes", 8.0, math.inf).k, rel=1e-12)


def test_stretching_is_refused() -> None:
    with pytest.raises(SceneError, match=telling("water.waves.stretching:", "finite height", "leave it out")):
        in_water({"surface_level": 100.0, "waves": REGULAR | {"stretching": "wheeler"}})


@pytest.mark.parametrize(
    ("depth", "given", "message"),
    [
        (
            100.0,
            {"height": 27.0},
            "water.waves.regular.height: 27 m is too high: waves of 10 s in 100 m of water break",
        ),
        (8.0, {"height": 5.8}, "water.waves.regular.height: 5.8 m is too high: waves of 10 s in 8 m of water break"),
        (9.0, {"height": 5.0, "theory": "stokes"}, "water.waves.regular.theory: stokes: Ursell's number"),
    ],
)
def test_what_can_not_be_is_reported_in_a_line(depth: float, given: dict[str, Any], message: str) -> None:
    scene = in_water({"surface_level": 100.0, "depth": depth, "waves": {"regular": {"period": 10.0} | given}})
    with pytest.raises(SceneError, match=message) as raised:
        water_of(scene, scene.stages[1])
    assert "\n" not in str(raised.value)
