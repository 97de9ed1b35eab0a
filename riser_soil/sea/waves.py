"""Linear waves: surface, velocity and acceleration of the water, with all derivatives, for a sum of components.

With theta = k (x cos d + y sin d) - w t + phase, each component has

    surface   a cos theta
    velocity  a w C cos theta along (cos d, sin d), a w S sin theta upwards

with C = cosh k(z + h)/sinh kh and S = sinh k(z + h)/sinh kh, z being the height above the mean surface and h the depth,
which may be inf. The acceleration is the local one, dv/dt at a fixed point: linear theory drops the convective part.
Source: Airy (1845), as in Dean and Dalrymple, Water Wave Mechanics for Engineers and Scientists (1984), chapter 3.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.sea.components import Components

# Exponent k z below which a component is left out: it has decayed to 1e-13 of what it is at the surface.
DEEPEST = -30.0

Numbers = tuple[float, ...]


class WaveTrain(NamedTuple):
    """Components (m,) by increasing wave number, prepared for many evaluations.

    toward: (m, 2) unit vectors. speed: a w/(1 - exp(-2 k h)) [m/s]. mirror: exp(-2 k h).
    """

    amplitude: Array
    w: Array
    k: Array
    toward: Array
    phase: Array
    speed: Array
    mirror: Array


class Heights(NamedTuple):
    """Points at which linear theory is evaluated: height z (n,) from the mean surface [m], its gradient (n, 3) at the
    points.
    """

    z: Array
    gradient: Array


class Kinematics(NamedTuple):
    """Velocity v and acceleration a (n, 3), and their gradients dv, da (n, 3, 3), [i, j] = component i by x_j."""

    v: Array
    a: Array
    dv: Array
    da: Array


def train(waves: Components, h: float) -> WaveTrain:
    """The components prepared for water of depth h [m]."""
    a, w, k, d, phase = (part[np.argsort(waves.wave_number)] for part in waves)
    toward = np.stack([np.cos(d), np.sin(d)], axis=-1)
    return WaveTrain(a, w, k, toward, phase, a * w / -np.expm1(-2.0 * k * h), np.exp(-2.0 * k * h))


def circular(waves: WaveTrain, t: float, x: Array) -> tuple[Array, Array]:
    """cos theta and sin theta (n, m) at points x (n, 3)."""
    theta = x[:, :2] @ (waves.toward * waves.k[:, None]).T
    theta += waves.phase - np.remainder(waves.w * t, 2.0 * np.pi)
    return np.cos(theta), np.sin(theta)


def surface(waves: WaveTrain, cosine: Array, sine: Array) -> tuple[Array, Array]:
    """Rise of the surface above its mean (n,) and its slope (n, 2)."""
    slopes = waves.toward * (waves.amplitude * waves.k)[:, None]
    return cosine @ waves.amplitude, -sine @ slopes


def wheeler(z: Array, eta: Array, slope: Array, h: float) -> Heights:
    """Wheeler's stretching: z' = (z - eta) h/(h + eta), at the surface 0 and at the bottom -h.

    Above the surface and below the bottom the water moves as it does there.
    Source: Wheeler, Journal of Petroleum Technology 22 (1970) 359-367.
    """
    shrink = 1.0 / (1.0 + eta / h)
    stretched = (z - eta) * shrink
    gradient = np.empty((z.size, 3))
    gradient[:, :2] = (-shrink * (1.0 + stretched / h))[:, None] * slope
    gradient[:, 2] = shrink
    return _within(Heights(stretched, gradient), h)


def vertical(z: Array, h: float) -> Heights:
    """Vertical stretching: above the mean surface the water moves as it does there."""
    gradient = np.zeros((z.size, 3))
    gradient[:, 2] = 1.0
    return _within(Heights(z, gradient), h)


def _within(at: Heights, h: float) -> Heights:
    inside = (at.z <= 0.0) & (at.z >= -h)
    return Heights(np.clip(at.z, -h, 0.0), at.gradient * inside[:, None])


def kinematics(waves: WaveTrain, cosine: Array, sine: Array, at: Heights) -> Kinematics:
    """The sum over the components.

    Where z is stretched, both the formula of v and that of a are taken at z', as is the practice: a is dv/dt at a fixed
    z'. The gradients are the exact derivatives of v and a as returned.
    """
    n = at.z.size
    out = Kinematics(np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3, 3)), np.empty((n, 3, 3)))
    _sum(waves, cosine, sine, at, out)
    return out


@njit
def _sum(waves: WaveTrain, cosine: Array, sine: Array, at: Heights, out: Kinematics) -> None:
    for p in range(at.z.size):
        z = at.z[p]
        vx, vy, vz, vxx, vxy, vyy, vxz, vyz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        ax, ay, az, axx, axy, ayy, axz, ayz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for j in range(waves.k.size):
            k, w = waves.k[j], waves.w[j]
            if k * z < DEEPEST:
                break
            cx, cy = waves.toward[j, 0], waves.toward[j, 1]
            down = np.exp(k * z)
            up = waves.mirror[j] / down
            level, rise = waves.speed[j] * (down + up), waves.speed[j] * (down - up)
            level_cos, level_sin = level * cosine[p, j], level * sine[p, j]
            rise_cos, rise_sin = rise * cosine[p, j], rise * sine[p, j]
            vx += level_cos * cx
            vy += level_cos * cy
            vz += rise_sin
            ax += w * level_sin * cx
            ay += w * level_sin * cy
            az -= w * rise_cos
            vxx -= k * level_sin * cx * cx
            vxy -= k * level_sin * cx * cy
            vyy -= k * level_sin * cy * cy
            vxz += k * rise_cos * cx
            vyz += k * rise_cos * cy
            axx += w * k * level_cos * cx * cx
            axy += w * k * level_cos * cx * cy
            ayy += w * k * level_cos * cy * cy
            axz += w * k * rise_sin * cx
            ayz += w * k * rise_sin * cy
        _write(out.v, out.dv, p, (vx, vy, vz), (vxx, vxy, vyy, vxz, vyz), at.gradient)
        _write(out.a, out.da, p, (ax, ay, az), (axx, axy, ayy, axz, ayz), at.gradient)


@njit
def _write(v: Array, dv: Array, p: int, value: Numbers, by: Numbers, gradient: Array) -> None:
    """A field without divergence and curl in (x, y, z'), whose z' has a gradient in (x, y, z)."""
    xx, xy, yy, xz, yz = by
    rows = ((xx, xy, xz), (xy, yy, yz), (xz, yz, -xx - yy))
    for i in range(3):
        v[p, i] = value[i]
        dv[p, i, 0] = rows[i][0] + rows[i][2] * gradient[p, 0]
        dv[p, i, 1] = rows[i][1] + rows[i][2] * gradient[p, 1]
        dv[p, i, 2] = rows[i][2] * gradient[p, 2]
