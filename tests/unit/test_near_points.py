"""Search for the points of the soil near the pipe: passing over what is clear of it leaves no point out."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.contact.closest_point import Axis
from riser_soil.contact.near_points import Surface, by_facet, fill_near, near_points, points_room

RADIUS, WITHIN, PARTS = 0.15, 0.05, 40


def plane_of_soil(turned: int) -> Surface:
    """Two facets of 2 m side by side, of 40 by 40 points each, in rows across the pipe, turned along it."""
    points = np.array([[x, y, 0.0] for x in (0.0, 2.0, 4.0) for y in (-1.0, 1.0)])
    parts, first = np.full((2, 2), PARTS), np.array([0, PARTS**2])
    return Surface(np.roll([[0, 2, 3, 1], [2, 4, 5, 3]], turned, axis=1), parts, first, points, points)


def axis_of(stretch: float, bend: float) -> Axis:
    """Two elements of 2 m above the soil, over stretch times as much of it, with ends that turn by a slope."""
    half = 2.0 * stretch
    ends = [[0.1, 0.0, 0.17], [0.1 + half, 0.1, 0.16], [0.1 + 2.0 * half, -0.1, 0.18]]
    tangents = [[1.0, 0.0, bend], [1.0, bend, -bend], [1.0, 0.0, 0.5 * bend]]
    q = np.array([[ends[e], tangents[e], ends[e + 1], tangents[e + 1]] for e in range(2)])
    return Axis(q, np.full(2, 2.0), np.full(2, RADIUS))


@pytest.mark.parametrize("turned", [0, 1])
@pytest.mark.parametrize(("stretch", "bend"), [(0.9, 0.0), (0.9, 0.2), (0.5, 1.0), (0.02, 1.0), (50.0, 0.3)])
def test_no_point_within_the_gap_is_passed_over(stretch: float, bend: float, turned: int) -> None:
    """Beside a search so wide that every point is tried on every element."""
    axis, surface = axis_of(stretch, bend), plane_of_soil(turned)
    pairs = np.array([0, 1, 0, 1]), np.array([0, 0, 1, 1])
    found, tried = (near_points(axis, surface, *pairs, within) for within in (WITHIN, 1e3))
    assert len(tried.number) == 2 * PARTS**2
    expected = tried.of(tried.gap < WITHIN)
    assert 20 < len(expected.number) < 2 * PARTS**2
    for name in ("number", "element", "along", "gap"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))


def test_points_beyond_the_room_are_counted_and_given_room(monkeypatch: pytest.MonkeyPatch) -> None:
    axis, surface = axis_of(0.9, 0.2), plane_of_soil(0)
    elements, facets = np.array([0, 1, 0, 1]), np.array([0, 0, 1, 1])
    wanted = near_points(axis, surface, elements, facets, WITHIN)
    few = points_room(3)
    assert fill_near(axis, surface, by_facet(elements, facets, 2), WITHIN, few) == len(wanted.number) > 3
    np.testing.assert_array_equal(few.number, wanted.number[:3])
    monkeypatch.setattr("riser_soil.contact.near_points.FEW", 3)
    for got, told in zip(near_points(axis, surface, elements, facets, WITHIN), wanted, strict=True):
        np.testing.assert_array_equal(got, told)
