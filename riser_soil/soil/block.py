"""Mesh of a soil block in gmsh: layered hexahedra or tetrahedra, fine under the riser.

Needs a running gmsh; leaves the mesh in gmsh's current model with one physical volume. gmsh has tolerances in lengths:
the block is meshed with its longest side as the unit of length.
"""

from __future__ import annotations

from typing import assert_never

import gmsh
import numpy as np

from riser_soil.errors import MeshError
from riser_soil.soil.block_geometry import dig
from riser_soil.soil.grading import BlockSpec, in_units


def make_block(spec: BlockSpec) -> float:
    """Build and mesh the block in gmsh's current model; the model's unit of length [m]."""
    _mesh(in_units(spec, spec.span))
    return spec.span


def _mesh(spec: BlockSpec) -> None:
    match spec.kind:
        case "hex" if spec.feature is not None:
            raise MeshError("soil mesh: a trench or a groove is meshed in tetrahedra; take kind tet")
        case "hex":
            _extrude_layers(spec)
        case "tet":
            _tetrahedra(spec)
        case _:
            assert_never(spec.kind)
    volumes = [tag for _, tag in gmsh.model.getEntities(3)]
    gmsh.model.addPhysicalGroup(3, volumes, 1)
    gmsh.model.mesh.generate(3)


def _extrude_layers(spec: BlockSpec) -> None:
    """Extrude a corner along x, y and z with given layers: hexahedra in a tensor-product grid."""
    x, y, z = (spec.coordinates(axis) for axis in range(3))
    shape = [(0, gmsh.model.geo.addPoint(x[0], y[0], z[0]))]
    for axis, levels in enumerate((x, y, z)):
        step = np.zeros(3)
        step[axis] = levels[-1] - levels[0]
        heights = (levels[1:] - levels[0]) / step[axis]
        made = gmsh.model.geo.extrude(
            shape, *step, numElements=[1] * len(heights), heights=list(heights), recombine=True
        )
        shape = [entity for entity in made if entity[0] == axis + 1]
    gmsh.model.geo.synchronize()


def _tetrahedra(spec: BlockSpec) -> None:
    if spec.feature is None:
        _box(spec)
    else:
        dig(spec, spec.feature)
    _size_field(spec)


def _box(spec: BlockSpec) -> None:
    """A box without a mesh, cut where layers of soil meet."""
    (x0, x1), (y0, y1) = spec.x, spec.y
    corner = gmsh.model.geo.addPoint(x0, y0, spec.level - spec.depth)
    shape = [(0, corner)]
    depths = np.array([0.0, *spec.boundaries, spec.depth])
    for axis, length in [(0, x1 - x0), (1, y1 - y0), *((2, thickness) for thickness in np.diff(depths)[::-1])]:
        step = [length if i == axis else 0.0 for i in range(3)]
        made = gmsh.model.geo.extrude(shape, *step)
        shape = made[:1] if axis == 2 else [entity for entity in made if entity[0] == axis + 1]
    gmsh.model.geo.synchronize()


def _size_field(spec: BlockSpec) -> None:
    """Cell size grows linearly away from the riser's strip at the top face, and down to the bottom of a feature."""
    (x0, x1), (y0, y1) = spec.fine_range(0), spec.fine_range(1)
    bottom = spec.level - (spec.feature.depth if spec.feature else 0.0)
    field = gmsh.model.mesh.field.add("Box")
    values = {
        "VIn": spec.finest, "VOut": spec.size_far, "Thickness": spec.reach,
        "XMin": x0, "XMax": x1, "YMin": y0, "YMax": y1, "ZMin": bottom, "ZMax": spec.level,
    }  # fmt: skip
    for name, value in values.items():
        gmsh.model.mesh.field.setNumber(field, name, value)
    gmsh.model.mesh.field.setAsBackgroundMesh(field)
    for option in ("MeshSizeFromPoints", "MeshSizeFromCurvature", "MeshSizeExtendFromBoundary"):
        gmsh.option.setNumber(f"Mesh.{option}", 0)
