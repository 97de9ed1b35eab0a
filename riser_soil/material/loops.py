"""Closed cycles of a stress–strain curve: secant modulus and damping ratio by strain amplitude."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray

CLOSED = 1e-9  # how far a cycle may end from its beginning, over its width


class ClosedCycle(NamedTuple):
    """Rows from first to last; strain amplitude and mean strain [-]; secant modulus [Pa]: stress over strain, from turn
    to turn; damping ratio [-]: area of the loop over 4π times the elastic energy ½ stress amplitude × strain amplitude.
    """

    first: int
    last: int
    amplitude: float
    mean: float
    secant_modulus: float
    damping_ratio: float


def turns(x: Array) -> IntArray:
    """Rows where x (n,) turns back, the first and last row among them; of rows that stand still the last."""
    moves = np.flatnonzero(np.diff(x))
    sense = np.sign(np.diff(x)[moves])
    back = moves[1:][sense[1:] != sense[:-1]]
    return np.unique([0, *back, len(x) - 1]).astype(np.int64)


def closed_cycles(driven: Array, strain: Array, stress: Array) -> list[ClosedCycle]:
    """Cycles between a turn and the next but one that is at the same `driven` value (n,), strain or stress; strain (n,)
    and stress (n,) [Pa] make the loop.
    """
    at = turns(driven)
    out = []
    for a, b, c in zip(at, at[1:], at[2:], strict=False):
        if abs(driven[c] - driven[a]) <= CLOSED * abs(driven[b] - driven[a]):
            out.append(_cycle(a, b, c, strain, stress))
    return out


def _cycle(a: int, b: int, c: int, strain: Array, stress: Array) -> ClosedCycle:
    gamma, tau = strain[a : c + 1], stress[a : c + 1]
    area = abs(float(np.sum(0.5 * (tau[1:] + tau[:-1]) * np.diff(gamma))))
    width, height = abs(float(strain[b] - strain[a])), abs(float(stress[b] - stress[a]))
    elastic = 0.125 * width * height
    mean = 0.5 * float(strain[a] + strain[b])
    damping = area / (4.0 * np.pi * elastic) if elastic > 0.0 else 0.0
    return ClosedCycle(int(a), int(c), 0.5 * width, mean, height / width if width > 0.0 else np.inf, float(damping))
