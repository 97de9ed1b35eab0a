"""Least distance of two lines: closed forms, and all pairs of fine points."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.results.bodies_and_joints import between_segments, clearance

O, X, Y, Z = np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize(
    ("ends", "expected"),
    [
        ((-X, X, Z - Y, Z + Y), (1.0, 0.5, 0.5)),  # crossing
        ((O, X, 2.0 * X + Y, 3.0 * X + Y), (np.sqrt(2.0), 1.0, 0.0)),  # end to end
        ((O, 2.0 * X, Y, X + Y), (1.0, 0.0, 0.0)),  # parallel
        ((O, 4.0 * X, 3.0 * X + Y, 3.0 * X + 2.0 * Y), (1.0, 0.75, 0.0)),  # an end beside the other's middle
    ],
)
def test_segments(ends: tuple[np.ndarray, ...], expected: tuple[float, float, float]) -> None:
    assert between_segments(*ends) == pytest.approx(expected)


def test_random_segments_against_fine_points() -> None:
    rng = np.random.default_rng(4)
    along = np.linspace(0.0, 1.0, 401)[:, None]
    for _ in range(40):
        a, b, c, d = rng.normal(size=(4, 3))
        first, second = a + along * (b - a), c + along * (d - c)
        fine = np.linalg.norm(first[:, None] - second[None], axis=2).min()
        distance, s, t = between_segments(a, b, c, d)
        assert distance <= fine + 1e-12
        assert distance == pytest.approx(fine, abs=2e-2)
        assert np.linalg.norm(a + s * (b - a) - c - t * (d - c)) == pytest.approx(distance)


def test_surfaces_and_what_counts() -> None:
    """Two lines that cross 1 m apart, of radii 0.1 and 0.2 m; without the crossing elements the next are nearest."""
    x = np.linspace(-2.0, 2.0, 5)[:, None] * X
    other = np.linspace(-2.0, 2.0, 5)[:, None] * Y + Z + 0.5 * X + 0.5 * Y
    radii, all_of = (np.full(4, 0.1), np.full(4, 0.2)), np.ones(4, dtype=bool)
    distance, e, s, f, t = clearance(x, radii[0], all_of, other, radii[1], all_of)
    assert (distance, e, s) == pytest.approx((0.7, 2, 0.5))
    assert (f, t) == pytest.approx((1, 0.5))
    far = all_of.copy()
    far[2] = False
    assert clearance(x, radii[0], far, other, radii[1], all_of)[0] == pytest.approx(np.hypot(1.0, 0.5) - 0.3)
