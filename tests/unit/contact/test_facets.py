"""Shape functions, the map's inverse, pairing, and the gap's derivatives on deformed facets."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from riser_soil.contact.facets import gap_forms, heights, inside, penalty_hessian, second_derivatives, shape
from riser_soil.contact.pairing import FacetSearch, facet_below, invert
from riser_soil.core.arrays import Array, IntArray

CORNERS = {
    4: np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], dtype=float),
    6: np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]]),
}
PLACES = {4: [(-0.3, 0.7), (0.9, -0.95)], 6: [(0.2, 0.3), (0.05, 0.9)]}
KINDS = pytest.mark.parametrize("nv", [4, 6])


def deformed_facet(nv: int) -> Array:
    """One facet, distorted, warped and (six nodes) curved in all directions."""
    rng = np.random.default_rng(3)
    flat = np.column_stack([CORNERS[nv] @ [[0.5, 0.1], [-0.05, 0.4]], 0.1 * CORNERS[nv].prod(axis=1)])
    return np.asarray(flat + 0.04 * rng.standard_normal((nv, 3)))


@KINDS
def test_functions_interpolate(nv: int) -> None:
    values = np.array([shape(nv, x, y)[0] for x, y in CORNERS[nv]])
    np.testing.assert_allclose(values, np.eye(nv), atol=1e-15)


@KINDS
@pytest.mark.parametrize("which", [0, 1])
def test_functions_sum_to_one_and_their_derivatives_agree(nv: int, which: int) -> None:
    x, h = np.array(PLACES[nv][which]), 1e-5
    (N, dN), ddN = shape(nv, *x), second_derivatives(nv)
    assert N.sum() == pytest.approx(1.0, abs=1e-15)
    assert abs(dN.sum(axis=0)).max() < 1e-14
    for a, step in enumerate(h * np.eye(2)):
        up, down = shape(nv, *(x + step)), shape(nv, *(x - step))
        np.testing.assert_allclose(dN[:, a], (up[0] - down[0]) / (2 * h), atol=1e-10)
        np.testing.assert_allclose(ddN[:, :, a], (up[1] - down[1]) / (2 * h), atol=1e-10)


@pytest.mark.parametrize(
    ("nv", "function"),
    [
        (4, lambda x, y: 1 + 2 * x - y + 3 * x * y),
        (6, lambda x, y: 1 + x - y + x * x - 2 * x * y + 4 * y * y),
    ],
)
def test_facets_hold_their_polynomials(nv: int, function: Callable[[Any, Any], Any]) -> None:
    at_nodes = function(*CORNERS[nv].T)
    for x, y in PLACES[nv]:
        assert shape(nv, x, y)[0] @ at_nodes == pytest.approx(function(x, y), abs=1e-14)


@KINDS
def test_map_is_inverted(nv: int) -> None:
    points, nodes = deformed_facet(nv), np.arange(nv)
    for place in PLACES[nv]:
        xy = shape(nv, *place)[0] @ points[:, :2]
        converged, *local = invert(xy, points, nodes, np.empty((nv, 3)))
        assert converged
        np.testing.assert_allclose(local, place, atol=1e-13)


def test_degenerate_facet_is_not_inverted() -> None:
    assert not invert(np.array([0.5, 0.5]), np.zeros((4, 3)), np.arange(4), np.empty((4, 3)))[0]


@KINDS
def test_inside(nv: int) -> None:
    assert all(inside(nv, x, y, 1e-9) for x, y in (*PLACES[nv], *CORNERS[nv]))
    assert not any(inside(nv, x, y, 1e-9) for x, y in [(1.1, 0.0), (0.0, 1.1), (-1.1, 0.0), (0.0, -1.1)])


def grid(nv: int, nx: int = 5, ny: int = 4) -> tuple[Array, IntArray]:
    """Surface over [0, nx/2] × [0, ny/2] of quad4, or of two tri6 to the square; z = 0."""
    n = 1 if nv == 4 else 2
    x, y = np.meshgrid(np.linspace(0, nx / 2, n * nx + 1), np.linspace(0, ny / 2, n * ny + 1), indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    number = np.arange(x.size).reshape(x.shape)
    cells = [number[n * i : n * i + n + 1, n * j : n * j + n + 1] for i in range(nx) for j in range(ny)]
    if nv == 4:
        return points, np.array([[c[0, 0], c[1, 0], c[1, 1], c[0, 1]] for c in cells])
    lower = [[c[0, 0], c[2, 0], c[2, 2], c[1, 0], c[2, 1], c[1, 1]] for c in cells]
    upper = [[c[0, 0], c[2, 2], c[0, 2], c[1, 1], c[1, 2], c[0, 1]] for c in cells]
    return points, np.array(lower + upper)


@KINDS
def test_every_point_of_a_deformed_surface_finds_its_facet(nv: int) -> None:
    points, facets = grid(nv)
    rng = np.random.default_rng(0)
    deformed = points + 0.02 * rng.standard_normal(points.shape)
    place = np.array([0.2, 0.3]) if nv == 6 else np.array([-0.4, 0.8])
    xy = shape(nv, *place)[0] @ deformed[facets]
    facet, xi = FacetSearch(points, facets).locate(xy[:, :2], deformed)
    np.testing.assert_array_equal(facet, np.arange(len(facets)))
    np.testing.assert_allclose(xi, np.tile(place, (len(facets), 1)), atol=1e-12)
    np.testing.assert_allclose(heights(facet, xi, facets, deformed), xy[:, 2], atol=1e-14)


@KINDS
def test_point_on_a_side_belongs_to_the_lowest_facet(nv: int) -> None:
    points, facets = grid(nv)
    shared, step = np.array([[0.5, 0.25], [1.0, 1.0], [1.5, 0.6]]), 1e-13
    for xy in (shared, shared + step, shared - step):
        facet, _ = FacetSearch(points, facets).locate(xy, points)
        around = [np.array([0, 4]), np.array([5, 6, 9, 10]), np.array([9, 13])]
        if nv == 4:
            np.testing.assert_array_equal(facet, [cells.min() for cells in around])
        again, _ = FacetSearch(points, facets[::-1]).locate(xy, points)
        assert (facet <= len(facets) - 1 - again).all()


@KINDS
def test_no_facet_outside_the_surface(nv: int) -> None:
    points, facets = grid(nv)
    xy = np.array([[-1e-3, 0.3], [2.501, 0.3], [1.0, 2.001], [40.0, 0.0]])
    facet, _ = FacetSearch(points, facets).locate(xy, points)
    np.testing.assert_array_equal(facet, -1)
    np.testing.assert_array_equal(heights(facet, np.zeros((4, 2)), facets, points), -np.inf)


@KINDS
def test_the_facet_is_found_where_the_surface_has_moved_far_sideways(nv: int) -> None:
    """The surface has moved by more than a facet, which the plan of the reference geometry does not show; beyond its
    end, too.
    """
    points, facets = grid(nv)
    place = np.array([0.2, 0.3])
    for moved in ([0.9, 0.0, 0.0], [-0.4, -0.7, 0.0], [5.0, 0.0, 0.0]):
        deformed = points + moved
        xy = shape(nv, *place)[0] @ deformed[facets]
        facet, _ = FacetSearch(points, facets).locate(xy[:, :2], deformed)
        np.testing.assert_array_equal(facet, np.arange(len(facets)))


@KINDS
def test_compiled_code_knows_the_same_places_to_be_covered(nv: int) -> None:
    """Whatever facet is said to have held a place last, and where the surface has moved since the cover was made."""
    points, facets = grid(nv)
    search, random = FacetSearch(points, facets), np.random.default_rng(5)
    cover = search.cover(points)
    corners = points[facets[:, 0], :2]  # on sides of facets, and on the surface's rim
    xy = np.vstack([random.uniform([-0.5, -0.5], [3.0, 2.5], size=(200, 2)), corners])
    for deformed in (points, points + 0.02 * random.standard_normal(points.shape)):
        cover.renew(deformed)
        places, _ = search.locate(xy, deformed)
        assert 0 < np.count_nonzero(places < 0) < len(xy)
        for place, wanted in zip(xy, places, strict=True):
            assert facet_below(cover, *place, -1) == wanted
            for previous in (0, wanted, len(facets) - 1):
                assert (facet_below(cover, *place, previous) >= 0) == (wanted >= 0)


def test_a_long_facet_beside_many_small_ones_is_found() -> None:
    x = np.append(np.linspace(0.0, 0.2, 21), 10.0)
    points = np.array([[a, b, 0.0] for a in x for b in (0.0, 1.0)])
    facets = np.array([[2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1] for i in range(21)])
    facet, _ = FacetSearch(points, facets).locate(np.array([[0.25, 0.5], [9.9, 0.1], [0.195, 0.2]]), points)
    assert facet.tolist() == [20, 20, 19]


def gap(q: Array, nv: int) -> float:
    """Gap of one point over one facet; q holds the point, then the facet's nodes."""
    at = np.ascontiguousarray(q.reshape(-1, 3))
    _, x, y = invert(at[0, :2], at[1:], np.arange(nv), np.empty((nv, 3)))
    return float(at[0, 2] - shape(nv, x, y)[0] @ at[1:, 2])


