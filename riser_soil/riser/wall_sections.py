"""Sections of the riser's wall: one at each node, two where unlike walls meet.

At a joint both walls bear the same effective tension, moments and pressures on diameters of their own. In a bend
stiffener the pipe bears the share of the moments that it has of the stiffness.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.riser.sections import Elements
from riser_soil.riser.wall_stress import Loads, Wall


@dataclass(frozen=True, eq=False)
class WallSections:
    """Sections (ns,) with their node, in the order of the nodes; nodes without a wall beside them have none.

    pressed: diameters [m] on which the pressures act. allowable: stress [Pa], 0 where none is given.
    borne: shares (ns, 2) of the bending moments about y and z that the pipe bears itself.
    """

    node: IntArray
    wall: Wall
    pressed: Wall
    allowable: Array
    borne: Array

    def loads(
        self, effective: Array, moment_y: Array, moment_z: Array, torque: Array, inside: Array, outside: Array
    ) -> Loads:
        """Loads (..., ns) from effective tension [N], moments [N m] and pressures [Pa] at nodes, each (..., nn)."""
        T, My, Mz, Mx, p_i, p_o = (
            values[..., self.node] for values in (effective, moment_y, moment_z, torque, inside, outside)
        )
        bore, outer = (0.25 * np.pi * d**2 for d in (self.pressed.inner_diameter, self.pressed.outer_diameter))
        borne_y, borne_z = self.borne.T
        return Loads(T + p_i * bore - p_o * outer, borne_y * My, borne_z * Mz, Mx, p_i, p_o)

    def at_nodes(self, values: Array, governing: Array, nodes: int) -> Array:
        """Values (..., ns) at the nodes (..., nn), of two sections that with more `governing` (..., ns), of equal ones
        the second; nan without a wall.
        """
        found, (first, second) = np.full((*values.shape[:-1], nodes), np.nan), self._of_nodes
        found[..., self.node] = values
        more = governing[..., first] > governing[..., second]
        found[..., self.node[first]] = np.where(more, values[..., first], values[..., second])
        return found

    @cached_property
    def _of_nodes(self) -> tuple[IntArray, IntArray]:
        """The sections of nodes that have two."""
        first = np.flatnonzero(self.node[1:] == self.node[:-1])
        return first, first + 1


def walls_of(elements: Elements) -> WallSections:
    """Sections of the elements' walls."""
    wall = Wall(elements.wall_outer_diameter, elements.wall_inner_diameter)
    pressed = Wall(elements.pipe_diameter, elements.inner_diameter)
    return wall_sections(wall, pressed, elements.allowable_stress, elements.borne_by_pipe)


def wall_sections(wall: Wall, pressed: Wall, allowable: Array, borne: Array) -> WallSections:
    """Sections from what the elements have (ne,), borne (ne, 2); an outer diameter of 0 is no wall."""
    numbers = np.column_stack([*wall, *pressed, allowable, borne])
    nodes = len(numbers) + 1
    before, after = np.insert(numbers, 0, 0.0, axis=0), np.append(numbers, np.zeros((1, numbers.shape[1])), axis=0)
    unlike = (before != after).any(axis=1)
    node = np.concatenate([np.arange(nodes)[unlike], np.arange(nodes)])
    rows = np.concatenate([before[unlike], after])
    walled = rows[:, 0] > 0.0
    order = np.argsort(node[walled], kind="stable")
    D, d, outside, bore, limit, *shares = rows[walled][order].T
    return WallSections(node[walled][order], Wall(D, d), Wall(outside, bore), limit, np.column_stack(shares))
