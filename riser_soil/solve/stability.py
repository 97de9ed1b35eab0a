"""Stability of equilibria: negative eigenvalues of the tangent.

The negative pivots of a factorisation are counted. Entries of the tangent K and of its factors have a relative error of
about eps. Such an error lies between -B and B, the diagonal matrix B_ii = eps d_i sum_j |K_ij|/d_j with any d > 0, as
what remains of B is then diagonally dominant, once scaled by d. With d = sqrt(|K_ii|) the bound does not depend on
units. The count is that of K + B: what it finds is certain, and what it misses lies above -B; that of K - B also finds
the doubtful ones. For a strut of n equal elements with hinged ends loads are doubtful above P_cr by less than 0.7 eps
n^4 of it, or by less than 4 eps (n/pi)^2 EA/P if that is more and the strut lies along no axis of the dofs: 2e-4 for n
= 1000, and 1e-3 for EA/P = 1e7. A strut with a free end counts as one twice as long.

A turn t of the whole riser that its supports leave free has no stiffness where the loads don't tell one direction from
another, and what Newton's tolerance leaves of the residual makes a small one of either sign. As K t = 0, prescribing
one dof that it moves takes it away and leaves all else as it is: v - c t, with that dof zero, has the energy of v.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.communicator import all_of, any_of
from riser_soil.core.matrix import Matrix
from riser_soil.core.part import LineField, Part, State, Weights, local
from riser_soil.core.system import System
from riser_soil.solve.bordered_band import band_alone, band_of

EPS = float(np.finfo(float).eps)
NO_STIFFNESS = 1e-4  # of the forces in play, for a turn that moves the riser by its length; a residual makes much less
SOFTEST = 1e-9  # of the stiffest: what takes a free turn away, such as a buoy's about the axis that it hangs on


def judged_parts(system: System) -> Sequence[Part] | None:
    """The parts whose tangent decides; None where it lacks symmetry, as with moments in space, so that nothing does."""
    judged = [part for part in system.model.parts if not part.traits.follows]
    return judged if all(part.traits.symmetric for part in judged) else None


class PivotCounter:
    """Counts negative pivots of one matrix of a system after the other. While nothing couples the lines with other
    fields, those of the others' rows are counted again only where these have changed: soil at rest is factorised once.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        self._matrix: Matrix | None = None
        self._values: Array = np.zeros(0)  # of the others' rows, as they were counted
        self._others = 0

    def count(self) -> int:
        """Negative pivots of the present matrix; collective."""
        system = self.system
        if system.whole_soil is None or any_of(system.comm, system.couples):
            return negative_pivots(system)
        rows = system.line_rows
        mine = band_alone(system.matrix, rows).negative_pivots() if rows else 0
        return int(system.sum([float(mine)])[0]) + self._of_others(rows)

    def _of_others(self, rows: int) -> int:
        """Negative pivots of the rows behind this rank's first ones; collective."""
        system, (starts, _, values) = self.system, self.system.matrix.stored.csr()
        present = values[starts[rows] :]
        unchanged = self._matrix is system.matrix and np.array_equal(present, self._values)
        if not all_of(system.comm, unchanged):
            self._others = _negative_pivots_behind(system, rows)
            self._matrix, self._values = system.matrix, present.copy()
        return self._others


def unstable_modes(
    pivots: PivotCounter, state: State, weights: Weights, forces: float, doubtful: bool = False
) -> int:
    """Independent ways to leave the equilibrium of the counter's system that set energy free; collective.

    forces [N]: norm of the forces in play. doubtful: count those as well that round-off may have made or may hide.
    The system's matrix is not that of its parts afterwards.
    """
    system = pivots.system
    judged = judged_parts(system)
    if judged is None or system.numbering.free == 0:
        return 0
    system.assemble(state, weights, judged)
    prescribed = _one_dof_each(system, _neutral(system, state, NO_STIFFNESS * forces))
    bounds = _row_bounds(system)
    more = (-EPS if doubtful else EPS) * bounds
    mine = _of_this_rank(system, prescribed)
    more[mine] += _not_soft(system, bounds, mine)
    system.matrix.add_to_diagonal(more)
    return pivots.count()


