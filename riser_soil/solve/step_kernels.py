"""Kernels of Newton's method for a time step of lines and bodies: rates, residual, norms, band, Newton update.

These are what every riser has; those of its parts are in `part_kernels`. `packed_line` binds both to their arguments,
so that each is compiled once for all risers.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core import banded
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.csr_matrix import add_magnitudes
from riser_soil.core.part import Weights
from riser_soil.core.rows import add_multiple
from riser_soil.riser.hermite import Size
from riser_soil.riser.part_kernels import LineForces
from riser_soil.solve.residual_norm import above_round_off, square_of, squares_in_play

ONE = fixed(1)
NONE, SINGULAR, TOO_NARROW = range(3)
"""Failures (1,) of an iteration, which kernels write: of the tangent, or of the room for what touches the lines."""


class StepData(NamedTuple):
    """A step to solve; arrays (nn, ndof). u: the first guess, then the solution, and v and a its rates. These follow u
    from v0 and a0 by the shifts, but for what is fixed, whose rates are in v0 and a0. past: see `time_scheme`.
    """

    u: Array
    v0: Array
    a0: Array
    v: Array
    a: Array
    past: Array


class Dofs(NamedTuple):
    """What is known of the dofs, (nn, ndof): whether they are fixed; levers [m] of moments; residual [N] of the last
    trial, zero where they are; sizes of the coordinates, and of the terms [N] that the residual is made of.
    """

    fixed: BoolArray
    levers: Array
    residual: Array
    sizes: Array
    terms: Array


class MatrixWorkspace(NamedTuple):
    """Workspace for the tangent: element matrices K (ne, n, n), and their rows (ne, n); the matrix as in `banded`, its
    pivots and its band.
    """

    K: Array
    rows: IntArray
    ab: Array
    pivots: IntArray
    band: Size


@njit
def follow(step: StepData, weights: Weights, dofs: Dofs) -> None:
    """Write the rates that follow the increments."""
    n = step.u.size
    u, fixed = step.u.reshape(n), dofs.fixed.reshape(n)
    write_rates(u, fixed, step.v0.reshape(n), weights.shift_v, step.v.reshape(n))
    write_rates(u, fixed, step.a0.reshape(n), weights.shift_a, step.a.reshape(n))


@njit
def write_rates(u: Array, fixed: BoolArray, start: Array, shift: float, out: Array) -> None:
    """Write rates (n,) that follow the increments u by a shift, but for those of fixed dofs; start: without increments.
    """
    for k in range(u.size):
        out[k] = start[k] + (0.0 if fixed[k] else shift * u[k])


@njit
def combine(forces: LineForces, step: StepData, weights: Weights, dofs: Dofs) -> None:
    """Write the residual of the weighted groups, zero where dofs are fixed."""
    n = dofs.residual.size
    groups = forces.inertia.reshape(n), forces.force.reshape(n), forces.end.reshape(n)
    residual, fixed = dofs.residual.reshape(n), dofs.fixed.reshape(n)
    write_balance(groups, weights.inertia, weights.force, step.past.reshape(n), residual)
    for k in range(n):
        residual[k] = 0.0 if fixed[k] else residual[k]


@njit
def write_balance(
    groups: tuple[Array, Array, Array], inertia: float, force: float, past: Array, out: Array
) -> None:
    """Write the residual (n,) of forces by group, see `Forces`, two of them weighted, with the share of the past."""
    for k in range(out.size):
        out[k] = inertia * groups[0][k] + force * groups[1][k] + groups[2][k] + past[k]


@njit
def add_norms(forces: LineForces, dofs: Dofs, sums: Array) -> None:
    """Add to sums (5,) the squares of the norms [N] of the residual of what is free, moments over the lever, of its
    share where nothing touches, and of the forces in play, see `squares_in_play`.
    """
    nodes, ndof = dofs.fixed.shape
    n = nodes * ndof
    residual, levers = dofs.residual.reshape(n), dofs.levers.reshape(n)
    for node in range(nodes):
        own, touched = square_of(residual, levers, node * ndof, (node + 1) * ndof), False
        for i in range(ndof):
            touched |= forces.end[node, i] != 0.0
        sums[0] += own
        sums[1] += 0.0 if touched else own
    inertia, force, end = forces.inertia.reshape(n), forces.force.reshape(n), forces.end.reshape(n)
    reactions, moving, contact = squares_in_play(inertia, force, end, levers, dofs.fixed.reshape(n), n)
    sums[2] += reactions
    sums[3] += moving
    sums[4] += contact


@njit
def write_norms(sums: Array, norms: Array) -> None:
    """Write the norms (3,) [N] of the residual, of its share where nothing touches, and of the forces in play, by the
    squares that `add_norms` has added up.
    """
    norms[0], norms[1] = math.sqrt(sums[0]), math.sqrt(sums[1])
    norms[2] = math.sqrt(max(sums[2], sums[3], sums[4]))


@njit
def set_zero(values: Array) -> None:
    """Write zero, or false."""
    values[:] = 0


@njit
def begin_with(bulk: Array, K: Array) -> None:
    """Write the element matrices of all but contact."""
    target, source = K.reshape(K.size), bulk.reshape(K.size)
    for k in range(K.size):
        target[k] = source[k]


@njit
def write_terms(workspace: MatrixWorkspace, dofs: Dofs) -> None:
    """Write the terms that the residual is made of, see `residual_norm`; K: at fixed rates."""
    terms = dofs.terms.reshape(dofs.terms.size)
    terms[:] = 0.0
    add_terms(workspace, dofs)


@njit
def add_terms(workspace: MatrixWorkspace, dofs: Dofs) -> None:
    """Add those of K, which may be a share of the tangent."""
    n, rows = dofs.terms.size, workspace.rows
    add_magnitudes(workspace.K, rows, rows, dofs.sizes.reshape(n), dofs.terms.reshape(n))


@njit
def find_above(dofs: Dofs, above: BoolArray) -> None:
    """Set above (1,) where some entry of the residual is above its round-off."""
    n = dofs.terms.size
    above[0] |= above_round_off(dofs.residual.reshape(n), dofs.terms.reshape(n))


@njit
def fill(workspace: MatrixWorkspace, dofs: Dofs) -> None:
    """Sum element matrices into the banded one, with ones on the diagonal for what is fixed."""
    K, ab, fixed = workspace.K, workspace.ab, dofs.fixed
    b, n, ndof, width = len(workspace.band), len(workspace.band) + 1, fixed.shape[1], ab.shape[1]
    ab[:] = 0.0
    for e in range(K.shape[0]):
        for i in range(len(workspace.band) + 1):
            add_multiple(ab, (e * ndof + i) * width + b - i, 1.0, K, (e * n + i) * n, workspace.band + ONE)
    for k, is_fixed in enumerate(fixed.ravel()):
        if is_fixed:
            ab[k] = 0.0
            for i in range(max(0, k - b), min(fixed.size, k + b + 1)):
                ab[i, k - i + b] = 0.0
            ab[k, b] = 1.0


@njit
def factorise(workspace: MatrixWorkspace, failure: IntArray) -> None:
    """Factorise the matrix."""
    if not banded.factorise(workspace.ab, workspace.pivots, workspace.band):
        failure[0] = SINGULAR


@njit
def improve(workspace: MatrixWorkspace, step: StepData, dofs: Dofs) -> None:
    """Newton update u -= K⁻¹ r of the free dofs."""
    size = dofs.residual.size
    fixed, change, u = dofs.fixed.reshape(size), dofs.residual.reshape(size), step.u.reshape(size)
    banded.solve(workspace.ab, workspace.pivots, change, workspace.band)
    for k in range(size):
        u[k] -= 0.0 if fixed[k] else change[k]


def matrix_workspace(nodes: int, ndof: int) -> MatrixWorkspace:
    """Workspace for the tangent of a line, or of a body, one node."""
    ends, size = min(nodes, 2), nodes * ndof
    elements = nodes + 1 - ends
    matrix, band = banded.workspace(size, ends * ndof - 1)
    return MatrixWorkspace(
        np.empty((elements, ends * ndof, ends * ndof)),
        ndof * np.arange(elements)[:, None] + np.arange(ends * ndof),
        matrix,
        np.empty(size, dtype=np.int64),
        band,
    )
