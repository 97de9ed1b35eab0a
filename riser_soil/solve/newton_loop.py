"""Newton's method, over whatever balance it is to find: the one loop beside PETSc's SNES.

    residual r(x), judged; tangent K(x), unless the last one is kept; x <- x - K^-1 r

What a balance is made of stands elsewhere: the parts of a system (`step_iteration`), or lines and bodies by kernels
(`packed_line`). When the loop ends is `convergence`'s.
"""

from __future__ import annotations

from typing import Protocol

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved
from riser_soil.solve.convergence import ITERATING


class Iteration(Protocol):
    """A balance at unknowns that it holds itself. Both methods are collective."""

    def judge(self) -> str:
        """Find the residual at the unknowns: how the method ends there, else ITERATING."""
        ...

    def improve(self) -> str:
        """Take the tangent's answer to the residual off the unknowns: ITERATING, or why there is none."""
        ...


def iterate(balance: Iteration) -> str:
    """Iterate until the balance is found, or can't be: how it ends; collective."""
    while (ending := balance.judge()) == ITERATING:
        if (ending := balance.improve()) != ITERATING:
            break
    return ending


class OutgrownError(Exception):
    """The matrix lacks places for the tangent: the iteration ends, to begin anew with a wider one; on all ranks."""


class Balance(Protocol):
    """Residual, tangent and rules of convergence over the parts of a system, for a `Loop`; arrays are over this rank's
    rows, see `StepIteration`. All methods are collective.
    """

    def residual(self, x: Array) -> Array: ...

    def tangent(self, x: Array) -> None:
        """Assemble the tangent at unknowns that are judged, unless the one before serves once more."""
        ...

    def judge(self, x: Array, f: Array, small: bool | None = None) -> str: ...

    def shortened(self, x: Array, y: Array) -> Array: ...

    def note_step_length(self, part: float) -> None:
        """Take note of the part of the last step that another line search has found."""
        ...

    def linear_tolerance(self) -> float: ...

    def negligible(self) -> float:
        """What of the residual [N] needs no answer of the next linear system; collective."""
        ...


class Loop:
    """Base of what finds a `Balance`. max_iterations: those after which a step is looked at. factorises: whether
    pivots may be counted, too.
    """

    max_iterations: int
    factorises = True

    @property
    def again(self) -> bool:
        """Whether what failed last may be tried once more."""
        return False

    def iterate(self, x: Array) -> str:
        """Iterate from x: how it ends; what was judged last is what was found; collective."""
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
