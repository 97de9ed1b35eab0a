"""Risers on a seabed by a grid of heights: a plane, a slope across, a valley along the riser."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.snapshot import Record
from riser_soil.scene.reader import scene_from_mapping
from tests.support.scenes import prescribed, riser_scene, static
from tests.support.stage_histories import distance, stage_histories

W, STIFFNESS, SLOPE = 700.0, 1e5, 3.0  # N/m, N/m2, deg
PIPE = {"EA": 3e8, "EI": 2e4, "GJ": 1e4, "outer_diameter": 0.3, "submerged_weight": W}


def lying(folder: Path, seabed: dict[str, Any], dimension: int = 3) -> Record:
    """A riser from the ground at its start, where its axis rests, to 60 m above and 110 m away."""
    scene = riser_scene(
        static(),
        pipe=PIPE,
        length=150.0,
        elements=75,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(110.0, 0.0, 60.0),
        gravity=9.81,
        seabed={"kind": "spring", "stiffness": STIFFNESS, "contact_at": "axis"} | seabed,
        contact={"method": "line"},
        solver={"tolerance": 1e-10},
        dimension=dimension,
    )
    return stage_histories(scene_from_mapping(scene, folder))[-1].end


def grid(folder: Path, x: Array, y: Array, z: Array) -> dict[str, Any]:
    rows = [f"{a:.17g}, {b:.17g}, {z[i, j]:.17g}\n" for i, a in enumerate(x) for j, b in enumerate(y)]
    (folder / "seabed.csv").write_text("x [m], y [m], z [m]\n" + "".join(rows), encoding="utf-8")
    return {"grid": "seabed.csv"}


X, Y = np.array([-20.0, 10.0, 60.0, 130.0]), np.array([-30.0, -5.0, 12.0, 30.0])


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_grid_on_a_slope_is_the_slope(dimension: int, tmp_path: Path) -> None:
    z = np.tan(np.radians(2.0)) * X[:, None] + 0.0 * Y
    state = lying(tmp_path, grid(tmp_path, X, Y, z), dimension)
    slope = lying(tmp_path, {"slope_deg": 2.0}, dimension)
    assert np.count_nonzero(slope.contact_force) > 10
    assert distance(slope.position, state.position) < 1e-7
    assert state.contact_force == pytest.approx(slope.contact_force, abs=1e-3)


def test_a_section_takes_a_slope_across_as_level(tmp_path: Path) -> None:
    z = 0.0 * X[:, None] + np.tan(np.radians(SLOPE)) * Y
    state, level = lying(tmp_path, grid(tmp_path, X, Y, z), 2), lying(tmp_path, {"level": 0.0}, 2)
    assert distance(level.position, state.position) < 1e-7


def test_in_a_valley_along_the_riser_space_is_the_plane(tmp_path: Path) -> None:
    y, s = np.array([-30.0, -10.0, 0.0, 10.0, 30.0]), X[:, None]
    given = grid(tmp_path, X, y, 0.03 * s - 1e-4 * s**2 + 2e-3 * y**2 + 0.0 * s)
    plane, space = lying(tmp_path, given, 2), lying(tmp_path, given, 3)
    assert np.count_nonzero(plane.contact_force) > 5
    assert distance(plane.position, space.position) < 1e-6
    assert space.contact_force == pytest.approx(plane.contact_force, abs=1e-2)


def test_a_beam_on_a_smooth_slope_across_bends_down_it(tmp_path: Path) -> None:
    """Clamped at both ends and as long as they are apart, on ground that slopes across it by the angle a.

    Smooth ground bears along its normal alone, far from the ends N = w cos a, w cos a/k deep; w sin a is left to bend
    the beam down the slope, by w sin a L^4/(384 EI). Sideways the ends bear what the ground does, N sin a.
    """
    a, L, elements = np.radians(SLOPE), 40.0, 20
    pipe = PIPE | {"EI": 1e6, "EA": 3e5, "GJ": 1e6}  # too easy to stretch to be held by its tension
    y = np.array([-9.0, 0.0, 9.0])
    given = grid(tmp_path, np.array([-5.0, 20.0, 45.0]), y, np.tan(a) * np.tile(y, (3, 1)))
    scene = riser_scene(
        static(),
        pipe=pipe,
        length=L,
        elements=elements,
        start=prescribed(0.0, 0.0, 0.0, rotation="fixed"),
        end=prescribed(L, 0.0, 0.0, rotation="fixed"),
        gravity=9.81,
        seabed={"kind": "spring", "stiffness": STIFFNESS, "contact_at": "axis"} | given,
        contact={"method": "line"},
        solver={"tolerance": 1e-10},
    )
    state = stage_histories(scene_from_mapping(scene, tmp_path))[-1].end
    middle = elements // 2
    normal, down = np.array([0.0, -np.sin(a), np.cos(a)]), np.array([0.0, -np.cos(a), -np.sin(a)])
    assert state.contact_force[middle] == pytest.approx(W * np.cos(a), rel=2e-3)
    assert state.position[middle] @ normal == pytest.approx(-W * np.cos(a) / STIFFNESS, rel=2e-3)
    assert state.position[middle] @ down == pytest.approx(W * np.sin(a) * L**4 / (384.0 * pipe["EI"]), rel=5e-3)
    total = state.start_force + state.end_force
    assert total[1] == pytest.approx((W * L - total[2]) * np.tan(a), rel=1e-6)
