"""Search for the points of the soil near the pipe: passing over what is clear of it leaves no point out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from riser_soil.contact.closest_point import Axis
from riser_soil.contact.ground import DeformedSurface
from riser_soil.contact.integration_points import ENOUGH, LARGEST, divisions
from riser_soil.contact.near_points import NearPoints, Surface, by_facet, fill_near, near_points, points_workspace
from riser_soil.contact.surface_contact import SurfaceContact
from riser_soil.core.arrays import Array
from tests.support.driven_stage import built, soil_under
from tests.support.scenes import LAY, touchdown
from tests.support.soil_tops import top

RADIUS, WITHIN, PARTS = 0.15, 0.05, 40


def plane_of_soil(turned: int) -> Surface:
    """Two facets of 2 m side by side, of 40 by 40 points each, in rows across the pipe, turned along it."""
    points = np.array([[x, y, 0.0] for x in (0.0, 2.0, 4.0) for y in (-1.0, 1.0)])
    parts, first = np.array([[PARTS, PARTS, 0, 0, 0]] * 2), np.array([0, PARTS**2])
    return Surface(np.roll([[0, 2, 3, 1], [2, 4, 5, 3]], turned, axis=1), parts, first, points, points)


def bent_soil(turned: int) -> Surface:
    """Triangles side by side, all as finely cut, whose sides have come to be curved."""
    flat = top("tri6", 2, 1, size=2.0)
    points, facets = flat.points, flat.facets[:, [*np.roll([0, 1, 2], turned), *np.roll([3, 4, 5], turned)]]
    parts = divisions(points, facets, np.array([1.0, 0.0]), (0.05, 0.05))
    first = np.append(0, np.cumsum(parts[:, :2].prod(axis=1)))[:-1]
    return Surface(facets, parts, first, points, points + 0.05 * np.random.default_rng(3).normal(size=points.shape))


def smooth_soil(turned: int) -> Surface:
    """Smooth facets across the pipe, whose rows have come to be curved."""
    flat = top("quad4", 4, 2, size=1.0)
    plain = DeformedSurface(flat)
    plain.smooth(np.array([1.0, 0.0] if turned else [0.0, 1.0]))
    parts = divisions(flat.points, plain.facets, np.array([1.0, 0.0]), (0.05, 0.05))
    first = np.append(0, np.cumsum(parts[:, :2].prod(axis=1)))[:-1]
    moved = flat.points + 0.05 * np.random.default_rng(3).normal(size=flat.points.shape)
    return Surface(plain.facets, parts, first, flat.points, moved)


def axis_of(stretch: float, bend: float) -> Axis:
    """Two elements of 2 m above the soil, over stretch times as much of it, with ends that turn by a slope."""
    half = 2.0 * stretch
    ends = [[0.1, 0.0, 0.17], [0.1 + half, 0.1, 0.16], [0.1 + 2.0 * half, -0.1, 0.18]]
    tangents = [[1.0, 0.0, bend], [1.0, bend, -bend], [1.0, 0.0, 0.5 * bend]]
    q = np.array([[ends[e], tangents[e], ends[e + 1], tangents[e + 1]] for e in range(2)])
    return Axis(q, np.full(2, 2.0), np.full(2, RADIUS))


@pytest.mark.parametrize("turned", [0, 1])
@pytest.mark.parametrize("soil", [plane_of_soil, bent_soil, smooth_soil])
@pytest.mark.parametrize(("stretch", "bend"), [(0.9, 0.0), (0.9, 0.2), (0.5, 1.0), (0.02, 1.0), (50.0, 0.3)])
def test_no_point_within_the_gap_is_passed_over(
    stretch: float, bend: float, soil: Callable[[int], Surface], turned: int
) -> None:
    """The search is compared with one so wide that every point is tried on every element."""
    axis, surface = axis_of(stretch, bend), soil(turned)
    facets = np.repeat(np.arange(len(surface.facets)), 2)
    pairs = np.tile([0, 1], len(surface.facets)), facets
    lists, tried = (near_points(axis, surface, *pairs, within) for within in (WITHIN, 1e3))
    assert len(tried.number) == surface.parts[:, :2].prod(axis=1).sum()
    near = tried.gap < WITHIN
    assert 5 < near.sum() < len(near)
    for name in ("number", "element", "along", "gap"):
        np.testing.assert_array_equal(getattr(lists, name), getattr(tried, name)[near])


def test_points_beyond_the_workspace_are_counted_and_given_workspace(monkeypatch: pytest.MonkeyPatch) -> None:
    axis, surface = axis_of(0.9, 0.2), plane_of_soil(0)
    elements, facets = np.array([0, 1, 0, 1]), np.array([0, 0, 1, 1])
    wanted = near_points(axis, surface, elements, facets, WITHIN)
    few = points_workspace(3)
    assert fill_near(axis, surface, by_facet(elements, facets, 2), WITHIN, few) == len(wanted.number) > 3
    np.testing.assert_array_equal(few.number, wanted.number[:3])
    monkeypatch.setattr("riser_soil.contact.near_points.FEW", 3)
    for got, expected in zip(near_points(axis, surface, elements, facets, WITHIN), wanted, strict=True):
        np.testing.assert_array_equal(got, expected)


@pytest.mark.parametrize("along", [(1.0, 0.0), (0.0, 1.0), (0.6, 0.8), (-0.8, 0.6)])
@pytest.mark.parametrize("corners", [[0, 1, 2], [1, 2, 0], [2, 1, 0]])
def test_points_of_a_triangle_sum_its_area_and_its_moments(along: tuple[float, float], corners: list[int]) -> None:
    """Sums are right to second order in the points' spacing; none lies farther across the riser from the next than
    asked for.
    """
    at = np.array([[0.0, 0.0, 0.1], [0.9, 0.2, 0.0], [0.3, 0.7, 0.4]])[corners]
    points = np.concatenate([at, 0.5 * (at + np.roll(at, -1, axis=0))])
    moment, moments = np.mean([np.outer(x, x) for x in points[3:]], axis=0), []
    for spacing in (0.05, 0.025):
        near = all_points(points, along, spacing)
        area = 0.5 * float(np.linalg.norm(np.cross(at[1] - at[0], at[2] - at[0])))
        assert near.area.sum() == pytest.approx(area, rel=1e-12)
        xi, eta = near.xi.T
        x = at[0] + xi[:, None] * (at[1] - at[0]) + eta[:, None] * (at[2] - at[0])
        assert (np.minimum(np.minimum(xi, eta), 1.0 - xi - eta) > 0.0).all()
        assert len(np.unique(near.number)) == len(near.number)
        moments.append(np.abs(np.einsum("n,ni,nj->ij", near.area, x, x) / area - moment).max())
    assert moments[0] < 5e-3
    assert moments[1] < 0.3 * moments[0]


def all_points(points: Array, along: tuple[float, float], spacing: float) -> NearPoints:
    """All points of the only facet, seen from a pipe that is near to all of them."""
    facets = np.array([[0, 1, 2, 3, 4, 5]])
    parts = divisions(points, facets, np.array(along), (spacing, spacing))
    surface = Surface(facets, parts, np.array([0]), points, points)
    return near_points(axis_of(1.0, 0.0), surface, np.array([0]), np.array([0]), 1e3)


def test_cells_far_larger_than_what_touches_have_no_more_points_along_than_they_need() -> None:
    """A triangle of 1 m is as fine across the riser as 1 mm, 12 points along it."""
    points = top("tri6", 1, 1, size=1.0)
    parts = divisions(points.points, points.facets, np.array([1.0, 0.0]), (4e-3, 1e-3), element=1.0)
    np.testing.assert_array_equal(parts[:, :2], [[LARGEST, ENOUGH]] * 2)


def test_a_riser_on_stiff_clay_of_tetrahedra_has_no_more_points_along_than_it_needs() -> None:
    """The riser touches by millimetres on cells of half a metre: as many points along as across would be millions."""
    contact = soil_under(built(touchdown(LAY, kind="tet", su=1.0e6))).contact
    assert isinstance(contact, SurfaceContact)
    across, along = contact._parts[:, 0], contact._parts[:, 1]
    assert across.max() > 300
    assert along.max() < 2 * ENOUGH
