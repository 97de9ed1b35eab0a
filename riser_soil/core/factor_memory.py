"""Memory of MUMPS' factorisation: the workspace that it is given for fill-in, and what it says of a want of memory.

MUMPS sets aside what its analysis foretells and some room beyond it, as pivots that are put off fill in more. Where
that was too little the factorisation is tried again with twice the room; where there is no memory, less soil helps.
"""

from __future__ import annotations

from petsc4py import PETSc

from riser_soil.errors import MemoryShortageError

WORKSPACE, MOST_WORKSPACE = 60, 960  # for fill-in beyond what is foretold [%]
IN_PERCENT = 14  # MUMPS' control of it
TOO_LITTLE_WORKSPACE = (-8, -9, -14, -15, -17, -20)  # INFOG(1): work arrays and buffers that are sized by it
WITHOUT_MEMORY = (-7, -13, -19, -22)  # INFOG(1): memory that was refused, or beyond a limit that is set
PER_ENTRY = 8.0  # bytes
REMEDY = "take larger cells or a smaller block (soil.mesh, soil.block), solver: {linear: iterative}, or more memory"


class Workspace:
    """Workspace for fill-in of a system's factorisations [%]; it grows where it was too little. Collective."""

    def __init__(self, percent: int = WORKSPACE) -> None:
        self.percent = percent

    @property
    def controls(self) -> dict[int, int]:
        """MUMPS' control of it."""
        return {IN_PERCENT: self.percent}

    def grows_after(self, pc: PETSc.PC) -> bool:
        """Whether a factorisation failed for want of room, of which there is more now; MemoryShortageError where it did
        for want of memory.
        """
        said, wanted = _said(pc)
        if said in WITHOUT_MEMORY or (said in TOO_LITTLE_WORKSPACE and self.percent >= MOST_WORKSPACE):
            raise MemoryShortageError(_too_little(said, wanted, pc))
        if said not in TOO_LITTLE_WORKSPACE:
            return False
        self.percent = min(MOST_WORKSPACE, 2 * max(self.percent, WORKSPACE // 2))
        return True


def _said(pc: PETSc.PC) -> tuple[int, int]:
    """INFOG(1) and INFOG(2) of a factorisation, the same on all ranks; 0, 0 where it is not MUMPS'."""
    if pc.getFactorSolverType() != "mumps":
        return 0, 0
    factor = pc.getFactorMatrix()
    return factor.getMumpsInfog(1), factor.getMumpsInfog(2)


def _too_little(said: int, wanted: int, pc: PETSc.PC) -> str:
    entries = wanted if wanted >= 0 else -1e6 * wanted  # MUMPS counts many in millions
    unknowns, _ = pc.getOperators()[0].getSize()
    return (
        f"the factorisation of {unknowns} unknowns ran out of memory: a rank wanted {PER_ENTRY * entries / 1e6:.4g} MB "
        f"that it could not have (MUMPS: INFOG(1) = {said}); {REMEDY}"
    )
