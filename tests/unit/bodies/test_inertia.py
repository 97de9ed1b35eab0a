"""Inertia of a body over steps of the midpoint rule: tangent, momentum, energy, and tops whose motion is known."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from riser_soil.bodies.body import MovingBody
from riser_soil.bodies.inertia import BodyInertia, MidpointBodyInertia
from riser_soil.core.arrays import Array
from riser_soil.core.part import State, Weights
from riser_soil.riser.spatial_directors import SpatialOrientation
from riser_soil.solve.time_scheme import Midpoint
from tests.support.dense_chain import residual, tangent
from tests.support.differences import error, slope
from tests.support.momentum import of_body
from tests.support.sample_body import body, properties

pytestmark = pytest.mark.usefixtures("uncompiled")

RULE = Midpoint()
FORCES = Weights(1.0, 0.0, 0.0, 0.0)
GENERAL = properties().mass_matrix()


def begun(made: MovingBody, M: Array, v: Array) -> tuple[MidpointBodyInertia, State]:
    """A part where a stage begins, and the accepted state, with rates v (6,)."""
    part, start = MidpointBodyInertia(made, M), State(2.0, np.zeros(6), v, np.zeros(6))
    part.begin_stage(start)
    return part, start


def to_end(start: State, u: Array, dt: float) -> State:
    return RULE.trial(start, start.t + dt, dt, u)


def middle(start: State, u: Array, dt: float) -> State:
    return RULE.balanced_at(start, to_end(start, u, dt), dt)


def free_step(part: MidpointBodyInertia, start: State, dt: float) -> State:
    """The end of a step in which nothing acts on the body, by Newton's method."""
    u = dt * start.v
    for _ in range(20):
        there = middle(start, u, dt)
        f = residual([part], there, FORCES)
        if np.abs(f).max() < 1e-13 * np.abs(part.M).max() / dt:
            break
        u = u - 2.0 * np.linalg.solve(tangent([part], there, RULE.weights(dt)), f)
    return to_end(start, u, dt)


def flown(made: MovingBody, M: Array, v: Array, dt: float, steps: int) -> tuple[Array, Array, Array]:
    """Linear and angular momentum (steps + 1, 3) and kinetic energy of a free body, at first and after each step."""
    part, start = begun(made, M, v)
    history = [(*of_body(made, M, v), part.energy(start).kinetic)]
    for _ in range(steps):
        end = free_step(part, start, dt)
        energy = part.energy(end).kinetic
        part.commit(end)
        made.commit(end)
        start = State(end.t, np.zeros(6), end.v, np.zeros(6))
        history.append((*of_body(made, M, end.v), energy))
    linear, angular, energies = (np.array(each) for each in zip(*history, strict=True))
    return linear, angular, energies


RATES = np.array([1.0, -2.0, 0.5, 0.8, 1.1, -0.6])


def test_tangent_is_the_derivative_of_the_residual() -> None:
    part, start = begun(body(), GENERAL, RATES)
    u, dt = np.array([0.1, -0.2, 0.15, 0.4, -0.3, 0.5]), 0.4
    K = tangent([part], middle(start, u, dt), RULE.weights(dt))

    def along(way: Array, s: float) -> Array:
        return residual([part], middle(start, u + 2.0 * s * way, dt), FORCES)

    expected = np.stack([slope(partial(along, way), 1e-3) for way in np.eye(6)], axis=1)
    assert error(K, expected) < 1e-8


def test_force_and_moment_over_a_step_are_the_changes_of_momentum() -> None:
    """About the origin of global axes, where the forces of the middle act on the place of the middle."""
    made = body()
    part, start = begun(made, GENERAL, RATES)
    u, dt = np.array([0.1, -0.2, 0.15, 0.4, -0.3, 0.5]), 0.4
    before = of_body(made, GENERAL, RATES)
    trial, force = made.trial(middle(start, u, dt)), residual([part], middle(start, u, dt), FORCES)
    assert isinstance(trial.turn, SpatialOrientation)
    moment = np.linalg.solve(trial.turn.H[0].T, force[3:]) + np.cross(trial.x[0], force[:3])
    end = to_end(start, u, dt)
    made.commit(end)
    linear, angular = of_body(made, GENERAL, end.v)
    np.testing.assert_allclose(dt * force[:3], linear - before[0], rtol=1e-11)
    np.testing.assert_allclose(dt * moment, angular - before[1], rtol=1e-10)


def test_a_free_body_keeps_both_momenta_and_energy_errs_in_second_order() -> None:
    """The body has added masses that differ and centres beside its origin."""
    ranges = []
    for dt in (0.1, 0.05):
        linear, angular, energy = flown(body(), GENERAL, RATES, dt, round(10.0 / dt))
        for kept in (linear, angular):
            assert np.abs(kept - kept[0]).max() < 1e-10 * np.linalg.norm(kept[0])
        ranges.append(np.ptp(energy) / energy[0])
    assert ranges[0] < 2e-2
    assert np.log2(ranges[0] / ranges[1]) > 1.8


def test_a_body_that_turns_about_its_centre_keeps_its_energy() -> None:
    M = np.diag([3.0, 3.0, 3.0, 40.0, 55.0, 90.0])
    _, angular, energy = flown(body(), M, RATES, 0.3, 100)
    assert np.ptp(energy) < 1e-11 * energy[0]
    assert np.abs(angular - angular[0]).max() < 1e-10 * np.linalg.norm(angular[0])


def test_a_symmetric_top_precesses() -> None:
    """In its own axes the angular velocity goes around by (J3 - J1)/J1 W3; errors are of second order."""
    J1, J3, W = 40.0, 90.0, np.array([0.7, 0.0, 1.3])
    M, turned, errors = np.diag([1.0, 1.0, 1.0, J1, J1, J3]), 2.0 * (J3 - J1) / J1 * W[2], []
    for steps in (20, 40):
        part, start = begun(made := body(), M, np.append(np.zeros(3), W))
        for _ in range(steps):
            end = free_step(part, start, 2.0 / steps)
            part.commit(end)
            made.commit(end)
            start = State(end.t, np.zeros(6), end.v, np.zeros(6))
        exact = 0.7 * np.array([np.cos(turned), np.sin(turned)])
        errors.append(np.linalg.norm(start.v[3:5] - exact))
        assert start.v[5] == pytest.approx(W[2], rel=1e-12)
    assert errors[1] < 1e-2
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)


def test_between_steps_it_is_the_inertia_of_the_instant() -> None:
    made = body()
    part, start = begun(made, GENERAL, RATES)
    now, instant = State(start.t, start.u, start.v, np.arange(1.0, 7.0)), BodyInertia(made, GENERAL)
    assert np.array_equal(residual([part], now, FORCES), residual([instant], now, FORCES))
    weights = RULE.weights(0.4)
    assert np.array_equal(tangent([part], now, weights), tangent([instant], now, weights))
