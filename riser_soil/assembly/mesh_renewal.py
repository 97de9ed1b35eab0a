"""Assembly of what renews the mesh of soil that moves under the pipe's surface."""

from __future__ import annotations

from riser_soil.contact.mesh_renewal import MeshRenewal
from riser_soil.contact.soil_friction import SoilFriction
from riser_soil.contact.surface_contact import SurfaceContact
from riser_soil.riser.line import Line
from riser_soil.soil.harmonic_mesh import HarmonicMesh
from riser_soil.soil.sections import Sections, sections_of
from riser_soil.soil.soil import Soil


def mesh_renewal_of(soil: Soil, contact: SurfaceContact, friction: SoilFriction | None, line: Line) -> MeshRenewal:
    """The part that gives the soil new meshes; they are made on the first rank."""
    across = abs(float(line.direction[1])) > abs(float(line.direction[0]))
    mesh = _mesh_made_anew(soil, int(across)) if soil.grid.nodes.comm.rank == 0 else None
    return MeshRenewal(soil, contact, friction, mesh)


def _mesh_made_anew(soil: Soil, along: int) -> Sections | HarmonicMesh:
    """A soil's sections where its nodes form a grid, the riser along x (0) or y (1)."""
    sections = sections_of(soil.mesh.points, along)
    return HarmonicMesh.of(soil.grid, soil.mesh, soil.surface) if sections is None else sections
