"""Mesh of a soil block in gmsh: layered hexahedra or tetrahedra, fine under the riser.

Needs a running gmsh; leaves the mesh in gmsh's current model with one physical volume. gmsh has tolerances in lengths:
the block is meshed with its longest side as the unit of length.

Geometry of a soil block with a trench or a groove, in gmsh's OpenCASCADE kernel.

Needs a running gmsh; leaves volumes without a mesh in gmsh's current model.
"""

from __future__ import annotations

from typing import assert_never

import gmsh
import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.errors import MeshError
from riser_soil.soil.grading import BlockSpec, in_units
from riser_soil.soil.seabed_feature import FeatureSpec, GrooveSpec, TrenchSpec

Entities = list[tuple[int, int]]


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


def dig(spec: BlockSpec, feature: FeatureSpec) -> None:
    """Make the block less its feature, cut where layers of soil meet."""
    (x0, x1), (y0, y1) = spec.x, spec.y
    box = [(3, gmsh.model.occ.addBox(x0, y0, spec.level - spec.depth, x1 - x0, y1 - y0, spec.depth))]
    match feature:
        case TrenchSpec():
            tool = _hexahedron(_placed(spec, feature.corners(spec.ends)))
        case GrooveSpec():
            tool = _groove(spec, feature)
        case _:
            assert_never(feature)
    soil, _ = gmsh.model.occ.cut(box, tool)
    _cut_into_layers(spec, soil)
    gmsh.model.occ.synchronize()


def _placed(spec: BlockSpec, points: Array) -> Array:
    """Points (..., 3) in global axes, from along, across and z below the level."""
    axis = spec.axis
    out = np.empty_like(points)
    out[..., axis], out[..., 1 - axis] = points[..., 0], spec.line + points[..., 1]
    out[..., 2] = spec.level + points[..., 2]
    return out


def _groove(spec: BlockSpec, feature: GrooveSpec) -> Entities:
    """A prism over the groove's section, closed above the seabed and longer than the block."""
    section = feature.section(spec.size_at_riser)
    lid = np.array([(section[-1, 0], feature.radius), (section[0, 0], feature.radius)])
    outline = np.vstack((section, lid))
    first, last = spec.ends
    beyond = 0.1 * (last - first)
    points = _placed(spec, np.column_stack((np.full(len(outline), first - beyond), outline)))
    step = [0.0, 0.0, 0.0]
    step[spec.axis] = last - first + 2.0 * beyond
    made = gmsh.model.occ.extrude([(2, _face(points))], *step)
    return [entity for entity in made if entity[0] == 3]


def _face(points: Array) -> int:
    corners = [gmsh.model.occ.addPoint(*point) for point in points]
    lines = [gmsh.model.occ.addLine(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    return int(gmsh.model.occ.addPlaneSurface([gmsh.model.occ.addCurveLoop(lines)]))


def _hexahedron(points: Array) -> Entities:
    """A solid with plane faces between two quadrilaterals (2, 4, 3)."""
    corners = [[gmsh.model.occ.addPoint(*point) for point in face] for face in points]
    rings = [[gmsh.model.occ.addLine(face[k], face[(k + 1) % 4]) for k in range(4)] for face in corners]
    posts = [gmsh.model.occ.addLine(corners[0][k], corners[1][k]) for k in range(4)]
    sides = [[rings[0][k], posts[(k + 1) % 4], -rings[1][k], -posts[k]] for k in range(4)]
    faces = [gmsh.model.occ.addPlaneSurface([gmsh.model.occ.addCurveLoop(loop)]) for loop in (*rings, *sides)]
    return [(3, gmsh.model.occ.addVolume([gmsh.model.occ.addSurfaceLoop(faces)]))]


def _cut_into_layers(spec: BlockSpec, soil: Entities) -> None:
    """Cut volumes along level planes, and take away what the planes have beyond them."""
    if not spec.boundaries:
        return
    (x0, x1), (y0, y1) = spec.x, spec.y
    planes = [(2, gmsh.model.occ.addRectangle(x0, y0, spec.level - d, x1 - x0, y1 - y0)) for d in spec.boundaries]
    gmsh.model.occ.fragment(soil, planes)
    gmsh.model.occ.synchronize()
    loose = [entity for entity in gmsh.model.getEntities(2) if not len(gmsh.model.getAdjacencies(*entity)[0])]
    gmsh.model.occ.remove(loose, recursive=True)
