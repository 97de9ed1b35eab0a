"""Automatic mesh: halving all cells, or the cells' length and the pipe's elements, changes little; fixed cells do."""

from __future__ import annotations

from copy import deepcopy
from typing import NamedTuple

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.assembly import build, sized
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.scene.soil import CellSizes, GeneratedMesh
from tests.support.coupled_scenes import Mapping
from tests.support.driven_stage import take
from tests.support.lifted_pipe import CLAY, ELASTIC, lifted_pipe
from tests.verification.test_surface_contact import D, slice_of_soil

EVEN_CLAY = {"kind": "von-mises", "su": 4.0e3, "E_over_su": 300.0, "nu": 0.49}


class Found(NamedTuple):
    """Force per length [N/m] at the given indentation, largest equivalent stress [Pa], plastic strain, unknowns."""

    force: float
    stress: float
    plastic_strain: float
    unknowns: int


def slice_scene(law: Mapping, weight: float, indentation: float, method: str = "surface") -> Mapping:
    """A slice of soil into which a pipe of this submerged weight [N/m] is pushed; block of eight diameters."""
    scene = slice_of_soil(2, method)
    scene["line_types"]["pipe"] |= {"submerged_weight": weight, "EA": 1e8}
    scene["soil"] |= {"law": deepcopy(law), "mesh": "auto"}
    scene["soil"]["block"] = {"x": [0.45, 0.55], "y": [-8.0 * D, 8.0 * D], "depth": 8.0 * D}
    for end in ("start", "end"):
        scene["stages"][0]["move"][end][2] = 0.5 * D - indentation
    return scene


def scaled(scene: Scene, across: float = 1.0, along: float = 1.0) -> Scene:
    """The scene with its automatic cells so many times as large across, and downwards, and along."""
    scene = sized(scene)
    assert scene.soil is not None
    mesh = scene.soil.mesh
    assert isinstance(mesh, GeneratedMesh)
    given = mesh.size_at_riser
    assert isinstance(given, CellSizes)
    sizes = CellSizes(along=along * given.along, across=across * given.across, strip=given.strip)
    mesh = mesh.model_copy(update={"size_at_riser": sizes, "size_far": across * mesh.size_far})
    return scene.model_copy(update={"soil": scene.soil.model_copy(update={"mesh": mesh})})


def pushed(scene: Scene) -> Found:
    assembly = build(scene, MPI.COMM_SELF)
    state = take(assembly, scene.stages[0])
    assert assembly.soil is not None
    assert assembly.soil_contact is not None
    grid, fields = assembly.soil.grid, assembly.soil.output_fields()
    force = -float(assembly.soil_contact.force_on_soil(state)[2]) / float(grid.high[0] - grid.low[0])
    return Found(force, fields.von_mises.max(), fields.plastic_strain.max(), 3 * len(assembly.soil.field.points))


def changes(law: Mapping, weight: float, indentation: float) -> tuple[float, float]:
    """What halving all cells changes of the force and of the largest stress."""
    scene = scene_from_mapping(slice_scene(law, weight, indentation))
    auto, half = pushed(scaled(scene)), pushed(scaled(scene, across=0.5))
    return half.force / auto.force - 1.0, half.stress / auto.stress - 1.0


def test_a_light_pipe_settles_the_same_on_cells_half_as_large() -> None:
    assert np.abs(changes(ELASTIC, 1070.0, D / 200.0)).max() < 0.05


def test_clay_that_yields_bears_the_same_on_cells_half_as_large() -> None:
    assert abs(changes(EVEN_CLAY, 1350.0, D / 100.0)[0]) < 0.05
