"""Largest bending between nodes: of cubics, parabolas and corners that are known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from riser_soil.riser.section_kernels import largest_between_nodes, moment_slopes, top_of_cubic


@pytest.mark.parametrize("top", [0.0, 0.2, 0.5, 1.0])
def test_top_of_a_parabola(top: float) -> None:
    value, at = top_of_cubic(5.0 - 3.0 * top**2, 5.0 - 3.0 * (1.0 - top) ** 2, 6.0 * top, -6.0 * (1.0 - top))
    assert (value, at) == (pytest.approx(5.0), pytest.approx(top))


def test_top_of_a_cubic() -> None:
    """x (1 - x) (2 - x): at 1 - 1/sqrt(3), 2/(3 sqrt(3)) high."""
    value, at = top_of_cubic(0.0, 0.0, 2.0, -1.0)
    assert (value, at) == (pytest.approx(2.0 / 27.0**0.5), pytest.approx(1.0 - 1.0 / math.sqrt(3.0)))


@pytest.mark.parametrize(("rise", "fall"), [(3.0, 3.0), (-3.0, 3.0), (-3.0, -3.0), (0.0, -1.0), (1.0, 0.0)])
def test_without_a_rise_and_a_fall_the_larger_end_counts(rise: float, fall: float) -> None:
    assert top_of_cubic(1.0, 2.0, rise, fall) == (2.0, 1.0)
    assert top_of_cubic(2.0, 1.0, rise, fall) == (2.0, 0.0)


def test_of_equal_values_the_first_counts_whatever_rounds() -> None:
    arc, values = np.arange(4.0), np.full((3, 2), 7.0)
    values[1:] += 7e-15
    assert largest_between_nodes(arc, values, np.zeros((3, 2))) == (7.0, 0.0, 0)


def test_a_cubic_does_not_tower_over_values_that_hardly_bend() -> None:
    """Second differences of 0.2 allow for twice 0.2/8 above the larger end; an element alone for all that it has."""
    values = np.array([[9.8, 10.0], [10.0, 10.0], [10.0, 9.8]])
    slope = np.array([[0.2, 0.2], [80.0, -80.0], [-0.2, -0.2]])
    assert largest_between_nodes(np.arange(4.0), values, slope) == (pytest.approx(10.05), pytest.approx(1.5), 1)
    alone = largest_between_nodes(np.arange(2.0), values[1:2], slope[1:2])
    assert alone == (pytest.approx(30.0), pytest.approx(0.5), 0)


def test_a_corner_is_not_overshot() -> None:
    """Steep up to a node, gently down from it."""
    arc, values = np.array([0.0, 1.0, 3.0, 4.0]), np.array([[0.0, 10.0], [10.0, 9.0], [9.0, 8.5]])
    slope = np.array([[10.0, 10.0], [-0.5, -0.5], [-0.5, -0.5]])
    assert largest_between_nodes(arc, values, slope) == (10.0, 1.0, 0)


def test_where_the_curvature_jumps_the_larger_side_counts() -> None:
    arc, values = np.array([0.0, 1.0, 2.0]), np.array([[4.0, 2.0], [8.0, 0.0]])
    assert largest_between_nodes(arc, values, np.full((2, 2), -5.0)) == (8.0, 1.0, 1)


def test_slopes_follow_from_the_shear_across_the_moment() -> None:
    """A cantilever along x held at 0 and pushed by F at its end s = 2: M = (2 - s) e x F, |M|' = -|F across e|."""
    force, tangent = np.array([3.0, -4.0, 12.0]), np.array([1.0, 0.0, 0.0])
    moment = np.array([(2.0 - s) * np.cross(tangent, force) for s in (0.0, 1.0)])
    out = np.empty((1, 2))
    moment_slopes(moment, np.tile(force, (1, 2, 1)), np.tile(tangent, (1, 2, 1)), out)
    assert out == pytest.approx(-math.hypot(4.0, 12.0))
    round_off = np.array([1e-13, -1e-13, 2e-13])
    hinged = np.array([round_off, moment[0]])  # at the start, and then at the end
    moment_slopes(hinged, np.tile(-force, (1, 2, 1)), np.tile(tangent, (1, 2, 1)), out)
    assert out == pytest.approx(math.hypot(4.0, 12.0))
    moment_slopes(hinged[::-1], np.tile(force, (1, 2, 1)), np.tile(tangent, (1, 2, 1)), out)
    assert out == pytest.approx(-math.hypot(4.0, 12.0))
    moment_slopes(0.0 * moment, np.tile(force, (1, 2, 1)), np.tile(tangent, (1, 2, 1)), out)
    assert not out.any()
