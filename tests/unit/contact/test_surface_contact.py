"""The pipe's cylinder on a surface of the soil: derivatives, balance, closed forms, and no print of the meshes."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import pytest

from riser_soil.contact.law import Penalty
from riser_soil.core.arrays import Array
from riser_soil.results.settlement_trough import TroughSections
from tests.support.contact_along import touchdown_at
from tests.support.differences import slope as differences
from tests.support.pipe_on_surface import RADIUS, STIFFNESS, PipeOnSurface, pipe_on_surface, sagging, shaken
from tests.support.soil_tops import top


def along_line(made: PipeOnSurface, u: Array, direction: Array, s: float) -> Array:
    return made.residual(u + s * direction)


KINDS = pytest.mark.parametrize("kind", ["quad4", "tri6"])
DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])


@KINDS
@DIMENSIONS
def test_the_residual_is_the_slope_of_the_potential(kind: str, dimension: int) -> None:
    """In a direction, so that rotations of the trial count as they do in the potential."""
    made = pipe_on_surface(sagging(), top(kind), dimension)
    u = np.zeros(made.size)
    direction = shaken(made, 1, 1.0)
    h = 1e-6

    def energy(s: float) -> Array:
        return np.array(made.contact.energy(made.state(u + s * direction)).potential)

    slope = float(differences(energy, h))
    assert made.residual(u) @ direction == pytest.approx(slope, rel=1e-6)
    assert abs(slope) > 100.0


@KINDS
@DIMENSIONS
def test_the_tangent_is_the_slope_of_the_residual(kind: str, dimension: int) -> None:
    """Not at once at rest, so that the rotations' own terms count."""
    made = pipe_on_surface(sagging(), top(kind), dimension)
    u = shaken(made, 2, 0.004)
    K = made.tangent(u)
    h = 1e-7
    for seed in range(4):
        direction = shaken(made, 10 + seed, 1.0)
        slope = differences(partial(along_line, made, u, direction), h)
        assert np.abs(K @ direction - slope).max() < 2e-6 * np.abs(K @ direction).max()
    assert not made.contact.outgrown
    assert np.abs(K - K.T).max() < 1e-12 * np.abs(K).max()


@KINDS
def test_an_end_of_the_riser_presses_as_a_sphere(kind: str) -> None:
    """Beyond the end the distance is that from its middle, and the tangent that of such a distance."""
    ends = np.array([[1.02, 0.03, RADIUS - 0.03], [1.6, 0.1, RADIUS - 0.02], [2.1, 0.2, RADIUS + 0.3]])
    made = pipe_on_surface(ends, top(kind))
    near = made.contact.evaluate(made.state()).pressed.points
    assert np.any(near.along == 0.0)
    u, h = shaken(made, 2, 0.002), 1e-7
    direction = shaken(made, 3, 1.0)
    slope = differences(partial(along_line, made, u, direction), h)
    wanted = made.tangent(u) @ direction
    assert np.abs(wanted - slope).max() < 2e-6 * np.abs(wanted).max()


def test_soil_that_has_come_through_is_pushed_down() -> None:
    """A pipe that a guess has put too deep still presses on the soil above its axis, not on its way up."""
    deep, along = 0.02, np.linspace(-0.5, 3.5, 6)
    made = pipe_on_surface(np.stack([along, np.zeros(6), np.full(6, -deep)], axis=1), top("quad4"), spacing=0.005)
    beside = RADIUS * (np.arange(10000) + 0.5) / 10000
    rho = np.hypot(beside, deep)
    pushed_up = np.where(beside < 0.5 * RADIUS, -(rho + RADIUS), np.maximum(RADIUS - rho, 0.0)) * deep / rho
    expected = 2.0 * RADIUS * 3.0 * STIFFNESS * float(pushed_up.mean())
    assert made.contact.force_on_soil(made.state())[2] == pytest.approx(expected, rel=0.05)
    assert expected < 0.0


