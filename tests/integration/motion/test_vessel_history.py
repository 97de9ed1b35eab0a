"""Ends on vessels that a file moves: closed forms of rigid bodies, RAOs, tables of the end, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI
from scipy.spatial.transform import Rotation

from riser_soil.assembly import build
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.riser.line_ends import End
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.plane import resolved_dimension
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.scene import Scene
from tests.support.scenes import AIRY, VESSEL_END, Mapping, dynamic, prescribed, riser_scene
from tests.support.scenes import below_vessel as at_sea
from tests.support.seas import EVERYWHERE, REFERENCE, surface, table

PIPE = {"EA": 1.0e8, "EI": 1.0e5, "GJ": 1.0e5, "mass": 50.0}
HEADER = "t [s], surge [m], sway [m], heave [m], roll [deg], pitch [deg], yaw [deg]\n"
ARM = np.array(VESSEL_END) - REFERENCE
T = np.linspace(0.0, 12.0, 241)
SIZES = np.array([3.0, -2.0, 1.5, 14.0, -9.0, 25.0])


def six(t: Array) -> Array:
    """Surge, sway, heave [m], roll, pitch, yaw [deg] (n, 6), at rest at t = 0."""
    w = np.array([0.5, 0.7, 1.1, 0.9, 1.3, 0.4])
    return SIZES * np.sin(np.multiply.outer(t, w)) ** 2


def text(rows: Array, t: Array = T, header: str = HEADER) -> str:
    lines = [", ".join(f"{value:.17g}" for value in (at, *row)) for at, row in zip(t, rows, strict=True)]
    return header + "\n".join(lines) + "\n"


def mapping(motion: Mapping) -> Mapping:
    return riser_scene(
        dynamic(12.0, 0.1, motion={"end": motion}),
        pipe=PIPE,
        length=float(np.linalg.norm(VESSEL_END)),
        elements=3,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(*VESSEL_END, rotation="fixed"),
    )


def scene(folder: Path, rows: str, **more: Any) -> Scene:
    (folder / "vessel.csv").write_text(rows, encoding="utf-8")
    history = {"file": "vessel.csv", "reference": REFERENCE} | more
    return scene_from_mapping(mapping({"vessel_history": history}), folder)


def end_of(scene: Scene) -> End:
    assembly = build(scene, MPI.COMM_SELF)
    assembly.begin(scene.stages[0])
    return assembly.riser.line.end


def by_hand(t: float, heading: float) -> tuple[Array, Array]:
    """Place of the end (3,) and the vessel's rotation from rest (3, 3), by its angles about its own axes in turn."""
    course = Rotation.from_euler("z", heading, degrees=True).as_matrix()
    x = six(np.array([t]))[0]
    R = course @ Rotation.from_euler("ZYX", x[[5, 4, 3]], degrees=True).as_matrix() @ course.T
    return np.array(REFERENCE) + course @ x[:3] + R @ ARM, R


@pytest.mark.parametrize("heading", [0.0, 130.0])
def test_an_end_is_carried_by_the_rigid_body(heading: float, tmp_path: Path) -> None:
    """Where it is, and how it is turned; between the rows, which lie 0.05 s apart, to the splines' fourth order."""
    end = end_of(scene(tmp_path, text(six(T)), heading_deg=heading))
    assert end.motion is not None
    assert end.turning is not None
    for t in (0.0, 1.0, 4.225, 9.87):
        place, R = by_hand(t, heading)
        assert end.motion(t)[0] == pytest.approx(place, abs=2e-5)
        assert Rotation.from_rotvec(end.turning(t).rotation).as_matrix() == pytest.approx(R, abs=2e-6)


def test_velocities_and_accelerations_are_the_derivatives(tmp_path: Path) -> None:
    end, h = end_of(scene(tmp_path, text(six(T)), heading_deg=50.0, ramp=3.0)), 1e-4
    assert end.motion is not None
    assert end.turning is not None
    for t in (0.72, 2.13, 5.513, 10.03):  # between rows, at which the splines' third derivatives jump
        (x0, v0, _), (_, v, a), (x1, v1, _) = end.motion(t - h), end.motion(t), end.motion(t + h)
        assert v == pytest.approx((x1 - x0) / (2.0 * h), abs=1e-6)
        assert a == pytest.approx((v1 - v0) / (2.0 * h), abs=1e-6)
        before, now, after = (end.turning(at) for at in (t - h, t, t + h))
        step = Rotation.from_rotvec(after.rotation) * Rotation.from_rotvec(before.rotation).inv()
        assert now.angular_velocity == pytest.approx(step.as_rotvec() / (2.0 * h), abs=1e-6)
        change = (after.angular_velocity - before.angular_velocity) / (2.0 * h)
        assert now.angular_acceleration == pytest.approx(change, abs=1e-6)
        assert np.abs(now.angular_acceleration).max() > 1e-3


