"""Artificial drag for pseudo-time steps towards equilibrium: the last resort of statics."""

from __future__ import annotations

import numpy as np

from riser_soil.arrays import Array
from riser_soil.part import Block, Energy, Forces, State, Weights, Work
from riser_soil.riser.line import Line


class Relaxation:
    """Part "relaxation": resists a pseudo-time step by `drag` times tributary length times translation.

    drag: N/m2, force per length and displacement in one step; large values allow small steps only. It may be changed
    between steps. The forces vanish with the increment, so that what it converges to is an equilibrium without it.
    """

    name, symmetric = "relaxation", True

    def __init__(self, line: Line, drag: float) -> None:
        self._line, self.drag = line, drag

    def blocks(self) -> dict[str, Block]:
        return {"riser": self._line.element_block()}

    def residual(self, state: State, forces: Forces) -> None:
        line = self._line
        if line.active:
            resistance = self.drag * line.tributary_length[:, None]
            line.nodal(forces.force)[:, : line.dimension] += resistance * line.nodal(state.u)[:, : line.dimension]

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        line = self._line
        if line.active:
            half = weights.force * 0.5 * self.drag * line.length[:, None]
            for end in (0, line.ndof):
                dofs = np.arange(end, end + line.dimension)
                values["riser"][:, dofs, dofs] += half

    def energy(self, state: State) -> Energy:
        return Energy()

    def work(self, before: State, after: State) -> Work:
        return Work()

    def commit(self, state: State) -> None:
        pass
