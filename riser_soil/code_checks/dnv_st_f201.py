"""DNV-ST-F201 (2018), Dynamic risers, load and resistance factor design; clauses are those of DNV-OS-F201 (2010).

The edition of 2018 renamed DNV-OS-F201 without another formula. Symbols: D outer diameter and t thickness of the wall
[m]; fy, fu characteristic yield and tensile strength [Pa]; p_li local incidental, p_ld local design, p_min least
pressure inside, p_e pressure outside [Pa]; gamma the product of material and safety class factor. All are arrays, or
numbers, of any shape that broadcasts. A utilisation is the left side of its criterion, which must not exceed 1.
"""

from __future__ import annotations

from types import MappingProxyType

import numpy as np

from riser_soil.code_checks.collapse import Number
from riser_soil.code_checks.load_effects import LoadFactors
from riser_soil.core.arrays import Array

LOAD_FACTORS = MappingProxyType(
    {
        "SLS": LoadFactors(1.0, 1.0, 1.0),
        "ULS": LoadFactors(1.1, 1.3, 0.0),
        "ALS": LoadFactors(1.0, 1.0, 1.0),
        "FLS": LoadFactors(1.0, 1.0, 0.0),
    }
)
"""Load effect factors by limit state, table 5-2; accidental effects have none in ULS and FLS."""

MATERIAL_FACTORS = MappingProxyType({"ULS": 1.15, "ALS": 1.15, "FLS": 1.0})
"""Material resistance factors by limit state, sec. 5; that of SLS was not found in two public sources."""

SAFETY_CLASS_FACTORS = MappingProxyType({"low": 1.04, "normal": 1.14, "high": 1.26})
"""Safety class resistance factors, sec. 5."""

MOST_HARDENED = 1.2  # bound of alpha_c, sec. 5 D


def characteristic_strength(specified: Number, derating: Number, factor: Number) -> Array:
    """(S - S_temp) alpha_U [Pa]: a specified minimum strength less its loss by temperature [Pa], times the material
    strength factor.

    Source: table 5-5. Worked example: 65 ksi with 0.96 is 62.4 ksi.
    """
    return np.asarray((specified - derating) * factor)


def bursting_resistance(D: Number, t: Number, fy: Number, fu: Number) -> Array:
    """p_b = 2/sqrt(3) 2 t/(D - t) min(fy, fu/1.15) [Pa].

    Source: sec. 5 D.
    """
    return np.asarray(4.0 / np.sqrt(3.0) * t / (D - t) * np.minimum(fy, fu / 1.15))


def plastic_collapse_pressure(D: Number, t: Number, fy: Number, alpha_fab: Number) -> Array:
    """p_p = 2 t/D fy alpha_fab [Pa], with the fabrication factor.

    Source: sec. 5 D.
    """
    return np.asarray(2.0 * t / D * fy * alpha_fab)


def collapse_resistance(p_el: Number, p_p: Number, f0: Number, D: Number, t: Number) -> Array:
    """p_c [Pa]: the least positive root of (p_c - p_el)(p_c^2 - p_p^2) = p_c p_el p_p f0 D/t.

    f0: initial ovality (D_max - D_min)/D, not below 0.005. The root lies below both p_el and p_p; it is found in the
    closed form of a cubic with three real roots. Source: sec. 5 D, with the cubic's solution of DNV-OS-F101 sec. 13.
    """
    p_el, p_p = np.asarray(p_el), np.asarray(p_p)
    b, d = -p_el, p_el * p_p**2
    c = -(p_p**2 + p_el * p_p * f0 * D / t)
    u, v = (c - b**2 / 3.0) / 3.0, 0.5 * (2.0 * b**3 / 27.0 - b * c / 3.0 + d)
    phi = np.arccos(np.clip(-v / np.sqrt(-(u**3)), -1.0, 1.0))
    return np.asarray(-2.0 * np.sqrt(-u) * np.cos(phi / 3.0 + np.pi / 3.0) - b / 3.0)


