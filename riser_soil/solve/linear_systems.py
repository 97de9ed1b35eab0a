"""The ways to solve Newton's linear systems, and which of them a system takes."""

from __future__ import annotations

from typing import ClassVar, Protocol

from petsc4py import PETSc

from riser_soil.core.factor_memory import Room
from riser_soil.core.saved_state import Saved
from riser_soil.core.system import System
from riser_soil.solve.iterative_solver import IterativeSolver, solid_of
from riser_soil.solve.kept_factors import KeptFactors
from riser_soil.solve.linear_solver import factorise_directly, keeps_factors


class LinearSystems(Protocol):
    """How one system after the other is solved; collective.

    factorises: whether pivots may be counted, too. to_tolerance: whether each is solved as exactly as the KSP is told.
    """

    factorises: ClassVar[bool]
    to_tolerance: ClassVar[bool]

    def serve(self, ksp: PETSc.KSP, levers: PETSc.Vec) -> None:
        """Solve what this KSP is asked for; by which levers [m] moments count as forces."""
        ...

    def failed(self, ksp: PETSc.KSP) -> tuple[str, bool]:
        """Drop what a failed solution has left; what to say of it, and whether another try may do."""
        ...

    def renew(self) -> None:
        """Expect a matrix of another pattern."""
        ...

    def forget(self) -> None:
        """Drop all that is kept."""
        ...

    def state(self) -> Saved: ...

    def restore(self, saved: Saved) -> None: ...


def linear_systems(system: System, asked: str) -> LinearSystems:
    """As asked: "direct", "kept", "iterative", or "auto"; what there is nothing for is solved directly."""
    solid = solid_of(system) if asked == "iterative" else None
    if solid is not None:
        return IterativeSolver(system, solid)
    if keeps_factors(system, asked):
        return KeptFactors(system.comm, system.symmetric, Room())
    return DirectSolver(system, Room())


class DirectSolver:
    """Each system is factorised."""

    factorises: ClassVar[bool] = True
    to_tolerance: ClassVar[bool] = False

    def __init__(self, system: System, room: Room) -> None:
        self._system, self._room = system, room

    def serve(self, ksp: PETSc.KSP, levers: PETSc.Vec) -> None:
        ksp.setType(PETSc.KSP.Type.PREONLY)
        factorise_directly(ksp.getPC(), self._system, self._room)

    def failed(self, ksp: PETSc.KSP) -> tuple[str, bool]:
        """Where factors found too little room, the next get more."""
        return "", self._room.grows_after(ksp.getPC())

    def renew(self) -> None: ...

    def forget(self) -> None: ...

    def state(self) -> Saved:
        return {}

    def restore(self, saved: Saved) -> None: ...
