"""Inertia over steps of the midpoint rule: tangents, momentum, energy, and what it is between steps."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.part import State, Weights
from riser_soil.riser.line import Line
from riser_soil.riser.midpoint_inertia import MidpointInertia, MidpointRotaryInertia, over_steps
from riser_soil.riser.placed_line import LineTrials
from riser_soil.riser.spatial_directors import SpatialOrientation
from riser_soil.solve.time_scheme import Midpoint
from tests.support.dense_chain import residual, tangent
from tests.support.differences import error
from tests.support.sample_line import Sample, sample

pytestmark = pytest.mark.usefixtures("uncompiled")

DT, BEGUN = 0.4, 2.0
WEIGHTS = Midpoint().weights(DT)
STENCIL = ((1, 3.0 / 4.0), (2, -3.0 / 20.0), (3, 1.0 / 60.0))
Stepping = MidpointInertia | MidpointRotaryInertia
both_dimensions = pytest.mark.parametrize("dimension", [2, 3])
both_parts = pytest.mark.parametrize("make", [Sample.inertia, Sample.rotary])


def started(make: Callable, dimension: int) -> tuple[Sample, Stepping, State]:
    """A part over steps and the accepted state where it starts, with rates; one step is behind it."""
    at = sample(dimension)
    part = over_steps(make(at))
    assert isinstance(part, Stepping)
    first = at.state(3, t=BEGUN - DT)
    begun = State(first.t, 0.0 * first.u, first.v, 0.0 * first.a)
    part.begin(begun)
    end = Midpoint().trial(begun, BEGUN, DT, at.state(4, 0.1).u)
    part.commit(end)
    at.line.commit(end)
    return at, part, State(BEGUN, 0.0 * end.u, end.v, 0.0 * end.a)


def to_end(start: State, u: Array) -> State:
    return Midpoint().trial(start, BEGUN + DT, DT, u)


def middle(start: State, u: Array) -> State:
    """The balanced state of the step with increments u."""
    return Midpoint().balanced_at(start, to_end(start, u), DT)


def differences(part: Stepping, start: State, u: Array, h: float = 2e-3) -> Array:
    """Derivative of the balance by half the increment, column by column; central differences of sixth order."""
    columns = []
    for way in 2.0 * np.eye(u.size):
        steps = [(s * c, middle(start, u + s * k * h * way)) for k, c in STENCIL for s in (1, -1)]
        columns.append(sum(c * residual([part], state, WEIGHTS) for c, state in steps) / h)
    return np.stack(columns, axis=1)


@both_dimensions
@both_parts
def test_tangent_is_the_derivative_of_the_residual(make: Callable, dimension: int) -> None:
    at, part, start = started(make, dimension)
    u = at.state(5, 0.3).u
    K = tangent([part], middle(start, u), WEIGHTS)
    assert error(K, differences(part, start, u)) < 1e-8


@both_dimensions
@both_parts
def test_turning_means_matter_in_the_tangent(make: Callable, dimension: int) -> None:
    """Other rates at the start change the forces on the means alone, and with these how they turn."""
    at, part, start = started(make, dimension)
    state = middle(start, at.state(5, 0.3).u)
    whole = tangent([part], state, WEIGHTS)
    part.begin(State(start.t, start.u, 2.0 * start.v, start.a))
    at.line.once(LineTrials).forget()
    assert error(tangent([part], state, WEIGHTS), whole) > 1e-4


def rigid(line: Line, state: State, spin: Array) -> Array:
    """Increments of the dofs in a rigid turn about the origin from a configuration, to first order."""
    trial, out = line.trial(state), np.zeros(line.size)
    nodal, turn = line.nodal(out), trial.turn
    nodal[:, : line.dimension] = np.cross(spin, line.to_global(trial.x)) @ line.basis
    if isinstance(turn, SpatialOrientation):
        nodal[:, 3:] = np.linalg.solve(turn.H, np.tile(spin, (line.nodes, 1))[..., None])[..., 0]
    else:
        nodal[:, 2] = spin @ line.normal
    return out


def angular_momentum(at: Sample, part: Stepping, state: State) -> Array:
    """About the origin, of a state at a step's end that is not accepted yet."""
    line, trial = at.line, at.line.trial(state)
    if isinstance(part, MidpointInertia):
        x, t = line.to_global(trial.x), trial.turn.tangent @ line.basis.T
        q = np.stack([x[:-1], t[:, 0], x[1:], t[:, 1]], axis=1)
        impulse = np.einsum("eab,ebi->eai", part.instant.M, part.q_rate(state)) @ line.basis.T
        return np.asarray(np.cross(q, impulse).sum(axis=(0, 1)))
    if isinstance(trial.turn, SpatialOrientation):
        frames = np.stack([trial.turn.frame1, trial.turn.frame2], axis=1)
        moving = [frames[..., k] for k in part.instant.on_directors()]
    else:
        t = trial.turn.tangent
        moving = [np.stack([-t[..., 1], t[..., 0]], axis=-1) @ line.basis.T]
    each = zip(moving, part.masses[..., None, None], part.rates(state), strict=True)
    return np.asarray(sum(np.cross(d, mass * rate @ line.basis.T).sum(axis=(0, 1)) for d, mass, rate in each))


