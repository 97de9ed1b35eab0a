"""Lowest eigenpairs of K φ = ω² M φ, with factors of K - σ M by MUMPS and SciPy's solvers for the rest.

M may be singular, as soil has no mass: what has none follows what has. Where few dofs have mass, or nearly all modes
are asked for, the flexibility between them makes a small dense problem, else the pairs are found by the shift-invert
Lanczos method (ARPACK). Modes are normalised by φᵀ M φ = 1.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

import numpy as np
from petsc4py import PETSc
from scipy.linalg import eigh
from scipy.sparse import csr_array
from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh

from riser_soil.core.arrays import Array, IntArray
from riser_soil.errors import SolveError
from riser_soil.solve.direct_solver import use_mumps

SPARE = 10  # modes beyond those asked for, on which the part of K that is not symmetric is tried, too
FEW = 300  # dofs with mass, up to which the problem is a dense one
SEED = 1  # seed of the vector that the search begins with
ROUND_OFF = 1e-12  # of the largest entry: a matrix that misses symmetry by less is symmetric


class Eigenpairs(NamedTuple):
    """Lowest n: squares of the angular frequencies (n,) [rad2/s2], modes (n, free).

    asymmetry: largest share by which the part of K that is not symmetric would change one of the frequencies.
    """

    squares: Array
    modes: Array
    asymmetry: float


def lowest(K: csr_array, M: csr_array, count: int, shift: float) -> Eigenpairs:
    """The modes of the symmetric part of K with the lowest squares, in their order; fewer than `count` where fewer dofs
    have mass. shift: below all squares [rad2/s2]. SolveError where they aren't found.
    """
    symmetric = csr_array(0.5 * (K + K.T))
    with _inverse(csr_array(symmetric - shift * M)) as inverse:
        massive = np.flatnonzero(M.diagonal())
        few = massive.size <= max(FEW, count + SPARE)  # Lanczos' method finds fewer than there are
        shares, modes = _dense(inverse, M, massive) if few else _lanczos(inverse, symmetric, M, count + SPARE, shift)
    squares = shift + 1.0 / shares
    order = np.argsort(squares)[: count + SPARE]
    squares, modes = squares[order], modes[order]
    return Eigenpairs(squares[:count], modes[:count], float(_asymmetry(K, squares, modes)[:count].max()))


def _dense(inverse: LinearOperator, M: csr_array, massive: IntArray) -> tuple[Array, Array]:
    """All 1/(ω² - σ) (n,) and modes (n, free): those of Lᵀ G L, with G the flexibility between what has mass, M = L Lᵀ.
    """
    masses, axes = eigh(M[massive][:, massive].toarray())
    there = masses > ROUND_OFF * masses.max(initial=0.0)
    if not there.any():
        raise SolveError("no modes: nothing that is free to move has mass; refine the riser, or give it mass")
    root = np.zeros((M.shape[0], np.count_nonzero(there)))
    root[massive] = axes[:, there] * np.sqrt(masses[there])
    answer = inverse @ root
    shares, combined = eigh(root.T @ answer)
    return shares, (answer @ combined / shares).T


def _lanczos(
    inverse: LinearOperator, K: csr_array, M: csr_array, count: int, shift: float
) -> tuple[Array, Array]:
    """Shares 1/(ω² - shift) (count,) and modes (count, n) of the eigenpairs nearest to the shift, by Lanczos' method.
    """
    begin = inverse @ (M @ np.random.default_rng(SEED).standard_normal(K.shape[0]))
    try:
        squares, modes = eigsh(K, count, M, sigma=shift, OPinv=inverse, v0=begin)
    except ArpackError as err:
        raise SolveError(f"modes were not found: {err}; ask for fewer, --count") from err
    return 1.0 / (squares - shift), modes.T


def _asymmetry(K: csr_array, squares: Array, modes: Array) -> Array:
    """Shares (n,) by which frequencies differ from those of K itself, reduced to the modes."""
    skew = csr_array(0.5 * (K - K.T))
    if abs(skew).max() <= ROUND_OFF * abs(K).max():
        return np.zeros(len(squares))
    changed = np.sort_complex(np.linalg.eigvals(np.diag(squares) + modes @ (skew @ modes.T)))
    size = np.sqrt(np.maximum(np.abs(squares), ROUND_OFF * np.abs(squares).max()))
    return np.asarray(np.abs(np.sqrt(changed) - np.sqrt(squares.astype(complex))) / size)


@contextmanager
def _inverse(A: csr_array) -> Iterator[LinearOperator]:
    """The inverse of a symmetric matrix, as long as the block lasts."""
    made = PETSc.Mat().createAIJ(A.shape, csr=_as_petsc(A), comm=PETSc.COMM_SELF)
    pc = PETSc.PC().create(PETSc.COMM_SELF)
    x, y = made.createVecs()
    pc.setOperators(made)
    use_mumps(pc, "lu", {})

    def solved(b: Array) -> Array:
        x.array_w[:] = b.ravel()
        pc.apply(x, y)
        return np.array(y.array_r)

    try:
        pc.setUp()
        yield LinearOperator(A.shape, solved, dtype=float)
    except PETSc.Error as err:
        raise SolveError(f"the stiffness of the riser at rest could not be factorised: {err}") from err
    finally:
        for thing in (pc, x, y, made):
            thing.destroy()


def _as_petsc(A: csr_array) -> tuple[Array, Array, Array]:
    return A.indptr.astype(PETSc.IntType), A.indices.astype(PETSc.IntType), A.data
