"""Sections of the riser's wall: one at each node, two where unlike walls meet.

At a joint both walls bear the same effective tension, moments and pressures on diameters of their own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.riser.wall_stress import Loads, Wall


@dataclass(frozen=True, eq=False)
class WallSections:
    """Sections (ns,) with their node, in the order of the nodes; nodes without a wall beside them have none.

    pressed: diameters [m] on which the pressures act. allowable: stress [Pa], 0 where none is given.
    """

    node: IntArray
    wall: Wall
    pressed: Wall
    allowable: Array

    def loads(
        self, effective: Array, moment_y: Array, moment_z: Array, torque: Array, inside: Array, outside: Array
    ) -> Loads:
        """Loads (..., ns) from effective tension [N], moments [N m] and pressures [Pa] at nodes, each (..., nn)."""
        T, My, Mz, Mx, p_i, p_o = (
            values[..., self.node] for values in (effective, moment_y, moment_z, torque, inside, outside)
        )
        bore, outer = (0.25 * np.pi * d**2 for d in (self.pressed.inner_diameter, self.pressed.outer_diameter))
        return Loads(T + p_i * bore - p_o * outer, My, Mz, Mx, p_i, p_o)

    def at_nodes(self, values: Array, governing: Array, nodes: int) -> Array:
        """Values (ns,) at the nodes (nn,), of two sections that with more `governing` (ns,); nan without a wall."""
        found = np.full(nodes, np.nan)
        order = np.argsort(governing, kind="stable")
        found[self.node[order]] = values[order]  # of two the last stays
        return found


def wall_sections(wall: Wall, pressed: Wall, allowable: Array) -> WallSections:
    """Sections from what the elements have (ne,); an outer diameter of 0 is no wall."""
    numbers = np.stack([*wall, *pressed, allowable], axis=1)
    nodes = len(numbers) + 1
    before, after = np.insert(numbers, 0, 0.0, axis=0), np.append(numbers, np.zeros((1, numbers.shape[1])), axis=0)
    unlike = (before != after).any(axis=1)
    node = np.concatenate([np.arange(nodes)[unlike], np.arange(nodes)])
    rows = np.concatenate([before[unlike], after])
    walled = rows[:, 0] > 0.0
    order = np.argsort(node[walled], kind="stable")
    D, d, outside, bore, limit = rows[walled][order].T
    return WallSections(node[walled][order], Wall(D, d), Wall(outside, bore), limit)
