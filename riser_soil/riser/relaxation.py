"""Artificial viscous drag for dynamic relaxation and settling: the part "relaxation"."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State, Traits, Weights
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart


class Relaxation(LinePart):
    """Part "relaxation": viscous drag on a pseudo-time step, `drag` times tributary length times translation.

    Rotation meets the drag of a rod of the tributary length that turns about its middle.

    drag: N/m2, force per length and displacement in one step; large values allow small steps only. It may be changed
    between steps. The forces vanish with the increment, so that what it converges to is an equilibrium without it.
    places (nn,): 1 at nodes that are dragged, else 0; all of them at first.
    """

    name, traits = "relaxation", Traits("F", symmetric=True)

    def __init__(self, line: Line, drag: float) -> None:
        super().__init__(line)
        self.drag = drag
        self.places: Array = np.ones(line.nodes)

    def residual(self, state: State, forces: Forces) -> None:
        line = self.line
        line.nodal(forces.force)[...] += self.drag * self._shares() * line.nodal(state.u)

    def _shares(self) -> Array:
        """Shares of the drag, by node or element and dof of a node [m, m3]."""
        length = self.line.tributary_length
        shares = np.repeat((self.places * length)[:, None], self.line.ndof, axis=1)
        shares[:, self.line.dimension :] *= length[:, None] ** 2 / 12.0
        return shares

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        line = self.line
        for end, nodes in ((0, slice(None, -1)), (line.ndof, slice(1, None))):
            dofs = np.arange(end, end + line.ndof)
            share = (0.5 * line.length / line.tributary_length[nodes])[:, None]
            whole = self.drag * self._shares()[nodes]
            values[line.name][:, dofs, dofs] += weights.force * share * whole
