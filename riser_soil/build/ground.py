"""What the riser lies on: soil, seabed, and contact with them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from mpi4py import MPI

from riser_soil.arrays import Array
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.scene.contact import Contact as ContactScene
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import RigidSeabed, SpringSeabed
from riser_soil.scene.soil import LinearElastic, MeshFile
from riser_soil.scene.soil import Soil as SoilScene

if TYPE_CHECKING:
    from riser_soil.contact.contact import Contact
    from riser_soil.seabed.plane import Plane
    from riser_soil.soil.grid import Grid
    from riser_soil.soil.soil import Soil
    from riser_soil.soil.surface import Surface

NOMINAL_DIAMETER = 0.1  # m, for stiffness and footprint of the contact of a line without an outer diameter


def soil_of(scene: Scene, given: SoilScene, line: Line, comm: MPI.Intracomm) -> Soil:
    """The continuum; meshed finely under the straight line between the riser's ends. Collective."""
    from riser_soil.soil.linear_elastic import LinearElastic as Elastic
    from riser_soil.soil.soil import Soil
    from riser_soil.soil.von_mises import VonMises

    law = given.law
    constants = law.model_dump(exclude={"kind"})
    make = Elastic.at_depth if isinstance(law, LinearElastic) else VonMises.at_depth
    return Soil(
        _grid(scene, given, line, comm),
        lambda depth: make(depth, **constants),
        level=scene.seabed_level,
        unit_weight=given.submerged_unit_weight,
        K0=given.K0,
    )


def _grid(scene: Scene, given: SoilScene, line: Line, comm: MPI.Intracomm) -> Grid:
    from riser_soil.soil.block import BlockSpec
    from riser_soil.soil.grid import block_grid, file_grid

    if isinstance(given.mesh, MeshFile):
        return file_grid(comm, given.mesh.file)
    assert given.block is not None  # the scene's checks have seen to it
    first, last = (line.to_global(line.x[node])[:2].tolist() for node in (0, -1))
    return block_grid(
        comm,
        BlockSpec(
            x=given.block.x,
            y=given.block.y,
            depth=given.block.depth,
            size_at_riser=given.mesh.size_at_riser,
            size_far=given.mesh.size_far,
            level=scene.seabed_level,
            kind=given.mesh.kind,
            riser=((first[0], first[1]), (last[0], last[1])),
        ),
    )


def contact_of(
    scene: Scene,
    settings: ContactScene,
    line: Line,
    elements: Elements,
    surface: Surface | None,
    stiffness: dict[str, float],
    active: bool,
) -> Contact:
    """Contact of the riser with all grounds of the scene.

    stiffness [N/m2]: by ground, from `stiffnesses`. active: whether this rank evaluates contact.
    """
    from riser_soil.contact.contact import FOOTPRINT, Contact
    from riser_soil.contact.law import Penalty

    outer_radius = float(_at_nodes(0.5 * elements.outer_diameter).mean()) or 0.5 * NOMINAL_DIAMETER
    return Contact(
        line,
        _at_nodes(contact_radius(scene, elements)),
        plane=_plane(scene, stiffness, settings.smoothing),
        surface=surface,
        penalty=Penalty(stiffness["soil"], settings.smoothing) if surface is not None else None,
        footprint=FOOTPRINT * outer_radius,  # also where the axis touches: a single point finds no balance on a kink
        along=line.direction[:2],
        active=active,
    )


def contact_radius(scene: Scene, elements: Elements) -> Array:
    """Distance (ne,) from the axis to the line of the pipe that touches [m]."""
    return 0.5 * elements.outer_diameter * (scene.contact_at == "outer")


def _at_nodes(values: Array) -> Array:
    """The larger of what the two elements beside a node have (nn,)."""
    return np.maximum(np.append(values, 0.0), np.append(0.0, values))


def stiffnesses(scene: Scene, settings: ContactScene, elements: Elements, weight: float) -> dict[str, float]:
    """Force per length and penetration [N/m2] by ground: the scene's own, else the automatic choice.

    weight: typical force per length of the riser [N/m].
    """
    from riser_soil.contact.law import automatic_stiffness

    size = float(elements.outer_diameter.max()) or NOMINAL_DIAMETER
    out = {}
    for ground, E in _penalty_grounds(scene):
        automatic = settings.stiffness == "auto"
        out[ground] = automatic_stiffness(E, weight, size) if automatic else float(settings.stiffness)
    if isinstance(scene.seabed, SpringSeabed):
        out["plane"] = scene.seabed.stiffness
    return out


def _penalty_grounds(scene: Scene) -> Iterator[tuple[str, float | None]]:
    """Grounds that the pipe must not enter, each with its Young's modulus [Pa] (None: rigid)."""
    if scene.soil is not None:
        yield "soil", surface_modulus(scene.soil)
    if isinstance(scene.seabed, RigidSeabed):
        yield "plane", None


def surface_modulus(soil: SoilScene) -> float:
    """Young's modulus at the soil's surface [Pa]."""
    return soil.law.E if isinstance(soil.law, LinearElastic) else soil.law.E_over_su * soil.law.su


def _plane(scene: Scene, stiffness: dict[str, float], smoothing: float) -> Plane | None:
    from riser_soil.seabed.plane import Plane

    return Plane(scene.seabed.level, stiffness["plane"], smoothing) if scene.seabed is not None else None
