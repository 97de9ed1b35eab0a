"""Supports that turn: what follows them, how fast, and what their turning does to springs."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State
from riser_soil.riser import rotations
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End, SupportRotation
from riser_soil.riser.springs import EndSpring
from tests.support.sample_line import DIRECTION, UP, Sample, sample

pytestmark = pytest.mark.usefixtures("uncompiled")

both_dimensions = pytest.mark.parametrize("dimension", [2, 3])
NORMAL = np.cross(DIRECTION, UP)


def hub(t: float) -> SupportRotation:
    """Spun up about the normal of the sample's plane, by many turns."""
    return SupportRotation(*(rate * NORMAL for rate in (0.5 * t**2, t, 1.0)))


def tumbling(t: float) -> SupportRotation:
    """About an axis that turns itself: exp(z) exp(y) of angles z, y; whole turns are lost in its rotation vector."""
    (z, w, b), (y, q, c) = (0.3 * t**2, 0.6 * t, 0.6), (0.8 * t, 0.8, 0.0)
    about_z = np.array(rotations.exp((0.0, 0.0, z)))
    R = about_z @ np.array(rotations.exp((0.0, y, 0.0)))
    e, k = about_z[:, 1], np.array([0.0, 0.0, 1.0])
    rotation = np.array(rotations.log(tuple(map(tuple, R))))
    return SupportRotation(rotation, w * k + q * e, b * k + c * e + q * w * np.cross(k, e))


CASES = pytest.mark.parametrize(("dimension", "turning"), [(2, hub), (3, hub), (3, tumbling)])


def turned(dimension: int, turning: Callable[[float], SupportRotation]) -> Sample:
    return sample(dimension, (End(True, rotation_fixed=True, turning=turning), End(True)), shaken=False)


def step_to(line: Line, t: float) -> State:
    state = State.at_rest(t, line.size)
    line.prescribe(t, state.u, state.v, state.a)
    line.commit(state)
    return state


def start_frame(line: Line) -> Array:
    """Tangent of the first element at the start, global axes."""
    unturned = line.frames.turn(np.zeros((line.nodes, line.frames.dofs)))
    return np.asarray(line.basis @ unturned.tangent[0, 0])


@CASES
def test_a_fixed_rotation_follows_its_support_through_many_turns(
    dimension: int, turning: Callable[[float], SupportRotation]
) -> None:
    line = turned(dimension, turning).line
    first = start_frame(line)
    for t in np.arange(1, 121) * 0.08:  # the hub turns by 46 rad, the steps by less than 1
        u = line.nodal(step_to(line, t).u)[0, dimension:]
        assert np.linalg.norm(u) < 1.0
        expected = np.array(rotations.exp(tuple(turning(t).rotation))) @ first
        assert start_frame(line) == pytest.approx(expected, abs=1e-13)


@CASES
def test_rates_are_derivatives_of_the_increments(dimension: int, turning: Callable[[float], SupportRotation]) -> None:
    """A small increment from time t is the angular velocity there in body axes; accelerations are those of its
    components in the body axes."""
    line, t, h = turned(dimension, turning).line, 1.7, 1e-4
    step_to(line, t)

    def at(time: float) -> tuple[Array, Array, Array]:
        u, v, a = np.zeros((3, line.size))
        line.prescribe(time, u, v, a)
        angle, rate, acceleration = (line.nodal(x)[0, dimension:] for x in (u, v, a))
        return angle, rate, acceleration

    (ahead, v_ahead, _), (behind, v_behind, _), (_, v, a) = at(t + h), at(t - h), at(t)
    assert v == pytest.approx((ahead - behind) / (2 * h), abs=1e-6)
    assert a == pytest.approx((v_ahead - v_behind) / (2 * h), abs=1e-6)


@CASES
def test_a_new_stage_turns_on_from_where_the_support_is(
    dimension: int, turning: Callable[[float], SupportRotation]
) -> None:
    line = turned(dimension, turning).line
    step_to(line, 2.0)
    there = start_frame(line)
    line.begin_stage()
    line.start.turning = None
    step_to(line, 1.0)
    assert start_frame(line) == pytest.approx(there, abs=1e-15)
    line.start.turning = turning
    step_to(line, 1.0)
    again = np.array(rotations.exp(tuple(turning(1.0).rotation))) @ there
    assert start_frame(line) == pytest.approx(again, abs=1e-14)


@CASES
def test_a_spring_is_at_rest_where_its_support_points(
    dimension: int, turning: Callable[[float], SupportRotation]
) -> None:
    made = sample(dimension, (End(True, turning=turning), End(True)), shaken=False)
    line, spring = made.line, EndSpring(made.line, 0, 700.0)
    assert moment_of(spring, State.at_rest(1.0, line.size)) == pytest.approx(700.0 * turning(1.0).rotation, rel=1e-12)
    followed = End(True, rotation_fixed=True, turning=turning)
    other = sample(dimension, (followed, End(True)), shaken=False).line
    state = State.at_rest(1.0, other.size)
    other.prescribe(1.0, state.u, state.v, state.a)
    assert moment_of(EndSpring(other, 0, 700.0), state) == pytest.approx(np.zeros(3), abs=1e-11)


def moment_of(spring: EndSpring, state: State) -> Array:
    """Moment (3,) of a spring on the riser, in global axes."""
    line, forces = spring.line, Forces.zeros(state.u.size)
    spring.residual(state, forces)
    maps = line.trial(state).turn.moment_maps(line.turning_axes)
    return np.asarray(-maps[spring.node] @ line.nodal(forces.force)[spring.node, line.dimension :])


@CASES
def test_turning_a_support_against_its_spring_is_work(
    dimension: int, turning: Callable[[float], SupportRotation]
) -> None:
    """While the riser stays as it is, the spring stores it all; to second order in the step."""

    def missing(steps: int) -> float:
        made = sample(dimension, (End(True, turning=turning), End(True)), shaken=False)
        spring = EndSpring(made.line, 0, 700.0)
        states = [State.at_rest(t, made.line.size) for t in np.linspace(0.0, 1.5, steps + 1)]
        work = sum(spring.work(a, b).external for a, b in pairwise(states))
        return abs(work / spring.energy(states[-1]).strain - 1.0)

    if turning is hub:
        assert missing(10) < 1e-12
    else:
        assert missing(20) < 2e-3
        assert missing(40) < 0.27 * missing(20)
