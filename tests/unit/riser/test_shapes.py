"""Unstressed and initial shapes and what the line starts from."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.riser import shapes
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End
from tests.support.said import telling

ARC = np.linspace(0.0, 10.0, 11)
EAST, NORTH, UP = np.eye(3)


def test_straight_between_two_points_is_stretched_evenly() -> None:
    curve = shapes.between(ARC, [1.0, 2.0, 3.0], [1.0, 2.0, 23.0])
    assert curve.position[5] == pytest.approx([1.0, 2.0, 13.0])
    assert curve.tangent == pytest.approx(np.broadcast_to(UP, (10, 2, 3)))


def test_no_straight_line_through_one_point() -> None:
    with pytest.raises(SceneError, match="same point"):
        shapes.between(ARC, [1.0, 2.0, 3.0], [1.0, 2.0, 3.0])


def test_arc_of_a_circle() -> None:
    radius, angle = 40.0 / np.pi, 0.25 * np.pi
    curve = shapes.circle(ARC, [0.0, radius, 0.0], [0.0, 0.0, 0.0], angle, UP)
    end = [radius * np.sin(angle), radius * (1.0 - np.cos(angle)), 0.0]
    assert curve.position[-1] == pytest.approx(end, abs=1e-13)
    assert curve.tangent[0, 0] == pytest.approx(EAST)
    assert curve.tangent[-1, 1] == pytest.approx([np.cos(angle), np.sin(angle), 0.0])


def test_arc_that_turns_the_other_way() -> None:
    radius = 40.0 / np.pi
    curve = shapes.circle(ARC, [0.0, radius, 0.0], [0.0, 0.0, 0.0], -0.25 * np.pi, UP)
    assert curve.tangent[0, 0] == pytest.approx(-EAST)
    assert curve.position[1, 0] < 0.0


def test_arc_of_another_length_than_the_riser_is_refused() -> None:
    with pytest.raises(SceneError, match=telling("riser.unstressed.arc:", "length is 20 m", "segments", "to 10 m")):
        shapes.circle(ARC, [0.0, 20.0, 0.0], [0.0, 0.0, 0.0], 1.0, UP)


def test_points_are_followed_by_their_own_fraction() -> None:
    curve = shapes.through(ARC, [[0.0, 0.0, 0.0], [6.0, 0.0, 0.0], [6.0, 6.0, 0.0]])
    assert curve.position[5] == pytest.approx([6.0, 0.0, 0.0])
    assert curve.position[-1] == pytest.approx([6.0, 6.0, 0.0])
    assert curve.tangent[5, 0] == pytest.approx([np.sqrt(0.5), np.sqrt(0.5), 0.0])
    assert curve.tangent[4, 1] == pytest.approx(curve.tangent[5, 0])


def test_tangents_at_nodes_are_exact_on_a_circle() -> None:
    phi = np.linspace(0.0, 1.2, 7)
    circle = np.stack([np.sin(phi), 0.0 * phi, 1.0 - np.cos(phi)], axis=1)
    exact = np.stack([np.cos(phi), 0.0 * phi, np.sin(phi)], axis=1)
    assert shapes.nodal_tangents(circle) == pytest.approx(exact, abs=1e-14)


@pytest.mark.parametrize("points", [[[0.0, 0.0, 0.0]], [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]])
def test_too_few_points_are_refused(points: list[list[float]]) -> None:
    with pytest.raises(SceneError, match="at least two"):
        shapes.through(ARC, points)


unit_vectors = st.tuples(*[st.floats(-1.0, 1.0)] * 3).map(np.array).filter(lambda v: np.linalg.norm(v) > 0.1)


def turned(a: Array, b: Array) -> Array:
    """The smallest turn (3, 3) of one vector, among others."""
    among = np.stack([EAST, a, EAST]), np.stack([-EAST, b, EAST])
    return np.asarray(shapes.smallest_turns(*among)[1])


@given(unit_vectors, unit_vectors)
def test_smallest_turn_is_a_rotation_about_the_common_normal(a: Array, b: Array) -> None:
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    turn = turned(a, b)
    assert turn @ a == pytest.approx(b, abs=1e-6)
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-6)
    assert np.linalg.det(turn) == pytest.approx(1.0, abs=1e-6)
    assert 1.0 + a @ b < 1e-9 or turn @ np.cross(a, b) == pytest.approx(np.cross(a, b), abs=1e-6)


def test_turns_by_nearly_half_a_turn_are_exact() -> None:
    a = np.array([0.625, 1e-5, 0.0])
    turn = turned(a / np.linalg.norm(a), -EAST)
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-14)
    assert turn @ a / np.linalg.norm(a) == pytest.approx(-EAST, abs=1e-10)


def test_half_turns_keep_to_the_vertical_plane() -> None:
    assert turned(EAST, -EAST) == pytest.approx(np.diag([-1.0, 1.0, -1.0]))


def test_an_unstressed_riser_along_x_needs_no_rotation() -> None:
    curve = shapes.straight(ARC)
    layout = shapes.layout(ARC, np.zeros(10), curve, curve)
    assert pytest.approx(np.broadcast_to(np.eye(3), (10, 2, 3, 3))) == layout.T0
    assert layout.rotation == pytest.approx(np.broadcast_to(np.eye(3), (11, 3, 3)))


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("first", [[0.0, 0.0, -1.0], [-0.6, 0.0, -0.8], [-1.0, 0.0, 0.0], [1.0, 0.0, 0.2]])
def test_the_line_starts_with_the_initial_tangents(dimension: int, first: list[float]) -> None:
    """Also where the initial shape starts downwards or backwards."""
    points = np.array([[0.0, 0.0, 0.0], first, [2.0, 0.0, -3.0], [6.0, 0.0, 1.0]])
    points += np.array([4.0, 5.0, 6.0])
    initial = shapes.through(ARC, points)
    layout = shapes.layout(ARC, np.zeros(10), shapes.straight(ARC), initial)
    line = Line(dimension, layout, End(True), End(True))
    turn = line.frames.turn(np.zeros((11, line.frames.dofs)))
    assert turn.tangent @ line.basis.T == pytest.approx(initial.tangent, abs=1e-13)
