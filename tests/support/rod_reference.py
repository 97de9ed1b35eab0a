"""The elastic rod as a boundary value problem: a reference that shares no formula with the elements."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, root

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

        solution = root(lambda m, end=end, factor=factor: end(m)[12:] - factor * moment, clamp, tol=1e-11)
        clamp = solution.x
        assert np.abs(solution.fun).max() < 1e-8
    return end(clamp)[:3]


def moments_at_tip(legs: Sequence[tuple[Rod, Array]], force: Array) -> Callable[[Array], Array]:
    """Moments (3,) left at the free end of rods joined rigidly, from those at the clamp, by the rod's equations.

    legs: rods with their unstressed section axes (3, 3).
    """

    def at_tip(clamp: Array) -> Array:
        state, before = np.concatenate([np.zeros(3), legs[0][1].ravel(), clamp]), legs[0][1]
        for rod, axes in legs:
            state[3:12] = (state[3:12].reshape(3, 3) @ before.T @ axes).ravel()
            state = solve_ivp(equations(rod, force), (0.0, rod.length), state, **TOLERANCES).y[:, -1]
            before = axes
        return np.asarray(state[12:])

    return at_tip


def first_buckling(legs: Sequence[tuple[Rod, Array]], direction: Array, low: float, high: float) -> float:
    """Tip force [N] at which the planar (x-y) solution of the shooting problem has another beside it."""

    def determinant(force: float) -> float:
        at_tip, clamp = moments_at_tip(legs, force * direction), np.zeros(3)
        scale = force * legs[0][0].length
        for _ in range(5):  # Newton's method for the clamp's in-plane moment
            clamp[2] -= at_tip(clamp)[2] / _slope(at_tip, clamp, 2, 1e-4 * scale)[2]
        across = [_slope(at_tip, clamp, k, 1e-4 * scale)[:2] for k in range(2)]
        return float(np.linalg.det(across))

    return float(brentq(determinant, low, high, xtol=1e-9 * high))


def _slope(f: Callable[[Array], Array], x: Array, k: int, h: float) -> Array:
    """Derivative of f by x[k]."""
    step = h * np.eye(x.size)[k]
    return (f(x + step) - f(x - step)) / (2.0 * h)
