"""Undrained clay: constants that its laws have in common, strength and stiffness by depth, bearing capacity."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Self

from pydantic import Field, model_validator

from riser_soil.core.lazy import LazyModule
from riser_soil.core.quantities import PoissonRatio, Ratio, StrengthGradient, StressOrNone, wrong
from riser_soil.seabed.bearing import Number, Strength, strip_capacity
from riser_soil.soil.law import Bearing, Formula, SoilLaw
from riser_soil.soil.rate import Rate
from riser_soil.soil.remoulding import RemouldedClay, Remoulding, WeakeningFormula

if TYPE_CHECKING:
    import numpy as np

    from riser_soil.core.arrays import Array
    from riser_soil.soil import mandel
else:
    np, mandel = LazyModule("numpy"), LazyModule("riser_soil.soil.mandel")


class UndrainedClay(SoilLaw, ABC):
    """Clay that fails at q = √3·su: su is the strength in simple shear and plane strain."""

    su: StressOrNone = Field(description="undrained shear strength at the seabed [Pa]; may be 0 if it grows from there")
    su_gradient: StrengthGradient = Field(default=0.0, description="growth of su with depth [Pa/m]")
    E_over_su: Ratio = Field(description="Young's modulus over su, the same at every depth [-]")
    nu: PoissonRatio = Field(default=0.49, description="Poisson's ratio [-]")
    remoulding: Remoulding | None = Field(
        default=None, description="{sensitivity, xi_95}: loss of strength with plastic strain; none by default"
    )

    rate: Rate | None = Field(
        default=None, description="{mu, reference}: gain of strength with the rate of shear; none by default"
    )

    @abstractmethod
    def intact(self, depth: Array, initial: Array) -> WeakeningFormula:
        """The formula of clay without remoulding; arguments as of `at_points`."""

    def at_points(self, depth: Array, initial: Array) -> Formula:
        intact = self.intact(depth, initial)
        return intact if self.remoulding is None else RemouldedClay(intact, self.remoulding)

    @model_validator(mode="after")
    def _has_a_strength(self) -> Self:
        if self.su == 0.0 and self.su_gradient <= 0.0:
            raise wrong("su", "must be above 0 where su_gradient is not", "raise su or su_gradient")
        return self

    @property
    def reference_rate(self) -> float | None:
        return None if self.rate is None else self.rate.reference

    def surface_modulus(self, width: float) -> float:
        """Young's modulus at the seabed [Pa]; of clay without strength there, that at half the width below it."""
        return self._modulus(self._strength.at(0.0 if self.su > 0.0 else 0.5 * width))

    @property
    def _strength(self) -> Strength:
        return Strength(self.su, self.su_gradient)

    def undrained_strength(self, depth: Number) -> Number:
        return self._strength.at(depth)

    def _modulus(self, strength: Number) -> Number:
        """Young's modulus of clay of that strength [Pa]."""
        return self.E_over_su * strength

    def _constants(self, depth: Array) -> tuple[Array, Array, Array]:
        """Bulk and shear modulus and the largest equivalent stress √3·su at depths (n,), (n,) each [Pa]."""
        strength = self._strength.at(depth)
        E = self._modulus(strength)
        return mandel.bulk_modulus(E, self.nu), mandel.shear_modulus(E, self.nu), np.sqrt(3.0) * strength

    def wrong_within(self, depth: float) -> tuple[str, str] | None:
        if self._strength.at(depth) > 0.0:
            return None
        return "su must stay positive down to the block's bottom", "raise su_gradient or take a shallower block"

    def bearing(self, width: float) -> Bearing:
        capacity = strip_capacity(self._strength, width)
        return Bearing(capacity, f"(2 + pi) su D + su_gradient D^2/4 with D = {width:.4g} m")
