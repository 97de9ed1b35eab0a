"""Places of a grid without end that have been asked for, each with a number: a table of keys, for compiled code."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit

_SPREAD = 0x1E3779B97F4A7C15  # a large odd number, by which neighbouring keys are scattered over the table


class Places(NamedTuple):
    """Room for n places. key: (n,). time: (n,) a time for which something is known there [s]; nan where the place is
    new. taken: (1,) how many there are. table: (a power of two, at least 2 n) their numbers where their keys lead to,
    or -1.
    """

    key: IntArray
    time: Array
    taken: IntArray
    table: IntArray


def places(n: int) -> Places:
    """Room for n places, none taken."""
    size = 1 << (2 * n - 1).bit_length()
    return Places(np.empty(n, np.int64), np.empty(n), np.zeros(1, np.int64), np.full(size, -1))


@njit
def number(at: Places, key: int) -> int:
    """Number of the place of this key. Where there is no room for a new one, all others are forgotten."""
    mask = at.table.size - 1
    slot = ((key * _SPREAD) >> 24) & mask
    while at.table[slot] >= 0:
        if at.key[at.table[slot]] == key:
            return at.table[slot]
        slot = (slot + 1) & mask
    if at.taken[0] == at.key.size:
        at.taken[0] = 0
        at.table[:] = -1
    new = at.taken[0]
    at.taken[0], at.table[slot], at.key[new], at.time[new] = new + 1, new, key, np.nan
    return new
