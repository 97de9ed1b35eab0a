"""Bend of a pipe where it comes to lie on a level seabed, in closed form: what its stiffness adds to a cable.

With y the height over the surface, w the weight, H the horizontal tension, k the ground's stiffness [N/m2] and small
slopes, a pipe that lies where s < 0 and hangs where s > 0 is in balance where

    EI y'''' - H y'' + k y = -w,  s < 0;      EI y'''' - H y'' = -w,  s > 0;      y(0) = 0.

With K = w/H, L^2 = EI/H, the depth d = w/k at rest, q^2 = k/EI and p^2 = 1/L^2 + 2 q, what fades away from s = 0 is

    y = -d + f,  f'' = p f' - q f;            y = K s^2/2 + E s + F (e^(-s/L) - 1).

That y, y', y'' and y''' are continuous gives f(0) = d and

    f'(0) = (K + q d (1 + p L))/(L (p^2 - q) + p),  F = L^2 (p f'(0) - q d - K),  E = f'(0) + F/L.

Far away the pipe hangs as a cable that comes down at s = -E/K to the height (K L^2 - d)/2: all along it
EI (y' y''' - y''^2/2) - H y'^2/2 + k y^2/2 + w y is the same, with k y^2/2 where it lies. Source: bending boundary
layers of tensioned pipes (J. G. A. Croll, Applied Ocean Research 22, 2000) and pipe laying on elastic ground (S. Lenci
& M. Callegari, Acta Mechanica 178, 2005), both from memory.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array

APART = 1e-8  # of p/2: for half the difference of two roots that are the same


@dataclass(frozen=True)
class TouchdownBend:
    """weight w [N/m], horizontal tension H [N], bending stiffness EI [N m2], depth d at rest [m]: all > 0."""

    weight: float
    H: float
    EI: float
    depth: float

    @property
    def curvature(self) -> float:
        """K [1/m]: of a cable where it comes down."""
        return self.weight / self.H

    @property
    def length(self) -> float:
        """L [m]: over which the bend fades in what hangs."""
        return math.sqrt(self.EI / self.H)

    @property
    def lift_off(self) -> float:
        """Arc length [m] from the touchdown to where a cable would come down."""
        return -self._E / self.curvature

    @property
    def rise(self) -> float:
        """Height [m] of that place over the surface."""
        return 0.5 * (self.curvature * self.length**2 - self.depth)

    @property
    def overshoot(self) -> float:
        """Depth of the deepest place over that at rest: where f' = 0 first, the largest s < 0 there."""
        (c, r), d = self._roots(), self.depth
        steeper = self._slope - r * d
        s = float(np.real(np.emath.log(r * (steeper - 2.0 * c * d) / (steeper * (r + 2.0 * c))) / (2.0 * c)))
        if np.iscomplexobj(c) and s > 0.0:
            s -= math.pi / float(abs(c))
        return 1.0 - float(self._lying(np.array([s]))[0][0]) / d if s < 0.0 else 1.0

    def beyond_cable(self, s: Array) -> tuple[Array, Array]:
        """Height [m] and slope of the pipe beyond those of a cable on ground that is higher by the rise, at arc lengths
        from the touchdown (n,) [m].
        """
        (height, slope), suspended = self._pipe(s), np.maximum(s - self.lift_off, 0.0)
        return height - self.rise - 0.5 * self.curvature * suspended**2, slope - self.curvature * suspended

    def _pipe(self, s: Array) -> tuple[Array, Array]:
        """Height over the surface, and slope."""
        K, L, E, F, t = self.curvature, self.length, self._E, self._F, np.maximum(s, 0.0)
        fading = np.exp(-t / L)
        (f, df), lies = self._lying(np.minimum(s, 0.0)), s < 0.0
        height = np.where(lies, f - self.depth, 0.5 * K * t**2 + E * t + F * (fading - 1.0))
        return height, np.where(lies, df, K * t + E - F / L * fading)

    def _lying(self, s: Array) -> tuple[Array, Array]:
        """f and its derivative: d e^(r s) + (f'(0) - r d) e^(r s) (e^(2 c s) - 1)/(2 c), with c^2 = p^2/4 - q and the
        roots r = p/2 - c and r + 2 c, which may be complex.
        """
        (c, r), d = self._roots(), self.depth
        fading, steeper = np.exp(r * s), self._slope - r * d
        f = fading * (d + steeper * np.expm1(2.0 * c * s) / (2.0 * c))
        return np.real(f), np.real(r * f + steeper * fading * np.exp(2.0 * c * s))

    def _roots(self) -> tuple[complex, complex]:
        """The constants c and r [1/m] of the exponentials in `_lying`."""
        half = 0.5 * self._p
        c = np.emath.sqrt(half**2 - self._q) or half * APART
        return c, self._q / (half + c)

    @property
    def _q(self) -> float:
        return math.sqrt(self.weight / self.depth / self.EI)

    @property
    def _p(self) -> float:
        return math.sqrt(1.0 / self.length**2 + 2.0 * self._q)

    @property
    def _slope(self) -> float:
        p, q, L = self._p, self._q, self.length
        return (self.curvature + q * self.depth * (1.0 + p * L)) / (L * (p**2 - q) + p)

    @property
    def _F(self) -> float:
        return self.length**2 * (self._p * self._slope - self._q * self.depth - self.curvature)

    @property
    def _E(self) -> float:
        return self._slope + self._F / self.length
