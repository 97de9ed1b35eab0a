"""Heights of the seabed: along a line by a cubic spline, over a grid of x and y by a bicubic one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.seabed.grounds import Ground, Mat, Vec, distance_at

Weights = tuple[float, float, float, float]


class HeightFieldData(NamedTuple):
    """A `HeightField` as kernels read it. nodal (nx, ny, 2, 2): the spline's derivatives at the points, [i, j, 0, 1]
    that by y.

    along: direction of the section that counts, (0, 0) where the whole surface does.
    """

    x: Array
    y: Array
    nodal: Array
    along: tuple[float, float]


@distance_at.of(HeightFieldData)
def _distance_at(ground: HeightFieldData, x: Vec) -> tuple[float, Vec, Mat]:
    """Distance and its derivatives; with g the slope of the height h, c = (1 + g.g)^(-1/2) and G_i = g_k h_ki:
    d = (z - h) c, c_i = -c^3 G_i, c_ij = 3 c^5 G_i G_j - c^3 (h_ki h_kj + g_k h_kij).
    """
    h, (p, q), (xx, xy, yy), (xxx, xxy, xyy, yyy) = _heights(ground, x[0], x[1])
    over, c = x[2] - h, 1.0 / math.sqrt(1.0 + p**2 + q**2)
    c3, c5 = c**3, c**5
    gx, gy = p * xx + q * xy, p * xy + q * yy
    cx, cy = -c3 * gx, -c3 * gy
    cxx = 3.0 * c5 * gx * gx - c3 * (xx * xx + xy * xy + p * xxx + q * xxy)
    cxy = 3.0 * c5 * gx * gy - c3 * (xx * xy + xy * yy + p * xxy + q * xyy)
    cyy = 3.0 * c5 * gy * gy - c3 * (xy * xy + yy * yy + p * xyy + q * yyy)
    dxx = over * cxx - 2.0 * p * cx - xx * c
    dxy = over * cxy - p * cy - q * cx - xy * c
    dyy = over * cyy - 2.0 * q * cy - yy * c
    return over * c, (over * cx - p * c, over * cy - q * c, c), ((dxx, dxy, cx), (dxy, dyy, cy), (cx, cy, 0.0))


@njit
def _heights(
    ground: HeightFieldData, x: float, y: float
) -> tuple[float, tuple[float, float], tuple[float, float, float], Weights]:
    """Height and its first, second and third derivatives by x and y; those along the section alone, if one counts."""
    i, u = _weights(ground.x, x)
    j, v = _weights(ground.y, y)
    h = _sum(ground.nodal, i, j, u[0], v[0])
    p, q = _sum(ground.nodal, i, j, u[1], v[0]), _sum(ground.nodal, i, j, u[0], v[1])
    xx, yy = _sum(ground.nodal, i, j, u[2], v[0]), _sum(ground.nodal, i, j, u[0], v[2])
    xy, xxx = _sum(ground.nodal, i, j, u[1], v[1]), _sum(ground.nodal, i, j, u[3], v[0])
    xxy, xyy = _sum(ground.nodal, i, j, u[2], v[1]), _sum(ground.nodal, i, j, u[1], v[2])
    yyy = _sum(ground.nodal, i, j, u[0], v[3])
    a, b = ground.along
    if a == 0.0 and b == 0.0:
        return h, (p, q), (xx, xy, yy), (xxx, xxy, xyy, yyy)
    s1, s2 = a * p + b * q, a * a * xx + 2.0 * a * b * xy + b * b * yy
    s3 = a**3 * xxx + 3.0 * a * a * b * xxy + 3.0 * a * b * b * xyy + b**3 * yyy
    third = (a**3 * s3, a * a * b * s3, a * b * b * s3, b**3 * s3)
    return h, (a * s1, b * s1), (a * a * s2, a * b * s2, b * b * s2), third


@njit
def _weights(points: Array, at: float) -> tuple[int, tuple[Weights, Weights, Weights, Weights]]:
    """The point before a place, and the weights of the values and slopes there and at the next one: of the cubic
    Hermite polynomial and of its three derivatives. Straight beyond the first and last points.
    """
    within = min(max(at, points[0]), points[-1])
    i = min(max(np.searchsorted(points, within, side="right") - 1, 0), points.size - 2)
    w = points[i + 1] - points[i]
    t = (within - points[i]) / w
    value = (1.0 - t * t * (3.0 - 2.0 * t), w * t * (1.0 - t) ** 2, t * t * (3.0 - 2.0 * t), w * t * t * (t - 1.0))
    bend = 6.0 * t * (1.0 - t) / w
    slope = (-bend, (1.0 - t) * (1.0 - 3.0 * t), bend, t * (3.0 * t - 2.0))
    if within != at:
        over, none = at - within, (0.0, 0.0, 0.0, 0.0)
        beyond = (
            value[0] + over * slope[0],
            value[1] + over * slope[1],
            value[2] + over * slope[2],
            value[3] + over * slope[3],
        )
        return i, (beyond, slope, none, none)
    turn = (12.0 * t - 6.0) / w**2
    second = (turn, (6.0 * t - 4.0) / w, -turn, (6.0 * t - 2.0) / w)
    third = (12.0 / w**3, 6.0 / w**2, -12.0 / w**3, 6.0 / w**2)
    return i, (value, slope, second, third)


@njit
def _sum(nodal: Array, i: int, j: int, u: Weights, v: Weights) -> float:
    total = 0.0
    for m in range(4):
        for n in range(4):
            total += u[m] * v[n] * nodal[i + m // 2, j + n // 2, m % 2, n % 2]
    return total


@dataclass(frozen=True, eq=False)
class HeightField(Ground):
    """Heights z (nx, ny) [m] at points x (nx,), y (ny,), at least two each: a bicubic spline, twice continuously
    differentiable (a natural cubic spline along each row and column), straight beyond the last points.

    The distance is the height over the ground times the cosine of the ground's slope below. along (2,): in a vertical
    plane along this horizontal unit vector the section through it counts, as if the ground were constant across.
    """

    x: Array
    y: Array
    z: Array
    along: Array | None = None
    flat: ClassVar[bool] = False

    @cached_property
    def kernel_data(self) -> HeightFieldData:
        a, b = (0.0, 0.0) if self.along is None else map(float, self.along)
        by_x, by_y = _slopes(self.x, self.z), _slopes(self.y, self.z.T).T
        nodal = np.stack([self.z, by_y, by_x, _slopes(self.x, by_y)], axis=-1).reshape(*self.z.shape, 2, 2)
        return HeightFieldData(np.array(self.x, dtype=float), np.array(self.y, dtype=float), nodal, (a, b))

    @property
    def highest(self) -> float:
        return np.inf


def _slopes(at: Array, values: Array) -> Array:
    """Slopes (n, m) at the points (n,) of natural cubic splines through values (n, m)."""
    from scipy.interpolate import CubicSpline  # not to read what was compiled for this ground

    return np.asarray(CubicSpline(at, values, bc_type="natural")(at, 1))


class ProfileData(NamedTuple):
    """A `Profile` as kernels read it. spline (4, n - 1): coefficients of powers 3 to 0 of the distance from each point
    but the last.
    """

    origin: tuple[float, float]
    direction: tuple[float, float]
    s: Array
    spline: Array


@distance_at.of(ProfileData)
def _distance_at_profile(ground: ProfileData, x: Vec) -> tuple[float, Vec, Mat]:
    """Distance and its derivatives: d = (z - h) c with c = 1/sqrt(1 + h'^2), c' = -h' h'' c^3."""
    (ox, oy), (a, b) = ground.origin, ground.direction
    h, h1, h2, h3 = _heights_along(ground, (x[0] - ox) * a + (x[1] - oy) * b)
    over = x[2] - h
    c = 1.0 / math.sqrt(1.0 + h1**2)
    c1 = -h1 * h2 * c**3
    c2 = -(h2**2 + h1 * h3) * c**3 - 3.0 * h1 * h2 * c**2 * c1
    along = over * c1 - h1 * c
    twice = over * c2 - 2.0 * h1 * c1 - h2 * c
    level = ((a * a * twice, a * b * twice), (a * b * twice, b * b * twice))
    return over * c, (along * a, along * b, c), ((*level[0], c1 * a), (*level[1], c1 * b), (c1 * a, c1 * b, 0.0))


@njit
def _heights_along(ground: ProfileData, s: float) -> tuple[float, float, float, float]:
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
    def kernel_data(self) -> ProfileData:
        from scipy.interpolate import CubicSpline  # not to read what was compiled for this ground

        (x, y), (a, b) = map(float, self.origin), map(float, self.direction)
        spline = CubicSpline(self.s, self.z, bc_type="natural").c
        return ProfileData((x, y), (a, b), np.array(self.s, dtype=float), np.array(spline, order="C"))

    @property
    def highest(self) -> float:
        return np.inf