def negative_pivots(system: System) -> int:
    """Negative pivots of the system's symmetric matrix: its number of negative eigenvalues; collective."""
    if (band := band_of(system)) is not None:
        return band.negative_pivots()
    from riser_soil.solve import direct_solver

    return direct_solver.negative_pivots(system)


def _negative_pivots_behind(system: System, rows: int) -> int:
    from riser_soil.solve import direct_solver

    return direct_solver.negative_pivots_behind(system, rows)


def prescribe_free_turns(system: System, state: State, least: float) -> None:
    """Prescribe a dof of each free turn of the riser that meets less than `least` [N] in the matrix; collective.

    It is singular there, so that round-off would decide where a step ends among equilibria that differ by a turn.
    """
    prescribed = _one_dof_each(system, _neutral(system, state, least))
    if prescribed.size:
        more, mine = system.numbering.zeros(), _of_this_rank(system, prescribed)
        more[mine] = _not_soft(system, np.abs(system.matrix.stored.diagonal()), mine)
        system.matrix.add_to_diagonal(more)


def _of_this_rank(system: System, rows: IntArray) -> IntArray:
    """Which of this rank's rows are among some of the system's."""
    first, owned = system.numbering.first, system.numbering.owned
    return np.asarray(rows[(rows >= first) & (rows < first + owned)] - first)


def _not_soft(system: System, sizes: Array, rows: IntArray) -> Array:
    """Sizes of some of this rank's rows, no less than `SOFTEST` of the largest of all ranks'; collective."""
    largest = max(system.comm.allgather(float(sizes.max(initial=0.0))))
    return np.asarray(np.maximum(sizes[rows], SOFTEST * largest))


def _row_bounds(system: System) -> Array:
    """d_i sum_j |K_ij|/d_j of this rank's rows."""
    of_all = np.sqrt(np.abs(np.concatenate(system.comm.allgather(system.matrix.stored.diagonal()))))
    of_all[of_all == 0.0] = of_all.max()
    starts, columns, values = system.matrix.stored.csr()
    first, owned = system.numbering.first, system.numbering.owned
    return np.asarray(of_all[first : first + owned] * np.add.reduceat(np.abs(values) / of_all[columns], starts[:-1]))


def _neutral(system: System, state: State, least: float) -> Array:
    """Free turns of the lines (k, size) that meet less than `least` [N]; the same on all ranks."""
    return np.concatenate([_neutral_turns(system, line, state, least) for line in system.model.lines])


def _neutral_turns(system: System, line: LineField, state: State, least: float) -> Array:
    turns, at = line.free_turns(state), local(line)
    whole = np.zeros((len(turns), system.numbering.size))
    whole[:, at] = turns
    if not turns.size:
        return whole
    met = np.array([line.in_newtons(force[at]) for force in _products(system, whole)]).reshape(turns.shape)
    _, sizes, combined = np.linalg.svd(met.T, full_matrices=False)
    return np.asarray(combined[sizes < least] @ whole)


def _products(system: System, increments: Array) -> list[Array]:
    """The assembled matrix times increments (k, size)."""
    products: list[Array] = [np.zeros(system.numbering.size) for _ in increments]
    for met, increment in zip(products, increments, strict=True):
        system.numbering.to_local(system.matrix.stored.times(system.numbering.to_global(increment)), met)
    return products


def _one_dof_each(system: System, turns: Array) -> IntArray:
    """Rows of the system, one for each turn, that no combination of the turns leaves in place: Gaussian elimination."""
    rest, rows = turns.copy(), list[int]()
    for _ in turns:
        chosen, dof = np.unravel_index(int(np.abs(rest).argmax()), rest.shape)
        pivot = rest[chosen] / rest[chosen, dof]
        rest -= np.outer(rest[:, dof], pivot)
        rest[:, dof] = 0.0
        rows.append(int(system.numbering.index[dof]))
    return np.array(rows, dtype=np.int64)
