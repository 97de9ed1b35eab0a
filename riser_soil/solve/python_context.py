"""Python objects that PETSc's solvers and preconditioners of type python call, and their end before PETSc's own."""

from __future__ import annotations

import atexit
from typing import ClassVar

from petsc4py import PETSc


class PythonContext:
    """Context of a KSP or preconditioner of type python. in_use: all whose object is not destroyed."""

    in_use: ClassVar[dict[PythonContext, PETSc.KSP | PETSc.PC]] = {}

    def work_for(self, thing: PETSc.KSP | PETSc.PC) -> None:
        """Be what this object calls."""
        PythonContext.in_use[self] = thing
        thing.setType("python")
        thing.setPythonContext(self)

    def reset(self, thing: PETSc.KSP | PETSc.PC) -> None:
        """Called as the object is destroyed."""
        PythonContext.in_use.pop(self, None)


@atexit.register
def let_go() -> None:
    """Part all objects from their contexts here."""
    while PythonContext.in_use:
        _, thing = PythonContext.in_use.popitem()
        if thing:  # one that was destroyed without being reset is null
            thing.setType("none" if isinstance(thing, PETSc.PC) else "preonly")
