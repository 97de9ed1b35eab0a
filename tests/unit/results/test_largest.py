"""The reduction of a stage to its largest values, with their times and places."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.results.largest import Largest, largest_along

NAN = np.nan
TIMES = np.array([0.5, 1.0, 1.5, 2.0])
ARC = np.array([0.0, 10.0, 30.0])
ALONG = np.array([[1.0, 4.0, 4.0], [NAN, 3.0, 5.0], [5.0, NAN, 2.0], [NAN, NAN, NAN]])


def followed(values: Array, *batches: slice, floor: float = -np.inf) -> list[float]:
    """Value, time and arc length of the largest of rows along a riser, in these batches, each after a restart."""
    saved = Largest(beside=1, floor=floor).state()
    for batch in batches:
        largest = Largest(beside=1, floor=floor)
        largest.restore(saved)
        largest.update(TIMES[batch], *largest_along(values[batch], ARC))
        saved = largest.state()
    return largest.of()


ALONE = tuple(slice(n, n + 1) for n in range(4))


@pytest.mark.parametrize("batches", [(slice(None),), (slice(1), slice(1, None)), ALONE])
def test_the_first_of_the_largest_values_is_kept_with_its_time_and_place(batches: tuple[slice, ...]) -> None:
    """However instants come in batches; nan does not count."""
    assert followed(ALONG, *batches) == [5.0, 1.0, 30.0]


def test_of_equal_values_along_the_riser_the_first_counts() -> None:
    values, arcs, others = largest_along(ALONG[:2], ARC, 2.0 * ALONG[:2])
    assert values.tolist() == [[4.0], [5.0]]
    assert arcs.tolist() == [[10.0], [30.0]]
    assert others.tolist() == [[8.0], [10.0]]


def test_what_is_not_above_the_floor_does_not_count() -> None:
    assert followed(ALONG, slice(None), floor=4.9) == [5.0, 1.0, 30.0]
    value, *place = followed(ALONG, slice(None), floor=5.0)
    assert value == 5.0
    assert np.isnan(place).all()


@pytest.mark.parametrize(("share", "time"), [(0.9e-6, 0.5), (1.1e-6, 1.0)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_another_counts_when_it_exceeds_the_largest_by_more_than_the_tolerance(
    share: float, time: float, sign: float
) -> None:
    values = np.array([[sign * 1.0e4], [sign * 1.0e4 * (1.0 + sign * share)]])
    largest = Largest(tolerance=1e-6)
    for n in range(2):
        largest.update(TIMES[n : n + 1], values[n : n + 1])
    assert largest.of() == [values[int(time > 0.5), 0], time]
