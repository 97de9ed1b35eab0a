"""Largest bending between nodes: of cubics, parabolas and corners that are known."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.riser.bending_peaks import largest_between_nodes, top_of_cubic
from riser_soil.riser.components import cross
from riser_soil.riser.section_forces import moment_slopes


def largest(arc: Array, values: Array, slope: Array) -> Any:
    """Largest value, its arc length and element, of one state."""
    value, at, element = largest_between_nodes(arc, values, slope)
    return float(value), float(at), int(element)


def top(first: float, second: float, rise: float, fall: float) -> Any:
    """Largest value and its place of the cubic in one element, as of a line that is one."""
    value, at, _ = largest(np.arange(2.0), np.array([[first, second]]), np.array([[rise, fall]]))
    return value, at


@pytest.mark.parametrize("place", [0.0, 0.2, 0.5, 1.0])
def test_top_of_a_parabola(place: float) -> None:
    ends = 5.0 - 3.0 * place**2, 5.0 - 3.0 * (1.0 - place) ** 2
    assert top(*ends, 6.0 * place, -6.0 * (1.0 - place)) == (pytest.approx(5.0), pytest.approx(place))


def test_top_of_a_cubic() -> None:
    """x (1 - x) (2 - x): at 1 - 1/sqrt(3), 2/(3 sqrt(3)) high."""
    top = np.array(top_of_cubic(*np.array([0.0, 0.0, 2.0, -1.0])))
    assert top == pytest.approx([2.0 / 27.0**0.5, 1.0 - 1.0 / math.sqrt(3.0)])


@pytest.mark.parametrize(("rise", "fall"), [(3.0, 3.0), (-3.0, 3.0), (-3.0, -3.0), (0.0, -1.0), (1.0, 0.0)])
def test_without_a_rise_and_a_fall_the_larger_end_counts(rise: float, fall: float) -> None:
    assert top(1.0, 2.0, rise, fall) == (2.0, 1.0)
    assert top(2.0, 1.0, rise, fall) == (2.0, 0.0)


def test_of_equal_values_the_first_counts_whatever_rounds() -> None:
    arc, values = np.arange(4.0), np.full((3, 2), 7.0)
    values[1:] += 7e-15
    assert largest(arc, values, np.zeros((3, 2))) == (7.0, 0.0, 0)


def test_a_cubic_does_not_tower_over_values_that_hardly_bend() -> None:
    """Second differences of 0.2 allow for twice 0.2/8 above the larger end; an element alone for all that it has."""
    values = np.array([[9.8, 10.0], [10.0, 10.0], [10.0, 9.8]])
    slope = np.array([[0.2, 0.2], [80.0, -80.0], [-0.2, -0.2]])
    assert largest(np.arange(4.0), values, slope) == (pytest.approx(10.05), pytest.approx(1.5), 1)
    alone = largest(np.arange(2.0), values[1:2], slope[1:2])
    assert alone == (pytest.approx(30.0), pytest.approx(0.5), 0)


def test_a_corner_is_not_overshot() -> None:
    """Steep up to a node, gently down from it."""
    arc, values = np.array([0.0, 1.0, 3.0, 4.0]), np.array([[0.0, 10.0], [10.0, 9.0], [9.0, 8.5]])
    slope = np.array([[10.0, 10.0], [-0.5, -0.5], [-0.5, -0.5]])
    assert largest(arc, values, slope) == (10.0, 1.0, 0)


def test_where_the_curvature_jumps_the_larger_side_counts() -> None:
    arc, values = np.array([0.0, 1.0, 2.0]), np.array([[4.0, 2.0], [8.0, 0.0]])
    assert largest(arc, values, np.full((2, 2), -5.0)) == (8.0, 1.0, 1)


def test_of_many_states_each_is_as_it_is_alone() -> None:
    """Whatever the number of states: cubics, corners and ties at once."""
    rng = np.random.default_rng(3)
    arc, values, slope = np.arange(6.0), rng.uniform(0.0, 9.0, (40, 5, 2)), rng.normal(size=(40, 5, 2))
    values[::4] = 7.0
    together = largest_between_nodes(arc, values, slope)
    for n in range(40):
        assert largest(arc, values[n], slope[n]) == tuple(each[n] for each in together)
    assert len(set(together[2].tolist())) == 5


def slopes(moment: Array, force: Array) -> Array:
    """(2,), of moments (2, 3) at both ends of an element along x with a force."""
    tangent = np.array([1.0, 0.0, 0.0])
    shear = np.tile(cross(force, tangent)[:, None, None], (1, 2, 1))
    return moment_slopes(np.ascontiguousarray(moment.T), shear)[:, 0]


def test_slopes_follow_from_the_shear_across_the_moment() -> None:
    """A cantilever along x held at 0 and pushed by F at its end s = 2: M = (2 - s) e x F, |M|' = -|F across e|."""
    force, sheared = np.array([3.0, -4.0, 12.0]), math.hypot(4.0, 12.0)
    moment = np.array([(2.0 - s) * np.cross([1.0, 0.0, 0.0], force) for s in (0.0, 1.0)])
    assert slopes(moment, force) == pytest.approx(-sheared)
    round_off = np.array([1e-13, -1e-13, 2e-13])
    hinged = np.array([round_off, moment[0]])  # at the start, and then at the end
    assert slopes(hinged, -force) == pytest.approx(sheared)
    assert slopes(hinged[::-1], force) == pytest.approx(-sheared)
    assert not slopes(0.0 * moment, force).any()


@pytest.mark.parametrize("slope", [1e-6, 1e-20, 1e-200])
def test_a_cubic_that_hardly_rises_and_falls_is_largest_at_its_higher_end(slope: float) -> None:
    """The larger end is found by the values, 0 and 1, or 1 and 0, and such slopes; without a division by what cancels.
    """
    for values, end in (((0.0, 1.0), 1.0), ((1.0, 0.0), 0.0)):
        top, place = top_of_cubic(*np.array([[values[0]], [values[1]], [slope], [-slope]]))
        assert top == pytest.approx(1.0)
        assert place == pytest.approx(end, abs=slope)
