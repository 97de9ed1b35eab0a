"""Physical ranges: what no riser of any scale has is refused, and what a riser scaled by a million has is not."""

from __future__ import annotations

import math
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from mpi4py import MPI

from riser_soil.assembly import build
from riser_soil.errors import SceneError
from riser_soil.scene.reader import read_scene, scene_from_mapping
from tests.support.bad_scenes import GOOD
from tests.support.said import telling
from tests.support.scenes import LAY, Mapping, heave, touchdown

OUTSIDE = [
    ("gravity=1.0e-300", "gravity: value 1e-300: must be 0, or from 1e-09 to 1e+09 m/s2"),
    ("riser.segments.0.length=1.0e30", "value 1e+30: must be from 1e-12 to 1e+12 m"),
    ("riser.segments.0.elements=10000000000000000000", "value 10000000000000000000: must be at most 1e+06"),
    ("riser.contents.density=1.0e300", "value 1e+300: must be from 1e-09 to 1e+09 kg/m3"),
    ("line_types.pipe.outer_diameter=1.0e200", "value 1e+200: must be from 1e-12 to 1e+12 m"),
    ("line_types.pipe.submerged_weight=-1.0e-300", "value -1e-300: must be 0, or from 1e-24 to 1e+24 N/m in size"),
    ("water.density=1.0e30", "value 1e+30: must be from"),
    ("stages.1.motion.end.harmonic.amplitude.2=1.0e300", "value 1e+300: must be at most 1e+12 m in size"),
    ("solver.tolerance=1.0e-300", "must be from 1e-16 to 1"),
    ("soil.block.depth=1.0e13", "value 10000000000000.0: must be from 1e-12 to 1e+12 m"),
    ("seabed.profile=[[0, 0], [1.0e-300, 0]]", "the distances s must increase, by 1e-12 m at least"),
    ("water.current={profile: [[0, 0, 0], [1.0e-300, 1, 0]]}", "the heights z must increase, by 1e-12 m at least"),
    ("riser.unstressed={points: [[0, 0, 0], [1.0e-300, 0, 0], [148, 0, 0]]}", "must not coincide (1e-12 m)"),
    ("riser.segments.0={line_type: pipe, length: 148.0, element_length: 1.0e-9}", "into 1.48e+11 elements"),
    ("riser.segments.0={line_type: pipe, length: 1.0e6, element_length: [1.0e-12, 1.0]}", "into 2.763e+07 elements"),
]


@pytest.mark.parametrize(("change", "says"), OUTSIDE, ids=lambda text: text[:40])
def test_what_lies_outside_is_refused_with_its_range(change: str, says: str, tmp_path: Path) -> None:
    (tmp_path / "scene.yaml").write_text(GOOD)
    with pytest.raises(SceneError) as caught:
        read_scene(tmp_path / "scene.yaml", [change])
    (line,) = [line for line in str(caught.value).splitlines() if says in line]
    assert line.startswith(f"--set {change}: {change.partition('=')[0].split('.elem')[0]}")
    assert "; " in line


def test_the_elements_of_all_segments_are_counted() -> None:
    scene = touchdown(LAY)
    scene["riser"]["segments"] = [{"line_type": "flexible", "length": 15.0, "elements": 700_000}] * 2
    with pytest.raises(SceneError, match=telling("riser.segments:", "1400000 elements", "more than 1000000")):
        scene_from_mapping(scene)


@pytest.mark.parametrize("zero", ["gravity", "riser.contents.pressure", "seabed.level"])
def test_nothing_at_all_is_no_matter_of_size(zero: str, tmp_path: Path) -> None:
    (tmp_path / "scene.yaml").write_text(GOOD)
    read_scene(tmp_path / "scene.yaml", [f"{zero}=0.0", "riser.initial=straight", "riser.end.position=[148, 0, 0.15]"])


TABLES = {
    "t [s], x [m], y [m], z [m]\n0, 0, 0, 0\n1e-300, 0, 0, 0\n2, 0, 0, 0\n20, 0, 0, 0\n": "the rows, 1e-12 s apart",
    "t [s], x [m], y [m], z [m]\n0, 1e300, 0, 0\n": ":2: x: 1e300 is larger than 1e+12",
    "t [s], x [m], y [m], z [m]\n0, " + "1" * 140_000 + ", 0, 0\n": ":2: the row can't be read (field larger than",
    "t [s], x [m], y [m], z [m]\n0, " + "x" * 90_000 + ", 0, 0\n": 'xxx..." is not a finite number',
}


@pytest.mark.parametrize("table", TABLES, ids=["close", "huge", "long cell", "long word"])
def test_tables_keep_within_as_well(table: str, tmp_path: Path) -> None:
    (tmp_path / "motion.csv").write_text(table)
    (tmp_path / "scene.yaml").write_text(GOOD)
    with pytest.raises(SceneError) as caught:
        read_scene(tmp_path / "scene.yaml", ["stages.1.motion.end={table: motion.csv}"])
    assert TABLES[table] in str(caught.value)
    assert len(str(caught.value)) < 1000


def test_suction_reaches_beyond_its_peak() -> None:
    scene = {key: value for key, value in touchdown(LAY).items() if key != "soil"}
    scene["contact"] = {"suction": {"cap": 50.0, "reach": 5e-4}}
    with pytest.raises(SceneError, match=r"^contact\.suction\.reach = 0\.0005 m: .* raise reach"):
        build(scene_from_mapping(scene), MPI.COMM_SELF)


POWERS = {  # of the length, by Froude's law
    "outer_diameter": 1, "inner_diameter": 1, "mass": 2, "EA": 3, "EI": 5, "GJ": 5, "length": 1, "position": 1,
    "stiffness": 1, "amplitude": 1, "period": 0.5, "ramp": 0.5, "duration": 0.5, "time_step": 0.5, "x": 1, "y": 1,
    "depth": 1, "size_at_riser": 1, "size_far": 1, "su": 1,
}  # fmt: skip


def scaled(value: Any, s: float, power: float = 0.0) -> Any:
    """A scene of s times the size."""
    if isinstance(value, dict):
        return {key: scaled(inner, s, POWERS.get(key, 0.0)) for key, inner in value.items()}
    if isinstance(value, list):
        return [scaled(inner, s, power) for inner in value]
    return value * s**power if isinstance(value, float) and power else value


@pytest.mark.parametrize("s", [1e-6, 1e6])
def test_a_riser_scaled_by_a_million_is_read_and_built(s: float) -> None:
    scene: Mapping = scaled(deepcopy(touchdown(LAY, heave(1.0))), s)
    scene["solver"]["min_time_step"] = 1e-5 * math.sqrt(s)
    scene["contact"] = {"smoothing": 1e-3 * s}
    assembly = build(scene_from_mapping(scene), MPI.COMM_SELF)
    assert assembly.riser.line.arc[-1] == pytest.approx(30.0 * s)
