"""Sand by Drucker & Prager's cone, elastic and perfectly plastic, with its own dilation: q + M σm ≤ k.

q = √(3/2 s:s), σm the mean stress, tension positive. Plastic strain flows along the gradient of q + M' σm; at the
cone's apex, σm = k/M, along anything between: the soil bears no more tension.

The cone is fitted to Mohr & Coulomb's τ ≤ c cos φ - σ sin φ. In plane strain, as under a pipe, failure without
elastic strain leaves no plastic strain along the pipe; with a = M/(3√3) and a' = M'/(3√3) the out-of-plane deviator is
then -2 a' q/√3, the largest shear stress (q/√3) √(1 - 3 a'²), and its mean stress σm + a' q/√3, so that

    a' = sin ψ/√(9 + 3 sin² ψ),   (a, k/√3) = (sin φ/3, c cos φ)/(√(1 - 3 a'²) + a' sin φ),

which for ψ = φ is Drucker & Prager's own (Quart. Appl. Math. 10, 1952). In triaxial compression
(M, k) = (sin φ, c cos φ) 6/(3 - sin φ), M' likewise with ψ; such a cone bears more in plane strain.

Backward Euler: Δλ = (q + M σm - k)/(3 G + K M M') of the elastic trial, unless q - 3 G Δλ < 0: then the stress is the
apex. With M' ≤ M each step dissipates: Δλ (k - (M - M') σm) ≥ Δλ k M'/M.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from riser_soil.core.lazy import LazyModule
from riser_soil.core.quantities import PoissonRatio, StrengthGradient, Stress, wrong
from riser_soil.soil.law import PLASTIC_STRAIN, STRESS, SoilLaw, StressUpdate

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np

    from riser_soil.core.arrays import Array, IntArray
    from riser_soil.soil import mandel
else:
    np, mandel = LazyModule("numpy"), LazyModule("riser_soil.soil.mandel")

STEEPEST = 60.0  # friction angle [deg]
STIFFNESS_AT_APEX = 1e-4  # of the elastic tangent, where the stress does not change: loose soil still has a matrix


class DruckerPrager(SoilLaw):
    """Sand: elastic, perfectly plastic, with a strength that grows with the mean stress, and dilation."""

    kind: Literal["drucker-prager"] = Field(description="the law's name")
    friction_angle_deg: Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, le=STEEPEST)] = Field(
        description="friction angle φ of Mohr & Coulomb [deg]"
    )
    dilation_angle_deg: Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, le=STEEPEST)] = Field(
        default=0.0, description="dilation angle ψ, at most φ; it lasts however far the sand is sheared [deg]"
    )
    cohesion: Stress = Field(
        description="cohesion c [Pa]; a little (0.1 to 1 kPa) holds the surface together, where nothing confines sand"
    )
    E: Stress = Field(description="Young's modulus at the seabed [Pa]")
    E_gradient: StrengthGradient = Field(default=0.0, description="growth of E with depth [Pa/m]")
    nu: PoissonRatio = Field(default=0.3, description="Poisson's ratio [-]")
    match: Literal["plane-strain", "triaxial-compression"] = Field(
        default="plane-strain", description="where the cone bears what Mohr & Coulomb's law bears"
    )

    @model_validator(mode="after")
    def _dilates_less_than_it_rubs(self) -> Self:
        if self.dilation_angle_deg > self.friction_angle_deg:
            raise wrong(
                "dilation_angle_deg",
                f"must be at most friction_angle_deg ({self.friction_angle_deg:g} deg)",
                "sand that dilated more would give off energy; take some 30 deg less than friction_angle_deg, or 0",
            )
        return self

    def knows_effective_stress(self, columns: Sequence[str]) -> bool:
        """Sand drains: its stress is the effective one."""
        return True

    def surface_modulus(self, width: float) -> float:
        return self.E

    def at_points(self, depth: Array, initial: Array) -> FrictionalSoil:
        E = self.E + self.E_gradient * depth
        slope, cohesion, dilation = self.cone()
        moduli = mandel.bulk_modulus(E, self.nu), mandel.shear_modulus(E, self.nu)
        return FrictionalSoil(*moduli, slope, cohesion, dilation, initial)

    def cone(self) -> tuple[float, float, float]:
        """M [-], k [Pa], M' [-]."""
        phi, psi = math.radians(self.friction_angle_deg), math.radians(self.dilation_angle_deg)
        friction, c = math.sin(phi), self.cohesion * math.cos(phi)
        if self.match == "triaxial-compression":
            steep = 6.0 / (3.0 - friction)
            dilation = 6.0 * math.sin(psi) / (3.0 - math.sin(psi))
        else:
            share = math.sin(psi) / math.sqrt(9.0 + 3.0 * math.sin(psi) ** 2)
            steep = math.sqrt(3.0) / (math.sqrt(1.0 - 3.0 * share**2) + share * friction)
            dilation = 3.0 * math.sqrt(3.0) * share
        slope = steep * friction
        return slope, steep * c, slope if psi == phi else dilation

    def wrong_within(self, depth: float) -> tuple[str, str] | None:
        if self.E + self.E_gradient * depth > 0.0:
            return None
        return "E must stay positive down to the block's bottom", "raise E_gradient or take a shallower block"


