"""New meshes of soil at large strain: the part "new mesh".

Before each step it looks whether cells have strained too far, and lets soil and contact go on with new ones.
"""

from __future__ import annotations

import numpy as np

from riser_soil.contact.soil_friction import SoilFriction
from riser_soil.contact.surface_contact import SurfaceContact
from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Traits, Weights, Work
from riser_soil.core.roles import Renewing
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.soil.sections import Sections, at_columns, refilled, spread
from riser_soil.soil.soil import FOLDS, Soil

WORN = 0.02  # strain of a cell since its mesh was made: stretched ones bear more, and lose that on the next mesh
SOON = 0.5  # of that strain: sections that have it are renewed along with those that must be
CLEAR = 0.01  # radii of the pipe that a node is away from it, to be free


class MeshRenewal:
    """Renews the mesh of a soil, see the module's text. sections: of its block's nodes, on the first rank."""

    name = "new mesh"
    active = True
    traits = Traits("E", symmetric=True, roles=(Renewing, Stateful))

    def __init__(
        self, soil: Soil, contact: SurfaceContact, friction: SoilFriction | None, sections: Sections | None
    ) -> None:
        self._soil, self._contact, self._friction, self._sections = soil, contact, friction, sections
        self.count, self._lost = 0, 0.0

    def blocks(self) -> dict[str, MatrixBlock]:
        return {}

    def residual(self, state: State, forces: Forces) -> None:
        """Nothing acts."""

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        """Nothing acts."""

    def energy(self, state: State) -> Energy:
        return Energy()

    def work(self, before: State, after: State) -> Work:
        """What the transfer before the step has lost."""
        return Work(dissipated=self._lost)

    def commit(self, state: State) -> None:
        self._lost = 0.0

    def renew(self, state: State) -> bool:
        """Go on on a new mesh if need be and there is one; whether so. state: accepted, increments zero. Collective."""
        comm, worn = self._soil.grid.nodes.comm, self._soil.worn
        if max(comm.allgather(worn.max(initial=0.0))) < WORN:
            return False
        points, wear = self._soil.gathered_points(), self._soil.gathered_wear(worn)
        points, made = comm.bcast(self._renewed(points, wear, state) if comm.rank == 0 else None)
        if not made.any():
            return False
        surface = self._soil.surface.points + self._soil.surface.committed
        self._soil.take_mesh(points, made)
        if self._contact.active:
            self._contact.surface_renewed(surface, [self._friction.anew()] if self._friction else [])
        self.count += 1
        return True

    def lose(self, energy: float) -> None:
        self._lost = energy if self._soil.grid.nodes.comm.rank == 0 else 0.0

    def _renewed(self, points: Array, wear: Array, state: State) -> tuple[Array, BoolArray]:
        """All nodes (n, 3), and which of them (n,) are those of new sections; wear (n,): strain around the nodes."""
        assert self._sections is not None
        out, made = points.copy(), np.zeros(len(points), dtype=bool)
        for section in self._sections.nodes:
            new = None
            if wear[section].max() >= SOON * WORN:
                new = self._renewed_section(points[section], self._sections, state)
            if new is not None:
                out[section], made[section] = new, True
        return out, made

    def _renewed_section(self, at: Array, sections: Sections, state: State) -> Array | None:
        """New nodes of a section (nc, nl, 3), none of whose cells is folded; None where there is no such way."""
        line, across = at[:, -1], sections.across
        gaps = self._contact.gaps(line, state)
        tops = spread(line, sections.columns, gaps), at_columns(line, sections.columns, gaps, across)
        for top, beside in tops:
            brought, clear = self._contact.brought_to(top, beside, state), CLEAR * self._contact.radius
            free = beside > clear
            new = sections.renewed(at, self._refilled(line, brought, free, across, clear, state))
            if sections.skewness(new) > FOLDS:
                return new
        return None

    def _refilled(
        self, line: Array, top: Array, free: BoolArray, across: int, clear: float, state: State
    ) -> Array:
        """See `refilled`; a node that would be raised to within `clear` of the pipe [m] stays."""
        out = refilled(line, top, free, across)
        close = free & (self._contact.gaps(out, state) < clear)
        return self._refilled(line, top, free & ~close, across, clear, state) if close.any() else out

    def state(self) -> Saved:
        return {"count": np.array(self.count), "lost": np.array(self._lost)}

    def restore(self, saved: Saved) -> None:
        self.count, self._lost = int(saved["count"]), float(saved["lost"])
