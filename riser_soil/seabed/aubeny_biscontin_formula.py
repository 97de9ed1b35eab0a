"""Formula of the law `riser_soil.seabed.aubeny_biscontin`, whose text has the equations by their numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.seabed.compiled_law import CompiledLaw, answer, may_act
from riser_soil.seabed.pipe_bearing import PowerLaw, resistance, strength_at

TINY = 1e-30


class AubenyBiscontinData(NamedTuple):
    """Power law of the backbone, and the law's other constants."""

    power_law: PowerLaw
    k_over_su: float
    omega: float
    phi: float
    psi: float


class AubenyBiscontinHistory(NamedTuple):
    """History of a point: whether it went down, penetration z [m] and resistance P [N/m] where it is, z0, P0 where it
    last turned, and the largest penetration z1 when it turned.
    """

    down: float
    z: float
    P: float
    z0: float
    P0: float
    z1: float


@dataclass(frozen=True)
class AubenyBiscontinFormula(CompiledLaw):
    """The seafloor under a pipe of one diameter."""

    kernel_data: AubenyBiscontinData
    columns: ClassVar[tuple[str, ...]] = AubenyBiscontinHistory._fields
    gradual: ClassVar[bool] = True

    @property
    def capacity(self) -> float:
        """Resistance of the backbone [N/m] one diameter deep."""
        return float(self.backbone(np.array(self.kernel_data.power_law.diameter))[0])

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

    def backbone(self, z: Array) -> tuple[Array, Array]:
        """Resistance (1) to a first penetration, and its slope."""
        value, slope = np.vectorize(lambda depth: backbone(self.kernel_data, depth))(z)
        return value, slope


class BoundingLoop(NamedTuple):
    """Bounding loop: deepest point y1, P1; stiffness k [N/m2]; 1/((1 + omega) P1); greatest tension; y2 and y3."""

    y1: float
    P1: float
    k: float
    bend: float
    tension: float
    y2: float
    y3: float


@may_act.of(AubenyBiscontinData)
def _may_act(law: AubenyBiscontinData, penetration: float, history: Array) -> bool:
    return penetration > 0.0


@answer.of(AubenyBiscontinData)
def _answer(law: AubenyBiscontinData, penetration: float, history: Array, after: Array) -> tuple[float, float, float]:
    """Stored is what a rebound at the stiffness k would give back."""
    z = max(penetration, 0.0)
    now = _continued(z, history)
    P, slope = _of_riser(law, z, now)
    after[0], after[1], after[2], after[3], after[4], after[5] = now.down, z, P, now.z0, now.P0, now.z1
    return P, slope, 0.5 * P**2 / _stiffness(law, max(now.z1, z))


@njit
def backbone(law: AubenyBiscontinData, z: float) -> tuple[float, float]:
    """Resistance (1) to a first penetration, and its slope."""
    z = max(z, 0.0)
    P, slope = resistance(law.power_law, z)
    k = _stiffness(law, z)
    if k * z < P:
        return k * z, k + law.k_over_su * law.power_law.strength.gradient * z
    return P, slope


@njit
def _stiffness(law: AubenyBiscontinData, z: float) -> float:
    return law.k_over_su * strength_at(law.power_law.strength, z)


@njit
def bounding_loop(law: AubenyBiscontinData, y1: float) -> BoundingLoop:
    """Bounding loop of ground whose deepest point so far is y1."""
    P1, _ = backbone(law, y1)
    k, firm = _stiffness(law, y1), 1.0 / (1.0 + law.omega)
    part = _part(law, k * y1 / max(P1, TINY))
    phi = part * law.phi
    fall = (1.0 + phi) / (1.0 - part * firm * (1.0 + phi)) * P1 / k
    bend = part * firm / max(P1, TINY)
    return BoundingLoop(y1, P1, k, bend, phi * P1, y1 - fall, y1 - (1.0 + part * law.psi) * fall)


@njit
def _part(law: AubenyBiscontinData, room: float) -> float:
    """Share 0 to 1 of phi, psi and 1/(1 + omega) at which the loop is as long as y1 = room P1/k, or shorter:

    (1 + part psi)(1 + part phi)/(1 - part (1 + part phi)/(1 + omega)) = room, a quadratic equation.
    """
    inward = room / (1.0 + law.omega)
    a, b = law.phi * (law.psi + inward), law.psi + law.phi + inward
    c = max(room - 1.0, 0.0)
    return min(2.0 * c / (b + math.sqrt(b**2 + 4.0 * a * c)), 1.0)


@njit
def _continued(z: float, history: Array) -> AubenyBiscontinHistory:
    """The history of a step that goes to z, as far as it is known before its end."""
    past = AubenyBiscontinHistory(history[0], history[1], history[2], history[3], history[4], history[5])
    went_down = past.down > 0.0
    down = went_down if z == past.z else z > past.z
    if down == went_down:
        return past
    return AubenyBiscontinHistory(1.0 if down else 0.0, past.z, past.P, past.z, past.P, max(past.z1, past.z))


@njit
def _of_riser(law: AubenyBiscontinData, z: float, past: AubenyBiscontinHistory) -> tuple[float, float]:
    """Resistance and its slope: the turn's hyperbola between the loop's edges, the backbone beyond the loop."""
    if z <= 0.0:
        return 0.0, 0.0
    loop = bounding_loop(law, past.z1)
    inner, slope = _hyperbola(z - past.z0, past.P0, loop)
    edge, edge_slope = _lower(z, loop)
    if past.down > 0.0:
        edge, edge_slope = _upper(law, z, loop, (edge, edge_slope))
        if inner > edge or z >= past.z1:
            return edge, edge_slope
    elif inner < edge:
        return edge, edge_slope
    return inner, slope


@njit
def _hyperbola(d: float, P: float, loop: BoundingLoop) -> tuple[float, float]:
    """Resistance by the hyperbola (5), which is (2) from the deepest point, and its slope."""
    give = 1.0 / loop.k + abs(d) * loop.bend
    return P + d / give, 1.0 / (loop.k * give**2)


@njit
def _lower(z: float, loop: BoundingLoop) -> tuple[float, float]:
    """Resistance on the loop's lower edge, (2) and (3), and its slope; 0 above y3."""
    if z > loop.y2:
        return _hyperbola(min(z - loop.y1, 0.0), loop.P1, loop)
    return _s_curve(z, loop.y3, loop.y2, -loop.tension)


@njit
def _upper(law: AubenyBiscontinData, z: float, loop: BoundingLoop, lower: tuple[float, float]) -> tuple[float, float]:
    """Resistance on the loop's upper edge (4), then on the backbone, and its slope."""
    if z >= loop.y1:
        return backbone(law, z)
    again, slope = _s_curve(z, loop.y3, loop.y1, loop.P1)
    return lower if again < lower[0] else (again, slope)


@njit
def _s_curve(z: float, first: float, last: float, height: float) -> tuple[float, float]:
    """Cubic from 0 to a height, level at both ends and constant beyond, and its slope."""
    half = max(0.5 * (last - first), TINY)
    t = min(max((z - 0.5 * (first + last)) / half, -1.0), 1.0)
    return 0.25 * height * (2.0 + 3.0 * t - t**3), 0.75 * height * (1.0 - t**2) / half
