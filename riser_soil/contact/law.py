"""Penalty law of normal contact: force per length by penetration, and the default penalty stiffness.

Penetration δ = −gap [m]; force f [N/m] pushes the two sides apart; f = dψ/dδ with the potential ψ [N].
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.seabed.law import SeabedResponse

#: Penetration of a riser at rest under its own weight, in outer diameters: small beside what a pipe's size
#: can show.
PENETRATION_AT_REST = 1e-3
#: Contact stiffness over Young's modulus at the surface. A strip that loads a half space settles by about
#: force per length over E, so the penalty adds about a tenth to the settlement that it passes on.
STIFFNESS_OVER_SOIL = 10.0
#: The same where pressure is integrated over the width that touches: some 3 per cent.
SURFACE_STIFFNESS_OVER_SOIL = 20.0


@dataclass(frozen=True)
class Penalty:
    """Ramp f = k·max(δ, 0) with its corner rounded over |δ| < s by the parabola k(δ + s)²/(4s).

    stiffness: k [N/m2]. smoothing: s [m], 0 for the plain ramp. f and df/dδ are continuous for s > 0; f ≥ 0
    always and f(0) = k·s/4: the force starts at a gap of s.
    """

    stiffness: float
    smoothing: float = 0.0
    columns: ClassVar[tuple[str, ...]] = ()
    capacity: ClassVar[float] = math.inf

    def force(self, penetration: Array) -> Array:
        """f [N/m], same shape as the penetration [m]."""
        k, s = self.stiffness, self.smoothing
        ramp = k * np.maximum(penetration, 0.0)
        return np.where(self._rounded(penetration), k * (penetration + s) ** 2 / self._width(4.0), ramp)

    def slope(self, penetration: Array) -> Array:
        """df/dδ [N/m2]."""
        k, s = self.stiffness, self.smoothing
        step = k * (penetration > 0.0)
        return np.where(self._rounded(penetration), k * (penetration + s) / self._width(2.0), step)

    def potential(self, penetration: Array) -> Array:
        """ψ = ∫f dδ [N], 0 out of contact."""
        k, s = self.stiffness, self.smoothing
        parabola = np.where(penetration > 0.0, 0.5 * k * penetration**2 + k * s**2 / 6.0, 0.0)
        return np.where(self._rounded(penetration), k * (penetration + s) ** 3 / self._width(12.0), parabola)

    @property
    def start(self) -> float:
        return self.smoothing

    @property
    def reach(self) -> float:
        """Gap [m] from which on there is no force."""
        return self.smoothing

    def initial_history(self, shape: tuple[int, ...]) -> Array:
        return np.empty((*shape, 0))

    def active(self, penetration: Array, history: Array) -> BoolArray:
        return penetration > -self.smoothing

    def update(self, penetration: Array, history: Array) -> SeabedResponse:
        return SeabedResponse(self.force(penetration), self.slope(penetration), history, self.potential(penetration))

    def _rounded(self, penetration: Array) -> BoolArray:
        return np.abs(penetration) < self.smoothing

    def _width(self, factor: float) -> float:
        """factor·s, or 1 where s = 0 and the rounded branch is empty."""
        return factor * self.smoothing if self.smoothing > 0.0 else 1.0


def automatic_stiffness(
    E_soil: float | None, weight_per_length: float, outer_diameter: float, over_soil: float = STIFFNESS_OVER_SOIL
) -> float:
    """Penalty stiffness k [N/m2] from what touches: k = max(over_soil·E_soil, weight / (10⁻³·OD)).

    The first term keeps the penalty's give at about a tenth of the soil's own settlement; the second keeps
    the penetration of a riser at rest at a thousandth of its diameter. On a rigid floor (E_soil is None) the
    second stands alone: a larger k would lessen an error that is small already and raise the impact frequency
    √(k/m), hence the time step's cost. Where the reaction peaks at touchdown the penetration grows in
    proportion; it is reported with the results.

    E_soil: Young's modulus at the soil's surface [Pa]. weight_per_length: submerged weight [N/m].
    outer_diameter: [m].
    """
    at_rest = weight_per_length / (PENETRATION_AT_REST * outer_diameter)
    return at_rest if E_soil is None else max(over_soil * E_soil, at_rest)
