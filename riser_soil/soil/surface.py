"""Top surface of the soil for contact: all of it on rank 0, none elsewhere."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.part import State, local
from riser_soil.core.saved_state import Saved


class SoilTop:
    """Field "surface": views, on rank 0, of the soil's dofs at the top; it owns none.

    points (np, 3) [m]: undeformed. facets (nf, nv): indexes into points, counter-clockwise from above, of 4 corners or
    of 3 and then the midpoints of the sides 12, 23, 31. global_index, sign, prescribed (3 np,): of its dofs, x, y, z of
    each point; see `core.part.Field`. volume (nf,): number of the named volume below each facet. committed (np, 3) [m]:
    displacement since the geostatic start at the last accepted step; placed (np, 3) [m]: the one where areas are taken,
    none at small strain, see `Soil.place`. moves: whether the geometry follows that, as at large strain.
    """

    name = "surface"
    space = "soil"

    def __init__(
        self,
        points: Array,
        facets: IntArray,
        global_index: IntArray,
        sign: Array,
        prescribed: BoolArray,
        volume: IntArray,
        moves: bool = False,
    ) -> None:
        self.points, self.facets, self.volume, self.moves = points, facets, volume, moves
        self.global_index, self.sign, self.prescribed = global_index, sign, prescribed
        self.committed: Array = np.zeros_like(points)
        self.placed: Array = np.zeros_like(points)
        self.size = points.size
        self.offset = 0
        self.owned: BoolArray = np.zeros(self.size, dtype=bool)

    def displacement(self, state: State) -> Array:
        """Displacement of the whole top (np, 3) since the geostatic start [m]."""
        return np.asarray(self.committed + state.u[self.offset : self.offset + self.size].reshape(-1, 3))

    def prescribe(self, t: float, u: Array, v: Array, a: Array) -> None:
        for values in (u, v, a):
            values[self.prescribed] = 0.0

    def magnitudes(self, state: State) -> Array:
        return np.abs(self.committed.ravel() + state.u[local(self)])

    def commit(self, state: State) -> None:
        self._settle(self.displacement(state))

    def state(self) -> Saved:
        return {"committed": self.committed}

    def restore(self, saved: Saved) -> None:
        self._settle(saved["committed"].copy())

    def _settle(self, displacement: Array) -> None:
        self.committed = displacement
        if self.moves:
            self.placed = displacement

    def describe(self, entry: int) -> str:
        node, direction = divmod(entry, 3)
        x, y, _ = np.round(self.points[node], 3) + 0.0
        return f"soil surface at ({x:g}, {y:g}) m, {'xyz'[direction]} displacement"
