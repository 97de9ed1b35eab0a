"""Report and warnings of the soil's mesh: quality of its cells, and cells that lie across boundaries of layers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.scene.soil_layers import boundaries
from riser_soil.soil.quality import POOR, quality_of

# Aspect ratios above which cells are warned of: hexahedra may be long along the riser, thin tetrahedra make errors.
LONG_HEXAHEDRA, THIN_TETRAHEDRA = 1000.0, 30.0
ACROSS = 1e-6  # part of a cell's height by which it may reach over a boundary


def mesh_report(riser: LineAssembly) -> Iterator[str]:
    """Lines of `check` about the soil's cells; collective."""
    assert riser.soil is not None
    cells = quality_of(riser.soil.whole.grid)
    yield (
        f"soil mesh: edges of {cells.smallest:.4g} to {cells.largest:.4g} m, aspect ratios up to {cells.aspect:.3g}, "
        f"scaled Jacobians from {cells.jacobian:.3g} (1 is best)"
    )
    assert riser.scene.soil is not None
    depths = boundaries(riser.scene.soil.layers or ())
    if depths:
        depths_listed = ", ".join(f"{depth:g}" for depth in depths)
        crossing = _cells_across(riser, depths)
        across = f"{crossing} cells lie across, each of whose points has the law of its depth"
        yield f"soil layers meet at depths of {depths_listed} m; {across if crossing else 'cells end there'}"


def quality_warnings(riser: LineAssembly) -> Iterator[str]:
    """Warnings about the shape of the soil's cells; collective."""
    assert riser.soil is not None
    grid = riser.soil.whole.grid
    cells, tetrahedra = quality_of(grid), grid.family.corners == 3
    if cells.poor:
        yield (
            f"soil mesh: {cells.poor} cells have a scaled Jacobian below {POOR:g}, the worst, at "
            f"{_place(cells.skewed)}, {cells.jacobian:.2g}: strain is poor there; mend the mesh, or take other sizes"
        )
    limit = THIN_TETRAHEDRA if tetrahedra else LONG_HEXAHEDRA
    if cells.aspect > limit:
        yield (
            f"soil mesh: the cell at {_place(cells.thin)} has an aspect ratio of {cells.aspect:.3g}, above {limit:g}: "
            "bring its sizes nearer to each other"
        )


def _cells_across(riser: LineAssembly, depths: tuple[float, ...]) -> int:
    assert riser.soil is not None
    nodes = riser.soil.whole.grid.nodes
    depth = riser.scene.seabed_level - nodes.points[nodes.cells, 2]
    top, bottom = depth.min(axis=1, initial=np.inf), depth.max(axis=1, initial=-np.inf)
    slack = ACROSS * (bottom - top)
    across = np.zeros(len(top), dtype=bool)
    for boundary in depths:
        across |= (top + slack < boundary) & (bottom - slack > boundary)
    return int(nodes.comm.allreduce(int(np.count_nonzero(across))))


def _place(point: tuple[float, ...]) -> str:
    return f"({', '.join(f'{round(x, 6) + 0.0:.4g}' for x in point)}) m"
