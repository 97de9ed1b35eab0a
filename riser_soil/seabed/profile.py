"""Profile of the seabed: its heights along a line, by a cubic spline."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.seabed.grounds import Ground, Mat, Vec, distance_at


class ProfileNumbers(NamedTuple):
    """As of `Profile`; spline (4, n - 1): of the powers 3 to 0 of the distance from each point but the last."""

    origin: tuple[float, float]
    direction: tuple[float, float]
    s: Array
    spline: Array


@distance_at.of(ProfileNumbers)
def _distance_at(ground: ProfileNumbers, x: Vec) -> tuple[float, Vec, Mat]:
    """With c = 1/sqrt(1 + h'^2), c' = -h' h'' c^3: d = (z - h) c."""
    (ox, oy), (a, b) = ground.origin, ground.direction
    h, h1, h2, h3 = _heights(ground, (x[0] - ox) * a + (x[1] - oy) * b)
    over = x[2] - h
    c = 1.0 / math.sqrt(1.0 + h1**2)
    c1 = -h1 * h2 * c**3
    c2 = -(h2**2 + h1 * h3) * c**3 - 3.0 * h1 * h2 * c**2 * c1
    along = over * c1 - h1 * c
    twice = over * c2 - 2.0 * h1 * c1 - h2 * c
    level = ((a * a * twice, a * b * twice), (a * b * twice, b * b * twice))
    return over * c, (along * a, along * b, c), ((*level[0], c1 * a), (*level[1], c1 * b), (c1 * a, c1 * b, 0.0))


@njit
def _heights(ground: ProfileNumbers, s: float) -> tuple[float, float, float, float]:
    """Height and its first three derivatives by s."""
    first, last = ground.s[0], ground.s[-1]
    within = min(max(s, first), last)
    i = min(max(np.searchsorted(ground.s, within, side="right") - 1, 0), ground.s.size - 2)
    d, k3, k2, k1 = within - ground.s[i], ground.spline[0, i], ground.spline[1, i], ground.spline[2, i]
    h, h1 = ((k3 * d + k2) * d + k1) * d + ground.spline[3, i], (3.0 * k3 * d + 2.0 * k2) * d + k1
    if within != s:
        return h + h1 * (s - within), h1, 0.0, 0.0
    return h, h1, 6.0 * k3 * d + 2.0 * k2, 6.0 * k3


@dataclass(frozen=True, eq=False)
class Profile(Ground):
    """Heights [m] given along a horizontal line, constant across it: a cubic spline, straight beyond the last points.

    origin (2,): where s = 0 [m]; direction (2,): unit vector along which s grows. s, z (n,): points of the profile, at
    least two. The distance is the height over the ground times the cosine of the ground's slope below.
    """

    origin: Array
    direction: Array
    s: Array
    z: Array
    flat: ClassVar[bool] = False

    @cached_property
    def numbers(self) -> ProfileNumbers:
        from scipy.interpolate import CubicSpline  # not to read what was compiled for this ground

        (x, y), (a, b) = map(float, self.origin), map(float, self.direction)
        spline = CubicSpline(self.s, self.z, bc_type="natural").c
        return ProfileNumbers((x, y), (a, b), np.array(self.s, dtype=float), np.array(spline, order="C"))

    @property
    def highest(self) -> float:
        return np.inf
