"""Shape functions of surface facets and their first two derivatives, for compiled kernels.

quad4: ξ, η in [−1, 1]; corners counter-clockwise from (−1, −1).
tri6: ξ, η ≥ 0, ξ + η ≤ 1; corners (0, 0), (1, 0), (0, 1), then the middles of the sides 12, 23, 31.
Both are the node orders of Gmsh and VTK. The number of nodes, 4 or 6, tells the kind.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from riser_soil.arrays import Array

Shape = tuple[Array, Array, Array]


@njit(cache=True)
def shape(nodes: int, xi: float, eta: float) -> Shape:
    """N (nodes,), ∂N/∂ξ_α (nodes, 2) and ∂²N/∂ξ_α∂ξ_β (nodes, 2, 2) at (ξ, η)."""
    if nodes == 4:
        return _quad4(xi, eta)
    return _tri6(xi, eta)


@njit(cache=True)
def inside(nodes: int, xi: float, eta: float, tolerance: float) -> bool:
    """Whether (ξ, η) lies on the facet, its rim widened by the tolerance."""
    if nodes == 4:
        return max(abs(xi), abs(eta)) <= 1.0 + tolerance
    return min(xi, eta, 1.0 - xi - eta) >= -tolerance


@njit(cache=True)
def centre(nodes: int) -> tuple[float, float]:
    """(ξ, η) of the facet's middle."""
    if nodes == 4:
        return (0.0, 0.0)
    return (1.0 / 3.0, 1.0 / 3.0)


@njit(cache=True)
def _quad4(xi: float, eta: float) -> Shape:
    N, dN, ddN = np.empty(4), np.empty((4, 2)), np.zeros((4, 2, 2))
    for a, (x, y) in enumerate(((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))):
        N[a] = 0.25 * (1.0 + x * xi) * (1.0 + y * eta)
        dN[a] = 0.25 * x * (1.0 + y * eta), 0.25 * y * (1.0 + x * xi)
        ddN[a, 0, 1] = ddN[a, 1, 0] = 0.25 * x * y
    return N, dN, ddN


@njit(cache=True)
def _tri6(xi: float, eta: float) -> Shape:
    """Corners N = L(2L − 1), sides N = 4·L·L', in the area coordinates L."""
    N, dN, ddN = np.empty(6), np.empty((6, 2)), np.empty((6, 2, 2))
    L = (1.0 - xi - eta, xi, eta)
    dL = ((-1.0, -1.0), (1.0, 0.0), (0.0, 1.0))
    for i in range(3):
        j, m = (i + 1) % 3, i + 3
        N[i], N[m] = L[i] * (2.0 * L[i] - 1.0), 4.0 * L[i] * L[j]
        for a in range(2):
            dN[i, a] = (4.0 * L[i] - 1.0) * dL[i][a]
            dN[m, a] = 4.0 * (dL[i][a] * L[j] + L[i] * dL[j][a])
            for b in range(2):
                ddN[i, a, b] = 4.0 * dL[i][a] * dL[i][b]
                ddN[m, a, b] = 4.0 * (dL[i][a] * dL[j][b] + dL[i][b] * dL[j][a])
    return N, dN, ddN
