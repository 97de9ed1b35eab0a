"""Penalty contact with suction: tension up to a cap on uplift, then softening and breakaway (cohesive law).

With the opening w = -penetration > 0, the stiffness k of the penalty, the cap p and the reach r, the tension is

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

from riser_soil.contact.law import Penalty, PenaltyNumbers, ramp
from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.seabed.compiled_law import CompiledLaw, answer, may_act


class SuctionNumbers(NamedTuple):
    """The penalty; cap p [N/m] and reach r [m] of the tension, and its place p/k [m]."""

    penalty: PenaltyNumbers
    cap: float
    reach: float
    peak: float


@may_act.of(SuctionNumbers)
def _may_act(law: SuctionNumbers, penetration: float, history: Array) -> bool:
    in_tension = -penetration < law.reach and history[0] < law.reach
    return in_tension or may_act(law.penalty, penetration, history)


@answer.of(SuctionNumbers)
def _answer(law: SuctionNumbers, penetration: float, history: Array, after: Array) -> tuple[float, float, float]:
    force, slope, stored = ramp(law.penalty, penetration)
    w = min(max(-penetration, 0.0), law.reach)  # as far as it matters
    tension, stiffness = _tension(law, w, history[0])
    after[0] = 0.0 if penetration >= 0.0 else max(-penetration, history[0])
    return force - tension, slope + stiffness, stored + 0.5 * tension * w


@njit
def _tension(law: SuctionNumbers, w: float, widest: float) -> tuple[float, float]:
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

    History (..., 1): largest opening [m] since the last touch, inf before the first.
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
    def numbers(self) -> SuctionNumbers:
        return SuctionNumbers(self.penalty.numbers, float(self.cap), float(self.reach), self._peak)

    @property
    def start(self) -> float:
        return self.penalty.start

    def initial_history(self, shape: tuple[int, ...]) -> Array:
        return np.full((*shape, 1), np.inf)