@KINDS
def test_forces_and_moments_on_riser_and_soil_sum_to_zero(kind: str) -> None:
    surface = top(kind)
    surface.committed = 0.01 * np.random.default_rng(5).normal(size=surface.points.shape)
    made = pipe_on_surface(sagging(), surface)
    state = made.state()
    on_riser, on_soil = made.contact.force_on_riser(state), made.contact.force_on_soil(state)
    assert np.abs(on_riser + on_soil).max() < 1e-12 * np.abs(on_riser).max()
    turn, spin, nodal = np.zeros(made.size), np.array([0.3, 0.5, 1.0]), np.zeros((made.line.nodes, 6))
    trial, at = made.line.trial(state), surface.offset
    nodal[:, :3] = np.cross(spin, made.line.to_global(trial.x))
    nodal[:, 3:] = [trial.turn.at(node).T @ spin for node in range(made.line.nodes)]
    turn[2 : 2 + made.line.size] = nodal.ravel()
    turn[at:] = np.cross(spin, surface.points + surface.committed).ravel()
    work = made.residual(state.u) * turn
    assert abs(work.sum()) < 1e-12 * np.abs(work).sum()


@KINDS
def test_a_level_pipe_presses_as_the_circle_s_chord_says(kind: str) -> None:
    """k(R - rho) over the chord of a circle that dips into a plane, its upright share."""
    depth = 0.02
    points = np.stack([np.linspace(0.2, 2.8, 6), np.full(6, 0.013), np.full(6, RADIUS - depth)], axis=1)
    half = np.sqrt(RADIUS**2 - (RADIUS - depth) ** 2)
    x = half * np.cos(np.pi * (np.arange(20000) + 0.5) / 20000)
    weight = half * np.sin(np.pi * (np.arange(20000) + 0.5) / 20000) * np.pi / 20000
    rho = np.hypot(x, RADIUS - depth)
    expected = STIFFNESS * np.sum(weight * (RADIUS - rho) * (RADIUS - depth) / rho)
    for spacing, bound in ((0.04, 0.04), (0.02, 0.01), (0.01, 3e-3)):
        made = pipe_on_surface(points, top(kind), spacing=spacing, pressure=Penalty(STIFFNESS))
        force = made.contact.force_per_length(made.state())[2:4]
        assert force == pytest.approx(expected, rel=bound)


@KINDS
def test_no_node_leaves_a_print(kind: str) -> None:
    """A level pipe presses evenly, wherever nodes of riser and soil are: each row of soil nodes has its share."""
    along = np.array([-1.0, 0.37, 0.61, 1.44, 1.93, 4.0])
    points = np.stack([along, np.full(6, 0.01), np.full(6, RADIUS - 0.01)], axis=1)
    made = pipe_on_surface(points, top(kind), spacing=0.01)
    force = made.contact.force_per_length(made.state())
    assert force[2] == pytest.approx(force[3], rel=1e-3)
    on_soil = made.residual(np.zeros(made.size))[made.surface.offset :].reshape(-1, 3)
    rows = made.surface.points[:, 0]
    share = np.array([on_soil[rows == x, 2].sum() for x in np.unique(rows)])[2:-2]
    for same in (share[::2], share[1::2]):  # in the middles of sides and at corners, where there are both
        assert np.ptp(same) < 1e-3 * np.abs(same).max()


def test_the_stretch_is_that_of_the_facets_that_press() -> None:
    surface = top("quad4")
    made = pipe_on_surface(sagging(angle=0.0), surface)
    assert made.contact.stretch(made.state()) == pytest.approx(1.0)
    surface.committed[:, 1] = 0.5 * surface.points[:, 1]
    surface.committed[np.abs(surface.points[:, 1]) > 0.6, 1] *= 3.0  # these facets the pipe doesn't touch
    assert made.contact.stretch(made.state()) == pytest.approx(1.5)
    above = pipe_on_surface(sagging(depth=-0.17), surface)
    assert above.contact.stretch(above.state()) == 1.0


def test_nothing_touches_above_the_soil() -> None:
    made = pipe_on_surface(sagging(depth=-0.17), top("quad4"))
    state = made.state()
    assert not made.residual(state.u).any()
    assert made.contact.work(state, state).dissipated == 0.0
    assert made.contact.max_penetration(state) == 0.0
    assert not made.contact.force_on_soil_per_length(state).any()
    assert np.isnan(touchdown_at(made.contact, state))


