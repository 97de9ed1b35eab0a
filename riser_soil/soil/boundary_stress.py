"""Stress that the riser causes at the sides and the bottom of the soil."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from mpi4py import MPI

from riser_soil.soil.soil import Soil


class BoundaryStress(NamedTuple):
    """Largest change of the equivalent stress since the start, as means of cells [Pa]: in cells at the bottom, and in
    cells at the two sides along the riser.
    """

    bottom: float
    sides: float


def boundary_stress(soil: Soil, across: int) -> BoundaryStress:
    """Of the committed state; across: the axis, x (0) or y (1), more nearly square to the riser (collective)."""
    grid, change = soil.grid, soil.stress_change()
    corners = grid.nodes.points[grid.nodes.cells]
    near = 1e-6 * float(np.max(grid.high - grid.low))
    bottom = (corners[..., 2] < grid.low[2] + near).any(axis=1)
    y = corners[..., across]
    sides = ((y < grid.low[across] + near) | (y > grid.high[across] - near)).any(axis=1)
    found = [float(change[cells].max(initial=0.0)) for cells in (bottom, sides)]
    return BoundaryStress(*(grid.nodes.comm.allreduce(value, MPI.MAX) for value in found))
