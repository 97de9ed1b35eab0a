"""Assembly of soil, seabed and contact."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, assert_never

import numpy as np

from riser_soil.assembly.scales import Scales, contact_radius, scales_of
from riser_soil.core.arrays import Array
from riser_soil.core.communicator import Communicator
from riser_soil.core.part import Part
from riser_soil.errors import SceneError
from riser_soil.interruption import restoring_signal_handlers
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements, larger_beside
from riser_soil.scene.bathymetry import seabed_axis
from riser_soil.scene.contact import Contact as ContactScene
from riser_soil.scene.contact import Suction
from riser_soil.scene.plane import resolved_dimension
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import HystereticSeabed, RigidSeabed, Seabed, SpringSeabed
from riser_soil.scene.soil import GeneratedMesh, MeshFile, SoilScene
from riser_soil.scene.soil_law import density_of, law_of, volumes, weight_of

if TYPE_CHECKING:
    from riser_soil.contact.law import Penalty, SuctionLaw
    from riser_soil.contact.mesh_renewal import MeshRenewal
    from riser_soil.contact.seabed_contact import Cushion, SeabedContact
    from riser_soil.contact.soil_contact import SoilContact
    from riser_soil.contact.soil_friction import SoilFriction
    from riser_soil.contact.surface_contact import SurfaceContact
    from riser_soil.seabed.grounds import Ground
    from riser_soil.seabed.law import NormalLaw
    from riser_soil.soil.condensed import SoilSurface
    from riser_soil.soil.grid import DistributedMesh
    from riser_soil.soil.harmonic_mesh import HarmonicMesh
    from riser_soil.soil.sections import Sections
    from riser_soil.soil.soil import Soil

GAUSS_POINTS = 5  # of an element on the seabed: where the force sets in within it, three leave ten times the error
# Integration points across the width that touches at rest, as parts of the diameter, and how much farther apart along.
POINTS_ACROSS, FINEST, COARSEST, ALONG = 4.0, 1.0 / 200.0, 1.0 / 16.0, 4.0
NARROWEST_CORNER, WIDEST_CORNER = 1.0 / 3000.0, 1.0 / 300.0  # of the outer diameter; sharper ones cost iterations
SHALLOWEST = 1.0 / 300.0  # soil that gains strength from nothing has at least that of this depth
CUSHION, LEVEL = 0.01, 0.01  # of the diameter: how far it gives under the riser's weight; unevenness of a level top


def soil_of(scene: Scene, given: SoilScene, line: Line, diameter: float, comm: Any) -> Soil:
    """The continuum; meshed finely under the straight line between the riser's ends. diameter: of the riser [m].
    Collective.
    """
    with restoring_signal_handlers():  # imports gmsh
        from riser_soil.soil.asked_fields import fields_of
        from riser_soil.soil.soil import Soil

    grid = _grid(scene, given, line, comm)
    return Soil(
        grid,
        law_of(given, grid, SHALLOWEST * diameter),
        level=scene.seabed_level,
        unit_weight=weight_of(given),
        K0=given.K0,
        moves=scene.soil_moves,
        inertia=given.inertia,
        fields=fields_of(scene.output.soil_fields, given.laws),
    )


def soil_in_motion(scene: Scene, given: SoilScene, soil: Soil) -> list[Part]:
    """Parts of soil with inertia in dynamic stages."""
    if not given.inertia:
        return []
    from riser_soil.soil.inertia import SoilBoundary, SoilInertia

    density = soil.mean_by_depth(density_of(given, scene))
    boundary = [SoilBoundary(soil, density)] if given.absorbing else []
    return [SoilInertia(soil, density), *boundary]


def own_forms_of(given: SoilScene, soil: Soil) -> list[Part]:
    """The part of a user's terms, if there are any."""
    if given.forms is None:
        return []
    from riser_soil.soil.own_forms import SoilForms

    return [SoilForms(soil, given.forms)]


def _grid(scene: Scene, given: SoilScene, line: Line, comm: Any) -> DistributedMesh:
    from riser_soil.assembly.soil_block import block_of
    from riser_soil.soil.grid import block_grid, file_grid

    match given.mesh:
        case MeshFile():
            return file_grid(comm, given.mesh.file, volumes(given))
        case GeneratedMesh() | "auto":  # sizes are chosen
            pass
        case _:
            assert_never(given.mesh)
    first, last = ((float(x), float(y)) for x, y, _ in (line.to_global(line.x[node]) for node in (0, -1)))
    spec = block_of(scene, given, (first, last))
    if given.model == "block":
        return block_grid(comm, spec)
    from riser_soil.soil.slices import slice_grid

    return slice_grid(comm, spec)


