"""Sections against a block of elastic soil under a strip load that varies along it: what stress along it does."""

from __future__ import annotations

import math

import numpy as np
import pytest
from mpi4py import MPI
from scipy.sparse.linalg import splu

from riser_soil.checks.mesh_plausibility import excess_of_sections
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.soil.block import BlockSpec
from riser_soil.soil.grid import DistributedMesh, block_grid
from riser_soil.soil.slices import slice_grid
from riser_soil.soil.soil import Soil
from tests.support.soil_bench import assemble
from tests.support.soil_cases import ELASTIC

DEPTH, WIDTH, CELLS = 1.5, 0.1, 12  # m; width of the strip; cells along half a wave


def settlement(grid: DistributedMesh, length: float) -> float:
    """Settlement of a strip of the width, under a load cos(x/length) [N/m], the amplitude [m]: by the work of the load.
    """
    soil = Soil(grid, ELASTIC, level=0.0, unit_weight=0.0)
    x, y, z = soil.field.points.T
    load = np.zeros((len(x), 3))
    top = np.flatnonzero(z > -1e-9)
    ends = (x[top] < 1e-9) | (x[top] > math.pi * length - 1e-9)
    along = np.cos(x[top] / length) * math.pi * length / CELLS * np.where(ends, 0.5, 1.0)
    load[top, 2] = -along * share_of_strip(np.round(y[top], 9))
    K = assemble(soil, State.at_rest(0.0, soil.field.size))
    free = np.flatnonzero(~soil.field.prescribed)
    moved = splu(K[free][:, free].tocsc()).solve(load.ravel()[free])
    return float(load.ravel()[free] @ moved) / (0.5 * math.pi * length)


def share_of_strip(y: Array) -> Array:
    """Part (n,) of the strip's width that nodes at y bear: half of the way to their neighbours."""
    lines, where = np.unique(y, return_inverse=True)
    middles = np.clip(0.5 * (lines[1:] + lines[:-1]), -0.5 * WIDTH, 0.5 * WIDTH)
    return np.asarray(np.diff(middles, prepend=-0.5 * WIDTH, append=0.5 * WIDTH)[where] / WIDTH)


@pytest.mark.parametrize("lengths", [1.0, *(pytest.param(x, marks=pytest.mark.verify) for x in (2.0, 4.0)), 6.0])
def test_sections_settle_more_than_a_block_by_what_is_foretold(lengths: float) -> None:
    """To a depth of so many lengths 1/k. Found: 0.96, 0.97, 1.09 and 1.24 times the block's."""
    length = DEPTH / lengths
    half = math.pi * length
    plan, line, along = ((0.0, half), (-3.0 * DEPTH, 3.0 * DEPTH)), ((0.0, 0.0), (half, 0.0)), half / CELLS
    spec = BlockSpec(*plan, DEPTH, 0.5 * WIDTH, 0.8, riser=line, along=along, strip=2.0 * WIDTH)
    ratio = settlement(slice_grid(MPI.COMM_SELF, spec), length) / settlement(block_grid(MPI.COMM_SELF, spec), length)
    assert ratio == pytest.approx(1.0 + excess_of_sections(length, WIDTH, DEPTH), abs=0.05)