@KINDS
@DIMENSIONS
def test_along_the_riser_the_soil_gets_what_the_riser_loses(kind: str, dimension: int) -> None:
    """The force per length is from the soil's nodes: in sum what they get, and at each node of the riser the size of
    what it bears.
    """
    surface = top(kind)
    surface.committed = 0.01 * np.random.default_rng(5).normal(size=surface.points.shape)
    made = pipe_on_surface(sagging(angle=0.3 * (dimension == 3)), surface, dimension)
    state, contact = made.state(), made.contact
    along = contact.force_on_soil_per_length(state)
    total, on_riser = made.line.tributary_length @ along, contact.force_on_riser(state)
    assert np.abs(total - contact.force_on_soil(state)).max() < 1e-13 * np.abs(on_riser).max()
    in_plane = made.line.basis @ made.line.basis.T
    assert np.abs(in_plane @ total + on_riser).max() < 1e-12 * np.abs(on_riser).max()
    borne = np.linalg.norm(along @ in_plane, axis=1)
    np.testing.assert_allclose(borne, contact.force_per_length(state), rtol=1e-12, atol=1e-12 * borne.max())
    assert np.count_nonzero(borne) >= 3


@KINDS
def test_settlement_is_the_depth_less_the_penetration(kind: str) -> None:
    surface = top(kind)
    surface.committed[:, 2] = -0.004 - 0.002 * surface.points[:, 0]
    made = pipe_on_surface(sagging(), surface)
    state = made.state()
    xy = made.line.positions3(state)[:, :2]
    touching = made.contact.penetration(state) > 0.0
    settlement = made.contact.settlement(xy, state)
    sunk = made.contact.depth(state) - made.contact.penetration(state)
    assert touching.any()
    np.testing.assert_allclose(settlement, 0.004 + 0.002 * xy[:, 0], rtol=1e-9)
    np.testing.assert_allclose(settlement[touching], sunk[touching], rtol=1e-9)
    assert np.isnan(made.contact.settlement(np.array([[90.0, 0.0]]), state)).all()


@KINDS
def test_sections_lie_across_the_riser_and_stay(kind: str) -> None:
    """The surface settled by a plane; offsets count to the left along growing arc length."""
    surface = top(kind)
    surface.committed[:, 2] = -0.01 - 0.003 * surface.points[:, 0] + 0.005 * surface.points[:, 1]
    made = pipe_on_surface(sagging(angle=0.3), surface)
    offsets = (-9.0, -0.2, 0.0, 0.3)
    sections = TroughSections(made.line, made.contact, (made.line.arc[2], made.line.arc[3]), offsets)
    assert np.isnan(sections.values(made.state())["settlement_across"]).all()
    sections.lay(*made.placed(), math.nan)
    assert sections.laid
    values = sections.values(made.state())
    np.testing.assert_array_equal(values["section_arc"], made.line.arc[[2, 3]])
    np.testing.assert_allclose(values["section_position"], made.line.positions3(made.state())[[2, 3]], atol=1e-12)
    across = np.array([-np.sin(0.3), np.cos(0.3), 0.0])
    np.testing.assert_allclose(values["section_direction"], [across, across], atol=1e-12)
    x, y, _ = np.moveaxis(values["section_position"][:, None] + np.array(offsets)[None, :, None] * across, 2, 0)
    expected = 0.01 + 0.003 * x - 0.005 * y
    np.testing.assert_allclose(values["settlement_across"][:, 1:], expected[:, 1:], rtol=1e-9)
    assert np.isnan(values["settlement_across"][:, 0]).all(), "beside the soil"
    again = TroughSections(made.line, made.contact, (made.line.arc[0], made.line.arc[1]), offsets)
    again.restore(sections.state())
    np.testing.assert_array_equal(again.values(made.state())["settlement_across"], values["settlement_across"])


def test_a_section_waits_for_the_touchdown_point() -> None:
    made = pipe_on_surface(sagging(), top("quad4"))
    sections = TroughSections(made.line, made.contact, None, (0.0,))
    sections.lay(*made.placed(), math.nan)
    assert not sections.laid
    sections.lay(*made.placed(), 1.0)
    assert sections.values(made.state())["section_arc"] == [1.0]
