"""Remoulding of clay: its strength falls with the plastic shear strain that it has gone through.

    δ = δ_rem + (1 - δ_rem) exp(-3 ξ/ξ95),   δ_rem = 1/sensitivity

is the strength over that of intact clay, ξ the plastic shear strain summed up without regard to its sign, √3 times the
equivalent plastic strain. I. Einav & M. F. Randolph, Combining upper bound and strain path methods for evaluating
penetration resistance, Int. J. Numer. Methods Eng. 63 (2005), from memory, as the source could not be read; for their
factor by the rate of strain see `rate`. The factor of a step is that of ξ at its start, so that the tangent stays
consistent; the error is of first order in the increment of ξ. The stiffness stays. Softening concentrates strain within
the width of a cell: what follows from it depends on the mesh.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Protocol

from pydantic import BaseModel, Field

from riser_soil.core.lazy import LazyModule
from riser_soil.core.quantities import FROZEN, Ratio
from riser_soil.soil.law import PLASTIC_STRAIN, Formula, StressUpdate

if TYPE_CHECKING:
    import numpy as np

    from riser_soil.core.arrays import Array
else:
    np = LazyModule("numpy")


class Remoulding(BaseModel):
    """Loss of strength with plastic shear strain."""

    model_config = FROZEN

    sensitivity: Annotated[Ratio, Field(ge=1)] = Field(
        description="intact over fully remoulded strength, usually 2 to 6 [-]"
    )
    xi_95: Ratio = Field(
        description="accumulated plastic shear strain that takes 95 % of what can be lost, usually 10 to 50 [-]"
    )

    def factor(self, plastic: Array) -> Array:
        """Strength over that of intact clay (n,) after an equivalent plastic strain (n,)."""
        remoulded = 1.0 / self.sensitivity
        return remoulded + (1.0 - remoulded) * np.exp(-3.0 * np.sqrt(3.0) * plastic / self.xi_95)


class WeakeningFormula(Formula, Protocol):
    """A formula whose strength may fall from step to step."""

    def update(
        self, strain_increment: Array, history: Array, dt: float = math.inf, strength: Array | float = 1.0
    ) -> StressUpdate:
        """strength: that of this step over the intact one, (n,) or one for all."""
        ...


@dataclass(frozen=True, eq=False)
class RemouldedClay:
    """Clay that weakens by its equivalent plastic strain, which its history holds."""

    clay: WeakeningFormula
    remoulding: Remoulding

    @property
    def columns(self) -> tuple[str, ...]:
        return self.clay.columns

    @property
    def symmetric(self) -> bool:
        return self.clay.symmetric

    @property
    def by_rate(self) -> bool:
        return self.clay.by_rate

    @property
    def bulk(self) -> Array:
        return self.clay.bulk

    @property
    def shear(self) -> Array:
        return self.clay.shear

    def start(self) -> Array:
        return self.clay.start()

    def update(self, strain_increment: Array, history: Array, dt: float = math.inf) -> StressUpdate:
        return self.clay.update(strain_increment, history, dt, self.strength(history))

    def strength(self, history: Array) -> Array:
        """Strength over that of intact clay (n,) in a step that begins with this history."""
        return self.remoulding.factor(history[:, self.columns.index(PLASTIC_STRAIN)])

    def overstress(self, stress: Array) -> Array:
        return self.clay.overstress(stress)
