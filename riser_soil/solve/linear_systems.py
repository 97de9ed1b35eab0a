"""The way in which a system's linear systems are solved."""

from __future__ import annotations

from typing import Any

from petsc4py import PETSc

from riser_soil.core.factor_memory import Room
from riser_soil.core.system import System
from riser_soil.solve.iterative_solver import IterativeSolver, solid_of
from riser_soil.solve.kept_factors import KeptFactors
from riser_soil.solve.linear_solver import LinearSystems, factorise_directly, keeps_factors
from riser_soil.solve.section_solver import SectionSolver, sections_of


def linear_systems(system: System, asked: str) -> LinearSystems:
    """As asked: "direct", "kept", "iterative", or "auto", which takes sections by themselves; what there is nothing for
    is solved directly.
    """
    comm: Any = system.comm
    solid = solid_of(system) if asked == "iterative" else None
    if solid is not None:
        return IterativeSolver(system, solid)
    sections = sections_of(system) if asked == "auto" else None
    if sections is not None:
        return SectionSolver(system, sections, Room())
    if keeps_factors(system, asked):
        return KeptFactors(comm, system.symmetric, Room())
    return DirectSolver(system, Room())


class DirectSolver(LinearSystems):
    """Each system is factorised."""

    def __init__(self, system: System, room: Room) -> None:
        self._system, self._room = system, room

    def serve(self, ksp: PETSc.KSP, levers: PETSc.Vec) -> None:
        ksp.setType(PETSc.KSP.Type.PREONLY)
        factorise_directly(ksp.getPC(), self._system, self._room)

    def failed(self, ksp: PETSc.KSP) -> tuple[str, bool]:
        """Where factors found too little room, the next get more."""
        return "", self._room.grows_after(ksp.getPC())
