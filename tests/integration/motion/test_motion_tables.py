"""Motions from CSV files: what is read, what is refused and with which words, and what they make of a scene."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.assembly import build
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.riser.line_ends import Kinematics
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.plane import resolved_dimension
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.scene import Scene
from tests.support.scenes import dynamic, prescribed, riser_scene

PIPE = {"EA": 1.0e8, "EI": 1.0e5, "GJ": 1.0e5, "mass": 50.0}
HEADER = "t [s], x [m], y [m], z [m]\n"
STILL = "0, 0, 0, 0\n"
ROWS = "1, 0.1, 0, 0.2\n2, 0.3, 0, 0.1\n4, 0, 0, -0.5\n"
END = np.array([24.0, 18.0, 0.0])


def scene(folder: Path, text: str | None, table: Any = "motion.csv", rotation: Any = "free") -> Scene:
    """A straight pipe in an oblique vertical plane, its end moved by a table."""
    if text is not None:
        (folder / "motion.csv").write_text(text, encoding="utf-8")
    moving = dynamic(4.0, 0.1, motion={"end": {"table": table}})
    pipe = riser_scene(
        moving,
        pipe=PIPE,
        length=30.0,
        elements=3,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(*END, rotation=rotation),
    )
    return scene_from_mapping(pipe, folder)


def at(scene: Scene, t: float) -> Kinematics:
    """The end at a time of the first stage."""
    assembly = build(scene, MPI.COMM_SELF)
    assembly.begin(scene.stages[0])
    assert assembly.riser.line.end.motion is not None
    return assembly.riser.line.end.motion(t)


def refusal(folder: Path, text: str | None, **more: Any) -> str:
    with pytest.raises(SceneError) as caught:
        scene(folder, text, **more)
    assert len(str(caught.value).splitlines()) == 1
    return str(caught.value)


def test_end_goes_through_the_rows_from_where_it_is(tmp_path: Path) -> None:
    moved = scene(tmp_path, HEADER + STILL + ROWS)
    assert at(moved, 0.0)[0] == pytest.approx(END)
    assert at(moved, 2.0)[0] == pytest.approx(END + np.array([0.3, 0.0, 0.1]))
    assert at(moved, 4.0)[0] == pytest.approx(END + np.array([0.0, 0.0, -0.5]))


@pytest.mark.parametrize(
    "text",
    [
        "t [ms],x [mm],y [cm],z [ft]\n0,0,0,0\n1000,100,0,.656167979\n2000,300,0,0.3280839895\n4000,0,0,-1.64041995\n",
        "# from the tank\nZ [m]; T [min]; y [m]; X [cm]\n\n0; 0; 0; 0\n.2; 1.6666666666666667e-2; 0; 10\n"
        ".1; 3.3333333333333333e-2; 0; 30\n# last\n-.5; 6.6666666666666667e-2; 0; 0\n",
        "\ufefft[s],x[m],y[m],z[m]\r\n0,0,0,0\r\n1,.1,0,.2\r\n2,.3,0,.1\r\n4,0,0,-.5\r\n",
    ],
)
def test_units_order_and_separators_are_free(text: str, tmp_path: Path) -> None:
    expected = at(scene(tmp_path, HEADER + STILL + ROWS), 1.4)
    for computed, value in zip(at(scene(tmp_path, text), 1.4), expected, strict=True):
        assert computed == pytest.approx(value, rel=1e-8, abs=1e-8)


def test_rotations_turn_the_support(tmp_path: Path) -> None:
    header = "t [s], x [m], y [m], z [m], ry [deg]\n"
    rows = "".join(f"{t}, 0, 0, 0, {10.0 * t}\n" for t in range(5))
    moved = scene(tmp_path, header + rows, rotation="fixed")
    assembly = build(moved, MPI.COMM_SELF)
    assembly.begin(moved.stages[0])
    turning = assembly.riser.line.end.turning
    assert turning is not None
    assert turning(3.0).rotation == pytest.approx(np.radians([0.0, 30.0, 0.0]))
    assert turning(3.0).angular_velocity == pytest.approx(np.radians([0.0, 10.0, 0.0]))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "motion.csv: the file is empty; its first line must name the columns: t [s], x [m]"),
        ("# nothing\n\n", "motion.csv: the file is empty"),
        ("0, 0, 0, 0\n" + ROWS, 'motion.csv:1: "0" names no column with its unit; write them like t [s]'),
        ("t, x, y, z\n" + STILL, 'motion.csv:1: "t" names no column with its unit'),
        (HEADER.replace("x [m]", "surge [m]") + STILL, 'motion.csv:1: no such column as "surge", known are t, x, y, z'),
        (HEADER.replace("x [m]", "x [km]") + STILL, "motion.csv:1: x can't be in [km], accepted are m, mm, cm, ft"),
        (HEADER.replace("x [m]", "y [m]") + STILL, "motion.csv:1: there are two columns y"),
        ("t [s], x [m], z [m]\n0, 0, 0\n", "motion.csv:1: there is no column y"),
        (HEADER + STILL + "1, 2, 3\n" + ROWS, "motion.csv:3: the row has 3 values, but the header names 4 columns"),
        (HEADER + STILL + "\n1, a, 0, 0\n", 'motion.csv:4: x: "a" is not a finite number'),
        (HEADER + STILL + "1, 1_0, 0, 0\n", 'motion.csv:3: x: "1_0" is not a finite number'),
        (HEADER + STILL + "1, nan, 0, 0\n", 'motion.csv:3: x: "nan" is not a finite number'),
        (HEADER + STILL + "1, 0, 0,\n", 'motion.csv:3: z: "" is not a finite number'),
        (HEADER + STILL + ROWS.replace("2,", "1.0,"), "motion.csv:4: times must increase, but 1 s follows 1 s"),
        (HEADER + STILL + "4, 0, 0, 1\n", "motion.csv: a table of 2 rows; cubic splines need at least 4"),
        (HEADER, "a table of 0 rows"),
        (HEADER + STILL + ROWS.replace("4,", "3.9,"), "covers 0 to 3.9 s, but the stage lasts from 0 to 4 s"),
        (HEADER + ROWS + "5, 0, 0, 0\n", "covers 1 to 5 s, but the stage lasts from 0 to 4 s"),
        (HEADER + "0, 0.3, 0, 0.4\n" + ROWS, "motion.csv:2: without a ramp the end would jump by 0.5 m"),
        (None, "there is no such file as"),
    ],
)
def test_refused_tables(text: str | None, says: str, tmp_path: Path) -> None:
    message = refusal(tmp_path, text)
    assert message.startswith('scene: stages.0.motion.end.table: value "motion.csv": ')
    assert says in message
    assert str(tmp_path) in message
    assert "; " in message


def test_cells_may_stand_in_quotes(tmp_path: Path) -> None:
    plain = scene(tmp_path, HEADER + STILL + ROWS)
    lines = (HEADER + STILL + ROWS).splitlines()
    quoted = "".join(",".join(f'"{cell.strip()}"' for cell in line.split(",")) + "\n" for line in lines)
    assert '"t [s]","x [m]"' in quoted
    expected = at(plain, 1.3)
    for values, other in zip(at(scene(tmp_path, quoted), 1.3), expected, strict=True):
        assert values == pytest.approx(other, abs=1e-15)


def test_not_utf8(tmp_path: Path) -> None:
    (tmp_path / "motion.csv").write_bytes(HEADER.encode() + b"0, 0, 0, 0\n1, 0, 0, \xb5\n")
    assert "motion.csv:3: not UTF-8 text" in refusal(tmp_path, None)


def test_a_ramp_leads_to_rows_that_begin_elsewhere(tmp_path: Path) -> None:
    moved = scene(tmp_path, HEADER + "0, 0.3, 0, 0.4\n" + ROWS, table={"file": "motion.csv", "ramp": 3.0})
    for values, first in zip(at(moved, 0.0), (END, [0.0] * 3, [0.0] * 3), strict=True):
        assert values == pytest.approx(first)
    assert at(moved, 4.0)[0] == pytest.approx(END + np.array([0.0, 0.0, -0.5]))


def test_echo_finds_the_table_from_elsewhere(tmp_path: Path) -> None:
    moved = scene(tmp_path, HEADER + STILL + ROWS)
    folder = tmp_path / "results"
    folder.mkdir()
    (folder / "scene.yaml").write_text(dump_scene(moved), encoding="utf-8")
    again = read_scene(folder / "scene.yaml")
    assert again == moved
    assert at(again, 1.4)[0] == pytest.approx(at(moved, 1.4)[0])


def row(t: float, x: Array) -> str:
    return ", ".join(f"{value:.17g}" for value in (t, *x)) + "\n"


@pytest.mark.parametrize(
    ("direction", "rotation", "dimension"),
    [
        ([0.8, 0.6, 0.0], [0.0, 0.0, 0.0], 2),
        ([0.8, 0.6, 0.5], [0.6, -0.8, 0.0], 2),
        ([1.0, 0.0, 0.0], [0.0, 0.0, 0.0], 3),
        ([0.8, 0.6, 0.5], [0.0, 1.0, 0.0], 3),
        ([0.0, 0.0, 0.0], [0.0, 0.0, 0.1], 3),
        ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0], 2),
    ],
)
def test_only_what_leaves_the_plane_makes_three_dimensions(
    direction: list[float], rotation: list[float], dimension: int, tmp_path: Path
) -> None:
    header = "t [s], x [m], y [m], z [m], rx [rad], ry [rad], rz [rad]\n"
    rows = [row(t, s * np.array([*direction, *rotation])) for t, s in ((0, 0.0), (1, 1.0), (2, -0.3), (4, 1e-7))]
    assert resolved_dimension(scene(tmp_path, header + "".join(rows))) == dimension


def test_a_support_rocks_while_a_table_moves_it(tmp_path: Path) -> None:
    (tmp_path / "motion.csv").write_text(HEADER + STILL + ROWS, encoding="utf-8")
    rocking = {"axis": [0.0, 1.0, 0.0], "amplitude_deg": 9.0, "period": 4.0}
    moving = dynamic(4.0, 0.1, motion={"end": {"table": "motion.csv", "rotation": rocking}})
    ends = prescribed(0.0, 0.0, 0.0), prescribed(30.0, 0.0, 0.0, rotation="fixed")
    both = riser_scene(moving, pipe=PIPE, length=30.0, elements=3, start=ends[0], end=ends[1])
    assembly = build(scene_from_mapping(both, tmp_path), MPI.COMM_SELF)
    assembly.begin(assembly.scene.stages[0])
    end = assembly.riser.line.end
    assert end.motion is not None
    assert end.turning is not None
    assert end.motion(1.0)[0] == pytest.approx([30.1, 0.0, 0.2])
    assert np.degrees(end.turning(1.0).rotation) == pytest.approx([0.0, 9.0, 0.0])
