"""Contact with the smooth surface of soil that moves: its curve, derivatives, balance, and a groove that fits."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from riser_soil.contact.facets import shape, strips
from riser_soil.contact.law import Penalty
from riser_soil.contact.soil_friction import SoilFriction
from riser_soil.core.arrays import Array
from riser_soil.soil.surface import SoilTop
from tests.support.differences import slope as differences
from tests.support.pipe_on_surface import RADIUS, STIFFNESS, PipeOnSurface, pipe_on_surface, sagging, shaken
from tests.support.soil_tops import top

DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])


def moving(turned: bool = False) -> SoilTop:
    """A surface of squares a third as wide as the pipe; turned: numbered the other way around."""
    surface = top("quad4", 30, 10, 0.1)
    surface.moves = True
    surface.committed = 0.004 * np.random.default_rng(4).normal(size=surface.points.shape)
    if turned:
        surface.facets = np.roll(surface.facets, 1, axis=1)
    return surface


@DIMENSIONS
@pytest.mark.parametrize("turned", [False, True])
def test_residual_and_tangent_are_slopes(dimension: int, turned: bool) -> None:
    made = pipe_on_surface(sagging(), moving(turned), dimension)
    u, h = shaken(made, 2, 0.002), 1e-6

    def energy(direction: Array, s: float) -> Array:
        return np.array(made.contact.energy(made.state(direction * s)).potential)

    def residual(direction: Array, s: float) -> Array:
        return made.residual(u + s * direction)

    for seed in range(3):
        direction = shaken(made, 10 + seed, 1.0)
        wanted = float(differences(partial(energy, direction), h))
        assert made.residual(np.zeros(made.size)) @ direction == pytest.approx(wanted, rel=1e-6)
        assert abs(wanted) > 20.0
        by_tangent, slope = made.tangent(u) @ direction, differences(partial(residual, direction), 1e-7)
        assert np.abs(by_tangent - slope).max() < 2e-6 * np.abs(by_tangent).max()


def test_the_tangent_of_friction_is_its_slope() -> None:
    made = pipe_on_surface(sagging(), moving())
    friction = SoilFriction(made.contact, 0.5, 0.3, 3e6)
    u = shaken(made, 3, 0.001)
    direction = shaken(made, 12, 1.0)
    by_tangent = made.tangent(u, friction) @ direction
    slope = differences(lambda s: made.residual(u + s * direction, friction), 1e-7)
    assert np.abs(by_tangent - slope).max() < 5e-6 * np.abs(by_tangent).max()


def test_forces_and_moments_sum_to_zero() -> None:
    made = pipe_on_surface(sagging(), moving())
    state, surface = made.state(), made.surface
    on_riser, on_soil = made.contact.force_on_riser(state), made.contact.force_on_soil(state)
    assert np.abs(on_riser + on_soil).max() < 1e-12 * np.abs(on_riser).max()
    turn, spin, nodal = np.zeros(made.size), np.array([0.3, 0.5, 1.0]), np.zeros((made.line.nodes, 6))
    trial = made.line.trial(state)
    nodal[:, :3] = np.cross(spin, made.line.to_global(trial.x))
    nodal[:, 3:] = [trial.turn.at(node).T @ spin for node in range(made.line.nodes)]
    turn[2 : 2 + made.line.size] = nodal.ravel()
    turn[surface.offset :] = np.cross(spin, surface.points + surface.committed).ravel()
    work = made.residual(state.u) * turn
    assert abs(work.sum()) < 1e-12 * np.abs(work).sum()


def grooved(moves: bool, depth: float) -> PipeOnSurface:
    """A pipe that penetrates by `depth`, all along, a groove whose nodes lie on a circle."""
    surface = top("quad4", 30, 10, 0.1)
    surface.moves = moves
    angle = np.clip(surface.points[:, 1] / 0.1 * 0.3, -1.2, 1.2)
    groove = np.stack([(RADIUS - depth) * np.sin(angle), -(RADIUS - depth) * np.cos(angle)], axis=1)
    surface.committed[:, 1:] = groove - surface.points[:, 1:]
    along = np.linspace(-0.5, 3.5, 6)
    return pipe_on_surface(np.stack([along, 0.0 * along, 0.0 * along], axis=1), surface, 2, 0.005, Penalty(STIFFNESS))


def test_a_groove_that_fits_bears_the_pipe_evenly() -> None:
    """Nodes 0.3 rad apart on a circle: the smooth curve leaves it by 3/128 0.3^4 of its radius, chords by 0.3^2/8."""
    depth = 1e-3
    deep = 3.0 / 128.0 * 0.3**4 * RADIUS
    made = grooved(True, depth)
    points = made.contact.evaluate(made.state()).pressed.points
    inner = np.abs(made.surface.points[made.contact._soil.corners[points.facet]].mean(axis=1)[:, 1]) < 0.25
    gap = -points.gap[inner]
    assert depth - 1e-9 < gap.min() < gap.max() < depth + 1.1 * deep
    chords = grooved(False, depth)
    assert np.max(-chords.contact.evaluate(chords.state()).pressed.points.gap) > depth + 0.9 * 0.3**2 / 8.0 * RADIUS


def test_the_curve_goes_through_nodes_with_the_slope_between_their_neighbours() -> None:
    N, dN = shape(8, -1.0, -1.0)
    np.testing.assert_allclose(N, [1.0, 0, 0, 0, 0, 0, 0, 0])
    np.testing.assert_allclose(2.0 * dN[:, 1], [0, 0, 0, 0.5, -0.5, 0, 0, 0])  # by t = (1 + eta)/2
    for xi, eta in ((0.3, -0.7), (-0.2, 0.1), (1.0, 1.0)):
        N, dN = shape(8, xi, eta)
        places = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -3], [1, -3], [1, 3], [-1, 3]])
        np.testing.assert_allclose(N @ places, [xi, eta], atol=1e-14)
        np.testing.assert_allclose(dN.T @ places, np.eye(2), atol=1e-14)
        h = 1e-6
        ways = h * np.eye(2)
        by = [(shape(8, xi + a, eta + b)[0] - shape(8, xi - a, eta - b)[0]) / (2.0 * h) for a, b in ways]
        np.testing.assert_allclose(dN.T, by, atol=1e-9)


def test_strips_reach_to_the_next_nodes_across() -> None:
    """On a grid two facets long and three wide, numbered across first; at its rim nodes stand for themselves."""
    number = np.arange(12).reshape(3, 4)
    cells = [number[i : i + 2, j : j + 2] for i in range(2) for j in range(3)]
    quads = np.array([[n[0, 0], n[1, 0], n[1, 1], n[0, 1]] for n in cells])
    widths = strips(quads)
    assert widths[1].tolist() == [1, 5, 6, 2, 0, 4, 7, 3]
    assert widths[3].tolist() == [4, 8, 9, 5, 4, 8, 10, 6]
    assert (widths[:, :4] == quads).all()


def test_what_points_remember_goes_over_to_those_that_lie_there_next() -> None:
    """Nodes slide along the surface by half a facet: the tractions of friction stay where they were, and the nodes' way
    is no slide, within what other points take from the pressure.
    """
    made = pipe_on_surface(sagging(0.0), (surface := top("quad4", 60, 40, 0.05)), spacing=0.01)
    surface.moves = True
    made = pipe_on_surface(sagging(0.0), surface, spacing=0.01)
    friction = SoilFriction(made.contact, 0.5, 0.3, 3e6)
    u = np.zeros(made.size)
    u[2 : 2 + made.line.size : 6] = 1e-3
    made.commit(u, friction)
    pulled = friction.force_on_riser(made.state())
    before, places = friction.state()["points/rows"].copy(), surface.points + surface.committed
    total = before[:, :3].T @ before[:, 3]
    surface.committed[:, 1] += 0.025
    made.contact.surface_renewed(places, [friction.memory])
    after = friction.state()["points/rows"]
    assert after[:, :3].T @ after[:, 3] == pytest.approx(total, rel=0.02, abs=0.02 * np.abs(total).max())
    assert len(after) != 0
    pulls = friction.force_on_riser(made.state())
    assert pulls == pytest.approx(pulled, abs=0.05 * np.abs(pulled).max())
