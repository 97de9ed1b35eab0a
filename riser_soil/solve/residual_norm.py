"""Norms of a system's residuals and of the forces in play [N], moments over the lever."""

from __future__ import annotations

import math

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, local
from riser_soil.core.system import System
from riser_soil.solve.solution import place_of_largest


class ResidualNorm:
    """Of a system as its dofs are numbered now; collective."""

    def __init__(self, system: System) -> None:
        self._system, self._levers = system, system.numbering.to_global(system.levers)

    def of(self, f: Array) -> float:
        """Norm of a residual, of this rank's rows (owned,)."""
        return math.sqrt(self._system.sum([float(np.sum((f / self._levers) ** 2))])[0])

    def largest(self, f: Array) -> str:
        """Where it is largest, in words."""
        return place_of_largest(self._system, f / self._levers, self._system.numbering.first)

    def in_play(self, forces: Forces) -> float:
        """Norm of the forces in play: reactions, inertia, contact on the lines."""
        system = self._system
        reactions = system.reactions(forces) / system.levers[system.prescribed_dofs]
        inertia = forces.inertia / system.levers
        contact = np.concatenate([(forces.end / system.levers)[local(line)] for line in system.model.lines])
        mine = [float(f @ f) for f in (reactions, inertia, contact)]
        return math.sqrt(max(system.sum(mine)))
