"""Current that changes in time: its formula, what it does to a riser, and what a scene may say of it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from riser_soil.assembly.stage import times_to_hit
from riser_soil.errors import SceneError
from riser_soil.scene.plane import resolved_dimension
from riser_soil.scene.stages import DynamicStage
from riser_soil.sea.current import changing_current, spline_rates
from riser_soil.sea.flows import Sea
from tests.support import sample_water
from tests.support.dense_chain import tangent
from tests.support.differences import WEIGHTS, difference_tangent, error
from tests.support.sample_line import sample
from tests.support.scenes import MIDWATER, dynamic, in_water, riser_scene
from tests.support.seas import water_of
from tests.support.stage_histories import stage_histories

pytestmark = pytest.mark.usefixtures("uncompiled")

LEVEL, TIME = np.array([-100.0, -20.0, 0.0]), np.array([10.0, 30.0, 35.0])
VELOCITY = np.array(
    [
        [[0.0, 0.0], [0.2, 0.1], [0.5, 0.4]],
        [[0.1, 0.0], [0.6, -0.1], [1.5, 0.0]],
        [[0.0, 0.3], [0.0, 0.0], [0.2, -0.4]],
    ]
)


def sea(**more: Any) -> Sea:
    return Sea(5.0, [changing_current(LEVEL, TIME, VELOCITY, **more)])


def test_it_is_linear_between_heights_and_constant_beyond_the_times() -> None:
    x = np.array([[3.0, 1.0, -10.0]])
    top, mid = VELOCITY[:, 2], VELOCITY[:, 1]
    for t, velocity in ((0.0, 0.5 * (top[0] + mid[0])), (99.0, 0.5 * (top[2] + mid[2]))):
        motion = sea()(t, x)
        assert motion.velocity[0, :2] == pytest.approx(velocity)
        assert motion.acceleration == pytest.approx(0.0, abs=1e-15)
    motion = sea(clock=4.0)(26.0, x)
    assert motion.velocity[0, :2] == pytest.approx(0.5 * (top[1] + mid[1]))
    assert motion.velocity[0, 2] == motion.acceleration[0, 2] == 0.0


def test_its_rates_are_the_splines() -> None:
    """Rates are compared with SciPy's, level at both ends, and by hand for two times."""
    time, value = np.array([0.0, 1.0, 2.5, 3.0, 7.0]), np.array([0.3, 1.0, -0.5, 0.2, 0.9])
    theirs = CubicSpline(time, value, bc_type="clamped")
    assert spline_rates(time, value) == pytest.approx(theirs(time, 1), abs=1e-13)
    current = changing_current(np.zeros(1), time, np.stack([value, -value], axis=-1)[:, None])
    for t in (0.4, 1.0, 2.8, 6.9, 7.0):
        motion = Sea(None, [current])(t, np.zeros((1, 3)))
        assert motion.velocity[0] == pytest.approx(float(theirs(t)) * np.array([1.0, -1.0, 0.0]))
        assert motion.acceleration[0, 0] == pytest.approx(float(theirs(t, 1)), abs=1e-13)
    assert not spline_rates(np.array([0.0, 2.0]), np.array([1.0, 5.0])).any()


def test_rates_and_gradients_are_those_of_what_is_returned() -> None:
    x, step = np.random.default_rng(2).uniform(-110.0, 10.0, (40, 3)), 1e-5
    for t in (20.0, 33.0):
        motion = sea()(t, x)
        assert np.abs(motion.acceleration_gradient).max() > 1e-4
        rate = (sea()(t + step, x).velocity - sea()(t - step, x).velocity) / (2.0 * step)
        assert motion.acceleration == pytest.approx(rate, abs=1e-9)
        shift = np.array([0.0, 0.0, step])
        above, below = sea()(t, x + shift), sea()(t, x - shift)
        for part, gradient in ((0, 2), (1, 3)):
            assert motion[gradient][..., 2] == pytest.approx((above[part] - below[part]) / (2.0 * step), abs=1e-9)


def test_in_stages_without_time_it_stands_still() -> None:
    x = np.array([[0.0, 0.0, -20.0]])
    stood, grown = sea(clock=20.0, runs=False)(0.5, x), sea(clock=20.0, runs=False, grows=True)(0.5, x)
    there = sea()(20.0, x).velocity
    assert stood.velocity == pytest.approx(there)
    assert grown.velocity == pytest.approx(0.5 * there)
    assert not stood.acceleration.any()


