"""Why Newton's method failed, in words: PETSc's reason, and where the largest residual sits."""

from __future__ import annotations

import numpy as np
from mpi4py import MPI
from petsc4py import PETSc

from riser_soil.core.arrays import Array
from riser_soil.core.system import System
from riser_soil.solve.solution import largest_at


def reason_name(reason: int) -> str:
    """PETSc's name of a reason for which SNES has stopped."""
    names = (n for n, v in vars(PETSc.SNES.ConvergedReason).items() if v == reason and n.startswith("DIV"))
    return next(names, str(reason)).lower()


def place_of_largest(system: System, residual: Array, first: int) -> str:
    """The row with the largest residual, in words; collective.

    residual: this rank's [N], moments over the lever; its rows begin with `first`.
    """
    values = np.abs(residual)
    if not system.comm.allreduce(bool(np.isfinite(values).all()), MPI.LAND):
        return "the residual is not finite"
    k = int(np.argmax(values)) if len(values) else -1
    mine = (float(values[k]), first + k) if k >= 0 else (-1.0, -1)
    worst, row = max(system.comm.allgather(mine))
    return largest_at(worst, system.describe(row))
