"""Seabed geometry: distance of a point from the ground, with exact first and second derivatives.

Heights grow along z. A distance [m] is positive above the ground; its gradient points away from it and is a unit vector
on a plane, and nearly so on a profile.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np
from scipy.interpolate import CubicSpline

from riser_soil.core.arrays import Array


class Distance(NamedTuple):
    """Distance of points (n, 3): value (n,) [m], gradient (n, 3), hessian (n, 3, 3) [1/m], None where it is zero."""

    value: Array
    gradient: Array
    hessian: Array | None


class Ground(Protocol):
    """A surface that the riser may touch."""

    def distance(self, x: Array) -> Distance:
        """Distance of points x (n, 3) in global axes."""
        ...

    @property
    def highest(self) -> float:
        """No point higher than this [m] is below the ground; inf where there is no such height."""
        ...


@dataclass(frozen=True, eq=False)
class Plane:
    """A plane through a point (3,) [m] with the unit normal (3,), which points out of the ground."""

    point: Array
    normal: Array

    @classmethod
    def level(cls, height: float) -> Plane:
        return cls(np.array([0.0, 0.0, height]), np.array([0.0, 0.0, 1.0]))

    @classmethod
    def sloping(cls, point: Array, slope: float, direction: float) -> Plane:
        """Rising by the angle `slope` [rad] towards `direction` [rad], from x towards y."""
        uphill = np.array([np.cos(direction), np.sin(direction), 0.0])
        return cls(point, np.cos(slope) * np.array([0.0, 0.0, 1.0]) - np.sin(slope) * uphill)

    @property
    def highest(self) -> float:
        return float(self.point[2]) if self.normal[2] == 1.0 else np.inf

    def distance(self, x: Array) -> Distance:
        return Distance((x - self.point) @ self.normal, np.broadcast_to(self.normal, x.shape), None)


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
