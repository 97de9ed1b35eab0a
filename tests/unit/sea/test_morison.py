"""Morison's formula against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.part import State, Weights
from riser_soil.riser import shapes
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End
from riser_soil.sea.morison import Morison, in_still_water
from riser_soil.sea.morison_law import added_masses, drag_coefficients
from riser_soil.sea.pipe import Pipe
from tests.support.dense_chain import residual
from tests.support.sample_line import sample

pytestmark = pytest.mark.usefixtures("uncompiled")

RHO, D, L = 1025.0, 0.3, 6.0
CD, CDT, CA, CAT = 1.1, 0.05, 0.9, 0.1
DRAG_ONLY, MASS_ONLY = Weights(0.0, 1.0, 0.0, 0.0), Weights(1.0, 0.0, 0.0, 0.0)


def inclined(dimension: int) -> tuple[Line, Morison, Array]:
    """A straight pipe along (0.6, 0, 0.8)."""
    arc, tangent = np.linspace(0.0, L, 4), np.array([0.6, 0.0, 0.8])
    curve = shapes.straight(arc, direction=tangent)
    line = Line(dimension, shapes.layout(arc, np.full(3, D), curve, curve), End(False), End(False))
    ones = np.ones(3)
    drag = drag_coefficients(RHO, D * ones, CD * ones, CDT * ones)
    mass = added_masses(RHO, D * ones, CA * ones, CAT * ones)
    return line, in_still_water(Pipe(line), drag, mass), tangent


def uniform(line: Line, v: Array, a: Array) -> State:
    """All nodes move alike; v and a in global axes."""
    rates = np.zeros((2, line.size))
    for values, vector in zip(rates, (v, a), strict=True):
        line.nodal(values)[:, : line.dimension] = vector @ line.basis
    return State(0.0, np.zeros(line.size), rates[0], rates[1])


def total_force(line: Line, part: Morison, state: State, weights: Weights) -> Array:
    nodal = line.nodal(residual([part], state, weights))
    return np.asarray(line.basis @ nodal[:, : line.dimension].sum(axis=0))


@pytest.mark.parametrize("dimension", [2, 3])
def test_drag_across_and_along_the_pipe(dimension: int) -> None:
    line, part, tangent = inclined(dimension)
    normal = np.array([-0.8, 0.0, 0.6])
    v = -1.5 * normal + 0.7 * tangent
    across = 0.5 * RHO * CD * D * L * 1.5**2 * -normal
    along = 0.5 * RHO * CDT * np.pi * D * L * 0.7**2 * tangent
    assert total_force(line, part, uniform(line, v, 0.0 * v), DRAG_ONLY) == pytest.approx(across + along)


@pytest.mark.parametrize("dimension", [2, 3])
def test_added_mass_across_and_along_the_pipe(dimension: int) -> None:
    line, part, tangent = inclined(dimension)
    normal = np.array([-0.8, 0.0, 0.6])
    expected = RHO * 0.25 * np.pi * D**2 * L * (CA * 3.0 * normal + CAT * 2.0 * tangent)
    state = uniform(line, 0.0 * normal, 3.0 * normal + 2.0 * tangent)
    assert total_force(line, part, state, MASS_ONLY) == pytest.approx(expected)


def test_drag_out_of_the_plane() -> None:
    line, part, _ = inclined(3)
    state = uniform(line, np.array([0.0, -2.0, 0.0]), np.zeros(3))
    expected = [0.0, -0.5 * RHO * CD * D * L * 4.0, 0.0]
    assert total_force(line, part, state, DRAG_ONLY) == pytest.approx(expected)


@pytest.mark.parametrize("dimension", [2, 3])
def test_kinetic_energy_of_the_added_mass(dimension: int) -> None:
    line, part, tangent = inclined(dimension)
    v = 2.0 * np.array([-0.8, 0.0, 0.6]) + tangent
    expected = 0.5 * RHO * 0.25 * np.pi * D**2 * L * (CA * 4.0 + CAT)
    assert part.energy(uniform(line, v, 0.0 * v)).kinetic == pytest.approx(expected)


@pytest.mark.parametrize("dimension", [2, 3])
def test_drag_always_takes_energy(dimension: int) -> None:
    at = sample(dimension)
    part = at.morison()
    for seed in range(10):
        moving = at.state(seed)
        # at zero increments the body-axes spin is the rate of the rotation vector
        state = State(0.0, 0.0 * moving.u, moving.v, moving.a)
        assert residual([part], state, DRAG_ONLY) @ state.v > 0.0


@pytest.mark.parametrize("dimension", [2, 3])
def test_work_over_a_step_closes_the_energy_of_added_mass_and_drag(dimension: int) -> None:
    """Force times way of a short step splits into kinetic energy, drag and turning."""
    at = sample(dimension)
    part, start = at.morison(), at.state(3)
    h = 1e-4
    before = State(0.0, 0.0 * start.u, start.v, start.a)
    after = State(h, h * start.v + 0.5 * h * h * start.a, start.v + h * start.a, start.a)
    work = part.work(before, after)
    middle = State(0.5 * h, 0.5 * h * start.v, start.v + 0.5 * h * start.a, start.a)
    drag = residual([part], middle, DRAG_ONLY) @ start.v * h
    given = residual([part], middle, Weights(1.0, 1.0, 0.0, 0.0)) @ start.v * h
    gained = part.energy(after).kinetic - part.energy(before).kinetic
    assert work.dissipated == pytest.approx(drag, rel=1e-2)
    assert gained + work.dissipated - work.external == pytest.approx(given, rel=1e-2)
