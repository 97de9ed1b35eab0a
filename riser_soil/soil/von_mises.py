"""Undrained clay by von Mises plasticity, perfectly plastic: q = √(3/2 s:s) ≤ √3·su.

The factor √3 makes simple shear (and plane strain flow) yield at the shear stress su; triaxial compression
then fails at q = √3·su instead of 2·su. Radial return and its consistent tangent: Simo & Hughes,
Computational Inelasticity (1998), box 3.2, without hardening.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal

from pydantic import Field

from riser_soil.core.lazy import LazyModule
from riser_soil.soil.clay import UndrainedClay
from riser_soil.soil.law import PLASTIC_STRAIN, STRESS, StressUpdate
from riser_soil.soil.rate import Rate, gain_of

if TYPE_CHECKING:
    import numpy as np

    from riser_soil.core.arrays import Array
    from riser_soil.soil import kernels, mandel
else:
    np, mandel = LazyModule("numpy"), LazyModule("riser_soil.soil.mandel")
    kernels = LazyModule("riser_soil.soil.kernels")

FEW = 100  # points that flow, for which nothing needs to be compiled


class VonMises(UndrainedClay):
    """Undrained clay: elastic, perfectly plastic; su is the strength in simple shear and plane strain."""

    kind: Literal["von-mises"] = Field(description="the law's name")

    def intact(self, depth: Array, initial: Array) -> PerfectlyPlastic:
        return PerfectlyPlastic(*self._constants(depth), initial, self.rate)


@dataclass(frozen=True, eq=False)
class PerfectlyPlastic:
    """Elastic moduli and largest equivalent stress in slow shear, each (n,), and initial stress (n, 6) [Pa].

    History (n, 7): stress and equivalent plastic strain.
    """

    bulk: Array
    shear: Array
    limit: Array
    initial: Array
    rate: Rate | None = None
    columns: ClassVar[tuple[str, ...]] = (*STRESS, PLASTIC_STRAIN)
    symmetric: ClassVar[bool] = True

    @property
    def by_rate(self) -> bool:
        return self.rate is not None

    def start(self) -> Array:
        return np.column_stack((self.initial, np.zeros(len(self.limit))))

    def update(
        self, strain_increment: Array, history: Array, dt: float = math.inf, strength: Array | float = 1.0
    ) -> StressUpdate:
        limit = strength * self.limit
        trial = history[:, :6] + mandel.elastic_stress(self.bulk, self.shear, strain_increment)
        s = mandel.deviator(trial)
        q = np.sqrt(1.5 * mandel.product(s, s))
        shrink, slope = gain_of(self.rate, dt).radial_return(q, limit, 3.0 * self.shear)
        slip = q * (1.0 - shrink) / (3.0 * self.shear)
        stress = trial - (1.0 - shrink)[:, None] * s
        elastic = mandel.elastic_strain(self.bulk, self.shear, stress - self.initial)
        return StressUpdate(
            stress,
            self._tangent(s, q, shrink, slope),
            np.column_stack((stress, history[:, 6] + slip)),
            0.5 * mandel.product(stress - self.initial, elastic),
            elastic,
        )

    def _tangent(self, s: Array, q: Array, shrink: Array, slope: Array) -> Array:
        """K 1⊗1 + 2G (θ (P − n⊗n) + slope n⊗n) where it yields: n = s/|s| of the trial, θ = shrink; else elastic."""
        moduli, at = self._elastic.copy(), np.flatnonzero(shrink < 1.0)
        n, shear = s[at] * (np.sqrt(1.5) / q[at])[:, None], (self.shear * shrink)[at]
        along = 2.0 * (shear - self.shear[at] * slope[at])
        if len(at) > FEW:
            kernels.write_flowing(at, self.bulk, shear, along, n, moduli)
            return moduli
        K, G, along = (values[:, None, None] for values in (self.bulk[at], shear, along))
        moduli[at] = mandel.modulus(K, G, mandel.VOLUME, mandel.DEVIATOR, along, n[:, :, None], n[:, None, :])
        return moduli

    @cached_property
    def _elastic(self) -> Array:
        """Moduli (n, 6, 6) [Pa] where nothing yields."""
        return mandel.stiffness(self.bulk, self.shear)

    def overstress(self, stress: Array) -> Array:
        return mandel.von_mises(stress) / self.limit