@both_dimensions
@both_parts
def test_moment_over_a_step_is_the_change_of_angular_momentum(make: Callable, dimension: int) -> None:
    at, part, start = started(make, dimension)
    u = at.state(5, 0.3).u
    change = angular_momentum(at, part, to_end(start, u)) - angular_momentum(at, part, start)
    force = residual([part], middle(start, u), Weights(1.0, 0.0, 0.0, 0.0))
    axes = np.eye(3) if dimension == 3 else [at.line.normal]
    for spin in axes:
        moment = force @ rigid(at.line, middle(start, u), np.asarray(spin))
        assert DT * moment == pytest.approx(change @ spin, rel=1e-10, abs=1e-9 * np.abs(change).max())


@both_dimensions
@both_parts
def test_work_over_a_step_is_the_change_of_kinetic_energy(make: Callable, dimension: int) -> None:
    """The rotations work on spins of 2 tan(theta/2) about the step's axis, as these turn the means into the changes."""
    at, part, start = started(make, dimension)
    u = at.state(5, 0.3).u
    path, rotations = u.copy(), at.line.nodal(u)[:, dimension:]
    size = np.linalg.norm(rotations, axis=1, keepdims=True)
    at.line.nodal(path)[:, dimension:] = rotations * 2.0 * np.tan(0.5 * size) / size
    force = residual([part], middle(start, u), Weights(1.0, 0.0, 0.0, 0.0))
    gained = part.energy(to_end(start, u)).kinetic - part.energy(start).kinetic
    assert force @ path == pytest.approx(gained, rel=1e-10)


@both_dimensions
@both_parts
def test_between_steps_it_is_the_inertia_of_the_instant(make: Callable, dimension: int) -> None:
    at, part, start = started(make, dimension)
    now = State(BEGUN, start.u, start.v, at.state(8).a)
    assert np.array_equal(residual([part], now, WEIGHTS), residual([part.instant], now, WEIGHTS))
    assert np.array_equal(tangent([part], now, WEIGHTS), tangent([part.instant], now, WEIGHTS))


@both_dimensions
@both_parts
def test_for_short_steps_it_is_the_inertia_of_the_middle(make: Callable, dimension: int) -> None:
    """The difference vanishes with the step."""
    at = sample(dimension)
    part, smooth, gaps = over_steps(make(at)), at.state(6), []
    assert isinstance(part, Stepping)
    for dt in (0.02, 0.01):
        start = State(0.0, 0.0 * smooth.u, smooth.v, smooth.a)
        part.begin(start)
        halfway = State(0.5 * dt, *motion(start, 0.5 * dt))
        given = Midpoint().balanced_at(start, State(dt, *motion(start, dt)), dt)
        force = residual([part], State(given.t, given.u, given.v, start.a), WEIGHTS)
        exact = residual([part.instant], halfway, WEIGHTS)
        gaps.append(np.abs(force - exact).max() / np.abs(exact).max())
    assert gaps[0] < 0.1
    assert gaps[0] / gaps[1] > 1.8


def motion(start: State, t: float) -> tuple[Array, Array, Array]:
    return t * start.v + 0.5 * t * t * start.a, start.v + t * start.a, start.a
