"""Formula of the law `riser_soil.seabed.randolph_quiggin`, whose text has the equations by their numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.seabed.compiled_law import CompiledLaw, answer, may_act
from riser_soil.seabed.pipe_bearing import PowerLaw, displaced, resistance

TINY = 1e-30
Curve = tuple[float, float]  # value at z, and its slope


class RandolphQuigginData(NamedTuple):
    """Ultimate resistance; x over |z - z0| [1/m]; the law's other constants; weight of the displaced soil [N/m3]."""

    ultimate: PowerLaw
    per_metre: float
    f_suc: float
    lambda_suc: float
    lambda_rep: float
    weight: float


class RandolphQuigginHistory(NamedTuple):
    """History of a point: whether it went down, penetration z [m] and resistance P [N/m] where it is, z0, P0 where it
    last turned, largest penetration zm [m] when it turned; suction s and wholeness c when it turned.
    """

    down: float
    z: float
    P: float
    z0: float
    P0: float
    zm: float
    s: float
    c: float


@dataclass(frozen=True)
class RandolphQuigginFormula(CompiledLaw):
    """The clay under a pipe of one diameter."""

    kernel_data: RandolphQuigginData
    columns: ClassVar[tuple[str, ...]] = RandolphQuigginHistory._fields
    gradual: ClassVar[bool] = True

    @property
    def capacity(self) -> float:
        """Ultimate resistance [N/m] one diameter deep."""
        ultimate = self.kernel_data.ultimate
        return float(ultimate.resistance(np.array(ultimate.diameter))[0])

    @property
    def start(self) -> float:
        return 0.0

    @property
    def reach(self) -> float:
        return 0.0

    def initial_history(self, shape: tuple[int, ...]) -> Array:
        untouched = np.empty(len(self.columns))
        leave(0.0, untouched)
        return np.tile(untouched, (*shape, 1))


@may_act.of(RandolphQuigginData)
def _may_act(law: RandolphQuigginData, penetration: float, history: Array) -> bool:
    return penetration > 0.0


@answer.of(RandolphQuigginData)
def _answer(law: RandolphQuigginData, penetration: float, history: Array, after: Array) -> tuple[float, float, float]:
    """Stored is what a rebound at the greatest stiffness would give back, and the potential of buoyancy."""
    z = max(penetration, 0.0)
    now = _continued(law, z, history)
    if z <= 0.0:
        leave(now.zm, after)
        return 0.0, 0.0, 0.0
    ultimate = resistance(law.ultimate, z)
    P, slope = _of_clay(law, z, ultimate, now)
    after[0], after[1], after[2], after[3] = now.down, z, P, now.z0
    after[4], after[5], after[6], after[7] = now.P0, now.zm, now.s, now.c
    rebound = 0.5 * P**2 / max(law.per_metre * ultimate[0], TINY)
    if law.weight == 0.0:
        return P, slope, rebound
    volume, area, width = displaced(z, law.ultimate.diameter)
    return P + law.weight * area, slope + law.weight * width, rebound + law.weight * volume


@njit
def leave(zm: float, after: Array) -> None:
    """Write the history of a point above the surface, the deepest that it has been being zm, 0 for never."""
    after[:] = 0.0
    after[0], after[5] = 1.0, zm
    after[6] = after[7] = 0.0 if zm > 0.0 else 1.0


@njit
def _first(law: RandolphQuigginData, z: float, ultimate: Curve) -> Curve:
    """Resistance (2) to a first penetration, and its slope."""
    Pu, dPu = ultimate
    x = law.per_metre * z
    share = x / (1.0 + x)
    return Pu * share, dPu * share + Pu * law.per_metre / (1.0 + x) ** 2


@njit
def _continued(law: RandolphQuigginData, z: float, history: Array) -> RandolphQuigginHistory:
    """The history of a step that goes to z, as far as it is known before its end."""
    h = history
    past = RandolphQuigginHistory(h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7])
    went_down = past.down > 0.0
    down = went_down if z == past.z else z > past.z
    if down == went_down:
        return past
    return _after_uplift(law, past) if down else _after_sinking(law, past)


