"""The pipe's cylinder on a surface of the soil: derivatives, balance, closed forms, and no print of the meshes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
import pytest

from riser_soil.contact.law import Penalty
from riser_soil.contact.soil_contact import CandidateRange
from riser_soil.contact.surface_contact import SurfaceContact
from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State, Weights
from riser_soil.riser import shapes
from riser_soil.riser.ends import End
from riser_soil.riser.line import Line
from riser_soil.soil.surface import SoilTop
from tests.support.differences import slope as differences
from tests.support.soil_tops import top

WEIGHTS = Weights(inertia=0.0, force=0.0, shift_v=0.0, shift_a=0.0)
RADIUS, STIFFNESS = 0.15, 2.0e6  # m, N/m3


@dataclass
class Case:
    """A riser over a surface; dofs of another field lie between them."""

    line: Line
    surface: SoilTop
    contact: SurfaceContact

    @property
    def size(self) -> int:
        return self.surface.offset + self.surface.size

    def state(self, u: Array | None = None) -> State:
        u = np.zeros(self.size) if u is None else u
        return State(0.0, u, np.zeros(self.size), np.zeros(self.size))

    def residual(self, u: Array) -> Array:
        forces = Forces.zeros(self.size)
        self.contact.residual(self.state(u), forces)
        assert not forces.inertia.any()
        assert not forces.force.any()
        return forces.end

    def tangent(self, u: Array) -> Array:
        blocks = self.contact.blocks()
        values = {key: block.zeros() for key, block in blocks.items()}
        self.contact.tangent(self.state(u), WEIGHTS, values)
        K = np.zeros((self.size, self.size))
        for key, block in blocks.items():
            np.add.at(K, (block.rows[:, :, None], block.cols[:, None, :]), values[key])
        return K


def case(
    points: Array,
    surface: SoilTop,
    dimension: int = 3,
    spacing: float = 0.05,
    smoothing: float = 2e-3,
    upright: bool = False,
) -> Case:
    """A riser through points (n, 3), smooth at the nodes."""
    arc = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))))
    ahead = np.array([*(points[-1] - points[0])[:2], 0.0])
    direction = ahead / np.linalg.norm(ahead)
    curved = shapes.from_nodes(points, shapes.nodal_tangents(points))
    straight = shapes.straight(arc, points[0], direction)
    layout = shapes.layout(arc, np.full(len(arc) - 1, 2.0 * RADIUS), straight, curved)
    line = Line(dimension, layout, End(False), End(False), direction=direction)
    line.offset = 2
    surface.offset = 2 + line.size + 3
    contact = SurfaceContact(
        line,
        np.full(len(arc) - 1, RADIUS),
        surface,
        Penalty(STIFFNESS, smoothing),
        (2.0 * spacing, spacing),
        upright=upright,
        along=direction[:2],
        reach=CandidateRange(0.5, 0.5),
    )
    return Case(line, surface, contact)


def sagging(angle: float = 0.3, depth: float = 0.03) -> Array:
    """Five nodes that cross the surface at an angle, the middle one deepest in it."""
    s = np.array([-1.1, -0.5, 0.1, 0.6, 1.2])
    z = RADIUS - depth + 0.06 * s**2
    return np.stack([1.5 + s * np.cos(angle), s * np.sin(angle), z], axis=1)


def shaken(made: Case, seed: int, size: float) -> Array:
    u = np.zeros(made.size)
    u[2:] = size * np.random.default_rng(seed).normal(size=made.size - 2)
    return u


def along_line(made: Case, u: Array, direction: Array, s: float) -> Array:
    return made.residual(u + s * direction)


KINDS = pytest.mark.parametrize("kind", ["quad4", "tri6"])
DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])
UPRIGHT = pytest.mark.parametrize("upright", [False, True])


@KINDS
@DIMENSIONS
@UPRIGHT
def test_the_residual_is_the_slope_of_the_potential(kind: str, dimension: int, upright: bool) -> None:
    """In a direction, so that rotations of the trial count as they do in the potential."""
    made = case(sagging(), top(kind), dimension, upright=upright)
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
@UPRIGHT
def test_the_tangent_is_the_slope_of_the_residual(kind: str, dimension: int, upright: bool) -> None:
    """Not at once at rest, so that the rotations' own terms count."""
    made = case(sagging(), top(kind), dimension, upright=upright)
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
    made = case(ends, top(kind))
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
    made = case(np.stack([along, np.zeros(6), np.full(6, -deep)], axis=1), top("quad4"), spacing=0.005)
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
    made = case(sagging(), surface)
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
        made = case(points, top(kind), spacing=spacing, smoothing=0.0)
        force = made.contact.force_per_length(made.state())[2:4]
        assert force == pytest.approx(expected, rel=bound)


@KINDS
def test_no_node_leaves_a_print(kind: str) -> None:
    """A level pipe presses evenly, wherever nodes of riser and soil are: each row of soil nodes has its share."""
    along = np.array([-1.0, 0.37, 0.61, 1.44, 1.93, 4.0])
    made = case(np.stack([along, np.full(6, 0.01), np.full(6, RADIUS - 0.01)], axis=1), top(kind), spacing=0.01)
    force = made.contact.force_per_length(made.state())
    assert force[2] == pytest.approx(force[3], rel=1e-3)
    on_soil = made.residual(np.zeros(made.size))[made.surface.offset :].reshape(-1, 3)
    rows = made.surface.points[:, 0]
    share = np.array([on_soil[rows == x, 2].sum() for x in np.unique(rows)])[2:-2]
    for same in (share[::2], share[1::2]):  # in the middles of sides and at corners, where there are both
        assert np.ptp(same) < 1e-3 * np.abs(same).max()


def test_the_stretch_is_that_of_the_facets_that_press() -> None:
    surface = top("quad4")
    made = case(sagging(angle=0.0), surface)
    assert made.contact.stretch(made.state()) == pytest.approx(1.0)
    surface.committed[:, 1] = 0.5 * surface.points[:, 1]
    surface.committed[np.abs(surface.points[:, 1]) > 0.6, 1] *= 3.0  # these facets the pipe doesn't touch
    assert made.contact.stretch(made.state()) == pytest.approx(1.5)
    above = case(sagging(depth=-0.17), surface)
    assert above.contact.stretch(above.state()) == 1.0


@DIMENSIONS
def test_upright_contact_neither_sees_nor_pushes_the_soil_sideways(dimension: int) -> None:
    """The upright forces stay in balance; a shift of the surface in plan changes nothing."""
    made = case(sagging(), top("quad4"), dimension, upright=True)
    u = shaken(made, 2, 0.004)
    on_riser, on_soil = made.contact.force_on_riser(made.state(u)), made.contact.force_on_soil(made.state(u))
    assert on_riser[2] == pytest.approx(-on_soil[2], rel=1e-12)
    assert on_riser[2] > 100.0
    assert not on_soil[:2].any()
    before, shifted = made.residual(u), u.copy()
    for axis in (0, 1):
        shifted[made.surface.offset + axis :: 3] += 0.03
    assert np.array_equal(made.residual(shifted), before)


def test_nothing_touches_above_the_soil() -> None:
    made = case(sagging(depth=-0.17), top("quad4"))
    state = made.state()
    assert not made.residual(state.u).any()
    assert made.contact.work(state, state).dissipated == 0.0
    assert made.contact.max_penetration(state) == 0.0
    assert np.isnan(made.contact.touchdown_arc(state))