@dataclass(frozen=True, eq=False)
class FrictionalSoil:
    """Elastic moduli (n,) [Pa]; the cone's slope M [-] and strength k [Pa] without mean stress; M' of its flow [-];
    initial stress (n, 6) [Pa].

    History (n, 7): stress and equivalent plastic strain (its deviator's).
    """

    bulk: Array
    shear: Array
    slope: float
    cohesion: float
    dilation: float
    initial: Array
    columns: ClassVar[tuple[str, ...]] = (*STRESS, PLASTIC_STRAIN)
    by_rate: ClassVar[bool] = False

    @property
    def symmetric(self) -> bool:
        return self.dilation == self.slope

    def start(self) -> Array:
        return np.column_stack((self.initial, np.zeros(len(self.bulk))))

    @cached_property
    def _elastic(self) -> Array:
        """Moduli (n, 6, 6) [Pa] where nothing yields."""
        return mandel.stiffness(self.bulk, self.shear)

    @cached_property
    def _resistance(self) -> Array:
        """3 G + K M M' (n,) [Pa]: fall of q + M σm by Δλ."""
        return 3.0 * self.shear + self.bulk * self.slope * self.dilation

    def update(self, strain_increment: Array, history: Array, dt: float = math.inf) -> StressUpdate:
        stress = history[:, :6] + mandel.elastic_stress(self.bulk, self.shear, strain_increment)
        tangent, slip = self._elastic.copy(), np.zeros(len(stress))
        q, excess = mandel.von_mises(stress), self._excess(stress)
        at_apex = 3.0 * self.shear * excess > q * self._resistance
        cone = np.flatnonzero((excess > 0.0) & ~at_apex)
        slip[cone] = excess[cone] / self._resistance[cone]
        tangent[cone] = self._tangent(cone, stress[cone], q[cone], slip[cone])
        stress[cone] = self._returned(cone, stress[cone], q[cone], slip[cone])
        apex = np.flatnonzero((excess > 0.0) & at_apex)
        slip[apex] = q[apex] / (3.0 * self.shear[apex])
        stress[apex] = self.cohesion / self.slope * mandel.UNIT
        tangent[apex] *= STIFFNESS_AT_APEX
        elastic = mandel.elastic_strain(self.bulk, self.shear, stress - self.initial)
        stored = 0.5 * mandel.product(stress - self.initial, elastic)
        return StressUpdate(stress, tangent, np.column_stack((stress, history[:, 6] + slip)), stored, elastic)

    def _excess(self, stress: Array) -> Array:
        return mandel.von_mises(stress) + self.slope * mandel.mean(stress) - self.cohesion

    def _returned(self, at: IntArray, trial: Array, q: Array, slip: Array) -> Array:
        """Stress on the cone; q is what the mean stress there allows, to round-off."""
        mean = mandel.mean(trial) - self.bulk[at] * self.dilation * slip
        allowed = np.maximum(self.cohesion - self.slope * mean, 0.0)
        return mean[:, None] * mandel.UNIT + (allowed / q)[:, None] * mandel.deviator(trial)

    def _tangent(self, at: IntArray, trial: Array, q: Array, slip: Array) -> Array:
        """K 1⊗1 + 2G (θ (P - n⊗n) + n⊗n) - (√6 G n + K M' 1)⊗b, with b = dΔλ/dε and θ = 1 - 3 G Δλ/q of the trial."""
        K, G = self.bulk[at], self.shear[at]
        n = mandel.deviator(trial) * (np.sqrt(1.5) / q)[:, None]
        theta = 1.0 - 3.0 * G * slip / q
        by_shear, by_volume = (np.sqrt(6.0) * G)[:, None] * n, K[:, None] * mandel.UNIT
        b = (by_shear + self.slope * by_volume) / self._resistance[at, None]
        moduli = mandel.stiffness(K, G * theta) - (by_shear + self.dilation * by_volume)[:, :, None] * b[:, None, :]
        moduli += (2.0 * G * (1.0 - theta))[:, None, None] * n[:, :, None] * n[:, None, :]
        return moduli

    def overstress(self, stress: Array) -> Array:
        return 1.0 + self._excess(stress) / (self.cohesion + self.slope * np.abs(mandel.mean(stress)))
