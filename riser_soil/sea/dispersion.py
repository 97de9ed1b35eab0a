"""Dispersion relation of linear waves."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array


def wave_number(w: Array, g: float, h: float) -> Array:
    """Wave numbers k [rad/m] of angular frequencies w [rad/s] in water of depth h [m], which may be inf.

    Root of w^2 = g k tanh k h: Guo's explicit formula (Coastal Engineering 45, 2002, 71-74), wrong by 0.75 % at most,
    and Newton's method from there to round-off.
    """
    deep = w * w / g
    if np.isinf(h):
        return deep
    y = deep * h
    x = y * (-np.expm1(-(y**1.245))) ** (-1.0 / 2.490)
    for _ in range(3):
        tanh = np.tanh(x)
        x = x - (x * tanh - y) / (tanh + x * (1.0 - tanh * tanh))
    return x / h
