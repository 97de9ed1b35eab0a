"""What acts within the elements of a riser alone at an accepted state, by the kernels of its parts; see `part_kernels`.

As `riser.section_forces.element_residual`, which asks the parts' methods one by one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.bound import Bound, in_turn
from riser_soil.core.compiled import njit
from riser_soil.core.packed import Packed
from riser_soil.core.part import State
from riser_soil.riser.configuration import Configuration, base_of, place, room_for
from riser_soil.riser.hermite import put_pulled_back
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import LinePart
from riser_soil.riser.part_kernels import LineForces, add_forces, bound, forces_of
from riser_soil.riser.section_forces import element_residual
from riser_soil.solve import riser_loop as loop


class ElementForces:
    """Residuals of the elements of a line. parts: with the numbers that were asked for last."""

    def __init__(self, line: Line, parts: Sequence[tuple[LinePart, tuple[Any, ...]]]) -> None:
        self._line, shape = line, (line.nodes, line.ndof)
        within = [(part, part.numbers_within(numbers)) for part, numbers in parts]
        self._asked = [part for part, numbers in within if numbers is None]
        base = base_of(line)
        self._base = Packed(type(base)(*map(np.copy, base)))
        self._rates = np.zeros(shape), np.zeros(shape)
        self._out = np.zeros((line.length.size, 2 * line.ndof))
        at, forces = room_for(line), Packed(forces_of(line))
        here = Packed(at)
        self._find = in_turn(
            bound(place, at, self._base, *map(Packed, (np.zeros(shape), *self._rates))),
            Bound(loop.clear, forces),
            *(bound(add_forces, numbers, here, forces) for _, numbers in within if numbers is not None),
            Bound(put_residual, here, forces, Packed(self._out)),
        )

    def residual(self, state: State) -> Array:
        """Sum over parts and groups (ne, 2 ndof) at an accepted state, to whose time the numbers have been brought."""
        for kept, given in zip(self._base.value, base_of(self._line), strict=True):
            kept[...] = given
        for kept, given in zip(self._rates, (state.v, state.a), strict=True):
            kept.ravel()[:] = given
        self._find()
        return self._out + element_residual(self._line, self._asked, state) if self._asked else self._out.copy()


@njit
def put_residual(at: Configuration, forces: LineForces, out: Array) -> None:
    """Write the sum of all groups within the elements."""
    q = forces.inertia_q
    q += forces.force_q
    q += forces.end_q
    put_pulled_back(q, at.P, out, at.D, at.R)
    out += forces.inertia_e
    out += forces.force_e