def test_it_is_the_table_of_the_end(tmp_path: Path) -> None:
    """Table of the end's displacements and rotation vectors, worked out by hand row by row."""
    known = [by_hand(float(t), 0.0) for t in T]
    rows = np.array([[*(x - VESSEL_END), *Rotation.from_matrix(R).as_rotvec()] for x, R in known])
    header = "t [s], x [m], y [m], z [m], rx [rad], ry [rad], rz [rad]\n"
    (tmp_path / "end.csv").write_text(text(rows, header=header), encoding="utf-8")
    one = end_of(scene_from_mapping(mapping({"table": "end.csv"}), tmp_path))
    other = end_of(scene(tmp_path, text(six(T))))
    assert one.motion is not None
    assert one.turning is not None
    assert other.motion is not None
    assert other.turning is not None
    for t in (0.4, 3.31, 8.0):
        for values, expected, within in zip(other.motion(t), one.motion(t), (2e-5, 5e-4, 5e-3), strict=True):
            assert values == pytest.approx(expected, abs=within)
        for values, expected, within in zip(other.turning(t), one.turning(t), (2e-6, 5e-5, 5e-4), strict=True):
            assert values == pytest.approx(expected, abs=within)


def test_small_motions_are_those_by_raos(tmp_path: Path) -> None:
    """Heave and pitch in phase with the surface; RAOs turn by small angles, which leaves arm pitch^2/2 = 18 um."""
    (tmp_path / "rao.csv").write_text(table(*EVERYWHERE, heave=(0.02, 0.0), pitch=(1e-3, 0.0)), encoding="utf-8")
    by_rao = dynamic(12.0, 0.1, motion={"end": {"vessel": {"rao": "rao.csv", "reference": REFERENCE}}})
    known = scene_from_mapping(at_sea(by_rao, waves=AIRY), tmp_path)
    rise = np.array([surface(known, t) for t in T])
    rows = text(np.outer(rise, [0.02, 1e-3]), header="t [s], heave [m], pitch [rad]\n")
    one, other = end_of(known), end_of(scene(tmp_path, rows, ramp=0.1))
    assert one.motion is not None
    assert other.motion is not None
    for t in (3.0, 6.0, 11.3):
        for values, expected in zip(other.motion(t), one.motion(t), strict=True):
            assert values == pytest.approx(expected, abs=4e-5)
    assert np.abs(one.motion(6.0)[0] - VESSEL_END).max() > 0.01


def test_echo_and_dimension(tmp_path: Path) -> None:
    given = scene(tmp_path, text(six(T)))
    folder = tmp_path / "results"
    folder.mkdir()
    (folder / "scene.yaml").write_text(dump_scene(given), encoding="utf-8")
    assert read_scene(folder / "scene.yaml") == given
    assert resolved_dimension(given) == 3
    in_plane = scene(tmp_path, text(six(T)[:, [0, 2, 4]], header="t [s], surge [m], heave [m], pitch [deg]\n"))
    assert resolved_dimension(in_plane) == 2
    assert resolved_dimension(scene(tmp_path, text(six(T)[:, :1], header="t [s], sway [m]\n"))) == 3


FOUR = "1, 0.1\n2, 0.3\n12, 0.2\n"


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        ("t [s], heave [m]\n0, 0\n1, 1\n", "vessel.csv: a table of 2 rows; cubic splines need at least 4"),
        ("t [s], heave [m]\n0, 0\n1, 0\n1, 0\n9, 0\n", "vessel.csv:4: times must increase"),
        ("t [s], pitch [m]\n0, 0\n" + FOUR, "vessel.csv:1: pitch can't be in [m], accepted are deg, rad"),
        ("t [s], x [m]\n0, 0\n" + FOUR, 'no such column as "x", known are t, surge, sway, heave, roll, pitch, yaw'),
        ("t [s]\n0\n1\n2\n12\n", "vessel.csv:1: nothing moves; give surge [m]"),
        ("t [s], yaw [rad]\n0, 0\n1, 2\n2, 2\n12, 1\n", "vessel.csv:3: yaw must be within 90 deg of the heading"),
        ("t [s], heave [m]\n0, 0.2\n" + FOUR, "vessel.csv:2: without a ramp the end would jump by 0.2 m"),
        ("t [s], heave [m]\n0, 0\n" + FOUR.replace("12", "9"), "covers 0 to 9 s, but the stage lasts from 0 to 12 s"),
    ],
)
def test_refused_files(rows: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError) as caught:
        scene(tmp_path, rows)
    message = str(caught.value)
    assert len(message.splitlines()) == 1
    assert message.startswith("scene: stages.0.motion.end.vessel_history")
    assert says in message
    assert "; " in message
