"""Hysteretic seabed of Randolph & Quiggin: hyperbolic penetration, uplift with suction, softened repenetration.

Source: M. Randolph & P. Quiggin, Non-linear hysteretic seabed model for catenary pipeline contact, OMAE2009-79236.
With z the penetration, D the diameter, zeta = z Kmax/D, x = |z - z0| Kmax/D since the last turn at (z0, P0):

    ultimate resistance   Pu(z) = Nc su(z) D,  Nc = a (z/D)^b, below z/D = 0.1 Nc(0.1) sqrt(10 z/D)          (1)
    first penetration     P1(z) = Pu(z) zeta/(1 + zeta)                                                      (2)
    uplift                P = Ps + S^2/(S + Pu(z0) x),  S = P0 - Ps,  Ps = -f_suc s d Pu(z)                  (3)
    repenetration         P = Pu(z) - T^2/(T + Pu(z) x),  T = Pu(z) - P0                                     (4)
    bound, both ways      P <= e^min(0, -lambda_rep (1 - c d) + max(0, z - zm)/zm) P1(z)                     (5)
    decay in uplift       d = e^-((z0 - z)/(lambda_suc zm))                                                  (6)

zm is the largest penetration of all; s and c, 0 to 1, are the share of suction available at the next uplift and the
intactness of the clay. Both are 1 at first touch, decay by (6) and are 0 after the pipe has left the ground; s recovers
to P/P1 where the pipe is pressed again, c by penetrating beyond zm. (3) with P0 + f_suc Pu in place of S is the usual
form P0 - x/(S/Pu(z0) + x) S, and (4) from the origin is (2). The soil's buoyancy adds f_b gamma' A(z), A the area
displaced.

Certainty. Read in an extract of the manual of a program with the model (OrcaFlex): su(z), Nc with its square root (1),
f_suc as the ratio of suction to Pu, zeta, the start (z0, P0) of an episode, the order of the modes, no force out of
contact; in the abstract of the paper: hyperbolae for the three ways whose parameters change at each reversal, stiffness
Kmax. From memory: (2), (3) without s and d, the hyperbolic form of (4), and all default numbers. Own choices, where
these sources leave a gap: the reference Pu(z) in (4), the exponential (5, 6) with s and c, and the bound (5) in uplift
as well, which makes P vanish continuously at the surface and keeps the first half millimetre, where (2) is steeper than
Pu Kmax/D, from giving back more than it took. c does not recover by small movements, for else a pipe that trembles
could climb from a soft return back to the first curve and gain work in a cycle.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple

from pydantic import Field

from riser_soil.core.lazy import LazyModule
from riser_soil.core.quantities import Coefficient, NonNegative, PositiveStrengthGradient, Ratio, Stress, UnitWeight
from riser_soil.seabed.bearing import SHALLOW, PowerLaw, Strength, displaced
from riser_soil.seabed.law import SeabedLaw, SeabedResponse

if TYPE_CHECKING:
    import numpy as np

    from riser_soil.core.arrays import Array, BoolArray
else:
    np = LazyModule("numpy")

TINY = 1e-30


class RandolphQuiggin(SeabedLaw):
    """Hysteretic law of Randolph & Quiggin (2009); `riser_soil.seabed.randolph_quiggin` tells what is certain of it."""

    kind: Literal["randolph-quiggin"] = Field(description="the law's name")
    su: Stress = Field(description="undrained shear strength at the surface [Pa]")
    su_gradient: PositiveStrengthGradient = Field(default=0.0, description="its growth with depth [Pa/m]")
    unit_weight: UnitWeight = Field(default=0.0, description="submerged unit weight, for the soil's buoyancy [N/m3]")
    a: Ratio = Field(default=6.0, description="factor of the bearing capacity a (z/D)^b [-]")
    b: NonNegative = Field(default=0.25, lt=1.0, description="power of the bearing capacity a (z/D)^b [-]")
    K_max: Ratio = Field(default=200.0, description="greatest stiffness, over the ultimate pressure [-]")
    f_suc: NonNegative = Field(default=0.6, lt=1.0, description="suction over the ultimate resistance [-]")
    lambda_suc: Ratio = Field(default=1.0, description="decay length of suction over the greatest penetration [-]")
    lambda_rep: Coefficient = Field(default=0.3, description="softening of repenetration [-]")
    f_b: Coefficient = Field(default=1.5, description="factor of the soil's buoyancy [-]")

    def of_pipe(self, diameter: float) -> RandolphQuigginFormula:
        return RandolphQuigginFormula(diameter, self)


class RandolphQuigginHistory(NamedTuple):
    """History of a point: whether it went down, penetration z [m] and resistance P [N/m] where it is, z0, P0 where it
    last turned, largest penetration zm [m] when it turned; suction s and wholeness c when it turned.
    """

    down: Array
    z: Array
    P: Array
    z0: Array
    P0: Array
    zm: Array
    s: Array
    c: Array

    @classmethod
    def of(cls, history: Array) -> RandolphQuigginHistory:
        return cls(*np.moveaxis(history, -1, 0))


@dataclass(frozen=True)
class RandolphQuigginFormula:
    """The clay under a pipe of one diameter [m]; see the module's text."""

    diameter: float
    given: RandolphQuiggin
    columns: ClassVar[tuple[str, ...]] = RandolphQuigginHistory._fields

    @cached_property
    def _ultimate(self) -> PowerLaw:
        clay = self.given
        return PowerLaw(self.diameter, Strength(clay.su, clay.su_gradient), clay.a, clay.b, SHALLOW)

    @property
    def _per_metre(self) -> float:
        """x over |z - z0| [1/m]."""
        return self.given.K_max / self.diameter

    @property
    def capacity(self) -> float:
        """Ultimate resistance [N/m] one diameter deep."""
        return float(self._ultimate.resistance(np.array(self.diameter))[0])

    @property
    def start(self) -> float:
        return 0.0

    @property
    def reach(self) -> float:
        return 0.0

    def initial_history(self, shape: tuple[int, ...]) -> Array:
        return _out_of_contact(np.zeros(shape))

    def active(self, penetration: Array, history: Array) -> BoolArray:
        return penetration > 0.0

    def update(self, penetration: Array, history: Array) -> SeabedResponse:
        """Stored is what a rebound at the greatest stiffness would give back, and the potential of buoyancy."""
        z = np.maximum(penetration, 0.0)
        now = self._continued(z, RandolphQuigginHistory.of(history))
        P, slope = self._clay(z, now)
        there = np.stack(now._replace(z=z, P=P), axis=-1)
        rebound = 0.5 * P**2 / np.maximum(self._per_metre * self._ultimate.resistance(z)[0], TINY)
        volume, area, width = displaced(z, self.diameter)
        weight = self.given.f_b * self.given.unit_weight
        return SeabedResponse(
            P + weight * area,
            slope + weight * width,
            np.where((z > 0.0)[..., None], there, _out_of_contact(now.zm)),
            rebound + weight * volume,
        )

    def _first(self, z: Array) -> tuple[Array, Array]:
        """Resistance (2) to a first penetration, and its slope."""
        Pu, dPu = self._ultimate.resistance(z)
        x: Array = self._per_metre * np.maximum(z, 0.0)
        share: Array = x / (1.0 + x)
        rise: Array = dPu * share + Pu * self._per_metre / (1.0 + x) ** 2
        return Pu * share, rise

    def _continued(self, z: Array, past: RandolphQuigginHistory) -> RandolphQuigginHistory:
        down = np.where(z == past.z, past.down > 0.0, z > past.z)
        lifted, sunk = self._after_uplift(past), self._after_sinking(past)
        turned = [np.where(down, a, b) for a, b in zip(lifted, sunk, strict=True)]
        kept = past[3:]
        went_on = down == (past.down > 0.0)
        rest = (np.where(went_on, a, b) for a, b in zip(kept, turned, strict=True))
        return RandolphQuigginHistory(down * 1.0, past.z, past.P, *rest)

    def _after_uplift(self, past: RandolphQuigginHistory) -> tuple[Array, ...]:
        d = np.exp(-np.maximum(past.z0 - past.z, 0.0) / self._decay_length(past))
        return past.z, past.P, past.zm, past.s * d, past.c * d

    def _after_sinking(self, past: RandolphQuigginHistory) -> tuple[Array, ...]:
        beyond = np.maximum(past.z - past.zm, 0.0) / np.maximum(self.given.lambda_rep * past.zm, TINY)
        pressed = past.P / np.maximum(self._first(past.z)[0], TINY)
        s = np.clip(pressed, past.s, 1.0)
        return past.z, past.P, np.maximum(past.zm, past.z), s, np.minimum(past.c + beyond, 1.0)

    def _decay_length(self, past: RandolphQuigginHistory) -> Array:
        return np.maximum(self.given.lambda_suc * past.zm, TINY)

    def _clay(self, z: Array, past: RandolphQuigginHistory) -> tuple[Array, Array]:
        """Resistance without buoyancy, and its slope."""
        down = past.down > 0.0
        length = self._decay_length(past)
        d = np.where(down, 1.0, np.exp(-np.maximum(past.z0 - z, 0.0) / length))
        sinking, rising = self._repenetration(z, past), self._uplift(z, past, d, d / length)
        bound, bound_slope = self._bound(z, past, d, np.where(down, 0.0, d / length))
        P, slope = (np.where(down, a, b) for a, b in zip(sinking, rising, strict=True))
        free = bound > P
        value, derivative = np.where(free, P, bound), np.where(free, slope, bound_slope)
        return np.where(z > 0.0, value, 0.0), np.where(z > 0.0, derivative, 0.0)

    def _uplift(self, z: Array, past: RandolphQuigginHistory, d: Array, dd: Array) -> tuple[Array, Array]:
        Pu, dPu = self._ultimate.resistance(z)
        suction, dsuction = -self.given.f_suc * past.s * d * Pu, -self.given.f_suc * past.s * (d * dPu + dd * Pu)
        S = np.maximum(past.P0 - suction, 0.0)
        stiff = self._ultimate.resistance(past.z0)[0]
        whole = np.maximum(S + stiff * self._per_metre * np.maximum(past.z0 - z, 0.0), TINY)
        part = S / whole
        dS = np.where(S > 0.0, -dsuction, 0.0)
        return suction + S * part, dsuction + 2.0 * part * dS - part**2 * (dS - stiff * self._per_metre)

    def _repenetration(self, z: Array, past: RandolphQuigginHistory) -> tuple[Array, Array]:
        Pu, dPu = self._ultimate.resistance(z)
        T, x = Pu - past.P0, self._per_metre * np.maximum(z - past.z0, 0.0)
        part = T / np.maximum(T + Pu * x, TINY)
        return Pu - T * part, dPu - 2.0 * part * dPu + part**2 * (dPu * (1.0 + x) + Pu * self._per_metre)

    def _bound(self, z: Array, past: RandolphQuigginHistory, d: Array, dd: Array) -> tuple[Array, Array]:
        """Resistance of clay as whole as it is, and its slope; dd: derivative of d."""
        first, slope = self._first(z)
        zm = np.maximum(past.zm, TINY)
        exponent = -self.given.lambda_rep * (1.0 - past.c * d) + np.maximum(z - zm, 0.0) / zm
        soft = np.exp(np.minimum(exponent, 0.0))
        by_z = self.given.lambda_rep * past.c * dd + np.where(z > zm, 1.0, 0.0) / zm
        return soft * first, soft * (slope + np.where(exponent < 0.0, by_z * first, 0.0))


def _out_of_contact(zm: Array) -> Array:
    """History of points above the surface, the deepest that they have been being zm, 0 for never."""
    none, whole = np.zeros_like(zm), np.where(zm > 0.0, 0.0, 1.0)
    return np.stack([np.ones_like(zm), none, none, none, none, zm, whole, whole], axis=-1)
