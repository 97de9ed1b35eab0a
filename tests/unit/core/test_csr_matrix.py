"""Patterns of sparse matrices: entries of blocks, numbered in order."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.csr_matrix import number_entries, union, write_places


@pytest.mark.parametrize(("a", "b"), [([], []), ([3], []), ([], [3]), ([1, 4, 7], [0, 4, 9]), ([2, 5], [2, 5])])
def test_numbers_of_two_arrays(a: list[int], b: list[int]) -> None:
    both = union(np.array(a, dtype=np.int64), np.array(b, dtype=np.int64))
    assert both.dtype == np.int64
    assert both.tolist() == sorted({*a, *b})


def test_entries_of_blocks_are_numbered_in_order() -> None:
    """By sets and sorting; rows and columns of any order, some absent, some minus what the system has."""
    chance, n = np.random.default_rng(4), 9
    rows, cols = (chance.integers(-1, n, size=(6, size)).astype(np.int32) for size in (3, 4))
    minus = chance.random((6, 3)) < 0.3, chance.random((6, 4)) < 0.3
    numbers = np.empty((6, 3, 4), dtype=np.int32)
    keys = number_entries(rows, cols, minus, n, numbers)
    there = (rows[:, :, None] >= 0) & (cols[:, None, :] >= 0)
    entries = rows[:, :, None].astype(np.int64) * n + cols[:, None, :]
    assert keys.tolist() == sorted(set(entries[there].tolist()))
    assert (numbers[~there] == len(keys)).all()
    opposite = minus[0][:, :, None] != minus[1][:, None, :]
    assert (opposite & there).any()
    found = np.where(opposite, -1 - numbers, numbers)
    np.testing.assert_array_equal(keys[found[there]], entries[there])
    more, places = union(keys, np.array([0, 40, n * n + 5])), np.empty(numbers.size, dtype=np.int32)
    write_places(more, keys, numbers.ravel(), places)
    at = np.where(opposite, -1 - places.reshape(numbers.shape), places.reshape(numbers.shape))
    np.testing.assert_array_equal(more[at[there]], entries[there])
    assert (places.reshape(numbers.shape)[~there] == len(more)).all()


def test_no_blocks_have_no_entries() -> None:
    none = np.zeros((0, 3), dtype=np.int32), np.zeros((0, 2), dtype=np.int32)
    minus = np.zeros((0, 3), dtype=bool), np.zeros((0, 2), dtype=bool)
    assert number_entries(*none, minus, 4, np.empty((0, 3, 2), dtype=np.int32)).size == 0