def propagating_pressure(D: Number, t: Number, fy: Number, alpha_fab: Number) -> Array:
    """p_pr = 35 fy alpha_fab (t/D)^2.5 [Pa], for D/t from 15 to 45.

    Source: sec. 5 D.
    """
    return np.asarray(35.0 * fy * alpha_fab * (t / D) ** 2.5)


def flow_stress_parameter(D: Number, t: Number, fy: Number, fu: Number, overpressure: Number, p_b: Number) -> Array:
    """alpha_c = (1 - beta) + beta fu/fy, which accounts for strain hardening and wall thinning.

    beta = (0.4 + q_h) for D/t < 15, (0.4 + q_h)(60 - D/t)/45 up to D/t = 60, 0 above; q_h = 2/sqrt(3) (p_ld - p_e)/p_b
    where p_ld > p_e, else 0; at most 1.2. overpressure: p_ld - p_e [Pa]. Source: sec. 5 D.
    """
    hoop = 2.0 / np.sqrt(3.0) * np.maximum(overpressure, 0.0) / p_b
    beta = (0.4 + hoop) * np.clip((60.0 - D / t) / 45.0, 0.0, 1.0)
    return np.minimum((1.0 - beta) + beta * fu / fy, MOST_HARDENED)


def plastic_moment(D: Number, t: Number, fy: Number, alpha_c: Number) -> Array:
    """M_k = fy alpha_c (D - t)^2 t [N m].

    Source: sec. 5 D, eq. 5.25.
    """
    return np.asarray(fy * alpha_c * (D - t) ** 2 * t)


def plastic_tension(D: Number, t: Number, fy: Number, alpha_c: Number) -> Array:
    """T_k = fy alpha_c pi (D - t) t [N].

    Source: sec. 5 D, eq. 5.26.
    """
    return np.asarray(fy * alpha_c * np.pi * (D - t) * t)


def bursting(p_li: Number, p_e: Number, p_b: Number, gamma: Number) -> Array:
    """gamma (p_li - p_e)/p_b, p_b with t1; 0 where the pressure outside is larger.

    Source: sec. 5 D.
    """
    return np.asarray(gamma * np.maximum(p_li - p_e, 0.0) / p_b)


def hoop_buckling(p_e: Number, p_min: Number, p_c: Number, gamma: Number) -> Array:
    """gamma (p_e - p_min)/p_c, p_c with t1; 0 where the pressure inside is larger.

    Source: sec. 5 D.
    """
    return np.asarray(gamma * np.maximum(p_e - p_min, 0.0) / p_c)


def propagating_buckling(p_e: Number, p_min: Number, p_pr: Number, gamma: Number) -> Array:
    """gamma (p_e - p_min)/p_pr, p_pr with t2, where no buckle may propagate; 0 where the pressure inside is larger.

    Source: sec. 5 D, with gamma_c = 1.
    """
    return np.asarray(gamma * np.maximum(p_e - p_min, 0.0) / p_pr)


def combined_internal(moment: Number, tension: Number, overpressure: Number, p_b: Number, gamma: Number) -> Array:
    """gamma {m sqrt(1 - q^2) + T^2} + q^2 with q = (p_ld - p_e)/p_b, under net internal overpressure.

    moment: |M_d|/M_k, tension: T_ed/T_k, both of design effects. overpressure: p_ld - p_e >= 0 [Pa]; p_b with t2.
    Beyond bursting, q > 1, the root counts as 0. Source: sec. 5 D.
    """
    q = overpressure / p_b
    return np.asarray(gamma * (moment * np.sqrt(np.maximum(1.0 - q**2, 0.0)) + np.square(tension)) + q**2)


def combined_external(moment: Number, tension: Number, overpressure: Number, p_c: Number, gamma: Number) -> Array:
    """gamma^2 {m + T^2}^2 + gamma^2 ((p_e - p_min)/p_c)^2, under net external overpressure.

    moment: |M_d|/M_k, tension: T_ed/T_k, both of design effects. overpressure: p_e - p_min >= 0 [Pa]; p_c with t2.
    Source: sec. 5 D.
    """
    return np.asarray(gamma**2 * ((moment + np.square(tension)) ** 2 + (overpressure / p_c) ** 2))
