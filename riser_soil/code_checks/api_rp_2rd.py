"""API RP 2RD (1998), Design of risers for floating production systems and TLPs: von Mises' stress of the wall.

Working stress design: loads without factors, against a share of the yield stress that depends on the design case.
Symbols: D outer diameter, t nominal and t_min least thickness of the wall [m]; p_i, p_o pressures inside and outside
[Pa]. Radial and hoop stress are means over the wall, and bending counts in its middle; shear and torsion are neglected.
All are arrays, or numbers, of any shape that broadcasts.
"""

from __future__ import annotations

from types import MappingProxyType

import numpy as np

from riser_soil.code_checks.collapse import Number
from riser_soil.core.arrays import Array
from riser_soil.riser.wall_stress import Wall, bending_stress, von_mises

ALLOWABLE_SHARE = 2.0 / 3.0
"""C_a: basic allowable stress over yield stress."""

CASE_FACTORS = MappingProxyType({"operating": 1.0, "extreme": 1.2, "survival": 1.5})
"""C_f by design case, sec. 4.4 table 2."""


def radial_stress(D: Number, t: Number, p_i: Number, p_o: Number) -> Array:
    """-(p_o D + p_i d)/(D + d) [Pa], with the inner diameter d = D - 2 t.

    Source: sec. 5.
    """
    d = D - 2.0 * t
    return np.asarray(-(p_o * D + p_i * d) / (D + d))


def hoop_stress(D: Number, t_min: Number, p_i: Number, p_o: Number) -> Array:
    """(p_i - p_o) D/(2 t_min) - p_i [Pa].

    Source: sec. 5, with the least thickness of sec. 5.2.4.4.
    """
    return np.asarray((p_i - p_o) * D / (2.0 * t_min) - p_i)


def largest_stress(
    D: Number, t: Number, t_min: Number, tension: Number, moment: Number, p_i: Number, p_o: Number
) -> Array:
    """Von Mises' stress [Pa] of radial, hoop and axial stress T/A + M (D - t)/(2 I), and with a minus: the larger.

    tension: true wall tension [N]; moment: size of the bending moment [N m]. Source: sec. 5, axial stress by eq. 8.
    """
    wall = Wall(np.asarray(D), np.asarray(D - 2.0 * t))
    pulled, bent = tension / wall.area, bending_stress(np.asarray(moment), np.asarray(D - t), wall)
    pressed = hoop_stress(D, t_min, p_i, p_o), radial_stress(D, t, p_i, p_o)
    none = np.zeros(())
    return np.maximum(*(von_mises(axial, *pressed, none) for axial in (pulled + bent, pulled - bent)))


def utilisation(stress: Number, yield_stress: Number, case: str) -> Array:
    """Von Mises' stress over C_f C_a sigma_y.

    Source: sec. 4.4 table 2.
    """
    return np.asarray(stress / (CASE_FACTORS[case] * ALLOWABLE_SHARE * yield_stress))
