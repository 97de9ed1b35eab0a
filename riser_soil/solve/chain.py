"""Newton's loop for a riser alone on one rank, whose matrix is a band: a chain. It needs no PETSc."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from riser_soil.core import banded
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.banded import SingularError
from riser_soil.core.compiled import njit
from riser_soil.core.matrix import Matrix
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System
from riser_soil.solve.newton_progress import NAMES

# How a loop ends; OUTGROWN where the matrix lacks places.
ITERATING, CONVERGED, NOT_FINITE, NOT_SOLVED, DIVERGED, TOO_MANY, OUTGROWN = NAMES


class ChainFactors:
    """Factors of a chain's matrix, made anew where it has changed. rows: its first ones, which are the chain's; all by
    default.
    """

    def __init__(self, matrix: Matrix, rows: int | None = None) -> None:
        self._matrix, self._rows, self._factored = matrix, rows, -1

    def solve(self, load: Array) -> Array:
        """What the matrix makes the load of; SingularError where there is nothing."""
        self.factorise()
        found = load.copy()
        banded.solve(self._band, self._pivots, found, self._width)
        return found

    def factorise(self) -> None:
        """Where that has not been done; SingularError where it can't be."""
        if self._factored == self._matrix.changes:
            return
        self._factored = -1
        self._band, self._width = band_of(self._matrix, self._rows)
        self._pivots = np.zeros(len(self._band) - len(self._width), dtype=np.int64)
        if not banded.factorise(self._band, self._pivots, self._width):
            raise SingularError
        self._factored = self._matrix.changes


def negative_pivots(matrix: Matrix, rows: int | None = None) -> int:
    """Negative pivots of a chain's symmetric matrix: its number of negative eigenvalues. rows: as of `ChainFactors`."""
    band, width = band_of(matrix, rows)
    return int(banded.count_negative_pivots(band, len(band) - len(width), width))


def band_of(matrix: Matrix, rows: int | None = None) -> tuple[Array, Array]:
    """The matrix as in `banded`, and an array as long as its band is wide: of any length, where that is not fixed.
    rows: of the matrix, the first ones, and as many columns.
    """
    indptr, indices, values = matrix.stored.csr()
    n = len(indptr) - 1 if rows is None else rows
    of_entry = np.repeat(np.arange(n), np.diff(indptr[: n + 1]))
    columns = indices[: indptr[n]]
    b = int(np.abs(of_entry - columns)[columns < n].max(initial=0))
    band = np.zeros((n + b, 3 * b + 1))
    _spread(indptr[: n + 1], indices, values, band, b)
    return band, np.zeros(b)


@njit
def _spread(indptr: IntArray, indices: IntArray, values: Array, band: Array, b: int) -> None:
    n = indptr.size - 1
    for i in range(n):
        for k in range(indptr[i], indptr[i + 1]):
            if indices[k] < n:
                band[i, indices[k] - i + b] = values[k]


class OutgrownError(Exception):
    """The matrix lacks places for the tangent: the iteration ends, to begin anew with a wider one; on all ranks."""


class Balance(Protocol):
    """The balance that a loop is to find, and the rules by which; its arrays are over this rank's rows, see
    `StepIteration`. All methods are collective.
    """

    def residual(self, x: Array) -> Array: ...

    def tangent(self, x: Array) -> None:
        """Assemble the tangent at unknowns that are judged, unless the one before serves once more."""
        ...

    def judge(self, x: Array, f: Array, small: bool | None = None) -> str: ...

    def shortened(self, x: Array, y: Array) -> Array: ...

    def took(self, part: float) -> None:
        """Take note of the part of the last step that another line search has found."""
        ...

    def linear_tolerance(self) -> float: ...

    def negligible(self) -> float:
        """What of the residual [N] needs no answer of the next linear system; collective."""
        ...


class Loop:
    """Base of the loops of Newton's method. max_iterations: those after which a step is looked at. factorises: whether
    pivots may be counted, too. again: whether what failed last may be tried once more.
    """

    max_iterations: int
    factorises, again = True, False

    def iterate(self, x: Array, most: int) -> str:
        """Iterate from x, at most so often: how it ends; what was judged last is what was found; collective."""
        raise NotImplementedError

    def respond(self, f: Array) -> tuple[str, Array]:
        """What the present tangent answers to a residual; "", or why it has no answer; collective."""
        raise NotImplementedError

    def release(self) -> None:
        """Let go of the matrix, in whose place another is to come."""

    def renew(self) -> None:
        """Take the matrix that the system has now."""

    def state(self) -> Saved:
        """What is kept of linear systems."""
        return {}

    def restore(self, saved: Saved) -> None:
        """Go on with what was kept."""

    def destroy(self) -> None:
        """Give back what the ranks hold together; collective."""


class ChainLoop(Loop):
    """Newton's iteration with banded factors."""

    def __init__(self, system: System, max_iterations: int, balance: Balance) -> None:
        self._system, self.max_iterations, self._balance = system, max_iterations, balance
        self.renew()

    def iterate(self, x: Array, most: int) -> str:
        """Newton's method in its plainest form."""
        f = self._balance.residual(x)
        for left in range(most, -1, -1):
            if (ending := self._balance.judge(x, f)) != ITERATING:
                return ending
            if not left:
                break
            self._balance.tangent(x)
            failure, y = self.respond(f)
            if failure:
                return failure
            x = x - self._balance.shortened(x, y)
            f = self._balance.residual(x)
        return TOO_MANY

    def respond(self, f: Array) -> tuple[str, Array]:
        try:
            return "", self._factors.solve(f)
        except SingularError:
            return NOT_SOLVED, f

    def renew(self) -> None:
        self._factors = ChainFactors(self._system.matrix)
