"""Small soils for tests, serial: a block of either family, distorted inside if asked."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import basix
import numpy as np
from mpi4py import MPI

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.part import State
from riser_soil.soil.block import BlockSpec
from riser_soil.soil.grid import DistributedMesh, block_grid
from riser_soil.soil.linear_elastic import LinearElastic
from riser_soil.soil.soil import Soil
from riser_soil.soil.von_mises import VonMises

CLAY = VonMises(kind="von-mises", su=4.0e3, su_gradient=1.5e3, E_over_su=300.0, nu=0.49).at_points
ELASTIC = LinearElastic(kind="linear-elastic", E=1.2e6, nu=0.49).at_points
KINDS = ("hex", "tet")


def small_block(kind: Any, size: float = 0.5) -> DistributedMesh:
    """2 × 1.5 × 1 m, top at z = 0."""
    return block_grid(MPI.COMM_SELF, BlockSpec((0.0, 2.0), (0.0, 1.5), 1.0, size, size, kind=kind))


def slices_spec(along: int, length: float = 2.0, **more: Any) -> BlockSpec:
    """A block for four slices, a riser along x (0) or y (1) in its middle."""
    line, ranges = np.zeros((2, 2)), [(0.0, length), (-1.0, 1.0)]
    line[1, along] = length
    x, y = ranges if along == 0 else ranges[::-1]
    first, second = ((float(p[0]), float(p[1])) for p in line)
    return BlockSpec(x, y, 1.0, 0.25, 0.5, riser=(first, second), along=length / 4.0, **more)


def distorted(grid: DistributedMesh, amount: float = 0.08) -> DistributedMesh:
    """The grid with its inner vertices moved at random by up to `amount` [m]; edges stay straight."""
    points = grid.nodes.points.copy()
    move = inner(grid)
    points[move] += amount * np.random.default_rng(5).uniform(-1.0, 1.0, (np.count_nonzero(move), 3))
    return replace(grid, nodes=replace(grid.nodes, points=straightened(grid, points)))


def straightened(grid: DistributedMesh, points: Array) -> Array:
    """Points with every node placed by its cell's vertices."""
    family, cells = grid.family, grid.nodes.cells
    variant = basix.LagrangeVariant.gll_warped
    full, straight = (basix.create_element(basix.ElementFamily.P, family.cell, n, variant) for n in (family.degree, 1))
    shares = straight.tabulate(0, full.points)[0, :, :, 0]
    out = points.copy()
    out[cells] = np.einsum("nv,cvi->cni", shares, points[cells[:, : family.vertices]])
    return out


def inner(grid: DistributedMesh) -> BoolArray:
    """Nodes that lie on no face of the block."""
    p = grid.nodes.points
    result: BoolArray = np.all((p > grid.low + 1e-6) & (p < grid.high - 1e-6), axis=1)
    return result


def clay_block(kind: Any, **options: Any) -> Soil:
    given = {"level": 0.0, "unit_weight": 5.0e3, **options}
    return Soil(distorted(small_block(kind)), CLAY, **given)


def moved(soil: Soil, size: float, seed: int = 0) -> State:
    """A trial state with random increments of this size [m], none at the supports."""
    u = size * np.random.default_rng(seed).standard_normal(soil.field.size)
    u[soil.field.prescribed] = 0.0
    return State(1.0, u, np.zeros_like(u), np.zeros_like(u))


def sheared(soil: Soil, gamma: float) -> State:
    """An increment of simple shear."""
    u = np.zeros_like(soil.field.points)
    u[:, 0] = gamma * soil.field.points[:, 2]
    return State(1.0, u.ravel(), np.zeros(u.size), np.zeros(u.size))
