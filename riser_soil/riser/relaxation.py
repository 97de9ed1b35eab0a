"""Artificial drag for pseudo-time steps towards equilibrium: the last resort of statics."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Block, Energy, Forces, State, Traits, Weights, Work
from riser_soil.riser.line import Line


class Relaxation:
    """Part "relaxation": resists a pseudo-time step by `drag` times tributary length times translation, and turning as
    a rod of that length would be resisted that turns about its middle.

    drag: N/m2, force per length and displacement in one step; large values allow small steps only. It may be changed
    between steps. The forces vanish with the increment, so that what it converges to is an equilibrium without it.
    """

    name, traits = "relaxation", Traits("F", symmetric=True)

    def __init__(self, line: Line, drag: float) -> None:
        self._line, self.drag = line, drag

    def blocks(self) -> dict[str, Block]:
        return {self._line.name: self._line.element_block()}

    def residual(self, state: State, forces: Forces) -> None:
        line = self._line
        if line.active:
            line.nodal(forces.force)[...] += self.drag * self._shares(line.tributary_length) * line.nodal(state.u)

    def _shares(self, length: Array) -> Array:
        """Of the drag, by node or element and dof of a node [m, m3]."""
        shares = np.repeat(length[:, None], self._line.ndof, axis=1)
        shares[:, self._line.dimension :] *= length[:, None] ** 2 / 12.0
        return shares

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        line = self._line
        if line.active:
            for end, nodes in ((0, slice(None, -1)), (line.ndof, slice(1, None))):
                dofs = np.arange(end, end + line.ndof)
                share = (0.5 * line.length / line.tributary_length[nodes])[:, None]
                whole = self.drag * self._shares(line.tributary_length)[nodes]
                values[self._line.name][:, dofs, dofs] += weights.force * share * whole

    def energy(self, state: State) -> Energy:
        return Energy()

    def work(self, before: State, after: State) -> Work:
        return Work()

    def commit(self, state: State) -> None:
        pass
