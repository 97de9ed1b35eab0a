"""Linear waves as plain sums over the components at every point: what the series of `riser_soil.sea.wave_series` stand
for, and what they are timed against.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.core.smooth_step import smooth_step
from riser_soil.sea import waves
from riser_soil.sea.components import Components
from riser_soil.sea.flows import Sea, WaterMotion
from riser_soil.sea.waves import Stretching

KernelData = tuple[float, ...]


class SummedWaves:
    """The sea with waves as of `linear_waves`. deepest: k d beyond which components are left out at depth d."""

    deepest = 700.0

    def __init__(
        self,
        components: Components,
        depth: float,
        level: float,
        stretching: Stretching = "wheeler",
        ramp: float = 0.0,
        clock: float = 0.0,
        since: float = 0.0,
    ) -> None:
        self._waves = Components(*(part[np.argsort(components.wave_number)] for part in components))
        self._depth, self._level = depth, level
        self._stretching, self._ramp, self._clock, self._since = stretching, ramp, clock, since

    def __call__(self, t: float, x: Array) -> WaterMotion:
        motion = Sea(self._level)(t, x)
        (r, rate, _), t = smooth_step(self._since + t, self._ramp), self._clock + t
        a, w, k, d, phase = self._waves
        toward = np.stack([np.cos(d), np.sin(d)], axis=-1)
        theta = x[:, :2] @ (toward * k[:, None]).T + (phase - np.remainder(w * t, 2.0 * np.pi))
        cosine, sine = np.cos(theta), np.sin(theta)
        rise, slope = r * cosine @ a, -r * sine @ (toward * (a * k)[:, None])
        z = x[:, 2] - self._level
        wheeler = self._stretching == "wheeler"
        at = waves.wheeler(z, rise, slope, self._depth) if wheeler else waves.vertical(z, self._depth)
        speed, mirror = a * w / -np.expm1(-2.0 * k * self._depth), np.exp(-2.0 * k * self._depth)
        n = z.size
        v, dv, v_rate, dv_rate = (np.empty((n, *shape)) for shape in ((3,), (3, 3), (3,), (3, 3)))
        _sum(w, k, speed, mirror, toward, cosine, sine, at, self.deepest, v, dv, v_rate, dv_rate)
        motion.velocity[:] += r * v
        motion.velocity_gradient[:] += r * dv
        motion.acceleration[:] += r * v_rate + rate * v
        motion.acceleration_gradient[:] += r * dv_rate + rate * dv
        motion.immersion[:] += rise
        motion.immersion_gradient[:, :2] += slope
        return motion


@njit
def _sum(
    w: Array,
    wave_number: Array,
    speed: Array,
    mirror: Array,
    toward: Array,
    cosine: Array,
    sine: Array,
    at: waves.Heights,
    deepest: float,
    v: Array,
    dv: Array,
    v_rate: Array,
    dv_rate: Array,
) -> None:
    for p in range(at.z.size):
        vx, vy, vz, vxx, vxy, vyy, vxz, vyz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        ax, ay, az, axx, axy, ayy, axz, ayz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for j in range(w.size):
            k = wave_number[j]
            if k * at.z[p] < -deepest:
                break
            cx, cy = toward[j, 0], toward[j, 1]
            down = np.exp(k * at.z[p])
            up = mirror[j] / down
            level, rise = speed[j] * (down + up), speed[j] * (down - up)
            level_cos, level_sin = level * cosine[p, j], level * sine[p, j]
            rise_cos, rise_sin = rise * cosine[p, j], rise * sine[p, j]
            vx += level_cos * cx
            vy += level_cos * cy
            vz += rise_sin
            ax += w[j] * level_sin * cx
            ay += w[j] * level_sin * cy
            az -= w[j] * rise_cos
            vxx -= k * level_sin * cx * cx
            vxy -= k * level_sin * cx * cy
            vyy -= k * level_sin * cy * cy
            vxz += k * rise_cos * cx
            vyz += k * rise_cos * cy
            axx += w[j] * k * level_cos * cx * cx
            axy += w[j] * k * level_cos * cx * cy
            ayy += w[j] * k * level_cos * cy * cy
            axz += w[j] * k * rise_sin * cx
            ayz += w[j] * k * rise_sin * cy
        _write(v, dv, p, (vx, vy, vz), (vxx, vxy, vyy, vxz, vyz), at.gradient)
        _write(v_rate, dv_rate, p, (ax, ay, az), (axx, axy, ayy, axz, ayz), at.gradient)


@njit
def _write(v: Array, dv: Array, p: int, value: KernelData, by: KernelData, gradient: Array) -> None:
    """A field without divergence and curl in (x, y, z'), whose z' has a gradient in (x, y, z)."""
    xx, xy, yy, xz, yz = by
    rows = ((xx, xy, xz), (xy, yy, yz), (xz, yz, -xx - yy))
    for i in range(3):
        v[p, i] = value[i]
        dv[p, i, 0] = rows[i][0] + rows[i][2] * gradient[p, 0]
        dv[p, i, 1] = rows[i][1] + rows[i][2] * gradient[p, 1]
        dv[p, i, 2] = rows[i][2] * gradient[p, 2]
