"""Quadrature along the line's elements: values at Gauss points (stations), and residuals.

Arrays follow `hermite`: q (ne, 4, d). A field has values (ne, ng, d) at the ng stations of each element, three Gauss
points unless another rule is given.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.rows import add_shares, combined, numbers_at, times
from riser_soil.riser.hermite import Size, shapes, slopes

POINTS = 0.5 + np.sqrt(0.6) * np.array([-0.5, 0.0, 0.5])
FOUR = fixed(4)
GAUSS = np.array([5.0, 8.0, 5.0]) / 18.0


class QuadratureRule(NamedTuple):
    """Quadrature over an element: places xi in 0..1 and weights that sum to one, each (ng,)."""

    points: Array
    weights: Array


THREE_POINTS = QuadratureRule(POINTS, GAUSS)
ENDS = QuadratureRule(np.array([0.0, 1.0]), np.array([0.5, 0.5]))


def gauss(n: int) -> QuadratureRule:
    """Gauss and Legendre's rule of n points."""
    x, w = np.polynomial.legendre.leggauss(n)
    return QuadratureRule(0.5 + 0.5 * x, 0.5 * w)


class Stations(NamedTuple):
    """Shape functions N, their derivatives dN by arc length, N times quadrature weight; each (ne, ng, 4)."""

    N: Array
    dN: Array
    weighted: Array


def stations(L: Array, rule: QuadratureRule = THREE_POINTS) -> Stations:
    """Stations on elements of unstressed lengths L (ne,)."""
    N = np.stack([shapes(np.full(L.size, p), L) for p in rule.points], axis=1)
    dN = np.stack([slopes(np.full(L.size, p), L) for p in rule.points], axis=1)
    return Stations(N, dN, rule.weights[:, None] * L[:, None, None] * N)


def points(L: Array, xi: Array) -> Stations:
    """One station each, of weight 1, at xi (m,) of elements of lengths L (m,): what acts there is a force."""
    N = shapes(xi, L)[:, None, :]
    return Stations(N, slopes(xi, L)[:, None, :], N)


@njit
def value_at(N: Array, p: int, q: Array, e: int, D: Size) -> tuple[float, ...]:
    """Value (d,) at station p of all, N (ne, ng, 4), which lies in element e, of q (ne, 4, d)."""
    (N1, N2, N3, N4), d, at = numbers_at(N, 4 * p, FOUR), len(D), 4 * len(D) * e
    value: tuple[float, ...] = combined(((N1, q, at), (N2, q, at + d), (N3, q, at + 2 * d), (N4, q, at + 3 * d)), D)
    return value


@njit
def unit_tangent_at(
    dN: Array, p: int, chord: Array, ends: Array, e: int, D: Size
) -> tuple[tuple[float, ...], float]:
    """Unit tangent (d,) at station p of all, dN (ne, ng, 4), which lies in element e, and the stretch |x'| there; chord
    (ne, d), ends: end tangents (ne, 2, d).
    """
    (_, by_first, by_chord, by_second), d, square = numbers_at(dN, 4 * p, FOUR), len(D), 0.0
    slope = combined(((by_chord, chord, d * e), (by_first, ends, 2 * d * e), (by_second, ends, 2 * d * e + d)), D)
    for i in range(len(D)):
        square += slope[i] * slope[i]
    stretch = math.sqrt(square)
    return times(1.0 / stretch, slope), stretch


@njit
def add_integrand_at(weighted: Array, p: int, f: tuple[float, ...], F: Array, e: int, D: Size) -> None:
    """Add to F (ne, 4, d) what the force per length f (d,) at station p of all, weighted (ne, ng, 4), which lies in
    element e, has in it.
    """
    add_shares(F, 4 * len(D) * e, weighted, 4 * p, f, D)


def element_workspace(n: int, D: Size) -> Array:
    """Workspace for how what is conjugate to q of an element follows its n dofs (4, d, n)."""
    return np.empty((4, len(D), n))
