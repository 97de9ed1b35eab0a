"""A slice of soil in tetrahedra that are small at the edge of a strip: triangles in x and z, drawn out along y."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import gmsh
from mpi4py import MPI

from riser_soil.soil.grid import DistributedMesh, file_grid, silent_gmsh


def tet_slice(
    half: float, wide: float, deep: float, thickness: float, edge: float, growth: float, far: float, fine: float = 0.0
) -> DistributedMesh:
    """0 < x < wide, 0 < y < thickness, -deep < z < 0 [m]; a line of the mesh at the strip's edge, x = half.

    Size of the triangles: `edge` there and below the strip to `fine` from it, elsewhere `growth` times the distance
    from there more, at most `far`.
    """
    with TemporaryDirectory() as folder:
        path = Path(folder) / "slice.msh"
        with silent_gmsh():
            _draw(half, wide, deep, thickness)
            beside = f"(Abs(x - {half - 0.5 * fine}) - {0.5 * fine})"  # negative below the fine part of the strip
            _grade(f"Min({edge} + {growth} * Sqrt((0.5 * ({beside} + Abs({beside})))^2 + z^2), {far})")
            gmsh.model.mesh.generate(3)
            gmsh.write(str(path))
        return file_grid(MPI.COMM_SELF, path)


def _draw(half: float, wide: float, deep: float, thickness: float) -> None:
    geo = gmsh.model.geo
    corners = [(0.0, -deep), (wide, -deep), (wide, 0.0), (half, 0.0), (0.0, 0.0)]
    points = [geo.addPoint(x, 0.0, z) for x, z in corners]
    lines = [geo.addLine(a, b) for a, b in zip(points, points[1:] + points[:1], strict=True)]
    side = geo.addPlaneSurface([geo.addCurveLoop(lines)])
    made = geo.extrude([(2, side)], 0.0, thickness, 0.0, numElements=[1])
    geo.synchronize()
    gmsh.model.addPhysicalGroup(3, [tag for dimension, tag in made if dimension == 3], 1)


def _grade(size: str) -> None:
    field = gmsh.model.mesh.field.add("MathEval")
    gmsh.model.mesh.field.setString(field, "F", size)
    gmsh.model.mesh.field.setAsBackgroundMesh(field)
    for option in ("MeshSizeFromPoints", "MeshSizeFromCurvature", "MeshSizeExtendFromBoundary"):
        gmsh.option.setNumber(f"Mesh.{option}", 0)
