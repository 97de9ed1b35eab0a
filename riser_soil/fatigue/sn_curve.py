"""S-N curves: cycles to failure N by stress range S, log10 N = log_a - m log10 S, S in MPa; those of DNVGL-RP-C203.

S-N curves of DNVGL-RP-C203, Fatigue design of offshore steel structures, edition of April 2016.

Mean minus two standard deviations, 97.7 % survive. Air: Table 2-1, slope changes at 1e7 cycles; seawater with cathodic
protection: Table 2-2, at 1e6; seawater with free corrosion: Table 2-4, one slope. The logarithms are those printed, to
three decimals: where slopes change the branches meet to a few thousandths. T curves of tubular joints are not here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from riser_soil.core.arrays import Array

REFERENCE_THICKNESS = 0.025  # m, of welded connections other than tubular joints, DNVGL-RP-C203 (2016) 2.4
SOURCE = "DNVGL-RP-C203 (April 2016)"
_MANY = (17.146, 16.856, 16.320, 16.081, 15.835, 15.606, 15.350, 15.091, 14.832, 14.576, 14.330, 14.101, 13.845, 13.617)
_AIR = (15.117, 14.885, 12.592, 12.449, 12.301, 12.164, 12.010, 11.855, 11.699, 11.546, 11.398, 11.261, 11.107, 10.970)
_CATHODIC = (
    *(14.917, 14.685, 12.192, 12.049, 11.901, 11.764, 11.610),
    *(11.455, 11.299, 11.146, 10.998, 10.861, 10.707, 10.570),
)
_FREE = (12.436, 12.262, 12.115, 11.972, 11.824, 11.687, 11.533, 11.378, 11.222, 11.068, 10.921, 10.784, 10.630, 10.493)
CurveClass = Literal["B1", "B2", "C", "C1", "C2", "D", "E", "F", "F1", "F3", "G", "W1", "W2", "W3"]
Environment = Literal["air", "cathodic-protection", "free-corrosion"]
CLASSES: tuple[CurveClass, ...] = get_args(CurveClass)
_K = (0.0, 0.0, 0.05, 0.10, 0.15, 0.20, 0.20, *(0.25,) * 7)
_K_FREE = (0.0, 0.0, 0.15, 0.15, 0.15, 0.20, 0.20, *(0.25,) * 7)
_TABLES: dict[Environment, tuple[str, tuple[float, ...], float | None, tuple[float, ...]]] = {
    "air": ("Table 2-1", _AIR, 1e7, _K),
    "cathodic-protection": ("Table 2-2", _CATHODIC, 1e6, _K),
    "free-corrosion": ("Table 2-4", _FREE, None, _K_FREE),
}
ENVIRONMENTS = tuple(_TABLES)


@dataclass(frozen=True)
class SNCurve:
    """Branches from few to many cycles; the first and the last go on without end, so no range is too small to count.

    change: N where one branch ends and the next begins, one fewer than branches. k: thickness exponent; walls thicker
    than the reference [m] have their stress ranges multiplied by (t/reference)^k.
    """

    name: str
    source: str
    log_a: tuple[float, ...]
    m: tuple[float, ...]
    change: tuple[float, ...] = ()
    k: float = 0.0
    reference: float = REFERENCE_THICKNESS

    def endurance(self, S: Array) -> Array:
        """N of stress ranges S [MPa], inf of ranges that are 0."""
        S = np.asarray(S, dtype=float)
        log_a, m = np.array(self.log_a), np.array(self.m)
        ends = 10.0 ** ((log_a[:-1] - np.log10(self.change)) / m[:-1])  # [MPa], falling
        branch = (S[..., None] < ends).sum(axis=-1)
        with np.errstate(divide="ignore"):
            return np.asarray(10.0 ** (log_a[branch] - m[branch] * np.log10(S)))

    def damage(self, S: Array) -> float:
        """Miner's sum of stress ranges S [MPa], each a cycle."""
        return float(np.sum(1.0 / self.endurance(S)))

    def thickness_factor(self, thickness: float) -> float:
        """Factor on stress ranges in a wall of a thickness [m]; never below 1."""
        return float(max(thickness / self.reference, 1.0) ** self.k)


def curve_through(
    points: Sequence[tuple[float, float]], k: float = 0.0, reference: float = REFERENCE_THICKNESS
) -> SNCurve:
    """Straight in logarithms between points (N, S [Pa]) of growing N and falling S, and on beyond them."""
    log_N, log_S = np.log10(np.array(points)).T - np.array([[0.0], [6.0]])
    m = -np.diff(log_N) / np.diff(log_S)
    log_a = log_N[:-1] + m * log_S[:-1]
    change = tuple(float(N) for N, _ in points[1:-1])
    return SNCurve("table", "given by points", tuple(log_a.tolist()), tuple(m.tolist()), change, k, reference)


def dnv_curve(name: CurveClass, environment: Environment) -> SNCurve:
    """A curve by its class."""
    table, few, change, exponents = _TABLES[environment]
    n = CLASSES.index(name)
    name_and_source = f"DNV {name}, {environment.replace('-', ' ')}", f"{SOURCE}, {table}"
    if change is None:
        return SNCurve(*name_and_source, (few[n],), (3.0,), (), exponents[n])
    return SNCurve(*name_and_source, (few[n], _MANY[n]), (4.0 if n < 2 else 3.0, 5.0), (change,), exponents[n])
