"""New meshes of soil at large strain: the part "new mesh".

Before each step it looks whether cells have strained too far, and lets soil and contact go on with new ones.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from riser_soil.contact.soil_friction import SoilFriction
from riser_soil.contact.surface_contact import SurfaceContact
from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Traits, Weights, Work
from riser_soil.core.roles import Renewing
from riser_soil.core.saved_state import Saved, Stateful
from riser_soil.soil.sections import Pressing, Sections
from riser_soil.soil.soil import Soil

if TYPE_CHECKING:
    from riser_soil.soil.harmonic_mesh import HarmonicMesh

WORN = 0.02  # strain of a cell since its mesh was made: stretched ones bear more, and lose that on the next mesh
SOON = 0.5  # of that strain: sections that have it are renewed along with those that must be
CLEAR = 0.01  # radii of the pipe that a node is away from it, to be free


class MeshRenewal:
    """Renews the mesh of a soil, see the module's text. mesh: how, known on the first rank."""

    name = "new mesh"
    active = True
    traits = Traits("E", symmetric=True, roles=(Renewing, Stateful))

    def __init__(
        self,
        soil: Soil,
        contact: SurfaceContact,
        friction: SoilFriction | None,
        mesh: Sections | HarmonicMesh | None,
    ) -> None:
        self._soil, self._contact, self._friction, self._mesh = soil, contact, friction, mesh
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
        """Energy lost in the transfer to a new mesh before the step."""
        return Work(dissipated=self._lost)

    def commit(self, state: State) -> None:
        self._lost = 0.0

    def renew(self, state: State) -> bool:
        """Renew the mesh if cells have strained too far and a new one can be made; whether it was. Collective.

        state: accepted, increments zero.
        """
        comm, strain = self._soil.grid.nodes.comm, self._soil.worn
        if max(comm.allgather(strain.max(initial=0.0))) < WORN:
            return False
        points, worn = self._soil.gathered_points(), self._soil.gathered_wear(strain) >= SOON * WORN
        points, made = comm.bcast(self._mesh.renewed(points, worn, self._pipe(state)) if self._mesh else None)
        if not made.any():
            return False
        surface = self._soil.surface.points + self._soil.surface.committed
        self._soil.take_mesh(points, made)
        if self._contact.active:
            self._contact.surface_renewed(surface, [self._friction.memory] if self._friction else [])
        self.count += 1
        return True

    def lose(self, energy: float) -> None:
        self._lost = energy if self._soil.grid.nodes.comm.rank == 0 else 0.0

    def _pipe(self, state: State) -> Pressing:
        def gaps(points: Array) -> Array:
            return self._contact.gaps(points, state)

        def brought_to(points: Array, wanted_gaps: Array) -> Array:
            return self._contact.brought_to(points, wanted_gaps, state)

        return Pressing(gaps, brought_to, CLEAR * self._contact.radius)

    def state(self) -> Saved:
        return {"count": np.array(self.count), "lost": np.array(self._lost)}

    def restore(self, saved: Saved) -> None:
        self.count, self._lost = int(saved["count"]), float(saved["lost"])
