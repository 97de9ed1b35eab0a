"""Geometry of a soil block with a trench or a groove, in gmsh's OpenCASCADE kernel.

Needs a running gmsh; leaves volumes without a mesh in gmsh's current model.
"""

from __future__ import annotations

from typing import assert_never

import gmsh
import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.soil.grading import BlockSpec
from riser_soil.soil.seabed_feature import FeatureSpec, GrooveSpec, TrenchSpec

Entities = list[tuple[int, int]]


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
