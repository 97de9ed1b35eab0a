"""Seabed geometry: distance of a point from the ground, with exact first and second derivatives.

Heights grow along z. A distance [m] is positive above the ground; its gradient points away from it and is a unit vector
on a plane, and nearly so on a profile.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.by_type import by_type
from riser_soil.core.compiled import njit

Vec = tuple[float, float, float]
Mat = tuple[Vec, Vec, Vec]


@by_type
def distance_at(ground: Any, x: Vec) -> Any:
    """Distance of a point x in global axes from a ground of this kernel data [m], its gradient and its hessian [1/m].
    """


class Distance(NamedTuple):
    """Distance of points (n, 3): value (n,) [m], gradient (n, 3), hessian (n, 3, 3) [1/m], None where it is zero."""

    value: Array
    gradient: Array
    hessian: Array | None


class Ground(ABC):
    """A surface that the riser may touch. flat: the hessian of the distance from it is zero."""

    flat: ClassVar[bool]

    @property
    @abstractmethod
    def kernel_data(self) -> Any:
        """Its shape as compiled code reads it: a NamedTuple, whose type chooses the kernel of `distance_at`."""

    @property
    @abstractmethod
    def highest(self) -> float:
        """No point higher than this [m] is below the ground; inf where there is no such height."""

    def distance(self, x: Array) -> Distance:
        """Distance of points x (n, 3) in global axes."""
        points = ground_points(np.zeros(len(x)))
        points.place[...] = x
        data, packed = Packed(self.kernel_data), Packed(points)
        Bound(write_penetrations, data, packed)()
        if self.flat:
            return Distance(-points.penetration, points.gradient, None)
        Bound(write_hessians, data, packed, Packed(np.ones(len(x), dtype=np.bool_)))()
        return Distance(-points.penetration, points.gradient, points.hessian)


class GroundPoints(NamedTuple):
    """Places (n, 3) in global axes [m], with a sphere of a radius (n,) [m] about each; its penetration (n,) into a
    ground [m]; gradient (n, 3) and hessian (n, 3, 3) [1/m] of the distance from it, this one zero on flat ground.
    """

    place: Array
    radius: Array
    penetration: Array
    gradient: Array
    hessian: Array


def ground_points(radius: Array) -> GroundPoints:
    """Workspace for points of a radius (n,) [m]."""
    n = len(radius)
    return GroundPoints(np.zeros((n, 3)), radius, np.zeros(n), np.zeros((n, 3)), np.zeros((n, 3, 3)))


@njit
def write_penetrations(ground: Any, points: GroundPoints) -> None:
    """Write the penetrations of points into a ground, by its kernel data, and the gradients of the distance."""
    place, gradient = points.place, points.gradient
    for p in range(points.radius.size):
        distance, by_place, _ = distance_at(ground, (place[p, 0], place[p, 1], place[p, 2]))
        points.penetration[p] = points.radius[p] - distance
        gradient[p, 0], gradient[p, 1], gradient[p, 2] = by_place


@njit
def write_hessians(ground: Any, points: GroundPoints, wanted: BoolArray) -> None:
    """Write the hessians of the distances of those points that are wanted (n,)."""
    place, hessian = points.place, points.hessian
    for p in range(points.radius.size):
        if wanted[p]:
            _, _, rows = distance_at(ground, (place[p, 0], place[p, 1], place[p, 2]))
            for i in range(3):
                hessian[p, i, 0], hessian[p, i, 1], hessian[p, i, 2] = rows[i]


class PlaneData(NamedTuple):
    """A `Plane` as kernels read it."""

    point: Vec
    normal: Vec


@distance_at.of(PlaneData)
def _distance_at(ground: PlaneData, x: Vec) -> tuple[float, Vec, Mat]:
    p, n, zero = ground.point, ground.normal, (0.0, 0.0, 0.0)
    return (x[0] - p[0]) * n[0] + (x[1] - p[1]) * n[1] + (x[2] - p[2]) * n[2], n, (zero, zero, zero)


@dataclass(frozen=True, eq=False)
class Plane(Ground):
    """A plane through a point (3,) [m] with the unit normal (3,), which points out of the ground."""

    point: Array
    normal: Array
    flat: ClassVar[bool] = True

    @classmethod
    def level(cls, height: float) -> Plane:
        return cls(np.array([0.0, 0.0, height]), np.array([0.0, 0.0, 1.0]))

    @classmethod
    def sloping(cls, point: Array, slope: float, direction: float) -> Plane:
        """Rising by the angle `slope` [rad] towards `direction` [rad], from x towards y."""
        uphill = np.array([np.cos(direction), np.sin(direction), 0.0])
        return cls(point, np.cos(slope) * np.array([0.0, 0.0, 1.0]) - np.sin(slope) * uphill)

    @cached_property
    def kernel_data(self) -> PlaneData:
        (x, y, z), (a, b, c) = map(float, self.point), map(float, self.normal)
        return PlaneData((x, y, z), (a, b, c))

    @property
    def highest(self) -> float:
        return float(self.point[2]) if self.normal[2] == 1.0 else np.inf
