"""Shape functions of surface facets and their first and second derivatives.

quad4: ξ, η in [−1, 1]; corners counter-clockwise from (−1, −1).
tri6: ξ, η ≥ 0, ξ + η ≤ 1; corners (0, 0), (1, 0), (0, 1), then the middles of the sides 12, 23, 31.
Both are the node orders of Gmsh and VTK.
strip8: quad4, then the next nodes across, beyond η = −1 twice and beyond η = 1 twice, in the order of the corners
beside them. It is linear in ξ, and in η the smooth curve through four nodes of Catmull & Rom (1974), whose slope at a
node is half of what lies between its neighbours. A node that has no next one is its own.
The number of nodes, 4, 6 or 8, tells the kind.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit

QUAD = ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))  # corners of quad4
AREA = ((-1.0, -1.0), (1.0, 0.0), (0.0, 1.0))  # gradients of the area coordinates of tri6


def strips(corners: IntArray) -> IntArray:
    """strip8 (nf, 8) of facets of four nodes (nf, 4), whose eta runs across."""
    beyond: dict[frozenset[int], list[tuple[int, dict[int, int]]]] = {}
    for f, (a, b, c, d) in enumerate(corners.tolist()):
        beyond.setdefault(frozenset((a, b)), []).append((f, {a: d, b: c}))
        beyond.setdefault(frozenset((c, d)), []).append((f, {d: a, c: b}))

    def follows(f: int, node: int, beside: int) -> int:
        """The node beyond the side of a facet that a node lies on with another one."""
        return next((to[node] for g, to in beyond[frozenset((node, beside))] if g != f), node)

    def around(f: int, a: int, b: int, c: int, d: int) -> tuple[int, int, int, int]:
        return follows(f, a, b), follows(f, b, a), follows(f, c, d), follows(f, d, c)

    outer = [around(f, *nodes) for f, nodes in enumerate(corners.tolist())]
    return np.hstack([corners, np.array(outer, dtype=np.int64).reshape(-1, 4)])


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
    elif N.size == 8:
        _strip8(xi, eta, N, dN)
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
def triangular(nodes: int) -> bool:
    """Whether facets of so many nodes are tri6."""
    return nodes == 6


@njit
def inside(nodes: int, xi: float, eta: float, tolerance: float) -> bool:
    """Whether (ξ, η) lies on the facet, its rim widened by the tolerance."""
    if not triangular(nodes):
        return max(abs(xi), abs(eta)) <= 1.0 + tolerance
    return min(xi, eta, 1.0 - xi - eta) >= -tolerance


@njit
def centre(nodes: int) -> tuple[float, float]:
    """(ξ, η) of the facet's middle."""
    if not triangular(nodes):
        return (0.0, 0.0)
    return (1.0 / 3.0, 1.0 / 3.0)


@njit
def _quad4(xi: float, eta: float, N: Array, dN: Array) -> None:
    for a, (x, y) in enumerate(QUAD):
        N[a] = 0.25 * (1.0 + x * xi) * (1.0 + y * eta)
        dN[a, 0], dN[a, 1] = 0.25 * x * (1.0 + y * eta), 0.25 * y * (1.0 + x * xi)


@njit
def _strip8(xi: float, eta: float, N: Array, dN: Array) -> None:
    t = 0.5 * (1.0 + eta)
    w = (-t + 2.0 * t**2 - t**3, 2.0 - 5.0 * t**2 + 3.0 * t**3, t + 4.0 * t**2 - 3.0 * t**3, -(t**2) + t**3)
    slope = (
        *(-1.0 + 4.0 * t - 3.0 * t**2, -10.0 * t + 9.0 * t**2),
        *(1.0 + 8.0 * t - 9.0 * t**2, -2.0 * t + 3.0 * t**2),
    )
    for a in range(8):
        x = -1.0 if a in (0, 3, 4, 7) else 1.0
        k = 1 if a < 2 else 2 if a < 4 else 0 if a < 6 else 3
        along = 0.5 * (1.0 + x * xi)
        N[a] = 0.5 * w[k] * along
        dN[a, 0], dN[a, 1] = 0.25 * x * w[k], 0.25 * slope[k] * along


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