def soil_contact_of(
    scene: Scene, settings: ContactScene, line: Line, elements: Elements, surface: SoilSurface, stiffness: float
) -> SoilContact:
    """Contact of the riser with the soil; evaluated on the first rank. stiffness: of the penalty [N/m2]."""
    if not settings.at_nodes:
        return _surface_contact_of(scene, settings, line, elements, surface, stiffness)
    from riser_soil.contact.law import Penalty
    from riser_soil.contact.node_contact import FOOTPRINT, NodeContact

    scales = scales_of(elements)
    outer_radius = float(larger_beside(0.5 * elements.outer_diameter).mean()) or 0.5 * scales.diameter
    return NodeContact(
        line,
        larger_beside(contact_radius(scene, elements)),
        surface,
        Penalty(stiffness, smoothing(settings, scales, "soil", stiffness)),
        footprint=FOOTPRINT * outer_radius,  # also where the axis touches: a single point finds no balance on a kink
        along=line.direction[:2],
    )


def _surface_contact_of(
    scene: Scene, settings: ContactScene, line: Line, elements: Elements, surface: SoilSurface, stiffness: float
) -> SurfaceContact:
    """Contact of the pipe's cylinder: the penalty's stiffness [N/m2] is spread over the width that touches at rest."""
    from riser_soil.contact.law import Penalty
    from riser_soil.contact.surface_contact import SurfaceContact

    assert scene.soil is not None
    scales = scales_of(elements)
    width = contact_width(scales, scene.soil.top_law.surface_modulus(scales.diameter))
    penalty = Penalty(stiffness / width, smoothing(settings, scales, "soil", stiffness))
    suction = settings.suction
    across = float(np.clip(width / POINTS_ACROSS, FINEST * scales.diameter, COARSEST * scales.diameter))
    return SurfaceContact(
        line,
        contact_radius(scene, elements),
        surface,
        penalty if suction is None else _with_suction(penalty, suction, "soil", scales.diameter),
        (ALONG * across, across),
        along=line.direction[:2],
    )


def mesh_renewal_of(
    soil: Soil, contact: SoilContact, friction: SoilFriction | None, line: Line
) -> MeshRenewal | None:
    """What renews the mesh of soil that moves under the pipe's cylinder."""
    from riser_soil.contact.surface_contact import SurfaceContact

    if not soil.moves or not isinstance(contact, SurfaceContact):
        return None
    from riser_soil.contact.mesh_renewal import MeshRenewal

    across = abs(float(line.direction[1])) > abs(float(line.direction[0]))
    mesh = _mesh_made_anew(soil, int(across)) if soil.grid.nodes.comm.rank == 0 else None
    return MeshRenewal(soil, contact, friction, mesh)


def _mesh_made_anew(soil: Soil, along: int) -> Sections | HarmonicMesh:
    """Its sections where its nodes form a grid, the riser along x (0) or y (1)."""
    from riser_soil.soil.sections import sections_of

    sections = sections_of(soil.mesh.points, along)
    if sections is not None:
        return sections
    from riser_soil.soil.harmonic_mesh import HarmonicMesh

    return HarmonicMesh.of(soil.grid, soil.mesh, soil.surface)


def contact_width(scales: Scales, E: float) -> float:
    """Width 2 b [m] over which the pipe touches elastic soil at rest, at most the diameter.

    Hertz's line contact of a cylinder: b² = 4 q R/(pi E*), with E* = 4/3 E of a soil without change of volume; E [Pa]
    at the surface.
    """
    plane = np.pi * max(4.0 / 3.0 * E, scales.weight / scales.diameter)  # very soft soil lets all of the pipe in
    return float(min(2.0 * np.sqrt(2.0 * scales.weight * scales.diameter / plane), scales.diameter))


def seabed_contact_of(
    scene: Scene, settings: ContactScene, line: Line, elements: Elements, law: NormalLaw, beside: SoilContact | None
) -> SeabedContact:
    """Contact of the riser with the seabed, beside the soil where there is one."""
    from riser_soil.contact.seabed_contact import SeabedContact
    from riser_soil.riser.stations import ENDS, gauss

    assert scene.seabed is not None
    return SeabedContact(
        line,
        contact_radius(scene, elements),
        ground_of(scene, scene.seabed),
        law,
        ENDS if settings.at_nodes else gauss(GAUSS_POINTS),
        covering=None if beside is None else beside.covering,
    )


def cushion_of(
    scene: Scene, contact: SoilContact, elements: Elements, top: Array, comm: Communicator
) -> Cushion | None:
    """What holds the riser at first that is to lie on a level soil; collective.

    top (np, 3): points of the soil's surface [m], all of it on the first rank.
    """
    scales = scales_of(elements)
    level = bool(np.ptp(top[:, 2]) < LEVEL * scales.diameter) if len(top) else True
    if not comm.bcast(level):
        return None
    from riser_soil.contact.seabed_contact import Cushion

    return Cushion(
        contact.line,
        contact_radius(scene, elements),
        scene.seabed_level,
        scales.weight,
        CUSHION * scales.diameter,
        contact.covering,
    )


