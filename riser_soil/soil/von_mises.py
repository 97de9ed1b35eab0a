"""Perfectly plastic von Mises clay, undrained: q = √(3/2 s:s) ≤ √3·su.

The factor √3 makes simple shear (and plane strain flow) yield at the shear stress su; triaxial compression
then fails at q = √3·su instead of 2·su. Radial return and its consistent tangent: Simo & Hughes,
Computational Inelasticity (1998), box 3.2, without hardening.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.soil import mandel


@dataclass(frozen=True, eq=False)
class VonMises:
    """Elastic moduli and largest equivalent stress, each (n,) [Pa], at the quadrature points.

    History (n, 1): equivalent plastic strain.
    """

    bulk: Array
    shear: Array
    limit: Array
    symmetric: bool = True

    @classmethod
    def at_depth(
        cls, depth: Array, *, su: float, su_gradient: float, E_over_su: float, nu: float
    ) -> VonMises:
        """Strength su + su_gradient·depth [Pa] at depths (n,) [m] below the seabed; E follows it."""
        strength = su + su_gradient * depth
        E = E_over_su * strength
        return cls(mandel.bulk_modulus(E, nu), mandel.shear_modulus(E, nu), np.sqrt(3.0) * strength)

    def start(self) -> Array:
        return np.zeros((len(self.limit), 1))

    def stress(self, strain_increment: Array, stress: Array, history: Array) -> tuple[Array, Array]:
        trial = stress + mandel.elastic_stress(self.bulk, self.shear, strain_increment)
        s, q, shrink = self._radial_return(trial)
        slip = q * (1.0 - shrink) / (3.0 * self.shear)
        return trial - (1.0 - shrink)[:, None] * s, history + slip[:, None]

    def tangent(self, strain_increment: Array, stress: Array, history: Array) -> Array:
        """K 1⊗1 + 2G θ (P − n⊗n) where it yields: n = s/|s| of the trial, θ = limit/q; else elastic."""
        trial = stress + mandel.elastic_stress(self.bulk, self.shear, strain_increment)
        s, q, shrink = self._radial_return(trial)
        moduli = mandel.stiffness(self.bulk, self.shear * shrink)
        yields = np.flatnonzero(shrink < 1.0)
        n = s[yields] * (np.sqrt(1.5) / q[yields])[:, None]
        moduli[yields] -= (2.0 * self.shear * shrink)[yields, None, None] * n[:, :, None] * n[:, None, :]
        return moduli

    def elastic_strain(self, stress: Array) -> Array:
        return mandel.elastic_strain(self.bulk, self.shear, stress)

    def overstress(self, stress: Array) -> Array:
        return mandel.von_mises(stress) / self.limit

    def plastic_strain(self, history: Array) -> Array:
        return history[:, 0]

    def _radial_return(self, trial: Array) -> tuple[Array, Array, Array]:
        """Deviator and equivalent stress of the trial, and the factor ≤ 1 that brings it to the limit."""
        s = mandel.deviator(trial)
        q = np.sqrt(1.5 * np.einsum("ni,ni->n", s, s))
        return s, q, self.limit / np.maximum(q, self.limit)
