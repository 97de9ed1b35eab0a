"""S-N curves of DNVGL-RP-C203, Fatigue design of offshore steel structures, edition of April 2016.

Mean minus two standard deviations, 97.7 % survive. Air: Table 2-1, slope changes at 1e7 cycles; seawater with cathodic
protection: Table 2-2, at 1e6; seawater with free corrosion: Table 2-4, one slope. The logarithms are those printed, to
three decimals: where slopes change the branches meet to a few thousandths. T curves of tubular joints are not here.
"""

from __future__ import annotations

from typing import Literal, get_args

from riser_soil.fatigue.sn_curve import SNCurve

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


def dnv_curve(name: CurveClass, environment: Environment) -> SNCurve:
    """A curve by its class."""
    table, few, change, exponents = _TABLES[environment]
    n = CLASSES.index(name)
    told = f"DNV {name}, {environment.replace('-', ' ')}", f"{SOURCE}, {table}"
    if change is None:
        return SNCurve(*told, (few[n],), (3.0,), (), exponents[n])
    return SNCurve(*told, (few[n], _MANY[n]), (4.0 if n < 2 else 3.0, 5.0), (change,), exponents[n])
