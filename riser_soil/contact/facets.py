"""Facets of the soil's surface: shape functions, and the normal gap of a point above one, with exact derivatives.

quad4: ξ, η in [−1, 1]; corners counter-clockwise from (−1, −1).
tri6: ξ, η ≥ 0, ξ + η ≤ 1; corners (0, 0), (1, 0), (0, 1), then the middles of the sides 12, 23, 31.
Both are the node orders of Gmsh and VTK.
strip8: quad4, then the next nodes across, beyond η = −1 twice and beyond η = 1 twice, in the order of the corners
beside them. It is linear in ξ, and in η the smooth curve through four nodes of Catmull & Rom (1974), whose slope at a
node is half of what lies between its neighbours. A node that has no next one is its own.
The number of nodes, 4, 6 or 8, determines the kind.

The gap is that between a point and the deformed facet below it. The facet point below the point x solves Σ N_a(ξ) p_a =
x in the two horizontal directions; the ground there has the height Z = Σ N_a(ξ) z_a and the slopes s = J⁻ᵀ ∂Z/∂ξ, J_iα
= Σ p_ai ∂N_a/∂ξ_α. With δ for a variation of point and facet:

    δξ_α = J⁻¹_αi (δx_i − Σ N_a δp_ai)
    δg   = δz − Σ N_a δz_a − s·(δx − Σ N_a δp_a)
    δ²g  = −2 Σ_α ε_α δξ_α − Σ_αβ H_αβ δξ_α δξ_β
    ε_α  = Σ ∂N_a/∂ξ_α (δz_a − s·δp_a),   H_αβ = Σ ∂²N_a/∂ξ_α∂ξ_β (z_a − s·p_a)

so the five linear forms δg, ε_1, ε_2, δξ_1, δξ_2 and the 2 × 2 matrix H hold everything. The sum of δg's
coefficients is zero in each direction: forces that derive from the gap balance to round-off.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array, IntArray, as_list
from riser_soil.core.compiled import njit

QUAD = ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))  # corners of quad4
AREA = ((-1.0, -1.0), (1.0, 0.0), (0.0, 1.0))  # gradients of the area coordinates of tri6


def strips(corners: IntArray) -> IntArray:
    """strip8 (nf, 8) of facets of four nodes (nf, 4), whose eta runs across."""
    beyond: dict[frozenset[int], list[tuple[int, dict[int, int]]]] = {}
    for f, (a, b, c, d) in enumerate(as_list(corners)):
        beyond.setdefault(frozenset((a, b)), []).append((f, {a: d, b: c}))
        beyond.setdefault(frozenset((c, d)), []).append((f, {d: a, c: b}))

    def follows(f: int, node: int, beside: int) -> int:
        """The node beyond the side of a facet that a node lies on with another one."""
        return next((to[node] for g, to in beyond[frozenset((node, beside))] if g != f), node)

    def around(f: int, a: int, b: int, c: int, d: int) -> tuple[int, int, int, int]:
        return follows(f, a, b), follows(f, b, a), follows(f, c, d), follows(f, d, c)

    outer = [around(f, *nodes) for f, nodes in enumerate(as_list(corners))]
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


@njit
def heights(facet: IntArray, xi: Array, facets: IntArray, points: Array) -> Array:
    """Height [m] of the deformed surface at places xi (n, 2) on facets (n,); −inf where the facet is −1."""
    out = np.full(len(facet), -np.inf)
    for i in range(len(facet)):
        if facet[i] >= 0:
            out[i] = height_at(facets[facet[i]], xi[i, 0], xi[i, 1], points)
    return out


@njit
def height_at(nodes: IntArray, xi: float, eta: float, points: Array) -> float:
    """Height [m] of the deformed surface at a place (xi, eta) on one facet of nodes (nv,)."""
    N, _ = shape(len(nodes), xi, eta)
    height = 0.0
    for a, p in enumerate(nodes):
        height += N[a] * points[p, 2]
    return height


@njit
def gap_forms(facet: IntArray, xi: Array, facets: IntArray, points: Array) -> tuple[Array, Array]:
    """Linear forms (n, 5, 3 + 3·nv) and H (n, 2, 2).

    Columns: the point's x, y, z, then those of the facet's nodes.
    facet (n,), xi (n, 2): where the points are above. facets (nf, nv). points (np, 3): deformed [m].
    """
    n, nv = len(facet), facets.shape[1]
    ddN = second_derivatives(nv)
    forms, H = np.empty((n, 5, 3 + 3 * nv)), np.empty((n, 2, 2))
    for i in range(n):
        _forms_of_one(xi[i], points[facets[facet[i]]], ddN, forms[i], H[i])
    return forms, H


@njit
def _forms_of_one(xi: Array, at: Array, ddN: Array, forms: Array, H: Array) -> None:
    nv = len(at)
    N, dN = shape(nv, xi[0], xi[1])
    grad = np.zeros((3, 2))
    for a in range(nv):
        for i in range(3):
            grad[i, 0] += at[a, i] * dN[a, 0]
            grad[i, 1] += at[a, i] * dN[a, 1]
    det = grad[0, 0] * grad[1, 1] - grad[0, 1] * grad[1, 0]
    inverse = ((grad[1, 1] / det, -grad[0, 1] / det, 0.0), (-grad[1, 0] / det, grad[0, 0] / det, 0.0))
    sx = inverse[0][0] * grad[2, 0] + inverse[1][0] * grad[2, 1]
    sy = inverse[0][1] * grad[2, 0] + inverse[1][1] * grad[2, 1]
    normal = (-sx, -sy, 1.0)
    H[:] = 0.0
    for k in range(nv + 1):
        # The point itself enters as a node of shape function −1.
        n, n1, n2 = (-1.0, 0.0, 0.0) if k == 0 else (N[k - 1], dN[k - 1, 0], dN[k - 1, 1])
        for i in range(3):
            column = 3 * k + i
            forms[0, column] = -n * normal[i]
            forms[1, column], forms[2, column] = n1 * normal[i], n2 * normal[i]
            forms[3, column], forms[4, column] = -n * inverse[0][i], -n * inverse[1][i]
    for a in range(nv):
        height = at[a, 2] - sx * at[a, 0] - sy * at[a, 1]
        for p in range(2):
            for q in range(2):
                H[p, q] += ddN[a, p, q] * height


@njit
def penalty_hessian(forms: Array, H: Array, force: Array, slope: Array) -> Array:
    """Second derivative (n, nr, nr) of ψ(−g): slope·δg⊗δg − force·δ²g.

    forms (n, 5, nr), H (n, 2, 2): of `gap_forms`. force, slope (n,): ψ' and ψ'' at the penetration −g.
    """
    n, nr = len(force), forms.shape[2]
    out = np.empty((n, nr, nr))
    for i in range(n):
        g, g1, g2, x1, x2 = forms[i, 0], forms[i, 1], forms[i, 2], forms[i, 3], forms[i, 4]
        for a in range(nr):
            # What of the point's place on the facet belongs to the second variation.
            h1, h2 = H[i, 0, 0] * x1[a] + H[i, 0, 1] * x2[a], H[i, 1, 0] * x1[a] + H[i, 1, 1] * x2[a]
            for b in range(nr):
                turned = g1[a] * x1[b] + x1[a] * g1[b] + g2[a] * x2[b] + x2[a] * g2[b] + h1 * x1[b] + h2 * x2[b]
                out[i, a, b] = slope[i] * g[a] * g[b] + force[i] * turned
    return out


@njit
def within_line(forms: Array, basis: Array) -> Array:
    """Forms (n, 5, d + 3·nv) whose first columns are those of a point of a line, with basis (3, d)."""
    n, d, nr = len(forms), basis.shape[1], forms.shape[2]
    out = np.zeros((n, 5, d + nr - 3))
    for i in range(n):
        for k in range(5):
            for j in range(d):
                for c in range(3):
                    out[i, k, j] += forms[i, k, c] * basis[c, j]
            for c in range(3, nr):
                out[i, k, d + c - 3] = forms[i, k, c]
    return out
