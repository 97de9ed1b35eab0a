"""Viscous forces of the elements: what they damp, by how much, and what they leave alone."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser import shapes
from riser_soil.riser.beam import Beam
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End
from riser_soil.riser.section_forces import element_residual, viscous_residual
from riser_soil.riser.sections import joined
from riser_soil.riser.spatial_directors import SpatialOrientation
from riser_soil.riser.structural_damping import StructuralDamping
from tests.support.dense_chain import residual, tangent
from tests.support.pipes import WEIGHTLESS, pipe
from tests.support.sample_line import DIRECTION, START, THICK, THIN, UP, sample
from tests.support.sections import section_forces

pytestmark = pytest.mark.usefixtures("uncompiled")

both_dimensions = pytest.mark.parametrize("dimension", [2, 3])
NORMAL = np.cross(DIRECTION, UP)


def moving(u: Array, v: Array) -> State:
    return State(0.0, u, v, np.zeros_like(v))


def rigid(line: Line, u: Array, spin: Array, velocity: Array) -> State:
    """The line at increments u in rigid motion: angular velocity and velocity of the origin, in global axes."""
    v, trial = np.zeros(line.size), line.trial(moving(u, 0.0 * u))
    nodal, turn = line.nodal(v), trial.turn
    nodal[:, : line.dimension] = (velocity + np.cross(spin, line.to_global(trial.x))) @ line.basis
    in_body_axes = np.swapaxes(turn.R, 1, 2) @ spin if isinstance(turn, SpatialOrientation) else spin @ NORMAL
    nodal[:, line.dimension :] = in_body_axes
    return moving(u, v)


@both_dimensions
def test_rigid_motion_is_not_damped_however_fast(dimension: int) -> None:
    at = sample(dimension)
    damping, u = at.damping(), at.state(1).u
    spin = 300.0 * (NORMAL if dimension == 2 else np.array([0.5, -0.7, 0.4]))
    whirl = rigid(at.line, u, spin, np.array([6.0, 8.0, -20.0]))
    shaken = moving(u, np.random.default_rng(4).normal(size=u.size) * np.abs(whirl.v).max())
    scale = np.abs(residual([damping], shaken)).max()
    assert np.abs(residual([damping], whirl)).max() < 1e-13 * scale


@both_dimensions
def test_forces_are_beta_times_the_stiffness_about_the_unstressed_shape(dimension: int) -> None:
    """A bend in the plane; in space a straight line, as the stiffness of a bend has a condensed twist in addition."""
    e = joined([pipe(3.0, 2, WEIGHTLESS, **THICK), pipe(5.0, 3, WEIGHTLESS, **THIN)])
    bend = shapes.circle(e.arc, START - 6.0 * UP, START, 8.0 / 6.0, -NORMAL)
    shape = bend if dimension == 2 else shapes.straight(e.arc, START, DIRECTION)
    layout = shapes.layout(e.arc, e.outer_diameter, shape, shape)
    line = Line(dimension, layout, End(True), End(False), direction=DIRECTION)
    e.damping[:] = 0.25
    v = np.random.default_rng(7).normal(size=line.size)
    expected = 0.25 * tangent([Beam(line, e)], State.at_rest(0.0, line.size)) @ v
    forces = residual([StructuralDamping(line, e)], moving(0.0 * v, v))
    assert np.abs(forces - expected).max() < 1e-10 * np.abs(expected).max()


@both_dimensions
def test_power_is_dissipated_and_enters_the_ledger(dimension: int) -> None:
    at, rng, dt = sample(dimension), np.random.default_rng(11), 1e-7
    damping = at.damping()
    for v in rng.normal(size=(20, at.line.size)):
        before, after = moving(0.0 * v, v), moving(dt * v, v)
        power = float(residual([damping], before) @ v)
        assert power > 0.0
        assert damping.work(before, after).dissipated == pytest.approx(dt * power, rel=1e-5)


@both_dimensions
def test_moments_contain_damping_and_curvature_does_not(dimension: int) -> None:
    at = sample(dimension)
    beam, damping, u = at.beam(), at.damping(), at.state(3).u
    state = moving(u, np.random.default_rng(5).normal(size=u.size))
    elastic = element_residual(at.line, [beam], state)
    both = element_residual(at.line, [beam, damping], state)
    calm = section_forces(at.line, at.elements, state, elastic)
    damped = section_forces(at.line, at.elements, state, both, viscous_residual(at.line, [damping], state))
    assert damped.curvature == pytest.approx(calm.curvature, rel=1e-9)
    assert np.abs(damped.bending_moment - calm.bending_moment).max() > 0.1 * calm.bending_moment.max()
