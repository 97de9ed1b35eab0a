"""New meshes of sections: a new surface keeps the area below it."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.soil.sections import at_columns, refilled, sections_of, spread


def test_a_new_surface_keeps_the_area_below_it() -> None:
    """A groove with heave beside it, corners of which are cut off: raised beside what touches, and nowhere else."""
    y = np.linspace(-3.0, 3.0, 41)
    z = np.where(np.abs(y) < 1.0, -np.sqrt(np.maximum(1.0 - y**2, 0.0)), 0.5 * np.exp(-3.0 * (np.abs(y) - 1.0)))
    line, free = np.stack([0.0 * y, y, z], axis=1), np.abs(y) > 1.05
    top, _ = spread(line, y**3 / 9.0, 0.0 * y)
    surface = refilled(line, top, free, across=1)

    def area(of: Array) -> float:
        return float(np.sum(0.5 * (of[1:, 2] + of[:-1, 2]) * np.diff(of[:, 1])))

    lost = abs(area(top) - area(line))
    assert lost > 1e-3
    assert abs(area(surface) - area(line)) < 0.005 * lost
    np.testing.assert_array_equal(surface[~free], top[~free])
    np.testing.assert_array_equal(surface[[0, -1]], top[[0, -1]])


def test_a_lip_that_leans_over_is_cut_where_cells_along_it_would_fold() -> None:
    """Soft clay squeezed out of a thin layer: spread along the surface its cells fold, at their columns they do not."""
    y, z = np.linspace(0.0, 0.3, 21), np.linspace(-0.06, 0.0, 5)
    grid = np.stack(np.meshgrid([0.0, 1.0], y, z, indexing="ij"), axis=-1).reshape(-1, 3)
    sections = sections_of(grid, along=0)
    assert sections is not None
    at = grid[sections.nodes[0]]
    at[6:10, -1, 1:] = [[0.100, 0.016], [0.119, 0.027], [0.112, 0.006], [0.126, 0.002]]
    at[4:6, -1, 1:] = [[0.070, -0.004], [0.088, 0.010]]
    along, _ = spread(at[:, -1], sections.columns, 0.0 * y)
    back, beside = at_columns(at[:, -1], sections.columns, y, across=1)
    assert sections.skewness(sections.beneath(at, along)) < 0.1
    assert sections.skewness(sections.beneath(at, back)) > 0.1
    np.testing.assert_array_equal(back[:, 1], y)
    assert back[:, 2].max() > 0.015
    np.testing.assert_allclose(beside[10:], y[10:], atol=1e-12)
    assert sections.skewness(grid[sections.nodes[0]]) == pytest.approx(1.0)
