"""A plain block of soil in gmsh: layered hexahedra or tetrahedra, fine under the riser.

Needs a running gmsh; leaves the mesh in gmsh's current model with one physical volume.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, assert_never

import gmsh
import numpy as np

from riser_soil.arrays import Array

Point = tuple[float, float]


@dataclass(frozen=True)
class BlockSpec:
    """A block with a level top [m].

    x, y: range in plan. level: z of the top face. depth: thickness. kind: element family. size_at_riser: cell
    size under the riser; size_far: the size that it grows to at the block's far faces. riser: two points of
    the riser's straight line in plan; a cell's middle, not its edge, lies under a line along x or y, so that
    the surface under the riser is smooth. None: fine in the whole plan.
    """

    x: Point
    y: Point
    depth: float
    size_at_riser: float
    size_far: float
    level: float = 0.0
    kind: Literal["hex", "tet"] = "hex"
    riser: tuple[Point, Point] | None = None

    def fine_range(self, axis: int) -> Point:
        """Range of x (axis 0) or y (axis 1) that the riser takes up in plan, with half a cell around."""
        low, high = (self.x, self.y)[axis]
        if self.riser is None:
            return low, high
        ends = sorted(point[axis] for point in self.riser)
        half = 0.5 * self.size_at_riser
        first, last = np.clip((ends[0] - half, ends[1] + half), low, high)
        return float(first), float(last)


def make_block(spec: BlockSpec) -> None:
    """Build and mesh the block in gmsh's current model."""
    match spec.kind:
        case "hex":
            _extrude_layers(spec)
        case "tet":
            _tetrahedra(spec)
        case _:
            assert_never(spec.kind)
    volumes = [tag for _, tag in gmsh.model.getEntities(3)]
    gmsh.model.addPhysicalGroup(3, volumes)
    gmsh.model.mesh.generate(3)


def graded(low: float, high: float, fine: Point, size: float, size_far: float) -> Array:
    """Coordinates from low to high: cells of `size` in the fine range, growing to `size_far` at the ends."""
    count = max(1, round((fine[1] - fine[0]) / size))
    middle = np.linspace(fine[0], fine[1], count + 1) if fine[1] > fine[0] else np.array([fine[0]])
    below = fine[0] - _growing(fine[0] - low, size, size_far)[:0:-1]
    above = fine[1] + _growing(high - fine[1], size, size_far)[1:]
    return np.concatenate((below, middle, above))


def _growing(length: float, size: float, size_far: float) -> Array:
    """Distances 0..length whose steps grow geometrically from about `size` to about `size_far`."""
    if length <= 1e-9 * size:
        return np.zeros(1)
    ratio = size_far / size
    if abs(ratio - 1.0) < 1e-9:
        return np.linspace(0.0, length, max(1, round(length / size)) + 1)
    count = max(1, int(np.ceil(length * np.log(ratio) / (size_far - size) - 1e-9)))
    distances: Array = length * (ratio ** (np.arange(count + 1) / count) - 1.0) / (ratio - 1.0)
    return distances


def _extrude_layers(spec: BlockSpec) -> None:
    """Extrude a corner along x, y and z with given layers: hexahedra in a tensor-product grid."""
    x = graded(*spec.x, spec.fine_range(0), spec.size_at_riser, spec.size_far)
    y = graded(*spec.y, spec.fine_range(1), spec.size_at_riser, spec.size_far)
    z = spec.level - _growing(spec.depth, spec.size_at_riser, spec.size_far)[::-1]
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
    (x0, x1), (y0, y1) = spec.x, spec.y
    corner = gmsh.model.geo.addPoint(x0, y0, spec.level - spec.depth)
    shape = [(0, corner)]
    for axis, length in enumerate((x1 - x0, y1 - y0, spec.depth)):
        step = [length if i == axis else 0.0 for i in range(3)]
        shape = [entity for entity in gmsh.model.geo.extrude(shape, *step) if entity[0] == axis + 1]
    gmsh.model.geo.synchronize()
    _size_field(spec)


def _size_field(spec: BlockSpec) -> None:
    """Cell size grows linearly away from the riser's strip at the top face."""
    (x0, x1), (y0, y1) = spec.fine_range(0), spec.fine_range(1)
    away = max(x0 - spec.x[0], spec.x[1] - x1, y0 - spec.y[0], spec.y[1] - y1, spec.depth)
    field = gmsh.model.mesh.field.add("Box")
    values = {
        "VIn": spec.size_at_riser, "VOut": spec.size_far, "Thickness": away,
        "XMin": x0, "XMax": x1, "YMin": y0, "YMax": y1, "ZMin": spec.level, "ZMax": spec.level,
    }  # fmt: skip
    for name, value in values.items():
        gmsh.model.mesh.field.setNumber(field, name, value)
    gmsh.model.mesh.field.setAsBackgroundMesh(field)
    for option in ("MeshSizeFromPoints", "MeshSizeFromCurvature", "MeshSizeExtendFromBoundary"):
        gmsh.option.setNumber(f"Mesh.{option}", 0)
