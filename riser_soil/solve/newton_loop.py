"""Newton's method for any balance: the one loop beside PETSc's SNES.

    residual r(x), judged; tangent K(x), unless the last one is kept; x <- x - K^-1 r

The residual and the tangent are those of the parts of a system (`step_iteration`), or of lines and bodies by kernels
(`packed_line`). `convergence` says when the loop ends.
"""

from __future__ import annotations

from typing import Protocol

from riser_soil.solve.convergence import ITERATING


class Iteration(Protocol):
    """A balance at unknowns that it holds itself. Both methods are collective."""

    def judge(self) -> str:
        """Evaluate the residual at the unknowns: how the method ends there, else ITERATING."""
        ...

    def improve(self) -> str:
        """Newton update x -= K⁻¹ r of the unknowns: ITERATING, or why it can't be made."""
        ...


def iterate(balance: Iteration) -> str:
    """Iterate until the method converges or fails: how it ends; collective."""
    while (ending := balance.judge()) == ITERATING:
        if (ending := balance.improve()) != ITERATING:
            break
    return ending
