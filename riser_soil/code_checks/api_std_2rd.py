"""API STD 2RD (2013), Dynamic risers for floating production systems: burst, collapse, combined loads by two methods.

Symbols: D outer diameter and t thickness of the wall [m]; S, U specified minimum yield and tensile strength [Pa]; F a
design factor, which depends on the case: operating, extreme or survival. All are arrays, or numbers, of any shape that
broadcasts. A utilisation is the share of the allowable loads, which must not exceed 1.
"""

from __future__ import annotations

from types import MappingProxyType

import numpy as np

from riser_soil.code_checks.collapse import Number
from riser_soil.core.arrays import Array

DESIGN_FACTORS = MappingProxyType({"operating": 0.8, "extreme": 0.8, "survival": 1.0})
"""Design factors of both methods by case, 5.4.3.2 and 5.4.3.3: those of SLS, ULS and ALS."""

SURVIVAL_UNDER_EXTERNAL = 0.9  # that of survival beyond half of the collapse pressure

WALL_VARIABILITY = 0.45  # k of pipe by API 5L and 5CT, 5.3.2
ROUND_OFF = 1e-13
MOST_ITERATIONS = 60


def burst_pressure(D: Number, t: Number, S: Number, U: Number, k: Number) -> Array:
    """p_b = k (S + U) ln(D/(D - 2 t)) [Pa], t less the corrosion allowance.

    Source: 5.3.2.
    """
    return np.asarray(k * (S + U) * np.log(D / (D - 2.0 * t)))


def yield_collapse_pressure(D: Number, t: Number, S: Number) -> Array:
    """p_y = 2 S t/D [Pa].

    Source: 5.3.3.1, as in API RP 1111.
    """
    return np.asarray(2.0 * S * t / D)


def collapse_pressure(p_y: Number, p_el: Number) -> Array:
    """p_c = p_y p_el/sqrt(p_y^2 + p_el^2) [Pa].

    Source: 5.3.3.1, as in API RP 1111.
    """
    return np.asarray(p_y * p_el / np.hypot(p_y, p_el))


def yield_tension(D: Number, t: Number, S: Number) -> Array:
    """T_y = S pi (D - t) t [N], of the nominal wall.

    Source: 5.3.
    """
    return np.asarray(S * np.pi * (D - t) * t)


def yield_moment(D: Number, t: Number, S: Number) -> Array:
    """M_y = pi/4 S (D - t)^2 t [N m], of the nominal wall.

    Source: 5.3.
    """
    return np.asarray(0.25 * np.pi * S * (D - t) ** 2 * t)


def plastic_moment(D: Number, t: Number, S: Number) -> Array:
    """M_p = 4/pi M_y [N m].

    Source: 5.3.
    """
    return 4.0 / np.pi * yield_moment(D, t, S)


def overpressure(inside: Number, outside: Number, resistance: Number) -> Array:
    """(inside - outside)/p, of bursting by p_b; of collapse with inside and outside exchanged, by p_c. 0 where the
    other pressure is larger.

    Source: 5.4.
    """
    return np.asarray(np.maximum(inside - outside, 0.0) / resistance)


def design_factor(case: str, overpressure: Number) -> Array:
    """F of both methods, for a net external overpressure over p_c.

    Source: 5.4.3.2, eq. 20, and 5.4.3.3, eq. 23.
    """
    beyond = (np.asarray(overpressure) > 0.5) & (case == "survival")
    return np.where(beyond, SURVIVAL_UNDER_EXTERNAL, DESIGN_FACTORS[case])


def method_1(tension: Number, moment: Number, pressure: Number, factor: Number) -> Array:
    """sqrt((T/T_y + M/M_y)^2 + q^2)/F: 1 where T/T_y + M/M_y = sqrt(F^2 - q^2).

    tension: |T|/T_y, moment: |M|/M_y; pressure: q, net internal overpressure over p_b or net external one over p_c.
    Source: 5.4.3.2, eq. 18 and 19.
    """
    return np.asarray(np.hypot(tension + moment, pressure) / factor)


def method_2(tension: Number, moment: Number, pressure: Number, factor: Number) -> Array:
    """The share u of the loads in those on the curve M/M_p = s cos(pi/2 (T/T_y)/s), s = sqrt(F^2 - q^2).

    tension: |T|/T_y, moment: |M|/M_p; pressure: q as of method 1. Loads divided by u lie on the curve if with S = u s
    S cos(pi/2 tension/S) = moment, where u = sqrt(S^2 + q^2)/F. S is found by Newton's method: the left side grows with
    S from 0 at S = tension and is concave, so that iterates climb to the root after the first.

    Source: 5.4.3.3, eq. 21 and 22.
    """
    tension, moment = np.broadcast_arrays(np.asarray(tension, dtype=float), np.asarray(moment, dtype=float))
    S = tension + moment
    for _ in range(MOST_ITERATIONS):
        angle = 0.5 * np.pi * np.divide(tension, S, out=np.zeros_like(S), where=S > 0.0)
        off = S * np.cos(angle) - moment
        step = off / (np.cos(angle) + angle * np.sin(angle))
        S = np.maximum(S - step, np.maximum(tension, moment))
        if np.all(np.abs(step) <= ROUND_OFF * S):
            break
    return np.asarray(np.hypot(S, pressure) / factor)
