"""What iterates a step's unknowns to balance: PETSc's SNES, or for a riser alone on one rank a loop without PETSc."""

from __future__ import annotations

from typing import Protocol

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System
from riser_soil.solve.chain import ChainFactors, SingularError

# How a loop ends, failures by PETSc's names.
ITERATING, CONVERGED, OUTGROWN = "iterating", "converged", "outgrown"  # the last where the matrix lacks places
DIVERGED, NOT_FINITE = "diverged_dtol", "diverged_fnorm_nan"
NOT_SOLVED, TOO_MANY = "diverged_linear_solve", "diverged_max_it"

LOOSE = 1e-5  # share of the residual that a linear system solved by iterations may leave


class Balance(Protocol):
    """The balance that a loop is to find; its arrays are over this rank's rows, see `Newton`."""

    def residual(self, x: Array) -> Array: ...

    def judge(self, x: Array, f: Array) -> str: ...

    def shortened(self, x: Array, y: Array) -> Array: ...

    def linear_tolerance(self) -> float: ...

    def negligible(self) -> float:
        """What of the residual [N] needs no answer of the next linear system; collective."""
        ...


class Loop(Protocol):
    """factorises: whether pivots may be counted, too. again: whether what failed last may be tried once more."""

    factorises: bool
    again: bool

    def iterate(self, x: Array, most: int) -> str:
        """Iterate from x, at most so often: how it ends; what was judged last is what was found; collective."""
        ...

    def respond(self, f: Array) -> tuple[str, Array]:
        """What the present tangent answers to a residual; "", or why it has no answer; collective."""
        ...

    def release(self) -> None:
        """Let go of the matrix, in whose place another is to come."""
        ...

    def renew(self) -> None:
        """Take the matrix that the system has now."""
        ...

    def state(self) -> Saved:
        """What is kept of linear systems."""
        ...

    def restore(self, saved: Saved) -> None: ...

    def destroy(self) -> None: ...


class ChainLoop:
    """Newton's iteration with banded factors."""

    factorises, again = True, False

    def __init__(self, system: System, balance: Balance) -> None:
        self._system, self._balance = system, balance
        self.renew()

    def iterate(self, x: Array, most: int) -> str:
        """As Newton's method in its plainest form."""
        f = self._balance.residual(x)
        for left in range(most, -1, -1):
            if (ending := self._balance.judge(x, f)) != ITERATING:
                return ending
            if not left:
                break
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

    def release(self) -> None:
        """Nothing but this loop's own arrays is held."""

    def renew(self) -> None:
        self._factors = ChainFactors(self._system.matrix)

    def state(self) -> Saved:
        return {}

    def restore(self, saved: Saved) -> None:
        """Nothing is kept."""

    def destroy(self) -> None:
        """There is nothing to give back."""
