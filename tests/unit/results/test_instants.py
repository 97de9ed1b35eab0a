"""Records of a run, of many instants at once: each is what it is alone."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.arrays import views
from riser_soil.results.figures import Extremes, pack
from riser_soil.riser.wall_stress import Wall, wall_sections
from tests.support.recorded_run import Catenary, changed, stacked

ARC = np.linspace(0.0, 150.0, 31)
SEEN = [Catenary(a, 60.0 - a).record(ARC) for a in (30.0, 34.0, 31.0)]


def test_views_are_of_the_vector_and_of_each_row() -> None:
    rows = np.arange(36.0).reshape(2, 18)
    shapes = [(2, 3), (4,), (2, 2, 2)]
    for n, row in enumerate(rows):
        for one, many in zip(views(row, shapes), views(rows, shapes), strict=True):
            np.testing.assert_array_equal(many[n], one)
    views(rows, shapes)[2][1, 0, 1, 1] = -1.0
    assert rows[1, 13] == -1.0


@pytest.mark.parametrize("n", range(3))
def test_one_of_many_is_itself(n: int) -> None:
    one = stacked(SEEN).at(n)
    assert list(one) == list(SEEN[n])
    for name, expected in SEEN[n].items():
        np.testing.assert_array_equal(one[name], expected)


def test_figures_of_many_are_those_of_each() -> None:
    rows = pack(stacked(SEEN))
    np.testing.assert_array_equal(rows, [pack(each) for each in SEEN])
    one_by_one, together, times = Extremes(), Extremes(), np.array([0.1, 0.2, 0.3])
    for t, row in zip(times, rows, strict=True):
        one_by_one.update(float(t), row)
    together.update(times, rows)
    assert together.nested() == one_by_one.nested()


def test_walls_of_many_are_those_of_each() -> None:
    """At a joint of two sections now the one governs, now the other."""
    wall = Wall(np.array([0.30, 0.28]), np.array([0.20, 0.25]))
    sections = wall_sections(wall, np.zeros(2), np.ones((2, 2)))
    stress = np.array([[1.0, 2.0, 5.0, 6.0], [1.0, 5.0, 2.0, 6.0]])
    walls = sections.at_nodes(-stress, stress, 3)
    assert walls.tolist() == [sections.at_nodes(-row, row, 3).tolist() for row in stress] == 2 * [[-1.0, -5.0, -6.0]]


def test_what_is_not_known_is_not_there() -> None:
    record = changed(SEEN[0], slip=None, largest_moment=None)
    assert "slip" not in record
    assert record.get("slip") is None
    assert record.extreme("largest_moment") is None
    assert record.extreme("largest_curvature") == (record.largest_curvature, 30.0)
    with pytest.raises(AttributeError, match="slip"):
        _ = record.slip
