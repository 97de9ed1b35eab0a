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
from typing import ClassVar

import numpy as np

from riser_soil.contact.law import Penalty
from riser_soil.core.arrays import Array, BoolArray
from riser_soil.seabed.law import SeabedResponse


@dataclass(frozen=True)
class SuctionLaw:
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

    @property
    def start(self) -> float:
        return self.penalty.start

    def initial_history(self, shape: tuple[int, ...]) -> Array:
        return np.full((*shape, 1), np.inf)

    def active(self, penetration: Array, history: Array) -> BoolArray:
        in_tension = (-penetration < self.reach) & (history[..., 0] < self.reach)
        return self.penalty.active(penetration, history) | in_tension

    def update(self, penetration: Array, history: Array) -> SeabedResponse:
        pushed, w = self.penalty.update(penetration, history[..., :0]), self._opening(penetration)
        tension, stiffness = self._tension(w, history[..., 0])
        opened = np.maximum(-penetration[..., None], history)
        return SeabedResponse(
            pushed.force - tension,
            pushed.slope + stiffness,
            np.where(penetration[..., None] >= 0.0, 0.0, opened),
            pushed.stored + 0.5 * tension * w,
        )

    def _opening(self, penetration: Array) -> Array:
        """Opening as far as it matters [m]."""
        return np.clip(-penetration, 0.0, self.reach)

    def _tension(self, w: Array, widest: Array) -> tuple[Array, Array]:
        """Tension and its derivative by the opening w >= 0."""
        fall = self.cap / (self.reach - self._peak)
        at = np.clip(np.maximum(w, widest), self._peak, self.reach)
        secant = fall * (self.reach - at) / at
        falling = (w > np.maximum(widest, self._peak)) & (w < self.reach)
        stiffness = np.where(falling, -fall, np.where(w > 0.0, secant, 0.0))
        return secant * w, np.where(w < self.reach, stiffness, 0.0)
