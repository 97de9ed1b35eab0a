"""Hysteretic seabed of Aubeny & Biscontin: backbone, bounding loop with suction, and reversals within.

Source: C. Aubeny & G. Biscontin, Seafloor-riser interaction model, International Journal of Geomechanics 9 (2009).
With y the penetration and (y1, P1) the deepest point so far, which lies on the backbone:

    backbone             Pb(y) = a (y/D)^b su(y) D                                                         (1)
    rebound, 1 to 2      P = P1 - d/(1/k + d/((1 + omega) P1)),  d = y1 - y,  to P2 = -phi P1              (2)
    separation, 2 to 3   P = P2/2 + P2/4 (3 t - t^3),  t from 1 at y2 to -1 at y3;  y2 - y3 = psi (y1 - y2)  (3)
    no contact           P = 0 above y3
    reloading, 3 to 1    P = P1/2 + P1/4 (3 t - t^3),  t from -1 at y3 to 1 at y1                          (4)
    turn at (yr, Pr)     P = Pr + d/(1/k + |d|/((1 + omega) P1)),  d = y - yr                              (5)

(2) and (3) are the loop's lower edge, (4) the upper one; (5) holds between them, and (1) beyond y1: from the lower
edge, (5) meets (y1, P1) and would rise above (1).

Certainty: of its make-up (backbone, bounding loop of four parameters, turns from and within the loop, partial and full
separation) the contents of the report that it grew from (C. Aubeny, G. Biscontin & J. Zhang, Seafloor interaction with
steel catenary risers, OTRC 9/06A173) and the abstract of a thesis (Y. Jiao, Texas A&M University, 2007) were read, not
the paper. The formulas and numbers are from memory: a = 6.73, b = 0.29 for a rough pipe in a trench up to half a
diameter deep, k/su = 660, omega = 0.433, phi = 0.203, psi = 0.661. Own choices: the backbone begins with the slope k,
as (1) is upright at the surface; where the loop would reach above the surface (y3 < 0, at small penetrations), phi,
psi and 1/(1 + omega) shrink together until y3 = 0, so that a pipe that rests on the first slope feels elastic ground;
the upper edge is nowhere below the lower.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple

from pydantic import Field

from riser_soil.core.lazy import LazyModule
from riser_soil.core.quantities import NonNegative, PositiveStrengthGradient, Ratio, Stress
from riser_soil.seabed.bearing import PowerLaw, Strength
from riser_soil.seabed.law import SeabedLaw, SeabedResponse

if TYPE_CHECKING:
    import numpy as np

    from riser_soil.core.arrays import Array, BoolArray
else:
    np = LazyModule("numpy")

TINY = 1e-30


class AubenyBiscontin(SeabedLaw):
    """Hysteretic law of Aubeny & Biscontin (2009); `riser_soil.seabed.aubeny_biscontin` tells what is certain of it."""

    kind: Literal["aubeny-biscontin"] = Field(description="the law's name")
    su: Stress = Field(description="undrained shear strength at the surface [Pa]")
    su_gradient: PositiveStrengthGradient = Field(default=0.0, description="its growth with depth [Pa/m]")
    a: Ratio = Field(default=6.73, description="factor of the backbone a (y/D)^b [-]")
    b: NonNegative = Field(default=0.29, lt=1.0, description="power of the backbone a (y/D)^b [-]")
    k_over_su: Ratio = Field(default=660.0, description="initial stiffness over the shear strength [-]")
    omega: Ratio = Field(default=0.433, description="asymptote of the rebound [-]")
    phi: NonNegative = Field(default=0.203, lt=1.0, description="suction over the resistance before the uplift [-]")
    psi: Ratio = Field(default=0.661, description="length of the separation over that of the rebound [-]")

    def of_pipe(self, diameter: float) -> AubenyBiscontinFormula:
        return AubenyBiscontinFormula(diameter, self)


class AubenyBiscontinHistory(NamedTuple):
    """History of a point: whether it went down, penetration z [m] and resistance P [N/m] where it is, z0, P0 where it
    last turned, and the largest penetration z1 when it turned.
    """

    down: Array
    z: Array
    P: Array
    z0: Array
    P0: Array
    z1: Array

    @classmethod
    def of(cls, history: Array) -> AubenyBiscontinHistory:
        return cls(*np.moveaxis(history, -1, 0))


class BoundingLoop(NamedTuple):
    """Bounding loop: deepest point y1, P1; stiffness k [N/m2]; 1/((1 + omega) P1); greatest tension; y2 and y3."""

    y1: Array
    P1: Array
    k: Array
    bend: Array
    tension: Array
    y2: Array
    y3: Array


@dataclass(frozen=True)
class AubenyBiscontinFormula:
    """The seafloor under a pipe of one diameter [m]; see the module's text."""

    diameter: float
    given: AubenyBiscontin
    columns: ClassVar[tuple[str, ...]] = AubenyBiscontinHistory._fields

    @cached_property
    def _strength(self) -> Strength:
        return Strength(self.given.su, self.given.su_gradient)

    @cached_property
    def _power_law(self) -> PowerLaw:
        return PowerLaw(self.diameter, self._strength, self.given.a, self.given.b)

    @property
    def capacity(self) -> float:
        """Resistance of the backbone [N/m] one diameter deep."""
        return float(self.backbone(np.array(self.diameter))[0])

    @property
    def start(self) -> float:
        return 0.0

    @property
    def reach(self) -> float:
        return 0.0

    def initial_history(self, shape: tuple[int, ...]) -> Array:
        history = np.zeros((*shape, len(self.columns)))
        history[..., 0] = 1.0
        return history

    def active(self, penetration: Array, history: Array) -> BoolArray:
        return penetration > 0.0

    def update(self, penetration: Array, history: Array) -> SeabedResponse:
        """Stored is what a rebound at the stiffness k would give back."""
        z = np.maximum(penetration, 0.0)
        now = self._continued(z, AubenyBiscontinHistory.of(history))
        P, slope = self._riser(z, now)
        after = np.stack(now._replace(z=z, P=P), axis=-1)
        return SeabedResponse(P, slope, after, 0.5 * P**2 / self._stiffness(np.maximum(now.z1, z)))

    def backbone(self, z: Array) -> tuple[Array, Array]:
        """Resistance (1) to a first penetration, and its slope."""
        P, slope = self._power_law.resistance(z)
        z = np.maximum(z, 0.0)
        elastic = self._stiffness(z) * z
        rise = self._stiffness(z) + self.given.k_over_su * self.given.su_gradient * z
        return np.minimum(elastic, P), np.where(elastic < P, rise, slope)

    def _stiffness(self, z: Array) -> Array:
        return self.given.k_over_su * self._strength.at(z)

    def _loop(self, y1: Array) -> BoundingLoop:
        P1, _ = self.backbone(y1)
        k, firm = self._stiffness(y1), 1.0 / (1.0 + self.given.omega)
        part = self._part(k * y1 / np.maximum(P1, TINY))
        phi = part * self.given.phi
        fall = (1.0 + phi) / (1.0 - part * firm * (1.0 + phi)) * P1 / k
        bend = part * firm / np.maximum(P1, TINY)
        return BoundingLoop(y1, P1, k, bend, phi * P1, y1 - fall, y1 - (1.0 + part * self.given.psi) * fall)

    def _part(self, room: Array) -> Array:
        """Share 0 to 1 of phi, psi and 1/(1 + omega) at which the loop is as long as y1 = room P1/k, or shorter:

        (1 + part psi)(1 + part phi)/(1 - part (1 + part phi)/(1 + omega)) = room, a quadratic equation.
        """
        inward = room / (1.0 + self.given.omega)
        a, b = self.given.phi * (self.given.psi + inward), self.given.psi + self.given.phi + inward
        c = np.maximum(room - 1.0, 0.0)
        return np.minimum(2.0 * c / (b + np.sqrt(b**2 + 4.0 * a * c)), 1.0)

    def _continued(self, z: Array, past: AubenyBiscontinHistory) -> AubenyBiscontinHistory:
        down = np.where(z == past.z, past.down > 0.0, z > past.z)
        turned = down != (past.down > 0.0)
        z0, P0 = np.where(turned, past.z, past.z0), np.where(turned, past.P, past.P0)
        z1 = np.where(turned, np.maximum(past.z1, past.z), past.z1)
        return AubenyBiscontinHistory(down * 1.0, past.z, past.P, z0, P0, z1)

    def _riser(self, z: Array, past: AubenyBiscontinHistory) -> tuple[Array, Array]:
        """Resistance and its slope: the turn's hyperbola between the loop's edges, the backbone beyond the loop."""
        loop, down = self._loop(past.z1), past.down > 0.0
        inner, slope = self._hyperbola(z - past.z0, past.P0, loop)
        lower = self._lower(z, loop)
        upper = self._upper(z, loop, lower)
        edge, edge_slope = (np.where(down, u, l) for u, l in zip(upper, lower, strict=True))
        on_edge = np.where(down, (inner > edge) | (z >= past.z1), inner < edge)
        value, derivative = np.where(on_edge, edge, inner), np.where(on_edge, edge_slope, slope)
        return np.where(z > 0.0, value, 0.0), np.where(z > 0.0, derivative, 0.0)

    def _hyperbola(self, d: Array, P: Array, loop: BoundingLoop) -> tuple[Array, Array]:
        """(5), and (2) from the deepest point."""
        give = 1.0 / loop.k + np.abs(d) * loop.bend
        return P + d / give, 1.0 / (loop.k * give**2)

    def _lower(self, z: Array, loop: BoundingLoop) -> tuple[Array, Array]:
        """Edge (2) and (3), 0 above y3."""
        rebound, slope = self._hyperbola(np.minimum(z - loop.y1, 0.0), loop.P1, loop)
        parting, parting_slope = _s_curve(z, loop.y3, loop.y2, -loop.tension)
        return np.where(z > loop.y2, rebound, parting), np.where(z > loop.y2, slope, parting_slope)

    def _upper(self, z: Array, loop: BoundingLoop, lower: tuple[Array, Array]) -> tuple[Array, Array]:
        """Edge (4), then the backbone."""
        again, slope = _s_curve(z, loop.y3, loop.y1, loop.P1)
        crossed = again < lower[0]
        again, slope = np.where(crossed, lower[0], again), np.where(crossed, lower[1], slope)
        first, rise = self.backbone(z)
        return np.where(z < loop.y1, again, first), np.where(z < loop.y1, slope, rise)


def _s_curve(z: Array, first: Array, last: Array, height: Array) -> tuple[Array, Array]:
    """Cubic from 0 to a height, level at both ends and constant beyond, and its slope."""
    half = np.maximum(0.5 * (last - first), TINY)
    t = np.clip((z - 0.5 * (first + last)) / half, -1.0, 1.0)
    return 0.25 * height * (2.0 + 3.0 * t - t**3), 0.75 * height * (1.0 - t**2) / half
