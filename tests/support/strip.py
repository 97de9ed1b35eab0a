"""A rigid strip, rough unless told, on a plane-strain block of soil without weight: its load as it is pressed in."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import gmsh
import numpy as np
from mpi4py import MPI

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.soil.block import BlockSpec
from riser_soil.soil.families import Family
from riser_soil.soil.grid import DistributedMesh, block_grid, file_grid, silent_gmsh
from riser_soil.soil.law import SoilLaw
from riser_soil.soil.soil import Soil
from riser_soil.soil.von_mises import VonMises
from tests.support.soil_bench import Bench


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


SU = 1.0e3
CLAY = VonMises(kind="von-mises", su=SU, su_gradient=0.0, E_over_su=300.0, nu=0.49)


@dataclass(frozen=True, eq=False)
class Strip:
    """Load of a rigid strip of half width 1 m, over the strength, and residual norms, step by step."""

    load: Array
    norms: list[list[float]]


def press_strip(
    kind: str,
    cells: int,
    family: Family | None = None,
    far: float = 0.5,
    law: SoilLaw = CLAY,
    strength: float = SU,
    steps: int = 15,
    rough: bool = True,
    seconds: float = math.inf,
) -> Strip:
    """Press half of a strip 0.15 m into a plane-strain block 5 m wide, 3 m deep; `cells` under the strip, seconds a
    step.
    """
    soil, under = strip_soil(kind, cells, family, far, law)
    return press(soil, under, 1.0 / cells, strength, steps, rough, seconds=seconds)


def press_graded_strip(
    size: float, growth: float, law: SoilLaw = CLAY, rough: bool = True, fine: float = 0.0, depth: float = 0.15
) -> Strip:
    """Press a strip into clay whose strength grows, `depth` [m] down, on tetrahedra of a `size` [m] at the strip's edge
    and `fine` m inwards below it.

    Away from there they grow by `growth` metres per metre, up to 16 times that size.
    """
    grid = tet_slice(1.0, 5.0, 3.0, 2.0 * size, size, growth, far=16.0 * size, fine=fine)
    soil = Soil(grid, law.at_points, level=0.0, unit_weight=0.0)
    return press(soil, under_strip(soil), 2.0 * size, SU, round(100.0 * depth), rough, depth)


def press(
    soil: Soil,
    under: BoolArray,
    thickness: float,
    strength: float,
    steps: int,
    rough: bool,
    depth: float = 0.15,
    seconds: float = math.inf,
) -> Strip:
    """Press the nodes `under` (n,) the strip `depth` [m] down, in equal steps, on a slice of this thickness [m]."""
    driven = np.zeros((len(under), 3), dtype=bool)
    driven[under] = [rough, rough, True]
    bench = Bench(soil, driven.ravel(), seconds=seconds)
    given = np.where(under, -depth / steps, 0.0)[:, None] * np.array([0.0, 0.0, 1.0])
    loads, norms = [], []
    for _ in range(steps):
        _step(bench, given.ravel())
        norms.append(bench.norms)
        reaction = bench.at_rest().reshape(-1, 3)[under, 2].sum()
        loads.append(-reaction / (thickness * strength))
    return Strip(np.array(loads), norms)


def _step(bench: Bench, given: Array, halvings: int = 2) -> None:
    """One step of the bench, or two of half the size where it finds no balance."""
    try:
        bench.step(given)
    except AssertionError:
        if halvings == 0:
            raise
        _scale(bench, 0.5)
        for _ in range(2):
            _step(bench, 0.5 * given, halvings - 1)
        _scale(bench, 2.0)


def _scale(bench: Bench, share: float) -> None:
    """The next step takes so much of the time, and starts from so much of the last increment."""
    bench.seconds *= share
    if bench.increment is not None:
        bench.increment = share * bench.increment


def strip_soil(kind: str, cells: int, family: Family | None, far: float, law: SoilLaw) -> tuple[Soil, BoolArray]:
    """A slice one cell thick, and which nodes lie under the strip."""
    h = 1.0 / cells
    fine = ((-1.0, 0.0), (1.25 - 0.5 * h, 0.0))  # cells of size h from the symmetry plane to x = 1.25
    spec = BlockSpec((0.0, 5.0), (0.0, h), 3.0, h, far, kind="tet" if kind == "tet" else "hex", riser=fine)
    grid: DistributedMesh = block_grid(MPI.COMM_SELF, spec)
    soil = Soil(replace(grid, family=family or grid.family), law.at_points, level=0.0, unit_weight=0.0)
    return soil, under_strip(soil)


def under_strip(soil: Soil) -> BoolArray:
    """Which nodes (n,) lie under the strip."""
    x, _, z = soil.field.points.T
    under: BoolArray = (z > -1e-9) & (x < 1.0 + 1e-9)
    return under
