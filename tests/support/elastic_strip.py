"""An even pressure on a strip: closed forms of the elastic half space in plane strain, and a slice of soil under it.

Strip of width B = 1 m, |x| < 1/2, pressure 1 Pa, z upwards. Johnson, Contact Mechanics (1985), section 2.5.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from mpi4py import MPI

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.soil.block import BlockSpec
from riser_soil.soil.grid import DistributedMesh, block_grid
from riser_soil.soil.linear_elastic import LinearElastic
from riser_soil.soil.soil import Soil
from tests.support.half_space import DOWN, NU, E, patch, respond
from tests.support.tet_slice import tet_slice


def settlement_from_the_middle(x: Array) -> Array:
    """How much less the surface settles at x (n,) than below the strip's middle [m]; of itself it is unbounded."""
    s = 2.0 * x
    both = sum((1.0 + side * s) * np.log(np.maximum(np.abs(1.0 + side * s), 1e-300)) for side in (1.0, -1.0))
    return np.asarray((1.0 - NU**2) / (np.pi * E) * both)


def stress_below(points: Array) -> Array:
    """Stress (n, 3) [Pa] σx, σz, τxz at points (n, 3), tension positive; σy = ν (σx + σz)."""
    x, depth = points[:, 0], -points[:, 2]
    left, right = np.arctan2(x + 0.5, depth), np.arctan2(x - 0.5, depth)
    angle, turned = left - right, 0.5 * (np.sin(2.0 * left) - np.sin(2.0 * right))
    shear = 0.5 * (np.cos(2.0 * right) - np.cos(2.0 * left))
    return np.stack([-(angle - turned), -(angle + turned), shear], axis=1) / np.pi


class StripOnSlice:
    """Half of the strip, x > 0, on a slice one cell thick that reaches `widths` strip widths aside and as deep.

    cells: under half of the strip; tetrahedra are half as large at its edge and grow from there, hexahedra beyond 1.5 m
    from the middle, to a share of 1/cells of the size of the block. Held at its bottom and normal to its sides.
    """

    def __init__(self, kind: Any, cells: int, widths: float) -> None:
        h, far = 0.5 / cells, widths / cells
        grid = hexahedra(h, widths, far) if kind == "hex" else tet_slice(0.5, widths, widths, h, 0.5 * h, 2.0 * h, far)
        self.soil = Soil(grid, LinearElastic(kind="linear-elastic", E=E, nu=NU).at_points, level=0.0, unit_weight=0.0)
        self.points = self.soil.field.points
        self.u = respond(self.soil, 0.5 * h * patch(self.soil)[:, None] * DOWN)
        rest = np.zeros(self.soil.field.size)
        self.soil.commit(State(1.0, self.u.ravel(), rest, rest))

    def settlement_error(self) -> float:
        """Error of the settlement from the middle at the surface up to 1.5 B away, largest, over that of the last of
        them.
        """
        top = (self.points[:, 2] > -1e-9) & (self.points[:, 0] < 1.5 + 1e-9)
        x, settled = self.points[top, 0], self.u[top, 2]
        settlement = settled - np.mean(settled[x < 1e-9])
        exact = settlement_from_the_middle(x)
        return float(np.abs(settlement - exact).max() / exact.max())

    def stress_error(self) -> float:
        """Error of the mean stress and the von Mises stress of cells below the strip's middle half, 1.5 B deep; over 1
        Pa.
        """
        mesh, fields = self.soil.output_mesh(), self.soil.output_fields()
        middle = mesh.points[mesh.cells].mean(axis=1)
        near = (middle[:, 0] < 0.25) & (middle[:, 2] > -1.5)
        sx, sz, t = stress_below(middle[near]).T
        sy = NU * (sx + sz)
        mises = np.sqrt(0.5 * ((sx - sy) ** 2 + (sy - sz) ** 2 + (sz - sx) ** 2) + 3.0 * t**2)
        off = fields.mean_stress[near] + (sx + sy + sz) / 3.0, fields.von_mises[near] - mises
        return float(np.abs(off).max())


def hexahedra(h: float, widths: float, far: float) -> DistributedMesh:
    """The slice in cells of the size h [m] to 1.5 m from the middle and half a metre deep."""
    fine = ((-0.5, 0.0), (1.5 - 0.5 * h, 0.0))
    block = BlockSpec((0.0, widths), (0.0, h), widths, h, far, riser=fine, strip=1.0)
    return block_grid(MPI.COMM_SELF, block)
