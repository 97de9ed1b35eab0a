"""Line kinematics between nodes: cubic Hermite interpolation of positions and unit tangents.

On an element of unstressed arc length L, with xi = s/L in 0..1,

    x(xi) = N1 x1 + N2 t1 + N3 x2 + N4 t2,
    N1 = 1 - 3 xi^2 + 2 xi^3,  N2 = L (xi - 2 xi^2 + xi^3),  N3 = 3 xi^2 - 2 xi^3,  N4 = L (xi^3 - xi^2),

where t1, t2 are the unit tangents at its ends. q = (x1, t1, x2, t2) has shape (ne, 4, d) with d = 2 or 3. A
load gives its residual F_q (ne, 4, d), conjugate to q. The kernels below carry it to the dofs by P = dt/dTheta
(ne, 2, d, r): positions pass, tangents turn with the r rotation dofs of their node.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.rows import add_pulled_back, write_blocks

Four = tuple[float, float, float, float]
Size = tuple[int, ...]  # of `fixed`: D for the dimension d, R for the r rotation dofs


@njit
def shape(xi: float, L: float) -> Four:
    """N1..N4 (1, m, 1, m) at xi."""
    square, cube = xi * xi, xi * xi * xi
    return (
        1.0 - 3.0 * square + 2.0 * cube,
        L * (xi - 2.0 * square + cube),
        3.0 * square - 2.0 * cube,
        L * (cube - square),
    )


@njit
def slope(xi: float, L: float) -> Four:
    """dN1/ds..dN4/ds (1/m, 1, 1/m, 1) at xi; the first and third cancel, so x' depends on the chord only."""
    square = xi * xi
    bow = 6.0 * (xi - square) / L
    return -bow, 1.0 - 4.0 * xi + 3.0 * square, bow, 3.0 * square - 2.0 * xi


@njit
def bend(xi: float, L: float) -> Four:
    """d²N1/ds²..d²N4/ds² (1/m2, 1/m, 1/m2, 1/m) at xi."""
    bow = (6.0 - 12.0 * xi) / (L * L)
    return -bow, (6.0 * xi - 4.0) / L, bow, (6.0 * xi - 2.0) / L


def shapes(xi: Array, L: Array) -> Array:
    """N1..N4 of each element at its own xi, shape (ne, 4)."""
    return np.stack(shape.py_func(xi, L), axis=-1)


def slopes(xi: Array, L: Array) -> Array:
    """dN1/ds..dN4/ds of each element at its own xi, shape (ne, 4)."""
    return np.stack(slope.py_func(xi, L), axis=-1)


def uniform_load(L: Array) -> Array:
    """Integrals of N1..N4 over each element (ne, 4): a load w per length acts on q as these times w."""
    return np.stack([L / 2, L**2 / 12, L / 2, -(L**2) / 12], axis=1)


def consistent_mass(L: Array, mass: Array) -> Array:
    """Integrals of mass N_a N_b over each element (ne, 4, 4); mass in kg/m."""
    scale = np.stack([np.ones_like(L), L, np.ones_like(L), L], axis=1)
    unit = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]) / 420.0
    return (mass * L)[:, None, None] * unit * scale[:, :, None] * scale[:, None, :]


@njit
def interleave(nodal: Array, directors: Array, D: Size) -> Array:
    """q (ne, 4, d) of nodal translations (nn, ≥ d) and directors at element ends (ne, 2, d)."""
    q = np.empty((directors.shape[0], 4, len(D)))
    write_interleaved(nodal, directors, q, D)
    return q


@njit
def write_interleaved(nodal: Array, directors: Array, q: Array, D: Size) -> None:
    """Write what `interleave` returns."""
    for e in range(directors.shape[0]):
        for side in range(2):
            for i in range(len(D)):
                q[e, 2 * side, i] = nodal[e + side, i]
                q[e, 2 * side + 1, i] = directors[e, side, i]


def weigh(M: Array, q: Array) -> Array:
    """M q of each element (ne, 4, d) for matrices M (ne, 4, 4) of shape functions."""
    F = np.zeros(q.shape)
    add_weighed(M, q, F, fixed(q.shape[2]))
    return F


@njit
def add_weighed(M: Array, q: Array, F: Array, D: Size) -> None:
    """Add what `weigh` returns to F (ne, 4, d)."""
    for e in range(q.shape[0]):
        for a in range(4):
            for i in range(len(D)):
                total = 0.0
                for b in range(4):
                    total += M[e, a, b] * q[e, b, i]
                F[e, a, i] += total


