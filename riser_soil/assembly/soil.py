"""Assembly of the soil as a continuum, of its parts in motion, and of a user's terms."""

from __future__ import annotations

from typing import Any, assert_never

from riser_soil.assembly.scales import SHALLOWEST
from riser_soil.assembly.soil_block import block_of
from riser_soil.core.part import Part
from riser_soil.riser.line import Line
from riser_soil.scene.scene import Scene
from riser_soil.scene.soil import GeneratedMesh, MeshFile, SoilScene
from riser_soil.scene.soil_law import density_of, law_of, volumes, weight_of
from riser_soil.soil.grid import DistributedMesh, block_grid, file_grid
from riser_soil.soil.requested_fields import fields_of
from riser_soil.soil.slices import slice_grid
from riser_soil.soil.soil import Soil


def soil_of(scene: Scene, given: SoilScene, line: Line, diameter: float, comm: Any) -> Soil:
    """The continuum; meshed finely under the straight line between the riser's ends. diameter: of the riser [m].
    Collective.
    """
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


def _grid(scene: Scene, given: SoilScene, line: Line, comm: Any) -> DistributedMesh:
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
    return slice_grid(comm, spec)


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