def seabed_law(
    seabed: Seabed, settings: ContactScene, scales: Scales, diameter: float, stiffness: dict[str, float]
) -> NormalLaw:
    """How the seabed answers to penetration by a pipe of a diameter [m]. stiffness [N/m2]: of penalties."""
    match seabed:
        case HystereticSeabed():
            return seabed.law.of_pipe(diameter)
        case RigidSeabed() | SpringSeabed():
            return _penalty(settings, scales, stiffness["seabed"])
        case _:
            assert_never(seabed)


def mean_diameter(elements: Elements) -> float:
    """That along the line [m]: of laws for a line of several diameters."""
    return float(np.average(elements.outer_diameter, weights=elements.length))


def _penalty(settings: ContactScene, scales: Scales, stiffness: float) -> NormalLaw:
    from riser_soil.contact.law import Penalty

    penalty = Penalty(stiffness, smoothing(settings, scales, "seabed", stiffness))
    return penalty if settings.suction is None else _with_suction(penalty, settings.suction, "seabed")


def _with_suction(penalty: Penalty, given: Suction, ground: str, width: float = 1.0) -> SuctionLaw:
    """A penalty with suction; on the soil both are pressures, the cap over that width [m]."""
    from riser_soil.contact.law import SuctionLaw

    cap, reach, peak = given.cap / width, given.reach, given.cap / width / penalty.stiffness
    if reach <= peak:
        raise SceneError(
            f"contact.suction.reach = {reach:g} m: suction has its cap of {given.cap:g} N/m at {peak:g} m on the "
            f"{ground}, and must reach farther; raise reach or lower cap"
        )
    return SuctionLaw(penalty, cap, reach)


def ground_of(scene: Scene, seabed: Seabed) -> Ground:
    """The seabed's shape."""
    from riser_soil.seabed.grounds import Plane

    origin, direction = (np.asarray(vector) for vector in seabed_axis(scene))
    if seabed.profile is not None:
        from riser_soil.seabed.height_field import Profile

        return Profile(origin[:2], direction[:2], *np.array(seabed.profile).T)
    if seabed.grid is not None:
        from riser_soil.seabed.height_field import HeightField

        heights, section = seabed.grid.heights, direction[:2] if resolved_dimension(scene) == 2 else None
        return HeightField(np.array(heights.x), np.array(heights.y), np.array(heights.z), section)
    if seabed.slope_deg == 0.0:
        return Plane.level(seabed.level)
    towards = float(np.arctan2(direction[1], direction[0]))
    return Plane.sloping(np.array([*origin[:2], seabed.level]), np.radians(seabed.slope_deg), towards)


def smoothing(settings: ContactScene, scales: Scales, ground: str, stiffness: float) -> float:
    """Half width [m] of the rounded corner of a penalty of this stiffness [N/m2].

    Rounded over much more than the penetration at rest, the riser hovers: on a stiff floor that would shift the tension
    more than the penalty does.
    """
    if settings.smoothing != "auto":
        return float(settings.smoothing)
    if ground == "soil":  # integrated over a width, the force has no corner
        return WIDEST_CORNER * scales.diameter if settings.at_nodes else 0.0
    at_rest = scales.weight / stiffness
    return float(np.clip(at_rest, NARROWEST_CORNER * scales.diameter, WIDEST_CORNER * scales.diameter))


def stiffnesses(scene: Scene, settings: ContactScene, scales: Scales) -> dict[str, float]:
    """Force per length and penetration [N/m2] by ground: the scene's own, else the automatic choice."""
    from riser_soil.contact.law import STIFFNESS_OVER_SOIL, SURFACE_STIFFNESS_OVER_SOIL, automatic_stiffness

    over_soil = STIFFNESS_OVER_SOIL if settings.at_nodes else SURFACE_STIFFNESS_OVER_SOIL

    def penalty(E: float | None) -> float:
        """Where the pipe must not enter; E: Young's modulus [Pa], None of a rigid ground."""
        if settings.stiffness != "auto":
            return float(settings.stiffness)
        return automatic_stiffness(E, scales.weight, scales.diameter, over_soil)

    out = {"soil": penalty(scene.soil.top_law.surface_modulus(scales.diameter))} if scene.soil is not None else {}
    match scene.seabed:
        case RigidSeabed():
            out["seabed"] = penalty(None)
        case SpringSeabed():
            out["seabed"] = scene.seabed.stiffness
        case HystereticSeabed() | None:
            pass
        case _:
            assert_never(scene.seabed)
    return out