def pull_back(F: Array, P: Array) -> Array:
    """Element residual in the dofs, (ne, 2 (d + r)), of F (ne, 4, d) conjugate to q."""
    pulled = np.empty((P.shape[0], 2 * (P.shape[2] + P.shape[3])))
    write_pulled_back(F, P, pulled, fixed(P.shape[2]), fixed(P.shape[3]))
    return pulled


@njit
def write_pulled_back(F: Array, P: Array, out: Array, D: Size, R: Size) -> None:
    """Write what `pull_back` returns."""
    d, r = len(D), len(R)
    for e in range(P.shape[0]):
        for side in range(2):
            at = side * (d + r)
            for i in range(d):
                out[e, at + i] = F[e, 2 * side, i]
            for k in range(r):
                total = 0.0
                for i in range(d):
                    total += P[e, side, i, k] * F[e, 2 * side + 1, i]
                out[e, at + d + k] = total


@njit
def scatter(element: Array, nodal: Array) -> None:
    """Add element arrays (ne, 2 ndof) along the chain to nodal (nn, ndof)."""
    ndof = nodal.shape[1]
    for e in range(element.shape[0]):
        for i in range(ndof):
            nodal[e, i] += element[e, i]
            nodal[e + 1, i] += element[e, ndof + i]


@njit
def collect_nodal(F: Array, P: Array, nodal: Array, D: Size, R: Size) -> None:
    """Add F (ne, 4, d) conjugate to q, pulled back and summed along the chain, to nodal (nn, d + r)."""
    d = len(D)
    for e in range(P.shape[0]):
        for side in range(2):
            for i in range(d):
                nodal[e + side, i] += F[e, 2 * side, i]
            for k in range(len(R)):
                total = 0.0
                for i in range(d):
                    total += P[e, side, i, k] * F[e, 2 * side + 1, i]
                nodal[e + side, d + k] += total


@njit
def write_rows(P: Array, shift: float, out: Array, D: Size, R: Size) -> None:
    """Write how the coordinates of positions and tangents at an element's ends follow its dofs, to out (d, n): a row
    for each coordinate; positions by `shift`, tangents by P (2, d, r). `core.rows` takes them, with shape functions.
    """
    n = len(D) + len(R)
    for i in range(len(D)):
        for side in range(2):
            for j in range(len(D)):
                out[i, side * n + j] = shift if i == j else 0.0
            for k in range(len(R)):
                out[i, side * n + len(D) + k] = P[side, i, k]


@njit
def write_all_rows(P: Array, shift: float, out: Array, D: Size, R: Size) -> None:
    """`write_rows` of all elements, out (ne, d, n)."""
    for e in range(out.shape[0]):
        write_rows(P[e], shift, out[e], D, R)


@njit
def add_mass_to(out: Array, scale: float, P: Array, rows: Array, M: Array, D: Size, R: Size) -> None:
    """Add scale P^T M D to out (ne, n, n), D being the derivative of q'' by the dofs, given by its rows, see
    `write_rows`; M (ne, 4, 4) as in `weigh`.
    """
    S = np.empty((4, len(D), 2 * (len(D) + len(R))))  # M D of one element
    for e in range(P.shape[0]):
        write_blocks(S, M[e], scale, rows[e], D, R)
        add_pulled_back(out[e], P[e], S, D, R)


@njit
def add_geometric(out: Array, scale: float, G: Array, d: int) -> None:
    """Add scale G, (ne, 2, r, r), to the rotation blocks of out (ne, 2 (d + r), 2 (d + r))."""
    r = G.shape[2]
    for e in range(G.shape[0]):
        for side in range(2):
            at = side * (d + r) + d
            for i in range(r):
                for j in range(r):
                    out[e, at + i, at + j] += scale * G[e, side, i, j]


def axis_at(nodes: Array, position: Array, tangent: Array, arc: Array) -> tuple[Array, Array]:
    """Position of the axis (nt, 3) [m] and its derivative by the arc length (nt, 3), global axes, at arc lengths (nt,).

    Of the nodes arc lengths (nn,) and, at each of nt states, positions (nt, nn, 3); tangent (nt, ne, 2, 3): of the
    elements' ends. nan at an arc length of nan.
    """
    e, row = np.clip(np.searchsorted(nodes, arc) - 1, 0, nodes.size - 2), np.arange(arc.size)
    length = nodes[e + 1] - nodes[e]
    xi, q = (arc - nodes[e]) / length, (position[row, e], tangent[row, e, 0], position[row, e + 1], tangent[row, e, 1])
    of_arrays = (getattr(kernel, "py_func", kernel) for kernel in (shape, slope))  # kernels are for one element
    place, direction = (
        sum(share[:, None] * each for share, each in zip(shares(xi, length), q, strict=True)) for shares in of_arrays
    )
    return np.asarray(place), np.asarray(direction)