def test_tangent_of_the_loads() -> None:
    at = sample(3)
    level, velocity = LEVEL * 0.05 + 5.0, VELOCITY * 3.0
    sea = Sea(None, [changing_current(level, TIME * 0.02, velocity)])
    part = sample_water.driven(sample_water.resistance(at), sea)
    assert error(tangent([part], at.state(2), WEIGHTS), difference_tangent(part, at.state(2), WEIGHTS)) < 1e-8


PIPE: dict[str, Any] = {"outer_diameter": 0.3, "mass": 1025.0 * 0.25 * math.pi * 0.3**2, "EA": 1.0e6, "EI": 2.0e3}
PIPE |= {"drag": {"normal": 1.1, "tangential": 0.05}, "added_mass": {"normal": 1.0}}


@pytest.mark.parametrize("coefficients", [True, False])
def test_a_floating_pipe_goes_with_the_water(coefficients: bool) -> None:
    """A pipe as heavy as the water that it displaces is accelerated by m + m_a as the water pushes by rho A + m_a."""
    history = [{"time": 1.0, "profile": [[0.0, 0.0, 0.0]]}, {"time": 5.0, "profile": [[0.0, 2.0, 0.0]]}]
    pipe = PIPE if coefficients else {key: PIPE[key] for key in ("outer_diameter", "mass", "EA", "EI")}
    (drift,) = stage_histories(
        riser_scene(
            dynamic(4.0, 0.1, scheme={"newmark": {"beta": 0.25, "gamma": 0.5}}),
            pipe=pipe,
            length=20.0,
            elements=4,
            start="free",
            end="free",
            riser={"unstressed": {"points": [[0.0, 0.0, -30.0], [0.0, 0.0, -10.0]]}},
            water={"current": {"history": history}},
        )
    )
    gone = np.array([position[:, 0].mean() for position in drift.position])
    s = np.clip((np.array(drift.t) - 1.0) / 4.0, 0.0, 1.0)
    assert gone == pytest.approx(8.0 * (s**3 - 0.5 * s**4), abs=1e-3)
    assert np.ptp(drift.position[-1][:, 0]) < 1e-9


HISTORY = [
    {"time": 0.0, "profile": [[0.0, 0.2, 0.0], [100.0, 1.0, 0.0]]},
    {"time": 30.0, "profile": [[60.0, -0.4, 0.0]]},
]


def test_a_scene_s_current_runs_on_the_waves_clock() -> None:
    scene = in_water({"current": {"history": HISTORY}})
    flows = [water_of(scene, stage) for stage in scene.stages]
    values = [water(0.5, MIDWATER).velocity[0, 0] for water in flows if water is not None]
    s = np.array([0.0, 0.5, 20.0, 20.5]) / 30.0
    expected = 0.6 - (3.0 * s**2 - 2.0 * s**3)
    assert values == pytest.approx(expected * [0.5, 1.0, 1.0, 1.0])
    storm = scene.stages[3]
    assert isinstance(storm, DynamicStage)
    assert times_to_hit(scene, storm)[-1] == 10.0
    assert resolved_dimension(scene) == 2
    across = [HISTORY[0], {"time": 30.0, "profile": [[0.0, 0.0, 0.3]]}]
    assert resolved_dimension(in_water({"current": {"history": across}})) == 3


@pytest.mark.parametrize(
    ("current", "message"),
    [
        ({}, "water.current.profile: missing: profile is missing; give profile"),
        ({"profile": [[0.0, 1.0, 0.0]], "history": HISTORY}, "profile and history are both given"),
        ({"history": HISTORY[:1]}, "water.current.history: .* at least 2"),
        ({"history": HISTORY[::-1]}, "times must increase, by 1e-12 s at least; sort the profiles by time"),
        ({"history": [HISTORY[0], HISTORY[1] | {"profile": []}]}, "water.current.history.1.profile: .* at least 1"),
    ],
)
def test_bad_input_is_reported_in_a_line(current: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError, match=message) as raised:
        in_water({"current": current})
    assert "\n" not in str(raised.value)
