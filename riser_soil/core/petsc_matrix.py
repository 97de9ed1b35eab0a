"""Matrices of PETSc, with the properties that the system's have; its exchange of what several ranks hold."""

from __future__ import annotations

import numpy as np
from petsc4py import PETSc

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.communicator import Communicator

# PETSc's own copy of a communicator goes with the last object on it. Ranks would lose it at different times, as Python
# collects what an exception or a circle has kept alive, and then wait in vain for the others to copy it again.
_STAYING: list[tuple[Communicator, PETSc.Vec]] = []


def on_arrays(indptr: IntArray, indices: IntArray, data: Array, symmetric: bool) -> PETSc.Mat:
    """A square matrix of one rank that works on the values where they are; assemble it when they have changed."""
    n = len(indptr) - 1
    pattern = (np.asarray(part, dtype=PETSc.IntType) for part in (indptr, indices))
    mat = PETSc.Mat().createAIJWithArrays((n, n), (*pattern, data), comm=PETSc.COMM_SELF)
    declare(mat, symmetric)
    return mat


def declare(mat: PETSc.Mat, symmetric: bool) -> None:
    """Its pattern is final; whether it is symmetric, and stays so."""
    mat.setOption(PETSc.Mat.Option.NEW_NONZERO_LOCATION_ERR, True)
    if symmetric:
        mat.setOption(PETSc.Mat.Option.SYMMETRIC, True)
        mat.setOption(PETSc.Mat.Option.SYMMETRY_ETERNAL, True)


class Scatter:
    """Exchange between this rank's rows (owned,) and the rows (n,) of its free local entries: values, and sums."""

    def __init__(self, comm: Communicator, owned: int, rows: IntArray) -> None:
        _keep(comm)
        self._all = PETSc.Vec().createMPI((owned, PETSc.DETERMINE), comm=comm)
        self._mine = PETSc.Vec().createSeq(len(rows))
        at = PETSc.IS().createGeneral(rows.astype(PETSc.IntType), comm=PETSc.COMM_SELF)
        self._scatter = PETSc.Scatter().create(self._all, at, self._mine, None)
        at.destroy()

    def from_all(self, x: Array) -> Array:
        """Values (n,) at the entries' rows; collective."""
        self._all.array_w[:] = x
        self._scatter.scatter(self._all, self._mine, PETSc.InsertMode.INSERT, PETSc.ScatterMode.FORWARD)
        return np.array(self._mine.array_r)

    def summed(self, values: Array) -> Array:
        """Sums (owned,) of all ranks' values (n,); collective."""
        self._all.set(0.0)
        self._mine.array_w[:] = values
        self._scatter.scatter(self._mine, self._all, PETSc.InsertMode.ADD, PETSc.ScatterMode.REVERSE)
        return np.array(self._all.array_r)

    def destroy(self) -> None:
        for thing in (self._scatter, self._mine, self._all):
            thing.destroy()


def _keep(comm: Communicator) -> None:
    """Let an object on a communicator stay; collective."""
    if all(known != comm for known, _ in _STAYING):
        _STAYING.append((comm, PETSc.Vec().createMPI((0, PETSc.DETERMINE), comm=comm)))
