"""Collapse of a pipe under external pressure: the elastic pressure of a ring, which several codes begin with."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array

Number = Array | float


def elastic_collapse_pressure(diameter: Number, thickness: Number, E: Number, nu: Number) -> Array:
    """p_el = 2 E (t/D)^3 / (1 - nu^2) [Pa], for diameter and thickness [m] and Young's modulus [Pa].

    Source: DNV-OS-F201 (2010) sec. 5 D; API STD 2RD (2013) 5.3.3.1.
    """
    return np.asarray(2.0 * E * (thickness / diameter) ** 3 / (1.0 - nu**2))
