"""Penalty law of normal contact, without and with suction, and the default penalty stiffness.

Penetration δ = −gap [m]; force f [N/m] pushes the two sides apart; f = dψ/dδ with the potential ψ [N].

Suction is tension up to a cap on uplift, then softening and breakaway (cohesive law). With the opening w = -penetration
> 0, the stiffness k of the penalty, the cap p and the reach r, the tension is

    k w up to the cap, then p (r - w)/(r - p/k), 0 beyond r.

The fall beyond the cap is spread over the reach instead of being sudden, so that the force is continuous within a
step. Between the largest opening wm since the last touch and the surface it follows the straight line from 0 to the
tension at wm: the loss of stiffness is permanent until the riser touches again. Breakaway takes p r/2 of energy per
length, all of it dissipated; unloading returns what reloading takes, so that no closed path gains work.
Bilinear cohesive law with secant unloading, as for delamination: M. Ortiz & A. Pandolfi, International Journal for
Numerical Methods in Engineering 44 (1999), here reset at the next contact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.seabed.compiled_law import CompiledLaw, answer, may_act
from riser_soil.seabed.law import SeabedResponse

#: Penetration of a riser at rest under its own weight, in outer diameters: small beside what a pipe's size
#: can show.
PENETRATION_AT_REST = 1e-3
#: Contact stiffness over Young's modulus at the surface. A strip that loads a half space settles by about
#: force per length over E, so the penalty adds about a tenth to the settlement that it passes on.
STIFFNESS_OVER_SOIL = 10.0
#: The same where pressure is integrated over the width that touches: some 3 per cent.
SURFACE_STIFFNESS_OVER_SOIL = 20.0


class PenaltyData(NamedTuple):
    """Stiffness k [N/m2] and smoothing s [m]."""

    stiffness: float
    smoothing: float


@njit
def ramp(law: PenaltyData, penetration: float) -> tuple[float, float, float]:
    """Force f [N/m], stiffness df/dδ [N/m2] and energy ψ [N] of a penalty law at a penetration [m], see `Penalty`."""
    k, s = law.stiffness, law.smoothing
    if abs(penetration) < s:
        within = penetration + s
        return k * within**2 / (4.0 * s), k * within / (2.0 * s), k * within**3 / (12.0 * s)
    if penetration > 0.0:
        return k * penetration, k, 0.5 * k * penetration**2 + k * s**2 / 6.0
    return 0.0, 0.0, 0.0


@may_act.of(PenaltyData)
def _may_act(law: PenaltyData, penetration: float, history: Array) -> bool:
    return penetration > -law.smoothing


@answer.of(PenaltyData)
def _answer(law: PenaltyData, penetration: float, history: Array, after: Array) -> tuple[float, float, float]:
    return ramp(law, penetration)


@dataclass(frozen=True)
class Penalty(CompiledLaw):
    """Ramp f = k·max(δ, 0) with its corner rounded over |δ| < s by the parabola k(δ + s)²/(4s).

    stiffness: k [N/m2]. smoothing: s [m], 0 for the plain ramp. f and df/dδ are continuous for s > 0; f ≥ 0
    always and f(0) = k·s/4: the force starts at a gap of s. Its potential is ψ = ∫f dδ, 0 out of contact.
    """

    stiffness: float
    smoothing: float = 0.0
    columns: ClassVar[tuple[str, ...]] = ()
    capacity: ClassVar[float] = math.inf

    @cached_property
    def kernel_data(self) -> PenaltyData:
        return PenaltyData(float(self.stiffness), float(self.smoothing))

    def force(self, penetration: Array) -> Array:
        """f [N/m], same shape as the penetration [m]."""
        return self._at(penetration).force

    def slope(self, penetration: Array) -> Array:
        """df/dδ [N/m2]."""
        return self._at(penetration).slope

    def potential(self, penetration: Array) -> Array:
        """ψ [N]."""
        return self._at(penetration).stored

    @property
    def start(self) -> float:
        return self.smoothing

    @property
    def reach(self) -> float:
        """Gap [m] from which on there is no force."""
        return self.smoothing

    def initial_history(self, shape: tuple[int, ...]) -> Array:
        return np.empty((*shape, 0))

    def _at(self, penetration: Array) -> SeabedResponse:
        return self.update(penetration, self.initial_history(penetration.shape))


def automatic_stiffness(
    E_soil: float | None, weight_per_length: float, outer_diameter: float, over_soil: float = STIFFNESS_OVER_SOIL
) -> float:
    """Penalty stiffness k [N/m2] from what touches: k = max(over_soil·E_soil, weight / (10⁻³·OD)).

    The first term keeps the penalty's give at about a tenth of the soil's own settlement; the second keeps
    the penetration of a riser at rest at a thousandth of its diameter. On a rigid floor (E_soil is None) the
    second is the only one: a larger k would lessen an error that is small already and raise the impact frequency
    √(k/m), hence the time step's cost. Where the reaction peaks at touchdown the penetration grows in
    proportion; the results have it.

    E_soil: Young's modulus at the soil's surface [Pa]. weight_per_length: submerged weight [N/m].
    outer_diameter: [m].
    """
    at_rest = weight_per_length / (PENETRATION_AT_REST * outer_diameter)
    return at_rest if E_soil is None else max(over_soil * E_soil, at_rest)


class SuctionData(NamedTuple):
    """The penalty; cap p [N/m] and reach r [m] of the tension, and its place p/k [m]."""

    penalty: PenaltyData
    cap: float
    reach: float
    peak: float


@may_act.of(SuctionData)
def _suction_may_act(law: SuctionData, penetration: float, history: Array) -> bool:
    in_tension = -penetration < law.reach and history[0] < law.reach
    return in_tension or may_act(law.penalty, penetration, history)


@answer.of(SuctionData)
def _suction_answer(law: SuctionData, penetration: float, history: Array, after: Array) -> tuple[float, float, float]:
    force, slope, stored = ramp(law.penalty, penetration)
    w = min(max(-penetration, 0.0), law.reach)  # as far as it matters
    tension, stiffness = _tension(law, w, history[0])
    after[0] = 0.0 if penetration >= 0.0 else max(-penetration, history[0])
    return force - tension, slope + stiffness, stored + 0.5 * tension * w


@njit
def _tension(law: SuctionData, w: float, widest: float) -> tuple[float, float]:
    """Tension and its derivative by the opening w >= 0."""
    if w >= law.reach:
        return 0.0, 0.0
    fall = law.cap / (law.reach - law.peak)
    at = min(max(w, widest, law.peak), law.reach)
    secant = fall * (law.reach - at) / at
    falling = w > max(widest, law.peak)
    return secant * w, -fall if falling else (secant if w > 0.0 else 0.0)


@dataclass(frozen=True)
class SuctionLaw(CompiledLaw):
    """Penalty law with suction: tension up to a cap on uplift, zero from an opening of `reach` on.

    penalty: the law in compression. cap [N/m], reach [m] > cap/stiffness: ValueError else.

    History (..., 1): largest opening [m] since the last touch, `reach` where nothing holds.
    """

    penalty: Penalty
    cap: float
    reach: float
    columns: ClassVar[tuple[str, ...]] = ("widest_opening",)
    capacity: ClassVar[float] = math.inf

    def __post_init__(self) -> None:
        if self.reach <= self._peak:
            raise ValueError(f"suction must reach farther than {self._peak:g} m, where it peaks; got {self.reach:g} m")

    @property
    def _peak(self) -> float:
        return self.cap / self.penalty.stiffness

    @cached_property
    def kernel_data(self) -> SuctionData:
        return SuctionData(self.penalty.kernel_data, float(self.cap), float(self.reach), self._peak)

    @property
    def start(self) -> float:
        return self.penalty.start

    def initial_history(self, shape: tuple[int, ...]) -> Array:
        return np.full((*shape, 1), self.reach)
