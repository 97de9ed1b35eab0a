"""Linear solver: PETSc's banded LU where a serial system is a chain, MUMPS otherwise."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from petsc4py import PETSc

from riser_soil.core.factor_memory import Room
from riser_soil.core.system import System

PREFIX = "riser_soil_"
# MUMPS' controls for counting pivots, on several ranks too (13), null pivots (24).
COUNTING = {13: 1, 24: 1}
IN_LIBRARY = 76  # PETSc's code of an error in another library, here MUMPS
NO_PIVOT = 1e-200  # whatever the units; by PETSc's default the stiffness of a riser a fingernail long is none


@contextmanager
def defaults(options: Mapping[str, str]) -> Iterator[None]:
    """PETSc options under the project's prefix while the block lasts; what the user has set wins."""
    database = PETSc.Options()
    added = [key for key in options if not database.hasName(PREFIX + key)]
    for key in added:
        database[PREFIX + key] = options[key]
    try:
        yield
    finally:
        for key in added:
            database.delValue(PREFIX + key)


def factorise_directly(pc: PETSc.PC, system: System, room: Room) -> None:
    """Make a preconditioner an exact solver, symmetric where the system is."""
    mumps = not _is_chain(system)
    _choose(pc, system, "cholesky" if mumps and system.symmetric else "lu", room.controls)


def complaint(err: PETSc.Error) -> str:
    """What MUMPS said of a system that it could not solve, the same on all ranks; "" for other errors of PETSc."""
    if err.ierr != IN_LIBRARY:
        return ""
    said = re.search(r"(?:in|during) (?:the )?(\w[\w ]*) phase.*INFOG\(1\)\s*=\s*(-?\d+)", str(err))
    where = f" in its {said[1]} phase: INFOG(1) = {said[2]}" if said else ""
    return f"the linear solver failed (MUMPS{where})"


def negative_pivots(system: System) -> int:
    """Negative pivots of the system's symmetric matrix: its number of negative eigenvalues; collective."""
    room = Room()
    while True:
        pc = PETSc.PC().create(system.comm)
        try:
            _choose(pc, system, "cholesky", room.controls | COUNTING)
            pc.setUp()
            if not room.grows_after(pc):
                return int(pc.getFactorMatrix().getInertia()[0])
        finally:
            pc.destroy()


def _choose(pc: PETSc.PC, system: System, kind: str, controls: Mapping[int, int]) -> None:
    pc.setOperators(system.matrix.mat)
    pc.setType(kind)
    if _is_chain(system):
        pc.setFactorOrdering("natural")
        pc.setFactorPivot(zeropivot=NO_PIVOT)
        return
    pc.setFactorSolverType("mumps")
    pc.setFactorSetUpSolverType()
    for control, value in controls.items():
        pc.getFactorMatrix().setMumpsIcntl(control, value)


def _is_chain(system: System) -> bool:
    return system.comm.size == 1 and len(system.model.fields) == 1
