"""Top surface of the soil for contact: all of it on rank 0, none elsewhere."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.part import State
from riser_soil.core.saved_state import Saved
from riser_soil.soil.field import components
from riser_soil.soil.gathered import GatheredMesh, top_facets
from riser_soil.soil.grid import DistributedMesh


class SoilTop:
    """Field "surface": views, on rank 0, of the soil's dofs at the top; it owns none.

    kind: "quad4" or "tri6". points (np, 3) [m]: undeformed. facets (nf, nv): indexes into points,
    counter-clockwise from above, for tri6 the corners and then the midpoints of the sides 12, 23, 31.
    committed (np, 3) [m]: displacement since the geostatic start at the last accepted step.
    """

    name = "surface"
    space = "soil"

    def __init__(self, grid: DistributedMesh, mesh: GatheredMesh) -> None:
        facets = top_facets(grid, mesh)
        used = np.unique(facets)
        self.kind = grid.family.facet_kind
        self.facets: IntArray = np.searchsorted(used, facets)
        self.points: Array = mesh.points[used]
        self.committed: Array = np.zeros_like(self.points)
        self.size = self.points.size
        self.offset = 0
        self.global_index: IntArray = components(used)
        self.owned: BoolArray = np.zeros(self.size, dtype=bool)
        self.prescribed: BoolArray = grid.supported(self.points).ravel()

    def prescribe(self, t: float, u: Array, v: Array, a: Array) -> None:
        for values in (u, v, a):
            values[self.prescribed] = 0.0

    def commit(self, state: State) -> None:
        self.committed += state.u[self.offset : self.offset + self.size].reshape(-1, 3)

    def state(self) -> Saved:
        return {"committed": self.committed.copy()}

    def restore(self, saved: Saved) -> None:
        self.committed = saved["committed"].copy()

    def describe(self, entry: int) -> str:
        node, direction = divmod(entry, 3)
        x, y, _ = np.round(self.points[node], 3) + 0.0
        return f"soil surface at ({x:g}, {y:g}) m, {'xyz'[direction]} displacement"
