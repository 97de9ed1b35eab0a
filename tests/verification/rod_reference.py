"""The elastic rod as a boundary value problem: a reference that shares no formula with the elements."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root

from riser_soil.core.arrays import Array
from riser_soil.riser.vectors import skew, vector

TOLERANCES = {"rtol": 1e-11, "atol": 1e-13, "method": "DOP853"}


class Rod(NamedTuple):
    """Uniform rod, clamped at the origin; scaled so that its length is of order one."""

    length: float
    EA: float
    stiffness: Array  # (GJ, EIy, EIz)
    curvature0: Array  # unstressed curvature in section axes
    frame0: Array  # (3, 3) section axes at the clamp, columns


def equations(rod: Rod, force: Array) -> Callable[[float, Array], Array]:
    """Rates of position, section frame and moment along the arc under a constant force (Kirchhoff)."""

    def rates(_: float, state: Array) -> Array:
        frame, m = state[3:12].reshape(3, 3), state[12:]
        curvature = rod.curvature0 + frame.T @ m / rod.stiffness
        slope = frame[:, 0] * (1.0 + force @ frame[:, 0] / rod.EA)
        spin = np.array(skew(vector(curvature)))
        return np.concatenate([slope, (frame @ spin).ravel(), -np.cross(slope, force)])

    return rates


def tip(rod: Rod, force: Array, moment: Array, steps: int = 6) -> Array:
    """Tip position (3,) under a dead force and a moment about fixed axes, by shooting from the clamp."""
    clamp = np.zeros(3)
    for factor in np.linspace(0.0, 1.0, steps + 1)[1:]:

        def end(m: Array, factor: float = factor) -> Array:
            start = np.concatenate([np.zeros(3), rod.frame0.ravel(), m])
            return solve_ivp(equations(rod, factor * force), (0.0, rod.length), start, **TOLERANCES).y[:, -1]

        found = root(lambda m, end=end, factor=factor: end(m)[12:] - factor * moment, clamp, tol=1e-11)
        clamp = found.x
        assert np.abs(found.fun).max() < 1e-8
    return end(clamp)[:3]