def configuration(nv: int) -> tuple[Array, Array, Array, IntArray]:
    """q, (ξ, η) (1, 2), points and facets of a point over a deformed facet."""
    points, place = deformed_facet(nv), np.array([PLACES[nv][0]])
    above = shape(nv, *place[0])[0] @ points + [0.0, 0.0, 0.01]
    return np.concatenate([above, points.ravel()]), place, points, np.arange(nv)[None]


@KINDS
def test_gap_forms_are_derivatives(nv: int) -> None:
    q, place, points, facets = configuration(nv)
    forms, H = gap_forms(np.array([0]), place, facets, points)
    h, steps = 1e-4, np.eye(len(q))
    gradient = [
        (8 * (gap(q + h * e, nv) - gap(q - h * e, nv)) - gap(q + 2 * h * e, nv) + gap(q - 2 * h * e, nv))
        / (12 * h)
        for e in steps
    ]
    np.testing.assert_allclose(forms[0, 0], gradient, atol=1e-10)
    np.testing.assert_allclose(forms[0, 0].reshape(-1, 3).sum(axis=0), 0.0, atol=1e-15)
    second = np.array([[_mixed(q, a, b, nv) for a in 1e-3 * steps] for b in 1e-3 * steps]) / 1e-6
    exact = -penalty_hessian(forms, H, np.ones(1), np.zeros(1))[0]
    np.testing.assert_allclose(exact, second, atol=1e-4 * abs(second).max())
    without_curvature = -penalty_hessian(forms, 0.0 * H, np.ones(1), np.zeros(1))[0]
    assert abs(without_curvature - second).max() > 1e-2 * abs(second).max()


def _mixed(q: Array, a: Array, b: Array, nv: int) -> float:
    return (gap(q + a + b, nv) - gap(q + a - b, nv) - gap(q - a + b, nv) + gap(q - a - b, nv)) / 4
