"""Profile of the seabed: its heights along a line, by a cubic spline."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.interpolate import CubicSpline

from riser_soil.core.arrays import Array
from riser_soil.seabed.grounds import Distance


@dataclass(frozen=True, eq=False)
class Profile:
    """Heights [m] given along a horizontal line, constant across it: a cubic spline, straight beyond the last points.

    origin (2,): where s = 0 [m]; direction (2,): unit vector along which s grows. s, z (n,): points of the profile, at
    least two. The distance is the height over the ground times the cosine of the ground's slope below.
    """

    origin: Array
    direction: Array
    s: Array
    z: Array
    _spline: CubicSpline = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_spline", CubicSpline(self.s, self.z, bc_type="natural"))

    @property
    def highest(self) -> float:
        return np.inf

    def _heights(self, s: Array) -> tuple[Array, Array, Array, Array]:
        """Height and its first three derivatives by s."""
        within = np.clip(s, self.s[0], self.s[-1])
        inside = within == s
        h, h1, h2, h3 = (self._spline(within, k) for k in range(4))
        return h + h1 * (s - within), h1, np.where(inside, h2, 0.0), np.where(inside, h3, 0.0)

    def distance(self, x: Array) -> Distance:
        """With c = 1/sqrt(1 + h'^2), c' = -h' h'' c^3: d = (z - h) c."""
        h, h1, h2, h3 = self._heights((x[:, :2] - self.origin) @ self.direction)
        over = x[:, 2] - h
        c = 1.0 / np.sqrt(1.0 + h1**2)
        c1 = -h1 * h2 * c**3
        c2 = -(h2**2 + h1 * h3) * c**3 - 3.0 * h1 * h2 * c**2 * c1
        along = over * c1 - h1 * c
        twice = over * c2 - 2.0 * h1 * c1 - h2 * c
        return Distance(over * c, self._spread(along, c), self._spread_twice(twice, c1))

    def _spread(self, along: Array, up: Array) -> Array:
        return np.concatenate([along[:, None] * self.direction, up[:, None]], axis=1)

    def _spread_twice(self, twice: Array, mixed: Array) -> Array:
        hessian = np.zeros((len(twice), 3, 3))
        hessian[:, :2, :2] = twice[:, None, None] * np.outer(self.direction, self.direction)
        hessian[:, :2, 2] = hessian[:, 2, :2] = mixed[:, None] * self.direction
        return hessian
