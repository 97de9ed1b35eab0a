"""Normal gap between a point and the deformed facet below it, with exact first and second derivatives.

The facet point below the point x solves Σ N_a(ξ) p_a = x in the two horizontal directions; the ground there
has the height Z = Σ N_a(ξ) z_a and the slopes s = J⁻ᵀ ∂Z/∂ξ, J_iα = Σ p_ai ∂N_a/∂ξ_α. With δ for a variation
of point and facet:

    δξ_α = J⁻¹_αi (δx_i − Σ N_a δp_ai)
    δg   = δz − Σ N_a δz_a − s·(δx − Σ N_a δp_a)
    δ²g  = −2 Σ_α ε_α δξ_α − Σ_αβ H_αβ δξ_α δξ_β
    ε_α  = Σ ∂N_a/∂ξ_α (δz_a − s·δp_a),   H_αβ = Σ ∂²N_a/∂ξ_α∂ξ_β (z_a − s·p_a)

so the five linear forms δg, ε_1, ε_2, δξ_1, δξ_2 and the 2 × 2 matrix H hold everything. The sum of δg's
coefficients is zero in each direction: forces that derive from the gap balance to round-off.
"""

from __future__ import annotations

import numpy as np

from riser_soil.contact.facets import second_derivatives, shape
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit


@njit
def heights(facet: IntArray, xi: Array, facets: IntArray, points: Array) -> Array:
    """Height [m] of the deformed surface at places xi (n, 2) on facets (n,); −inf where the facet is −1."""
    out = np.full(len(facet), -np.inf)
    for i in range(len(facet)):
        if facet[i] >= 0:
            N, _ = shape(facets.shape[1], xi[i, 0], xi[i, 1])
            out[i] = 0.0
            for a, p in enumerate(facets[facet[i]]):
                out[i] += N[a] * points[p, 2]
    return out


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


def penalty_hessian(forms: Array, H: Array, force: Array, slope: Array) -> Array:
    """Second derivative (n, nr, nr) of ψ(−g): slope·δg⊗δg − force·δ²g.

    forms (n, 5, nr), H (n, 2, 2): of `gap_forms`. force, slope (n,): ψ' and ψ'' at the penetration −g.
    """
    core = np.zeros((len(forms), 5, 5))
    core[:, 0, 0] = slope
    core[:, [1, 2], [3, 4]] = core[:, [3, 4], [1, 2]] = force[:, None]
    core[:, 3:, 3:] = force[:, None, None] * H
    hessian: Array = forms.transpose(0, 2, 1) @ (core @ forms)
    return hessian
