"""Shape functions of surface facets and their first and second derivatives.

quad4: ξ, η in [−1, 1]; corners counter-clockwise from (−1, −1).
tri6: ξ, η ≥ 0, ξ + η ≤ 1; corners (0, 0), (1, 0), (0, 1), then the middles of the sides 12, 23, 31.
Both are the node orders of Gmsh and VTK. The number of nodes, 4 or 6, tells the kind.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit

QUAD = ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))  # corners of quad4
AREA = ((-1.0, -1.0), (1.0, 0.0), (0.0, 1.0))  # gradients of the area coordinates of tri6


@njit
def shape(nodes: int, xi: float, eta: float) -> tuple[Array, Array]:
    """N (nodes,) and ∂N/∂ξ_α (nodes, 2) at (ξ, η)."""
    N, dN = np.empty(nodes), np.empty((nodes, 2))
    fill_shape(xi, eta, N, dN)
    return N, dN


@njit
def fill_shape(xi: float, eta: float, N: Array, dN: Array) -> None:
    """Write `shape` to N (nodes,) and dN (nodes, 2)."""
    if N.size == 4:
        _quad4(xi, eta, N, dN)
    else:
        _tri6(xi, eta, N, dN)


@njit
def second_derivatives(nodes: int) -> Array:
    """∂²N/∂ξ_α∂ξ_β (nodes, 2, 2), constant over the facet."""
    ddN = np.zeros((nodes, 2, 2))
    if nodes == 4:
        for a, (x, y) in enumerate(QUAD):
            ddN[a, 0, 1] = ddN[a, 1, 0] = 0.25 * x * y
        return ddN
    for i in range(3):
        j = (i + 1) % 3
        for a in range(2):
            for b in range(2):
                ddN[i, a, b] = 4.0 * AREA[i][a] * AREA[i][b]
                ddN[i + 3, a, b] = 4.0 * (AREA[i][a] * AREA[j][b] + AREA[j][a] * AREA[i][b])
    return ddN


@njit
def inside(nodes: int, xi: float, eta: float, tolerance: float) -> bool:
    """Whether (ξ, η) lies on the facet, its rim widened by the tolerance."""
    if nodes == 4:
        return max(abs(xi), abs(eta)) <= 1.0 + tolerance
    return min(xi, eta, 1.0 - xi - eta) >= -tolerance


@njit
def centre(nodes: int) -> tuple[float, float]:
    """(ξ, η) of the facet's middle."""
    if nodes == 4:
        return (0.0, 0.0)
    return (1.0 / 3.0, 1.0 / 3.0)


@njit
def _quad4(xi: float, eta: float, N: Array, dN: Array) -> None:
    for a, (x, y) in enumerate(QUAD):
        N[a] = 0.25 * (1.0 + x * xi) * (1.0 + y * eta)
        dN[a, 0], dN[a, 1] = 0.25 * x * (1.0 + y * eta), 0.25 * y * (1.0 + x * xi)


@njit
def _tri6(xi: float, eta: float, N: Array, dN: Array) -> None:
    """Corners N = L(2L − 1), sides N = 4·L·L', in the area coordinates L."""
    L = (1.0 - xi - eta, xi, eta)
    for i in range(3):
        j, m = (i + 1) % 3, i + 3
        N[i], N[m] = L[i] * (2.0 * L[i] - 1.0), 4.0 * L[i] * L[j]
        for a in range(2):
            dN[i, a] = (4.0 * L[i] - 1.0) * AREA[i][a]
            dN[m, a] = 4.0 * (AREA[i][a] * L[j] + L[i] * AREA[j][a])
