"""Tangents of parts by differences of their residuals, and how far others are from them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Part, State, Weights
from tests.support.dense_chain import residual

STENCIL = ((1, 3.0 / 4.0), (2, -3.0 / 20.0), (3, 1.0 / 60.0))
WEIGHTS = Weights(inertia=0.7, force=1.3, shift_v=4.0, shift_a=9.0)


def moved(state: State, du: Array, weights: Weights) -> State:
    return State(state.t, state.u + du, state.v + weights.shift_v * du, state.a + weights.shift_a * du)


def slope(f: Callable[[float], Array], h: float) -> Array:
    """Central difference of sixth order."""
    return np.asarray(sum(c * (f(k * h) - f(-k * h)) for k, c in STENCIL) / h)


def difference_tangent(part: Part, state: State, weights: Weights, h: float = 1e-5) -> Array:
    """dR/du by differences, rates following by the shifts."""
    columns = []
    for direction in np.eye(state.u.size):

        def along(s: float, direction: Array = direction) -> Array:
            return residual([part], moved(state, s * direction, weights), weights)

        columns.append(slope(along, h))
    return np.stack(columns, axis=1)


def error(K: Array, expected: Array) -> float:
    return float(np.abs(K - expected).max() / np.abs(expected).max())


def orders(errors: list[float]) -> Array:
    """Observed orders between successive halvings of a size."""
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
