"""Accelerations of the riser that a given force causes: its mass matrix, banded, factorised where it is needed.

Needed once at the start of a dynamic stage and, with contact, once a step (see time_scheme).
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import solveh_banded

from riser_soil.arrays import Array, BoolArray
from riser_soil.part import Field, Part, State, Weights
from riser_soil.system import System

MASS_ONLY = Weights(inertia=1.0, force=0.0, shift_v=0.0, shift_a=1.0)


class RiserMass:
    """Inverse of the riser's mass (its own and the added one) on its free dofs; collective over the system's ranks."""

    def __init__(self, system: System) -> None:
        self._system = system
        self._riser: Field = system.model.fields[0]
        self._parts: list[Part] = [p for p in system.model.parts if set(p.blocks()) == {"riser"}]

    def accelerations(self, t: float, force: Array) -> Array:
        """a with M a = force, in the accepted configuration at time t; local arrays, zero outside the riser.

        Dofs without mass (twist of a line without rotary inertia) and prescribed dofs get none.
        """
        at = slice(self._riser.offset, self._riser.offset + self._riser.size)
        mine = self._solve(t, force[at]) if self._system.comm.rank == 0 else None
        out = np.zeros_like(force)
        out[at] = self._system.comm.bcast(mine)
        return out

    def _solve(self, t: float, force: Array) -> Array:
        blocks = self._element_matrices(t)
        dofs = blocks.shape[1] // 2
        free = ~self._riser.prescribed
        banded = _banded(_masked(blocks, free, dofs), self._riser.size)
        massless = banded[-1] == 0.0
        banded[-1, massless] = 1.0
        return np.asarray(solveh_banded(banded, np.where(free & ~massless, force, 0.0)))

    def _element_matrices(self, t: float) -> Array:
        state = State.at_rest(t, self._system.numbering.size)
        values = {"riser": np.zeros(self._system.matrix.values["riser"].shape)}
        for part in self._parts:
            part.tangent(state, MASS_ONLY, values)
        return values["riser"]


def _masked(blocks: Array, free: BoolArray, dofs: int) -> Array:
    """Element matrices without the rows and columns of dofs that aren't free."""
    nodes = free.astype(float).reshape(-1, dofs)
    ends = np.concatenate([nodes[:-1], nodes[1:]], axis=1)
    return blocks * ends[:, :, None] * ends[:, None, :]


def _banded(blocks: Array, size: int) -> Array:
    """Upper banded storage of a chain of element matrices (ne, 2 dofs, 2 dofs): ab[u + i - j, j] = a[i, j]."""
    count, width, _ = blocks.shape
    dofs = width // 2
    ab = np.zeros((width, size))
    for i in range(width):
        for j in range(i, width):
            ab[width - 1 + i - j, j : j + dofs * count : dofs] += blocks[:, i, j]
    return ab
