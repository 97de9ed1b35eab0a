"""Isotropic linear elasticity: Δσ = K tr(Δε) 1 + 2G dev(Δε)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.soil import mandel


@dataclass(frozen=True, eq=False)
class LinearElastic:
    """Elastic soil; bulk and shear modulus (n,) [Pa] at the quadrature points."""

    bulk: Array
    shear: Array
    symmetric: bool = True

    @classmethod
    def at_depth(cls, depth: Array, *, E: float, nu: float) -> LinearElastic:
        """Young's modulus E [Pa] at all depths (n,) [m] below the seabed."""
        modulus = np.full_like(depth, E)
        return cls(mandel.bulk_modulus(modulus, nu), mandel.shear_modulus(modulus, nu))

    def start(self) -> Array:
        return np.zeros((len(self.bulk), 0))

    def stress(self, strain_increment: Array, stress: Array, history: Array) -> tuple[Array, Array]:
        return stress + mandel.elastic_stress(self.bulk, self.shear, strain_increment), history

    def tangent(self, strain_increment: Array, stress: Array, history: Array) -> Array:
        return mandel.stiffness(self.bulk, self.shear)

    def elastic_strain(self, stress: Array) -> Array:
        return mandel.elastic_strain(self.bulk, self.shear, stress)

    def overstress(self, stress: Array) -> Array:
        return np.zeros(len(stress))

    def plastic_strain(self, history: Array) -> Array:
        return np.zeros(len(history))
