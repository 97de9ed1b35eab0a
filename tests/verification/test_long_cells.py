"""Hexahedra long along the riser, fine across it: their length and nu near 1/2 leave a strip's load alone."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.soil.block import BlockSpec
from riser_soil.soil.grid import block_grid
from riser_soil.soil.linear_elastic import LinearElastic
from riser_soil.soil.soil import Soil
from tests.support.soil_bench import Bench

H = 0.25  # m
HALF_WIDTH = 7.5 * H / 2.0


@cache
def pressed(nu: float, aspect: float, finer: int = 1, mean_dilatation: bool = True) -> float:
    """Force per length on a rigid strip pressed by 1 mm into an elastic block, in plane strain [N/m]."""
    h = H / finer
    length = 2.0 * aspect * h
    axis = ((0.0, 0.0), (0.0, length))
    spec = BlockSpec((-4.0, 4.0), (0.0, length), 3.0, h, 1.0, riser=axis, along=aspect * h, strip=3.0)
    grid = block_grid(MPI.COMM_SELF, spec)
    family = replace(grid.family, mean_dilatation=mean_dilatation)
    law = LinearElastic(kind="linear-elastic", E=1.2e6, nu=nu).at_points
    soil = Soil(replace(grid, family=family), law, level=0.0, unit_weight=0.0)
    x, _, z = soil.field.points.T
    driven = np.zeros((len(x), 3), dtype=bool)
    driven[(z > -1e-9) & (np.abs(x) < HALF_WIDTH + 1e-9), 2] = True
    bench = Bench(soil, driven.ravel())
    bench.step(np.where(driven, -1e-3, 0.0).ravel())
    force = bench.force(np.zeros(soil.field.size)).reshape(-1, 3)
    return -float(force[driven[:, 2], 2].sum()) / length


@pytest.mark.parametrize("nu", [0.49, 0.4999])
def test_the_length_of_the_cells_does_not_count_where_nothing_varies_along(nu: float) -> None:
    assert pressed(nu, 50.0) == pytest.approx(pressed(nu, 1.0), rel=1e-9)


@pytest.mark.parametrize("nu", [0.49, 0.4999])
def test_no_locking_near_constant_volume(nu: float) -> None:
    """Seven cells under the strip are 2.5 % stiffer than 21, at either nu."""
    assert pressed(nu, 50.0) / pressed(nu, 50.0, finer=3) - 1.0 == pytest.approx(0.025, abs=0.005)


def test_full_integration_would_lock() -> None:
    assert pressed(0.4999, 50.0, mean_dilatation=False) > 5.0 * pressed(0.4999, 50.0)
