"""Matrices of PETSc, with the properties that the system's have."""

from __future__ import annotations

import numpy as np
from petsc4py import PETSc

from riser_soil.core.arrays import Array, IntArray


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