@njit
def _after_uplift(law: RandolphQuigginData, past: RandolphQuigginHistory) -> RandolphQuigginHistory:
    d = math.exp(-max(past.z0 - past.z, 0.0) / _decay_length(law, past))
    return RandolphQuigginHistory(1.0, past.z, past.P, past.z, past.P, past.zm, past.s * d, past.c * d)


@njit
def _after_sinking(law: RandolphQuigginData, past: RandolphQuigginHistory) -> RandolphQuigginHistory:
    beyond = max(past.z - past.zm, 0.0) / max(law.lambda_rep * past.zm, TINY)
    pressed = past.P / max(_first(law, past.z, resistance(law.ultimate, past.z))[0], TINY)
    s, c = min(max(pressed, past.s), 1.0), min(past.c + beyond, 1.0)
    return RandolphQuigginHistory(0.0, past.z, past.P, past.z, past.P, max(past.zm, past.z), s, c)


@njit
def _decay_length(law: RandolphQuigginData, past: RandolphQuigginHistory) -> float:
    return max(law.lambda_suc * past.zm, TINY)


@njit
def _of_clay(law: RandolphQuigginData, z: float, ultimate: Curve, past: RandolphQuigginHistory) -> Curve:
    """Resistance without buoyancy, and its slope."""
    if past.down > 0.0:
        decay = (1.0, 0.0)
        P, slope = _repenetration(law, z, ultimate, past)
    else:
        length = _decay_length(law, past)
        d = math.exp(-max(past.z0 - z, 0.0) / length)
        decay = (d, d / length)
        P, slope = _uplift(law, z, ultimate, past, decay)
    bound, bound_slope = _bound(law, z, ultimate, past, decay)
    return (P, slope) if bound > P else (bound, bound_slope)


@njit
def _uplift(law: RandolphQuigginData, z: float, ultimate: Curve, past: RandolphQuigginHistory, decay: Curve) -> Curve:
    """Resistance in uplift by (3) with the decay (6), and its slope."""
    (Pu, dPu), (d, dd) = ultimate, decay
    suction, dsuction = -law.f_suc * past.s * d * Pu, -law.f_suc * past.s * (d * dPu + dd * Pu)
    S = max(past.P0 - suction, 0.0)
    stiff = resistance(law.ultimate, past.z0)[0] * law.per_metre
    part = S / max(S + stiff * max(past.z0 - z, 0.0), TINY)
    dS = -dsuction if S > 0.0 else 0.0
    return suction + S * part, dsuction + 2.0 * part * dS - part**2 * (dS - stiff)


@njit
def _repenetration(law: RandolphQuigginData, z: float, ultimate: Curve, past: RandolphQuigginHistory) -> Curve:
    """Resistance in repenetration by (4), and its slope."""
    Pu, dPu = ultimate
    T, x = Pu - past.P0, law.per_metre * max(z - past.z0, 0.0)
    part = T / max(T + Pu * x, TINY)
    return Pu - T * part, dPu - 2.0 * part * dPu + part**2 * (dPu * (1.0 + x) + Pu * law.per_metre)


@njit
def _bound(law: RandolphQuigginData, z: float, ultimate: Curve, past: RandolphQuigginHistory, decay: Curve) -> Curve:
    """Resistance (5) of clay as whole as it is, and its slope."""
    (first, slope), (d, dd) = _first(law, z, ultimate), decay
    zm = max(past.zm, TINY)
    exponent = -law.lambda_rep * (1.0 - past.c * d) + max(z - zm, 0.0) / zm
    if exponent >= 0.0:
        return first, slope
    by_z = law.lambda_rep * past.c * dd + (1.0 if z > zm else 0.0) / zm
    soft = math.exp(exponent)
    return soft * first, soft * (slope + by_z * first)
