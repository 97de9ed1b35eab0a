"""S-N curves: cycles to failure N by stress range S, in branches log10 N = log_a - m log10 S, S in MPa."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array

REFERENCE_THICKNESS = 0.025  # m, of welded connections other than tubular joints, DNVGL-RP-C203 (2016) 2.4


@dataclass(frozen=True)
class SNCurve:
    """Branches from few to many cycles; the first and the last go on without end, so no range is too small to count.

    change: N where one branch ends and the next begins, one fewer than branches. k: thickness exponent; walls thicker
    than the reference [m] have their stress ranges multiplied by (t/reference)^k.
    """

    name: str
    source: str
    log_a: tuple[float, ...]
    m: tuple[float, ...]
    change: tuple[float, ...] = ()
    k: float = 0.0
    reference: float = REFERENCE_THICKNESS

    def endurance(self, S: Array) -> Array:
        """N of stress ranges S [MPa], inf of ranges that are 0."""
        S = np.asarray(S, dtype=float)
        log_a, m = np.array(self.log_a), np.array(self.m)
        ends = 10.0 ** ((log_a[:-1] - np.log10(self.change)) / m[:-1])  # [MPa], falling
        branch = (S[..., None] < ends).sum(axis=-1)
        with np.errstate(divide="ignore"):
            return np.asarray(10.0 ** (log_a[branch] - m[branch] * np.log10(S)))

    def damage(self, S: Array) -> float:
        """Miner's sum of stress ranges S [MPa], each a cycle."""
        return float(np.sum(1.0 / self.endurance(S)))

    def thickness_factor(self, thickness: float) -> float:
        """Factor on stress ranges in a wall of a thickness [m]; never below 1."""
        return float(max(thickness / self.reference, 1.0) ** self.k)


def curve_through(
    points: Sequence[tuple[float, float]], k: float = 0.0, reference: float = REFERENCE_THICKNESS
) -> SNCurve:
    """Straight in logarithms between points (N, S [Pa]) of growing N and falling S, and on beyond them."""
    log_N, log_S = np.log10(np.array(points)).T - np.array([[0.0], [6.0]])
    m = -np.diff(log_N) / np.diff(log_S)
    log_a = log_N[:-1] + m * log_S[:-1]
    change = tuple(float(N) for N, _ in points[1:-1])
    return SNCurve("table", "given by points", tuple(log_a.tolist()), tuple(m.tolist()), change, k, reference)
