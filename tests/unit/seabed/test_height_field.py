"""Heights of the seabed over a grid: closed forms, derivatives, what files are refused, and a plane's section."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.assembly import build
from riser_soil.checks.ground_plausibility import ground_warnings
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.scene.bathymetry import ground_height
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.plane import resolved_dimension
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.seabed.grounds import Plane
from riser_soil.seabed.height_field import HeightField, Profile
from tests.support.said import line_with, lines_with
from tests.support.scenes import prescribed, riser_scene, static

X = np.random.default_rng(7).uniform(-3.0, 12.0, size=(60, 3))
XS, YS = np.array([-2.0, 0.5, 2.0, 5.0, 9.0]), np.array([-1.0, 2.0, 4.5, 10.0])
BUMPS = np.random.default_rng(8).uniform(-0.8, 0.8, size=(5, 4))
PIPE = {"EA": 1.0e8, "EI": 1.0e5, "GJ": 1.0e5, "mass": 50.0, "outer_diameter": 0.3}


@pytest.mark.parametrize("along", [None, np.array([0.6, 0.8])])
def test_derivatives_of_the_distance(along: Array | None) -> None:
    """Within the grid and beyond it; of a section for points and steps in its plane."""
    ground, axes, points = HeightField(XS, YS, BUMPS, along), np.eye(3), X
    if along is not None:
        axes = np.array([[*along, 0.0], [0.0, 0.0, 1.0]])
        points = X[:, :2] @ axes
    distance, h = ground.distance(points), 1e-5
    assert distance.hessian is not None
    steps = [(ground.distance(points + h * e), ground.distance(points - h * e)) for e in axes]
    gradient = np.stack([(a.value - b.value) / (2.0 * h) for a, b in steps], axis=1)
    hessian = np.stack([(a.gradient - b.gradient) @ axes.T / (2.0 * h) for a, b in steps], axis=2)
    assert distance.gradient @ axes.T == pytest.approx(gradient, abs=1e-8)
    assert axes @ distance.hessian @ axes.T == pytest.approx(hessian, abs=1e-7)
    assert np.abs(hessian[:, 0, 0]).max() > 0.1


def test_surface_passes_through_its_points() -> None:
    x, y = np.meshgrid(XS, YS, indexing="ij")
    at = np.stack([x, y, BUMPS], axis=-1).reshape(-1, 3)
    assert HeightField(XS, YS, BUMPS).distance(at).value == pytest.approx(np.zeros(20), abs=1e-12)


def test_heights_of_a_plane_are_the_plane() -> None:
    """Sloping in x and y, within the grid and beyond."""
    slope, towards = np.radians(12.0), np.radians(50.0)
    plane = Plane.sloping(np.array([1.0, 2.0, -3.0]), slope, towards)
    x, y = np.meshgrid(XS, YS, indexing="ij")
    z = -3.0 + np.tan(slope) * ((x - 1.0) * np.cos(towards) + (y - 2.0) * np.sin(towards))
    field, known = HeightField(XS, YS, z).distance(X), plane.distance(X)
    assert field.value == pytest.approx(known.value, abs=1e-11)
    assert field.gradient == pytest.approx(np.asarray(known.gradient), abs=1e-11)
    assert field.hessian == pytest.approx(np.zeros((60, 3, 3)), abs=1e-10)


def test_heights_constant_across_are_the_profile() -> None:
    z = BUMPS[:, 0]
    profile = Profile(np.array([0.0, 0.0]), np.array([1.0, 0.0]), XS, z).distance(X)
    field = HeightField(XS, YS, np.tile(z[:, None], (1, 4))).distance(X)
    for one, other in zip(field, profile, strict=True):
        assert one == pytest.approx(np.asarray(other), abs=1e-10)


@pytest.mark.parametrize(("cells", "bound"), [(10, 4e-3), (40, 2e-5)])
def test_a_cylinder_is_met_with_fourth_order(cells: int, bound: float) -> None:
    """A round valley of radius 10 m askew to the grid: points on it and near it, R minus their distance from its axis.

    The height times the slope's cosine is the distance but for its square over 2 R.
    """
    R, axis = 10.0, np.array([0.8, 0.6])
    at = np.linspace(-7.0, 7.0, cells + 1)
    x, y = np.meshgrid(at, at, indexing="ij")
    across = np.random.default_rng(3).uniform(-2.5, 2.5, 30)
    s = np.random.default_rng(4).uniform(-2.5, 2.5, 30)
    angle, over = np.arcsin(across / R), 1e-3
    xy = s[:, None] * axis + ((R - over) * np.sin(angle))[:, None] * np.array([-0.6, 0.8])
    points = np.column_stack([xy, R - (R - over) * np.cos(angle)])
    z = R - np.sqrt(R**2 - (0.8 * y - 0.6 * x) ** 2)
    distance = HeightField(at, at, z).distance(points)
    assert distance.value == pytest.approx(np.full(30, over), abs=bound + over**2 / R)
    normal = np.column_stack([-np.sin(angle)[:, None] * np.array([-0.6, 0.8]), np.cos(angle)])
    assert distance.gradient == pytest.approx(normal, abs=20.0 * bound)


def grid_file(folder: Path, text: str) -> None:
    (folder / "seabed.csv").write_text(text, encoding="utf-8")


HEADER = "x [m], y [m], z [m]\n"
SUNK = {"start": prescribed(0.0, 0.0, -0.1), "end": prescribed(24.0, 0.0, 17.9)}
ROWS = "0, -5, -1\n0, 5, 1\n30, -5, 2\n30, 5, 4\n"


def scene(folder: Path, text: str, **more: Any) -> Scene:
    grid_file(folder, text)
    given = more.pop("seabed", {})
    seabed = ({} if "kind" in given else {"kind": "spring", "stiffness": 1e5}) | {"grid": "seabed.csv"} | given
    ends = {"start": prescribed(0.0, 0.0, 2.0), "end": prescribed(24.0, 0.0, 20.0)} | more.pop("ends", {})
    mapping = riser_scene(static(), pipe=PIPE, length=30.0, elements=3, **ends, seabed=seabed, **more)
    return scene_from_mapping(mapping | {"contact": {}}, folder)


def test_a_scene_reads_its_grid(tmp_path: Path) -> None:
    ground = scene(tmp_path, "Y [m]; z [cm]; x [m]\n5; 400; 30\n5; 100; 0\n-5; 200; 30\n-5; -100; 0\n")
    assert ground_height(ground, (15.0, 2.5, 0.0)) == pytest.approx(2.0)
    assert ground.seabed_level == pytest.approx(0.0)
    assert resolved_dimension(ground) == 3
    assert resolved_dimension(scene(tmp_path, HEADER + ROWS, dimension=2)) == 2
    folder = tmp_path / "results"
    folder.mkdir()
    (folder / "scene.yaml").write_text(dump_scene(ground), encoding="utf-8")
    assert read_scene(folder / "scene.yaml") == ground


@pytest.mark.parametrize(("reach", "count"), [("31", 0), ("25", 1)])
def test_a_free_end_beyond_the_grid_is_reported(reach: str, count: int, tmp_path: Path) -> None:
    """30 m along x in three elements."""
    ends = {"start": prescribed(0.0, 0.0, 5.0, rotation="fixed"), "end": "free"}
    made = scene(tmp_path, HEADER + ROWS.replace("30", reach), ends=ends)
    warnings = [warning for warning in ground_warnings(build(made, MPI.COMM_SELF).riser) if "seabed.grid" in warning]
    assert len(warnings) == count
    assert lines_with(warnings, "1 nodes", "first shape", "arc 30 to 30 m") == warnings


def test_an_end_below_the_ground(tmp_path: Path) -> None:
    """Springs bear at any depth: the end may lie there, and a warning says how deep. Other seabeds refuse it."""
    sunk = scene(tmp_path, HEADER + ROWS, ends=SUNK)
    line_with(ground_warnings(build(sunk, MPI.COMM_SELF).riser), "riser.start.position:", "0.1 m below", "10 kN/m")
    clay = {"kind": "hysteretic", "law": {"kind": "randolph-quiggin", "su": 2e3}}
    with pytest.raises(SceneError, match=r"riser.start.position: .* must not lie below the seabed"):
        scene(tmp_path, HEADER + ROWS, ends=SUNK, seabed=clay)


@pytest.mark.parametrize(
    ("text", "more", "says"),
    [
        (HEADER, {}, "seabed.csv: the points have 0 different x; a grid needs two at least"),
        (HEADER + "0, 0, 0\n1, 0, 0\n", {}, "the points have 1 different y"),
        (HEADER + ROWS[:-9], {}, "its 3 points have 2 different x and 2 different y, but there is none at x = 30"),
        (HEADER + ROWS + "0, 5, 1\n", {}, "seabed.csv:6: there is a row for x = 0, y = 5 m already; remove one"),
        (HEADER + ROWS.replace("30, 5, 4", "29, 5, 4"), {}, "there is none at x = 29, y = -5 m; a grid has a row for"),
        (HEADER + ROWS.replace("4\n", "nan\n"), {}, 'seabed.csv:5: z: "nan" is not a finite number'),
        ("x [m], z [m]\n0, 0\n", {}, "there is no column y"),
        (HEADER + ROWS.replace("30", "20"), {}, "riser.end.position, x = 24, y = 0 m, lies beyond the grid: x from 0"),
        (HEADER + ROWS, {"seabed": {"level": 1.0}}, "is given beside level, slope_deg or profile; give one of them"),
    ],
)
def test_refused_grids(text: str, more: dict[str, Any], says: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError) as caught:
        scene(tmp_path, text, **more)
    message = str(caught.value)
    assert len(message.splitlines()) == 1
    assert says in message
    assert "; " in message
