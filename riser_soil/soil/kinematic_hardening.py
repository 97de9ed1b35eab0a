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
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple

from pydantic import Field

from riser_soil.core.lazy import LazyModule
from riser_soil.core.quantities import Share
from riser_soil.soil.clay import UndrainedClay
from riser_soil.soil.law import PLASTIC_STRAIN, STRESS, StressUpdate
from riser_soil.soil.rate import Gain, Rate, gain_of

if TYPE_CHECKING:
    import numpy as np

    from riser_soil.core.arrays import Array, IntArray
    from riser_soil.soil import mandel
else:
    np, mandel = LazyModule("numpy"), LazyModule("riser_soil.soil.mandel")

BACKSTRESS = tuple(f"backstress_{component}" for component in ("xx", "yy", "zz", "xy", "xz", "yz"))
MOST_ITERATIONS, CONVERGED = 50, 1e-14  # of Δp; change over the largest that Δp may be
ROUND_OFF = 4e-15  # of |η| in the equation for Δp: a change that makes no more is none


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


class _Step(NamedTuple):
    """Of points that yield: direction n and η (m, 6), Δp, θ, -dθ/dΔp, and by how much the left side of the equation for
    Δp less its right side falls with Δp (m,).
    """

    n: Array
    eta: Array
    slip: Array
    theta: Array
    recall: Array
    falls: Array


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
        """As if the clay had been loaded to its initial stress: the elastic range lies around it."""
        return self._bounded(mandel.deviator(self.initial))

    def _bounded(self, s: Array) -> Array:
        """Deviators (n, 6), those beyond the backstress's bound brought back to it: it may have fallen."""
        bound = self.limit - self.elastic_limit
        return (bound / np.maximum(np.sqrt(1.5 * mandel.product(s, s)), bound))[:, None] * s

    @cached_property
    def _elastic(self) -> Array:
        """Moduli (n, 6, 6) [Pa] where nothing yields."""
        return mandel.stiffness(self.bulk, self.shear)

    @cached_property
    def _recall(self) -> Array:
        """γ (n,) [-]."""
        return self.hardening / (self.limit - self.elastic_limit)

    def update(
        self, strain_increment: Array, history: Array, dt: float = math.inf, strength: Array | float = 1.0
    ) -> StressUpdate:
        gain = gain_of(self.rate, dt)
        now = replace(self, limit=strength * self.limit, elastic_limit=strength * self.elastic_limit)
        stress = history[:, :6] + mandel.elastic_stress(self.bulk, self.shear, strain_increment)
        backstress = history[:, 7:].copy() if gain.gains else now._bounded(history[:, 7:])
        slip = np.zeros(len(stress))
        tangent = self._elastic.copy()
        relative = mandel.deviator(stress) - backstress
        at = np.flatnonzero(np.sqrt(1.5 * mandel.product(relative, relative)) > now.elastic_limit)
        if at.size and gain.flows:
            step = now._yielding(mandel.deviator(stress[at]), backstress[at], at, gain)
            tangent[at] = now._tangent(step, backstress[at], at)
            moved = step.slip[:, None] * step.n
            stress[at] -= np.sqrt(6.0) * self.shear[at, None] * moved
            hardened = backstress[at] + np.sqrt(2.0 / 3.0) * self.hardening[at, None] * moved
            backstress[at] = step.theta[:, None] * hardened
            slip[at] = step.slip
        after = np.column_stack((stress, history[:, 6] + slip, backstress))
        elastic = mandel.elastic_strain(self.bulk, self.shear, stress - self.initial)
        stored = 0.5 * mandel.product(stress - self.initial, elastic) + self._locked_in(backstress)
        return StressUpdate(stress, tangent, after, stored - self._locked_in_first, elastic)

    @cached_property
    def _locked_in_first(self) -> Array:
        return self._locked_in(self._first_backstress)

    def _locked_in(self, backstress: Array) -> Array:
        """Energy of the backstress (n,) [J/m3]."""
        return 0.75 / self.hardening * mandel.product(backstress, backstress)

    def _yielding(self, trial: Array, backstress: Array, at: IntArray, gain: Gain) -> _Step:
        """Δp by Newton's method, kept where the root is known to lie."""
        C, recall, stiff = self.hardening[at], self._recall[at], np.sqrt(6.0) * self.shear[at]
        root, first = np.sqrt(2.0 / 3.0), self.elastic_limit[at]

        def excess(slip: Array) -> tuple[Array, _Step]:
            factor, slope = gain.factor(slip)
            y = slip / factor
            theta = 1.0 / (1.0 + recall * y)
            eta = trial - theta[:, None] * backstress
            size = mandel.size(eta)
            n = eta / size[:, None]
            recalls = recall * theta**2 * (1.0 - y * slope) / factor
            hardens = C * theta**2 * (1.0 + recall * y**2 * slope) + first * slope
            falls = stiff + root * hardens - recalls * mandel.product(n, backstress)
            found = size - root * (factor * first + C * theta * slip) - stiff * slip
            return found, _Step(n, eta, slip, theta, recalls, falls)

        low: Array = np.zeros(len(at))
        found, step = excess(low)
        high: Array = found / stiff
        if gain.gains:  # α may be beyond its bound
            high += mandel.size(backstress) / stiff
            found, step = excess(np.clip(gain.slip(first + found / root, first, step.falls / root), low, high))
        least = np.maximum(CONVERGED * high, ROUND_OFF / stiff * mandel.size(step.eta))
        for _ in range(MOST_ITERATIONS):
            better = step.slip + found / step.falls
            better = np.where((better < low) | (better > high), 0.5 * (low + high), better)
            done = np.abs(better - step.slip) <= least
            found, step = excess(better)
            low, high = np.where(found > 0.0, better, low), np.where(found < 0.0, better, high)
            if done.all():
                break
        return step

    def _tangent(self, step: _Step, backstress: Array, at: IntArray) -> Array:
        """Consistent: dΔp = 2G n:dε/h; the direction turns with the strain and with what the backstress recalls, by
        b = 2G P dε + recall α dΔp across n, over |η|.
        """
        G, n = self.shear[at], step.n
        share = np.sqrt(6.0) * G * step.slip / mandel.size(step.eta)
        across = backstress - mandel.product(n, backstress)[:, None] * n
        turns = n + (step.slip / mandel.size(step.eta) * step.recall)[:, None] * across
        along = (np.sqrt(6.0) * G / step.falls)[:, None] * turns - share[:, None] * n
        flow = along[:, :, None] * ((2.0 * G)[:, None] * n)[:, None, :]
        return mandel.stiffness(self.bulk[at], G * (1.0 - share)) - flow

    def overstress(self, stress: Array) -> Array:
        return mandel.von_mises(stress) / self.limit
