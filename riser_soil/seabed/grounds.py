"""Seabed geometry: distance of a point from the ground, with exact first and second derivatives.

Heights grow along z. A distance [m] is positive above the ground; its gradient points away from it and is a unit vector
on a plane, and nearly so on a profile.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

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
