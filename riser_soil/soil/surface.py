"""Top surface of the soil for contact: all of it on rank 0, none elsewhere."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.part import State, local
from riser_soil.core.saved_state import Saved


def vector_areas(at: Array) -> Array:
    """Vector area (n, 3) [m2] between the corners of facets (n, nv, 3), of 4 or 3 and then others: along their normal,
    upwards.
    """
    corners = at[:, : 3 if at.shape[1] in (3, 6) else 4]
    corners = corners - corners[:, :1]
    return np.asarray(0.5 * np.cross(corners, np.roll(corners, -1, axis=1)).sum(axis=1))


class SoilTop:
    """Field "surface": views, on rank 0, of the soil's dofs at the top; it owns none.

    points (np, 3) [m]: undeformed. facets (nf, nv): indexes into points, counter-clockwise from above, of 4 corners or
    of 3 and then the midpoints of the sides 12, 23, 31. global_index, sign, prescribed (3 np,): of its dofs, x, y, z of
    each point; see `core.part.Field`. volume (nf,): number of the named volume below each facet. committed (np, 3) [m]:
    displacement since the geostatic start at the last accepted step; placed (np, 3) [m]: the one where areas are taken,
    zero at small strain, see `place`. moves: whether the geometry follows that, as at large strain.
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
        self._placed_for_step = False
        self.size = points.size
        self.offset = 0
        self.owned: BoolArray = np.zeros(self.size, dtype=bool)

    def displacement(self, state: State) -> Array:
        """Displacement of the whole top (np, 3) since the geostatic start [m]."""
        return np.asarray(self.committed + state.u[self.offset : self.offset + self.size].reshape(-1, 3))

    def lag(self, state: State) -> float:
        """Largest change of a facet's area from where it is placed to a state, as a share of it; 0 without facets."""
        placed, there = (self.points + moved for moved in (self.placed, self.displacement(state)))
        before, after = (np.linalg.norm(vector_areas(at[self.facets]), axis=1) for at in (placed, there))
        return float(np.abs(after / before - 1.0).max(initial=0.0))

    def place(self, state: State) -> None:
        """Take areas at a state of the step that is solved next: there they stay until another one begins."""
        self.placed, self._placed_for_step = self.displacement(state), True

    def prescribe(self, t: float, u: Array, v: Array, a: Array) -> None:
        for values in (u, v, a):
            values[self.prescribed] = 0.0

    def magnitudes(self, state: State) -> Array:
        return np.abs(self.committed.ravel() + state.u[local(self)])

    def commit(self, state: State) -> None:
        self.committed = self.displacement(state)
        if self.moves and not self._placed_for_step:
            self.placed = self.committed
        self._placed_for_step = False

    def move_to(self, displacement: Array) -> None:
        """Go on with another accepted displacement (np, 3) [m]."""
        self.committed = self.placed = displacement

    def state(self) -> Saved:
        return {"committed": self.committed, "placed": self.placed}

    def restore(self, saved: Saved) -> None:
        self.committed, self.placed = saved["committed"].copy(), saved["placed"].copy()

    def describe(self, entry: int) -> str:
        node, direction = divmod(entry, 3)
        x, y, _ = np.round(self.points[node], 3) + 0.0
        return f"soil surface at ({x:g}, {y:g}) m, {'xyz'[direction]} displacement"
