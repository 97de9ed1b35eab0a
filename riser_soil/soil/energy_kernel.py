"""Compiled energy, stress and moduli of an energy density in UFL at n points: one cell of an interval each."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import ufl
from dolfinx.mesh import create_interval
from mpi4py import MPI

from riser_soil.core.arrays import Array
from riser_soil.soil.dolfinx_compat import CellExpression, values_of_cells
from riser_soil.soil.law_source import LawError

SHEAR = 1.0 / 2.0**0.5
SIZE = 7  # numbers of a point: strain in Mandel's notation, and depth


class EnergyKernel:
    """Energy, stress and tangent by an energy density psi(eps, depth) in UFL, eps a symmetric tensor (3, 3); at depths
    (n,) [m].
    """

    def __init__(self, psi: Callable[[Any, Any], Any], depth: Array) -> None:
        mesh = create_interval(MPI.COMM_SELF, max(len(depth), 1), [0.0, 1.0])
        self._variables, self._at = values_of_cells(mesh, SIZE)
        self._at = self._at[: len(depth)]
        self._variables.x.array[self._at[:, -1]] = depth
        self._compiled = CellExpression(mesh, _with_derivatives(psi, self._variables))

    def at(self, strain: Array) -> tuple[Array, Array, Array]:
        """Energy (n,) [J/m3], stress (n, 6) and moduli (n, 6, 6) [Pa] of strains (n, 6)."""
        n = len(self._at)
        self._variables.x.array[self._at[:, :-1]] = strain
        values = self._compiled.values()[:n]
        return values[:, 0].copy(), values[:, 1:7].copy(), values[:, 7:].reshape(n, 6, 6).copy()


def _with_derivatives(psi: Callable[[Any, Any], Any], variables: Any) -> Any:
    """Energy, its six derivatives by Mandel's components, and theirs, (43,)."""
    x = ufl.variable(ufl.as_vector([variables[i] for i in range(6)]))
    xx, yy, zz, xy, xz, yz = x[0], x[1], x[2], SHEAR * x[3], SHEAR * x[4], SHEAR * x[5]
    energy = psi(ufl.as_tensor([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]), variables[6])
    if getattr(energy, "ufl_shape", None) != ():
        raise LawError(f"psi must return a number of UFL, and returns {type(energy).__name__}")
    stress = ufl.diff(energy, x)
    moduli = ufl.diff(stress, x)
    return ufl.as_vector([energy, *(stress[i] for i in range(6)), *(moduli[i, j] for i in range(6) for j in range(6))])
