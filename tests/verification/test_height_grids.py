"""Risers on a seabed by a grid of heights: a plane, a slope across, a valley along the riser."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.snapshot import RiserSnapshot
from riser_soil.scene.reader import scene_from_mapping
from tests.support.riser_scenes import distance, prescribed, riser_scene, stage_histories, static

W, STIFFNESS, SLOPE = 700.0, 1e5, 3.0  # N/m, N/m2, deg
PIPE = {"EA": 3e8, "EI": 2e4, "GJ": 1e4, "outer_diameter": 0.3, "submerged_weight": W}


def lying(folder: Path, seabed: dict[str, Any], dimension: int = 3) -> RiserSnapshot:
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
    rows = [f"{a!r}, {b!r}, {z[i, j]!r}\n" for i, a in enumerate(x.tolist()) for j, b in enumerate(y.tolist())]
    (folder / "seabed.csv").write_text("x [m], y [m], z [m]\n" + "".join(rows).replace("np.float64(", "").replace(
        ")", ""), encoding="utf-8")
    return {"grid": "seabed.csv"}


X, Y = np.array([-20.0, 10.0, 60.0, 130.0]), np.array([-30.0, -5.0, 12.0, 30.0])


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_grid_on_a_slope_is_the_slope(dimension: int, tmp_path: Path) -> None:
    z = np.tan(np.radians(2.0)) * X[:, None] + 0.0 * Y
    found = lying(tmp_path, grid(tmp_path, X, Y, z), dimension)
    slope = lying(tmp_path, {"slope_deg": 2.0}, dimension)
    assert np.count_nonzero(slope.contact_force) > 10
    assert distance(slope.position, found.position) < 1e-7
    assert found.contact_force == pytest.approx(slope.contact_force, abs=1e-3)


def test_a_section_takes_a_slope_across_as_level(tmp_path: Path) -> None:
    z = 0.0 * X[:, None] + np.tan(np.radians(SLOPE)) * Y
    found, level = lying(tmp_path, grid(tmp_path, X, Y, z), 2), lying(tmp_path, {"level": 0.0}, 2)
    assert distance(level.position, found.position) < 1e-7


def test_in_a_valley_along_the_riser_space_is_the_plane(tmp_path: Path) -> None:
    z = 0.01 * X[:, None] - 1e-4 * (X[:, None] - 20.0) ** 2 + 0.04 + 2e-3 * np.array([-30.0, -10.0, 10.0, 30.0]) ** 2
    z -= z[0].min()
    y = np.array([-30.0, -10.0, 10.0, 30.0])
    given = grid(tmp_path, X, y, z)
    plane, space = lying(tmp_path, given, 2), lying(tmp_path, given, 3)
    assert np.count_nonzero(plane.contact_force) > 5
    assert distance(plane.position, space.position) < 1e-6
    assert space.contact_force == pytest.approx(plane.contact_force, abs=1e-2)


def test_a_beam_on_a_slope_across_is_held_sideways_by_what_its_ends_bear(tmp_path: Path) -> None:
    """A clamped beam that lies on smooth ground sloping across: the ground bears along its normal alone.

    With slope a the beam of weight w slides down by the load w sin a, which its ends bear, and rests w cos a / k deep:
    far from the ends N = w cos a, whose horizontal part N sin a is the reaction's, per length.
    """
    a = np.radians(SLOPE)
    length, depth = 40.0, W * np.cos(a) / STIFFNESS
    y = np.array([-9.0, 0.0, 9.0])
    given = grid(tmp_path, np.array([-5.0, 20.0, 45.0]), y, np.tan(a) * np.tile(y, (3, 1)) + 0.0)
    stiff = PIPE | {"EI": 2e7, "GJ": 1e7}
    ends = [prescribed(x, 0.0, 0.0, rotation="fixed") for x in (0.0, length)]
    scene = riser_scene(
        static(),
        pipe=stiff,
        length=length,
        elements=20,
        start=ends[0],
        end=ends[1],
        gravity=9.81,
        seabed={"kind": "spring", "stiffness": STIFFNESS, "contact_at": "axis"} | given,
        contact={"method": "line"},
        initial="straight",
        solver={"tolerance": 1e-10},
    )
    found = stage_histories(scene_from_mapping(scene, tmp_path))[-1].end
    middle = len(found.contact_force) // 2
    assert found.contact_force[middle] == pytest.approx(W * np.cos(a), rel=5e-3)
    normal = np.array([0.0, -np.sin(a), np.cos(a)])
    assert found.position[middle] @ normal == pytest.approx(-depth, rel=5e-3)
    share = np.full(len(found.contact_force), length / 20.0)
    share[[0, -1]] *= 0.5
    borne = float(share @ found.contact_force)
    total = found.start_force + found.end_force
    assert total[1] == pytest.approx(borne * np.sin(a), rel=2e-2)
    assert total[2] == pytest.approx(W * length - borne * np.cos(a), rel=2e-2)
