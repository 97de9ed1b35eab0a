"""Patches of load on a block of elastic soil, and on the half space that it stands for."""

from __future__ import annotations

from typing import Any

import numpy as np
from mpi4py import MPI
from scipy.sparse.linalg import splu

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.part import State
from riser_soil.soil.block import BlockSpec
from riser_soil.soil.grid import block_grid
from riser_soil.soil.linear_elastic import LinearElastic
from riser_soil.soil.soil import Soil
from tests.support.soil_bench import assemble

E, NU = 1.0e6, 0.3
G = 0.5 * E / (1.0 + NU)
DOWN, ALONG = np.array([0.0, 0.0, -1.0]), np.array([1.0, 0.0, 0.0])


def boussinesq(to: Array) -> Array:
    """Displacement (n, 3) [m/N] at points `to` (n, 3) from a unit force downwards at the surface.

    Johnson, Contact Mechanics (1985), section 3.2; z downwards there.
    """
    x, y, z, R = *(to * [1.0, 1.0, -1.0]).T, np.linalg.norm(to, axis=1)
    outwards = z / R**2 - (1.0 - 2.0 * NU) / (R + z)
    down = z**2 / R**2 + 2.0 * (1.0 - NU)
    return np.stack([x * outwards, y * outwards, -down], axis=1) / (4.0 * np.pi * G * R)[:, None]


def cerruti(to: Array) -> Array:
    """Displacements from a unit force along x on the surface; Johnson, section 3.6."""
    x, y, z, R = *(to * [1.0, 1.0, -1.0]).T, np.linalg.norm(to, axis=1)
    a = 1.0 - 2.0 * NU
    along = 1.0 + x**2 / R**2 + a * (R / (R + z) - x**2 / (R + z) ** 2)
    across = x * y * (1.0 / R**2 - a / (R + z) ** 2)
    down = x * z / R**2 + a * x / (R + z)
    return np.stack([along, across, -down], axis=1) / (4.0 * np.pi * G * R)[:, None]


class LoadedBlock:
    """A block `half` m to each side and as deep, with a load of 1 N on a patch of about 1 m x 1 m in its middle.

    h [m]: cells at the patch; far: at the block's faces. u (n, 3) [m]: displacements of its points (n, 3).
    """

    def __init__(self, kind: Any, h: float, half: float, far: float, direction: Array) -> None:
        wide, line = (-half, half), ((-0.5, 0.0), (0.5, 0.0))
        grid = block_grid(MPI.COMM_SELF, BlockSpec(wide, wide, half, h, far, kind=kind, riser=line, strip=1.0))
        soil = Soil(grid, LinearElastic(kind="linear-elastic", E=E, nu=NU).at_points, level=0.0, unit_weight=0.0)
        self.points, self.load = soil.field.points, patch(soil)[:, None] * direction
        self.u = respond(soil, self.load)

    def share(self, unit: Any) -> float:
        """Share of the half space's displacement at all points 1.5 to 2 m from the patch's middle, what the block
        shows.
        """
        distance = np.linalg.norm(self.points, axis=1)
        near = (distance > 1.5) & (distance < 2.0)
        exact, forces = np.zeros((np.count_nonzero(near), 3)), np.linalg.norm(self.load, axis=1)
        for node in np.flatnonzero(forces):
            exact += forces[node] * unit(self.points[near] - self.points[node])
        return float(np.sum(self.u[near] * exact) / np.sum(exact**2))


def patch(soil: Soil) -> Array:
    """Forces (n,) of an even pressure on the facets within half a metre, 1 N in all; consistent with the elements."""
    top, (points, facets) = soil.surface, (soil.surface.points, soil.surface.facets)
    corners = points[facets[:, : 4 if facets.shape[1] == 4 else 3]]
    on = np.all(np.abs(corners.mean(axis=1)[:, :2]) < 0.5, axis=1)
    loaded = facets[on] if facets.shape[1] == 4 else facets[on, 3:]  # of second order the midpoints take it all
    sides = corners[on, 1] - corners[on, 0], corners[on, -1] - corners[on, 0]
    area = np.linalg.norm(np.cross(*sides), axis=1)
    forces = np.zeros(len(soil.field.points))
    nodes = top.global_index.reshape(-1, 3)[:, 0] // 3
    np.add.at(forces, nodes[loaded], (area / area.sum() / loaded.shape[1])[:, None])
    return forces


def respond(soil: Soil, load: Array) -> Array:
    """Displacements (n, 3) of elastic soil under nodal forces (n, 3)."""
    rest = np.zeros(soil.field.size)
    K = assemble(soil, State(0.0, rest, rest, rest))
    free: BoolArray = ~soil.field.prescribed
    u = np.zeros(soil.field.size)
    factors = splu(K[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    u[free] = factors.solve(load.ravel()[free])
    return u.reshape(-1, 3)
