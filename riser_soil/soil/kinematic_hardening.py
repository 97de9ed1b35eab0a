"""Cyclic clay by von Mises plasticity with nonlinear kinematic hardening: one backstress, Armstrong & Frederick's.

    f = √(3/2) |s - α| - q0 ≤ 0,   Δα = (2/3) C Δεp - γ α Δp,   Δεp = √(3/2) Δp n,   n = (s - α)/|s - α|

with α bounded by √(3/2) |α| = C/γ, so that q = q0 + C/γ = √3·su at failure. Parameters from su, the modulus and the
share of the strength that is elastic as in Anastasopoulos et al., Simplified constitutive model for simulation of
cyclic response of shallow foundations, J. Geotech. Geoenviron. Eng. 137 (2011), from memory, as the source could not
be read: C = E, γ = C/(√3·su - q0). Backward Euler: with θ = 1/(1 + γ Δp) and η = s_trial - θ α, the direction n is that
of η, and Δp solves

    |η| = √(2/3) (q0 + C θ Δp) + √6 G Δp.

Its left side less the right falls with Δp, by √6 G at least, so that the root is one and Newton's method finds it.

With a rate of shear (see `rate`) that makes clay r times as strong, r q0 stands for q0 and γ/r for γ: at a steady rate
loops are those of clay with r su. With y = Δp/r, θ = 1/(1 + γ y) and r' = dr/dΔp, dy/dΔp = (1 - y r')/r and
d(θ Δp)/dΔp = θ² (1 + γ y² r'). When flow slows down α falls by what it recalls, within a strain of some 1/γ.

The backstress fades with slip in either direction. In simple shear dα = k (a ∓ α) dγp, with a = (1 - share) su and k =
γ/√3 = C/(3 a), so that slip is easier towards the bound than away from it. Cycles of stress add the same strain each
time (J. Lemaitre, J.-L. Chaboche, Mechanics of Solid Materials, 1990, section 5.4; there in tension),

    (1/k) ln[(a² - αmin²)/(a² - αmax²)],   αmin = τmin + share su,   αmax = τmax - share su,

and of a small mean stress a cycle of strain, in which the backstress goes from -m to m and back, leaves

    r²,   r = (a - m)(G + k (a + m)) / ((a + m)(G + k (a - m))),

as a difference between two ways goes with the slope dα/dγ = G H/(G + H), H = k (a ∓ α), from their first to their last.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal

from pydantic import Field

from riser_soil.core.lazy import LazyModule
from riser_soil.core.quantities import Share
from riser_soil.soil.clay import UndrainedClay
from riser_soil.soil.law import PLASTIC_STRAIN, STRESS, StressUpdate
from riser_soil.soil.rate import Rate, gain_of

if TYPE_CHECKING:
    import numpy as np

    from riser_soil.core.arrays import Array
    from riser_soil.soil import cyclic_return, mandel
else:
    np, mandel = LazyModule("numpy"), LazyModule("riser_soil.soil.mandel")
    cyclic_return = LazyModule("riser_soil.soil.cyclic_return")

BACKSTRESS = tuple(f"backstress_{component}" for component in ("xx", "yy", "zz", "xy", "xz", "yz"))


class KinematicHardening(UndrainedClay):
    """Undrained clay under cyclic load: it yields early, hardens up to su, and remembers in which direction."""

    kind: Literal["kinematic-hardening"] = Field(description="the law's name")
    elastic_share: Share = Field(
        default=0.1, description="share of su up to which undisturbed clay is elastic, below 1 [-]"
    )

    @property
    def forgets_at(self) -> float:
        """By r² = 1/2, a quadratic equation in x = m/a: κ (1 - r) x² + (1 + r) x = (1 + κ)(1 - r), κ = k a/G."""
        a, slope, r = 1.0 - self.elastic_share, 2.0 * (1.0 + self.nu) / 3.0, math.sqrt(0.5)
        G, k = self.E_over_su / (3.0 * slope), self.E_over_su / (3.0 * a)  # in su
        constant = (1.0 + slope) * (1.0 - r)
        x = 2.0 * constant / (1.0 + r + math.sqrt((1.0 + r) ** 2 + 4.0 * slope * (1.0 - r) * constant))
        return (a * x + self.elastic_share) / G + math.atanh(x) / k

    def intact(self, depth: Array, initial: Array) -> CyclicClay:
        bulk, shear, limit = self._constants(depth)
        hardening = 9.0 * bulk * shear / (3.0 * bulk + shear)  # Young's modulus
        return CyclicClay(bulk, shear, limit, self.elastic_share * limit, hardening, initial, self.rate)


@dataclass(frozen=True, eq=False)
class CyclicClay:
    """Elastic moduli, largest equivalent stress, equivalent stress q0 at first yield, hardening modulus C, each (n,),
    and initial stress (n, 6) [Pa]; strengths in slow shear.

    History (n, 13): stress, equivalent plastic strain, backstress. The backstress stores 3/(4 C) α:α, which comes back
    or stays in the soil.
    """

    bulk: Array
    shear: Array
    limit: Array
    elastic_limit: Array
    hardening: Array
    initial: Array
    rate: Rate | None = None
    columns: ClassVar[tuple[str, ...]] = (*STRESS, PLASTIC_STRAIN, *BACKSTRESS)
    symmetric: ClassVar[bool] = False

    @property
    def by_rate(self) -> bool:
        return self.rate is not None

    def start(self) -> Array:
        return np.column_stack((self.initial, np.zeros(len(self.limit)), self._first_backstress))

    @cached_property
    def _first_backstress(self) -> Array:
        """Backstress (n, 6) [Pa] as if the clay had been loaded to its initial stress: the elastic range lies around
        it.
        """
        first = mandel.deviator(self.initial)
        cyclic_return.bring_within(self.limit - self.elastic_limit, first)
        return first

    def update(
        self, strain_increment: Array, history: Array, dt: float = math.inf, strength: Array | float = 1.0
    ) -> StressUpdate:
        gain, limits = gain_of(self.rate, dt), (strength * self.limit, strength * self.elastic_limit)
        clay = cyclic_return.Clay(self.bulk, self.shear, *limits, self.hardening, self.initial)
        stress, tangent, elastic = (np.empty((len(history), *shape)) for shape in ((6,), (6, 6), (6,)))
        out = StressUpdate(stress, tangent, np.empty_like(history), np.empty(len(history)), elastic)
        cyclic_return.update(clay, gain, strain_increment, history, out)
        return out._replace(stored=out.stored - self._locked_in_first)

    @cached_property
    def _locked_in_first(self) -> Array:
        """Energy of the first backstress (n,) [J/m3]."""
        out = np.empty_like(self.bulk)
        cyclic_return.write_locked_in(self.hardening, self._first_backstress, out)
        return out

    def overstress(self, stress: Array) -> Array:
        return mandel.von_mises(stress) / self.limit
