"""Linear solvers of a system's tangents in PETSc: what they have in common, and how they fail.

There are four: factors of each tangent (`direct_solver`), factors that are kept as preconditioners (`kept_factors`),
static condensation of soil in sections (`section_solver`), and multigrid on the soil (`iterative_solver`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import ClassVar

from petsc4py import PETSc

from riser_soil.core.banded import SingularError
from riser_soil.core.saved_state import Saved

IN_LIBRARY = 76  # PETSc's code of an error in another library, here MUMPS


class LinearSolver:
    """Solver of one linear system after the other; collective.

    factorises: whether pivots may be counted, too. to_tolerance: whether each is solved to the KSP's tolerance.
    options: PETSc's, where the user gives none of the name.
    """

    factorises: ClassVar[bool] = True
    to_tolerance: ClassVar[bool] = False
    options: ClassVar[Mapping[str, str]] = {}

    @property
    def reads_mat(self) -> bool:
        """Whether PETSc's own matrix is read, and not the rows that it is made of."""
        return True

    def attach(self, ksp: PETSc.KSP, levers: PETSc.Vec) -> None:
        """Set a KSP up to solve by this solver; by the levers [m] moments count as forces."""
        raise NotImplementedError

    def failed(self, ksp: PETSc.KSP) -> tuple[str, bool]:
        """Drop the data of a failed solution; a message about it, and whether another try may do."""
        self.forget()
        return "", False

    def renew(self) -> None:
        """Expect a matrix of another pattern."""
        self.forget()

    def forget(self) -> None:
        """Drop factors and all else that is cached."""

    def state(self) -> Saved:
        """Cached data, for a run that is to go on."""
        return {}

    def restore(self, saved: Saved) -> None:
        """Go on with that."""


def raised(err: Exception) -> Exception:
    """What a callback has raised, which PETSc 3.18 lets pass and PETSc 3.22 makes an error of its own of."""
    cause = err.__cause__
    return cause if isinstance(err, PETSc.Error) and isinstance(cause, Exception) else err


def complaint(err: Exception) -> str:
    """What was said of a system that could not be solved, the same on all ranks; "" for all other errors."""
    err = raised(err)
    if isinstance(err, SingularError):
        return "the linear solver failed (the matrix is singular)"
    if not (isinstance(err, PETSc.Error) and err.ierr == IN_LIBRARY):
        return ""
    said = re.search(r"(?:in|during) (?:the )?(\w[\w ]*) phase.*INFOG\(1\)\s*=\s*(-?\d+)", str(err))
    where = f" in its {said[1]} phase: INFOG(1) = {said[2]}" if said else ""
    return f"the linear solver failed (MUMPS{where})"
