"""Plausibility of motions: velocities that jump between stages, and time steps that are too long for what moves."""

from __future__ import annotations

import re
from math import hypot
from pathlib import Path
from typing import Any

import pytest

from riser_soil.checks.motion_plausibility import motion_warnings
from riser_soil.scene.reader import scene_from_mapping
from tests.support.driven_stage import built_of
from tests.support.said import line_with, lines_with
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene, static

PIPE = {"EA": 1.0e7, "EI": 1.0e5, "GJ": 1.0e5, "mass": 50.0, "submerged_weight": 200.0, "outer_diameter": 0.2}
HARMONIC: Mapping = {"amplitude": [0.0, 0.0, 2.0], "period": 6.2831853}  # 2 m/s at its middle
SWELL: Mapping = {"airy": {"height": 2.0, "period": 8.0}}


def warnings(*stages: Mapping, folder: Path | None = None, rotation: Any = "fixed", **more: Any) -> list[str]:
    pipe = riser_scene(
        *stages,
        pipe=PIPE,
        length=60.0,
        elements=6,
        start=prescribed(0.0, 0.0, -30.0),
        end=prescribed(40.0, 0.0, 3.0, rotation=rotation),
        gravity=9.81,
        **more,
    )
    scene = scene_from_mapping(pipe, folder) if folder else scene_from_mapping(pipe)
    return list(motion_warnings(built_of(scene).riser))


def moved(name: str = "move", duration: float = 6.2831853, time_step: float = 0.1, **motion: Any) -> Mapping:
    return dynamic(duration, time_step, name, motion={"end": motion})


@pytest.mark.parametrize(
    ("motion", "speed"),
    [
        ({"harmonic": HARMONIC}, "2 m/s"),
        ({"arc": {"hub": [40.0, 0.0, 13.0], "amplitude_deg": 9.0, "period": 6.2831853}}, "1.57 m/s"),
        ({"rotation": {"axis": [0.0, 1.0, 0.0], "amplitude_deg": 9.0, "period": 6.2831853}}, "9 deg/s"),
    ],
)
def test_a_start_at_full_speed_is_reported_and_a_ramp_heals_it(motion: Mapping, speed: str) -> None:
    (warning,) = warnings(static(), moved(**motion))
    line_with([warning], "stages.1.motion.end:", f"starts at {speed}", "ramp [s]")
    ((kind, given),) = motion.items()
    assert not warnings(static(), moved(**{kind: given | {"ramp": 3.0}}))


def test_a_table_that_starts_moving(tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text("t [s], x [m], y [m], z [m]\n" + "".join(f"{t},{-3 * t},0,0\n" for t in range(8)))
    (warning,) = warnings(moved(table="t.csv"), folder=tmp_path)
    line_with([warning], "end", "starts at 3 m/s")
    rows = "".join(f"{t},{-0.1 * t**3},0,0\n" for t in range(8))
    (tmp_path / "t.csv").write_text("t [s], x [m], y [m], z [m]\n" + rows)
    assert not warnings(moved(table="t.csv"), folder=tmp_path)


def test_what_stops_dead_is_reported() -> None:
    ramped: dict[str, Any] = {"harmonic": HARMONIC | {"ramp": 3.0}}
    (warning,) = warnings(moved(**ramped), dynamic(1.0, 0.1, "still"))
    line_with([warning], "stages.1:", "end", "stops dead", "2 m/s")
    (warning,) = warnings(moved(**ramped), moved("again", **ramped))
    line_with([warning], "stages.1:", "end", "another motion")
    assert not warnings(moved(**ramped), moved("on", harmonic=HARMONIC))  # a whole period later it is the same sine
    assert not warnings(moved(**ramped), static())
    assert len(warnings(moved(**ramped), static(), moved("again", harmonic=HARMONIC))) == 1
    assert not warnings(moved(duration=6.2831853 * 1.25, **ramped), dynamic(1.0, 0.1, "still"))  # at rest, at the top


@pytest.mark.parametrize(
    ("period", "waves", "time_step", "says"),
    [
        (4.0, None, 0.5, ("0.5 s", "end's harmonic", "4 s", "a tenth")),
        (4.0, None, 0.4, ()),
        (4.0, SWELL, 0.5, ("end's harmonic", "4 s")),
        (9.0, SWELL, 0.9, ("0.9 s", "period of the waves", "8 s", "a tenth")),
        (9.0, SWELL, 0.8, ()),
    ],
)
def test_long_time_steps(period: float, waves: Mapping | None, time_step: float, says: tuple[str, ...]) -> None:
    water: dict[str, Any] = {"water": {"surface_level": 10.0, "waves": waves}} if waves else {}
    harmonic = {"amplitude": [0.0, 0.0, 2.0], "period": period, "ramp": period}
    lines = warnings(static(), moved(harmonic=harmonic, time_step=time_step), **water)
    assert len(lines) == len(lines_with(lines, "stages.1.time_step:", *says)) == bool(says)


@pytest.mark.parametrize(
    ("stage", "path", "apart"),
    [
        (moved(harmonic=HARMONIC | {"amplitude": [12.0, 0.0, 9.0], "ramp": 1.0}), "stages.1.motion", hypot(52.0, 42.0)),
        (
            moved(arc={"hub": [40.0, 0.0, 53.0], "amplitude_deg": 30.0, "period": 6.2831853, "ramp": 1.0}),
            "stages.1.motion",
            hypot(40.0 + 50.0 * 0.5, 30.0 + 53.0 - 50.0 * 0.75**0.5),
        ),
        (static("pull", move={"end": [52.0, 0.0, 5.0]}), "stages.1.move", hypot(52.0, 35.0)),
    ],
)
def test_ends_that_go_farther_apart_than_the_riser_is_long(stage: Mapping, path: str, apart: float) -> None:
    line = line_with(warnings(static(), stage), f"{path}:", "ends", "60 m long")
    gap, stretched = (float(x) for x in re.findall(r"([\d.]+)(?: m apart|%)", line))
    assert gap == pytest.approx(apart, abs=0.1)
    assert stretched == pytest.approx(100.0 * (gap / 60.0 - 1.0), abs=0.01)


def test_ends_that_stay_within_the_length_are_not_reported() -> None:
    assert not warnings(static(), moved(harmonic=HARMONIC | {"amplitude": [6.0, 0.0, 4.5], "ramp": 3.0}))
    assert not warnings(static(), static("pull", move={"end": [48.0, 0.0, 5.0]}))


def test_motions_go_on_from_where_the_stage_before_left_the_end() -> None:
    """Each alone would stay within the length."""
    pull = static("pull", move={"end": [48.0, 0.0, 5.0]})
    heave = moved(harmonic=HARMONIC | {"amplitude": [2.0, 0.0, 4.0], "ramp": 3.0})
    assert not warnings(static(), heave)
    (warning,) = warnings(static(), pull, heave)
    assert re.match(r"stages\.2\.motion: .* 6[\d.]* m apart", warning)


def test_a_table_that_leads_too_far_at_one_of_its_rows_is_reported(tmp_path: Path) -> None:
    rows = [(t, 20 * (t == 51)) for t in range(0, 103, 3)]
    (tmp_path / "t.csv").write_text("t [s], x [m], y [m], z [m]\n" + "".join(f"{t},{x},0,0\n" for t, x in rows))
    lines = warnings(static(), moved(duration=100.0, table="t.csv"), folder=tmp_path)
    assert [warning for warning in lines if "apart at 51 s" in warning]
