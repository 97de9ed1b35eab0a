"""The balance of a step over the parts of a system, and the loops that solve it: `band_loop` and `snes_loop`."""

from __future__ import annotations

from typing import Protocol

from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved


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
        """Record the part of the last step that another line search has chosen."""
        ...

    def linear_tolerance(self) -> float: ...

    def negligible(self) -> float:
        """Residual [N] that the next linear system need not reduce; collective."""
        ...


class Loop:
    """Base of the loops that solve a `Balance`. max_iterations: those after which a step is looked at. factorises:
    whether pivots may be counted, too.
    """

    max_iterations: int
    factorises = True

    @property
    def again(self) -> bool:
        """Whether what failed last may be tried once more."""
        return False

    def iterate(self, x: Array) -> str:
        """Iterate from x: how it ends; the unknowns judged last are the solution; collective."""
        raise NotImplementedError

    def respond(self, f: Array) -> tuple[str, Array]:
        """"", or why it fails, and K⁻¹ f by the present tangent; collective."""
        raise NotImplementedError

    def release(self) -> None:
        """Free the matrix, which another one is to replace."""

    def renew(self) -> None:
        """Take the matrix that the system has now."""

    def state(self) -> Saved:
        """State of the linear solver."""
        return {}

    def restore(self, saved: Saved) -> None:
        """Go on with a saved state."""

    def destroy(self) -> None:
        """Free what all ranks share; collective."""
