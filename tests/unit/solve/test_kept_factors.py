"""Kept factors as a linear solver: solutions, new factors where the old don't do, saved and restored."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from mpi4py import MPI
from petsc4py import PETSc

from riser_soil.core.arrays import Array
from riser_soil.core.factor_memory import Workspace
from riser_soil.solve.kept_factors import FIRST_RATE, KeptFactors

SIDE = 14  # cells along each edge of a cube: factors of fewer are worth too few solves by the counts of MUMPS 5.7
TOLERANCE = 1e-8
RANDOM = np.random.default_rng(5)


class Solver:
    """Solves matrices of a size one after the other, with factors that are kept."""

    def __init__(self, symmetric: bool, levers: Array | float = 1.0) -> None:
        self.kept = KeptFactors(MPI.COMM_SELF, symmetric, Workspace())
        self._ksp = PETSc.KSP().create(PETSc.COMM_SELF)
        self._ksp.setTolerances(rtol=TOLERANCE)
        levers = PETSc.Vec().createWithArray(np.full(len(K), levers), comm=PETSc.COMM_SELF)
        self.kept.attach(self._ksp, levers)

    def solution(self, rows: Array, b: Array) -> Array:
        """Solution of A x = b, A with the pattern of dense rows (n, n) and their values."""
        matrix = sparse(rows)
        self._ksp.setOperators(matrix)
        x, right = matrix.createVecs()
        right.array_w[:] = b
        self._ksp.solve(right, x)
        assert self._ksp.reason > 0
        return np.asarray(x.array_r.copy())

    def destroy(self) -> None:
        self._ksp.destroy()
        self.kept.forget()


@pytest.fixture
def symmetric() -> Iterator[Solver]:
    solver = Solver(symmetric=True)
    yield solver
    solver.destroy()


@pytest.fixture
def skew() -> Iterator[Solver]:
    solver = Solver(symmetric=False)
    yield solver
    solver.destroy()


def sparse(rows: Array) -> PETSc.Mat:
    n = len(rows)
    at = rows != 0.0
    csr = np.append(0, np.cumsum(at.sum(axis=1))), np.nonzero(at)[1], rows[at]
    return PETSc.Mat().createAIJ((n, n), csr=tuple(part.astype(kind) for part, kind in zip(csr, "iid", strict=True)))


def springs() -> Array:
    """Stiffness of a cube of nodes with springs between neighbours, held all around."""
    chain = np.diag(np.full(SIDE, 2.0)) - np.eye(SIDE, k=1) - np.eye(SIDE, k=-1)
    one = np.eye(SIDE)
    along = ((chain, one, one), (one, chain, one), (one, one, chain))
    return np.sum([np.kron(np.kron(a, b), c) for a, b, c in along], axis=0)


K = springs()
B = RANDOM.normal(size=len(K))


def stiffened(factor: float, nodes: int) -> Array:
    """The matrix with stiffer springs to the ground at some nodes, as contact makes them."""
    out = K.copy()
    out[np.arange(nodes), np.arange(nodes)] *= factor
    return out


def residual(A: Array, x: Array) -> float:
    return float(np.linalg.norm(A @ x - B) / np.linalg.norm(B))


def test_a_change_at_a_node_takes_two_iterations_and_no_factorisation(symmetric: Solver) -> None:
    """(K + U) K^-1 differs from one by a matrix of rank one."""
    symmetric.solution(K, B)
    changed = stiffened(50.0, 1)
    assert residual(changed, symmetric.solution(changed, B)) <= TOLERANCE
    assert symmetric.kept.factorisations == 1
    assert symmetric.kept.iterations == 1 + 2


def test_factors_that_do_not_do_are_made_anew_at_once(symmetric: Solver) -> None:
    """Factors of K on other springs everywhere, 1e-4 to 1e4 as stiff: the first iterations tell that it would take far
    more than new factors are worth.
    """
    symmetric.solution(K, B)
    scale = 10.0 ** RANDOM.uniform(-4.0, 4.0, size=len(K))
    changed = np.sqrt(np.outer(scale, scale)) * K
    assert residual(changed, symmetric.solution(changed, B)) <= TOLERANCE
    assert symmetric.kept.factorisations == 2
    assert symmetric.kept.iterations == 1 + FIRST_RATE + 1


def test_factors_are_made_anew_once_a_solve_costs_more_than_the_mean(symmetric: Solver) -> None:
    """So that no solve pays for factors that no longer suit it. The change grows from solve to solve; how often
    hangs on what a factorisation is worth by the counts of MUMPS, whose versions order differently.
    """
    for k in range(20):
        symmetric.solution(stiffened(50.0, 1 + k), B)
    assert 2 <= symmetric.kept.factorisations <= 10


def test_moments_count_over_their_levers(symmetric: Solver) -> None:
    """Turns in place of every other displacement, with levers of 1000 m: they make the same of it."""
    levers = np.where(np.arange(len(K)) % 2, 1024.0, 1.0)
    turned, changed = Solver(symmetric=True, levers=levers), stiffened(50.0, 30)
    for A in (K, changed):
        x = symmetric.solution(A, B)
        other = turned.solution(np.outer(levers, levers) * A, levers * B)
        np.testing.assert_allclose(levers * other, x, rtol=0.0, atol=1e-12 * np.abs(x).max())
    assert turned.kept.iterations == symmetric.kept.iterations
    turned.destroy()


def test_one_triangle_is_enough_where_little_symmetry_is_missing(skew: Solver) -> None:
    changed = K.copy()
    changed[np.triu_indices(len(K), 1)] *= 1.01
    assert residual(changed, skew.solution(changed, B)) <= TOLERANCE
    assert skew.kept.factorisations == 1
    assert 1 < skew.kept.iterations <= 10


def test_all_of_the_matrix_is_factorised_from_then_on_where_a_triangle_does_not_do(skew: Solver) -> None:
    """A chain that only hangs on one side: its upper triangle, mirrored, is another one."""
    flow = np.eye(len(K)) - 0.999 * np.eye(len(K), k=-1) + 1e-3 * np.eye(len(K), k=1)
    assert residual(flow, skew.solution(flow, B)) <= TOLERANCE
    assert skew.kept.factorisations == 2
    assert residual(2.0 * flow, skew.solution(2.0 * flow, B)) <= TOLERANCE
    assert skew.kept.factorisations == 2


def test_factors_outlive_a_new_pattern(symmetric: Solver) -> None:
    """A spring between two nodes that had none, as where contact begins."""
    symmetric.solution(K, B)
    symmetric.kept.renew()
    changed = K.copy()
    changed[0, 7] = changed[7, 0] = -0.5
    assert residual(changed, symmetric.solution(changed, B)) <= TOLERANCE
    assert symmetric.kept.factorisations == 1


def test_new_factors_have_the_new_pattern(symmetric: Solver) -> None:
    symmetric.solution(K, B)
    symmetric.kept.renew()
    scale = 10.0 ** RANDOM.uniform(-4.0, 4.0, size=len(K))
    changed = np.sqrt(np.outer(scale, scale)) * K
    changed[0, 7] = changed[7, 0] = -0.5 * np.sqrt(scale[0] * scale[7])
    assert residual(changed, symmetric.solution(changed, B)) <= TOLERANCE
    assert symmetric.kept.factorisations == 2


def test_restored_factors_go_on_to_the_last_bit(symmetric: Solver) -> None:
    for k in range(3):
        symmetric.solution(stiffened(50.0, 1 + k), B)
    made, other = symmetric.kept.factorisations, Solver(symmetric=True)
    other.kept.restore(symmetric.kept.state())
    for k in range(3, 11):
        assert np.array_equal(symmetric.solution(stiffened(50.0, k), B), other.solution(stiffened(50.0, k), B))
    assert other.kept.factorisations == symmetric.kept.factorisations - made > 0
    other.destroy()


def test_nothing_is_saved_of_factors_that_are_not_there(symmetric: Solver) -> None:
    other = Solver(symmetric=True)
    other.kept.restore(symmetric.kept.state())
    assert residual(K, other.solution(K, B)) <= TOLERANCE
    other.destroy()
