"""Isotropic linear elasticity: Δσ = K tr(Δε) 1 + 2G dev(Δε)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal

from pydantic import Field

from riser_soil.core.lazy import LazyModule
from riser_soil.core.quantities import PoissonRatio, Stress
from riser_soil.soil.law import STRESS, SoilLaw, StressUpdate

if TYPE_CHECKING:
    import numpy as np

    from riser_soil.core.arrays import Array
    from riser_soil.soil import mandel
else:
    np, mandel = LazyModule("numpy"), LazyModule("riser_soil.soil.mandel")


class LinearElastic(SoilLaw):
    """Linear elastic soil."""

    path_dependent: ClassVar[bool] = False
    linear: ClassVar[bool] = True
    kind: Literal["linear-elastic"] = Field(description="the law's name")
    E: Stress = Field(description="Young's modulus [Pa]")
    nu: PoissonRatio = Field(description="Poisson's ratio [-]")

    def surface_modulus(self, width: float) -> float:
        return self.E

    def at_points(self, depth: Array, initial: Array) -> Elastic:
        modulus = np.full_like(depth, self.E)
        return Elastic(mandel.bulk_modulus(modulus, self.nu), mandel.shear_modulus(modulus, self.nu), initial)


@dataclass(frozen=True, eq=False)
class Elastic:
    """Bulk and shear modulus (n,) and initial stress (n, 6) [Pa]. History: the stress."""

    bulk: Array
    shear: Array
    initial: Array
    columns: ClassVar[tuple[str, ...]] = STRESS
    symmetric: ClassVar[bool] = True
    by_rate: ClassVar[bool] = False

    def start(self) -> Array:
        return self.initial

    def update(self, strain_increment: Array, history: Array, dt: float = math.inf) -> StressUpdate:
        stress = history + mandel.elastic_stress(self.bulk, self.shear, strain_increment)
        elastic = mandel.elastic_strain(self.bulk, self.shear, stress - self.initial)
        return StressUpdate(stress, self._moduli, stress, 0.5 * mandel.product(stress - self.initial, elastic), elastic)

    def overstress(self, stress: Array) -> Array:
        return np.zeros(len(stress))

    @cached_property
    def _moduli(self) -> Array:
        return mandel.stiffness(self.bulk, self.shear)
