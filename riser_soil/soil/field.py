"""Displacement field of the soil: dofs, supports and committed displacement."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.part import State
from riser_soil.core.saved_state import Saved
from riser_soil.soil.grid import DistributedMesh


class SoilField:
    """Field "soil": three displacements at every node of this rank, ghosts included.

    The bottom is fixed, the block's upright sides slide on rollers (no normal displacement), the top is free.
    Nodes behind a mirror view their twins' dofs. total (size,): committed displacement since the geostatic start [m].
    section (size,): number of the independent section that each entry lies in; None where the soil has none.
    """

    name = "soil"
    space = "soil"

    def __init__(self, grid: DistributedMesh) -> None:
        nodes = grid.nodes
        self.points = nodes.points
        self.size = 3 * len(nodes.points)
        self.offset = 0
        twins, self.sign = grid.twins(), grid.signs().ravel()
        self.global_index: IntArray = components(nodes.number[twins])
        own = (twins == np.arange(len(twins))) & (np.arange(len(twins)) < nodes.owned)
        self.owned: BoolArray = np.repeat(own, 3)
        self.prescribed: BoolArray = grid.supported(nodes.points).ravel()
        self.section = None if grid.section is None else np.repeat(grid.section, 3)
        self.total: Array = np.zeros(self.size)

    def own(self, values: Array) -> Array:
        """The field's slice of a local array."""
        return values[self.offset : self.offset + self.size]

    def prescribe(self, t: float, u: Array, v: Array, a: Array) -> None:
        for values in (u, v, a):
            values[self.prescribed] = 0.0

    def magnitudes(self, state: State) -> Array:
        return np.abs(self.total + self.own(state.u))

    def commit(self, state: State) -> None:
        self.total += self.own(state.u)

    def state(self) -> Saved:
        return {"total": self.total.copy()}

    def restore(self, saved: Saved) -> None:
        self.total = saved["total"].copy()

    def describe(self, entry: int) -> str:
        node, direction = divmod(entry, 3)
        x, y, z = np.round(self.points[node], 3) + 0.0
        return f"soil node at ({x:g}, {y:g}, {z:g}) m, {'xyz'[direction]} displacement"


def components(nodes: IntArray) -> IntArray:
    """Numbers of the three components of each node: (..., n) to (..., 3n)."""
    return (3 * nodes[..., None] + np.arange(3)).reshape(*nodes.shape[:-1], 3 * nodes.shape[-1])
