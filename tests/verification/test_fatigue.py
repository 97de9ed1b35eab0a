"""Fatigue of a pipe that is pulled and bent to and fro, from its runs to tables: by hand, with fatpack."""

from __future__ import annotations

import csv
import json
import re
import shutil
from pathlib import Path
from typing import Any

import fatpack
import numpy as np
import pytest
from ruamel.yaml import YAML
from typer.testing import CliRunner, Result

from riser_soil.__main__ import app
from riser_soil.core.arrays import Array
from riser_soil.fatigue.stress_history import stress_history
from riser_soil.results import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.whole_run import run
from tests.support.said import line_with, lines_with
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene

YEAR = 365.25 * 86400.0  # s
OUTER, INNER, PULL, BEND = 0.2731, 0.2319, 3.0e5, 6.0e4
A = 0.25 * np.pi * (OUTER**2 - INNER**2)
I = np.pi / 64.0 * (OUTER**4 - INNER**4)
STEEL: Mapping = {"EA": 3.0e9, "EI": 2.5e9, "GJ": 2.0e7, "mass": 160.0}
STEEL |= {"outer_diameter": OUTER, "inner_diameter": INNER}
CURVE: Mapping = {"log_a": [11.764, 15.606], "m": [3.0, 5.0], "change": [1.0e6]}
# Factors of the loads at [s]: cycles of three ranges.
HISTORY = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.2], [3.0, 0.6], [4.0, -1.0], [5.0, 0.0], [6.0, -0.4], [8.0, 0.0]]


def shaken(wall: bool = True, elements: int = 2, fields: tuple[str, ...] = ()) -> Mapping:
    """A clamped pipe along x, pulled and bent at its end, stiff enough to follow its loads."""
    loads = {"at": "end", "force": [PULL, 0.0, 0.0], "moment": [0.0, BEND, 0.0], "history": HISTORY}
    pipe = STEEL | ({"wall": {}} if wall else {})
    scheme = {"generalized_alpha": {"rho_inf": 0.0}}
    more: dict[str, Any] = {"output": {"interval": 0.1, **({"fields": list(fields)} if fields else {})}}
    return riser_scene(
        dynamic(8.0, 0.1, name="shake", loads=[loads], scheme=scheme),
        pipe=pipe,
        length=6.0,
        elements=elements,
        start=prescribed(0.0, 0.0, 0.0, rotation="fixed"),
        end="free",
        riser={"initial": "unstressed"},
        **more,
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With a run named shaken."""
    made = tmp_path_factory.mktemp("fatigue")
    run(scene_from_mapping(shaken()), made / "shaken")
    return made


def assessed(folder: Path, given: Mapping, *options: str) -> Result:
    with (folder / "fatigue.yaml").open("w", encoding="utf-8") as file:
        YAML(typ="safe").dump(given, file)
    call = ["fatigue", str(folder / "fatigue.yaml"), "-o", str(folder / "damage"), "--force", *options]
    return CliRunner().invoke(app, call)


def given(**more: Any) -> Mapping:
    return {"curve": CURVE, "points": 8, "cases": [{"run": "shaken", "share": 0.4}]} | more


def table(folder: Path) -> dict[str, Array]:
    with (folder / "damage" / "fatigue.csv").open(encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    return dict(zip(head, np.array(rows, dtype=float).T, strict=True))


def by_hand(stress: Array, seconds: float) -> float:
    """Damage in 40 % of a year of a stress [Pa]."""
    S = 1e-6 * fatpack.find_rainflow_ranges(stress, k=4096)
    few, many = 10.0**11.764 / S**3.0, 10.0**15.606 / S**5.0
    change = (10.0**11.764 / 1e6) ** (1.0 / 3.0)
    return float(0.4 * YEAR / seconds * np.sum(1.0 / np.where(change <= S, few, many)))


def test_every_damage_is_fatpack_s_by_hand(folder: Path) -> None:
    done = assessed(folder, given())
    assert done.exit_code == 0, done.output
    shaken, damage = Run(folder / "shaken"), table(folder)
    rows = shaken["stage"] == 0
    T, M = shaken["effective_tension"][rows], shaken["bending_moment_y"][rows]
    seconds = shaken.time[rows][-1] - shaken.time[rows][0]
    assert damage["damage_per_year"].size == 3 * 8
    for n, (arc, angle) in enumerate(zip(damage["arc_m"], damage["angle_deg"], strict=True)):
        node = int(np.argmin(np.abs(shaken.arc - arc)))
        stress = T[:, node] / A + M[:, node] * np.sin(np.radians(angle)) * 0.5 * OUTER / I
        assert damage["damage_per_year"][n] == pytest.approx(by_hand(stress, seconds), rel=1e-9)
    assert damage["life_years"] == pytest.approx(1.0 / damage["damage_per_year"], rel=1e-9)


def test_the_upper_side_is_as_loads_and_turns_by_hand_have_it(folder: Path) -> None:
    """Ranges 2.0, 0.4 and 0.4 of tension and bending together; inertia changes them by less than a per cent."""
    assessed(folder, given())
    data = json.loads((folder / "damage" / "fatigue.json").read_text(encoding="utf-8"))
    assert data["largest"]["angle_deg"] == 90.0
    S = 1e-6 * (PULL / A + BEND * 0.5 * OUTER / I) * np.array([2.0, 0.4, 0.4])
    N = np.where(S > 83.4, 10.0**11.764 / S**3.0, 10.0**15.606 / S**5.0)
    assert data["largest"]["damage_per_year"] == pytest.approx(0.4 * YEAR / 8.0 * np.sum(1.0 / N), rel=0.01)
    assert data["cases"][0]["damage_per_year"] == data["largest"]["damage_per_year"]


def test_factors_surface_and_shares(folder: Path) -> None:
    """One slope: SCF and thickness by their m-th power, the inner surface by its radius, cases by their shares."""
    one = {"curve": {"log_a": [12.0], "m": [3.0], "thickness_exponent": 0.25, "reference_thickness": 0.025}}
    assessed(folder, given(**one))
    plain = table(folder)["damage_per_year"]
    assessed(folder, given(**one, stress_concentration=1.3, thickness=0.05))
    assert table(folder)["damage_per_year"] == pytest.approx(plain * (1.3 * 2.0**0.25) ** 3, rel=1e-9)
    twice = [{"run": "shaken", "share": 0.1}, {"run": "shaken", "share": 0.7}]
    assessed(folder, given(**one, cases=twice))
    assert table(folder)["damage_per_year"] == pytest.approx(2.0 * plain, rel=1e-9)
    assessed(folder, given(**one, surface="inner"))
    inner = table(folder)
    assert np.all(inner["diameter_m"] == INNER)
    pulled = inner["angle_deg"] == 0.0
    assert inner["damage_per_year"][pulled] == pytest.approx(plain[pulled], rel=1e-6)
    assert np.all(inner["damage_per_year"][inner["angle_deg"] == 90.0] < plain[inner["angle_deg"] == 90.0])


def test_in_a_bend_stiffener_it_is_the_run_s_own_wall(tmp_path: Path) -> None:
    """The largest bending stress around is what the run has recorded: the stiffener bears two thirds of the moment."""
    scene = shaken(elements=12)
    cone = {"length": 3.0, "base_diameter": 0.9, "tip_diameter": 0.4, "E": 2.0e11}
    scene["riser"]["start"]["bend_stiffener"] = cone
    scene["stages"][0]["duration"] = 0.5
    run(scene_from_mapping(scene), tmp_path)
    done, angles = Run(tmp_path), np.array([0.5 * np.pi, 1.5 * np.pi])
    history = stress_history(done)
    bending = np.array([0.5 * np.ptp(history.at(n, angles, "outer"), axis=1) for n in range(history.arc.size)])
    recorded = done["wall_bending_stress"][done["stage"] == 0]
    for arc, largest in zip(done.arc, recorded.T, strict=True):
        assert bending[history.arc == arc].max(axis=0) == pytest.approx(largest, rel=1e-9)
    assert recorded[:, 0].max() < 0.4 * recorded[:, -1].max()


def test_what_is_doubtful_is_reported(folder: Path) -> None:
    done = assessed(folder, given(design_life=25.0, design_fatigue_factor=10.0, skip=0.5, arcs=[0.0, 3.0]))
    data = json.loads((folder / "damage" / "fatigue.json").read_text(encoding="utf-8"))
    used = 250.0 * data["largest"]["damage_per_year"]
    assert data["design"]["utilisation"] == pytest.approx(used, rel=1e-12)
    assert data["cases"][0]["seconds"] == pytest.approx(7.5, abs=1e-9)
    assert table(folder)["arc_m"].max() == 3.0
    line_with(data["warnings"], "cases", "40 % of the year")
    line_with(data["warnings"], "times 10", f"{used:.4g}", "more than 1")
    assert lines_with(data["warnings"], "uncertain by some")
    assert all(f"warning: {text}" in done.output for text in data["warnings"])
    short = assessed(folder, given(skip=7.5)).output
    line_with(short, "warning:", "shaken:", "less than twice", "0.5 s", "too short")


def test_the_picture_is_drawn(folder: Path) -> None:
    assert assessed(folder, given(), "--plot").exit_code == 0
    assert (folder / "damage" / "fatigue.png").stat().st_size > 10_000
    assert assessed(folder, given()).exit_code == 0
    assert not (folder / "damage" / "fatigue.png").exists(), "a picture of another assessment"


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"curve": {"dnv": "DD", "environment": "air"}}, r"yaml:\d+: curve.dnv: value \"DD\": must be one of B1"),
        ({"curve": {"dnv": "D"}}, "curve.environment: missing: the key is required here"),
        ({"curve": {}}, r"must be \{dnv, environment\}, \{log_a, m, change\} or \{table"),
        ({"curve": {"log_a": [12.0, 15.0], "m": [3.0]}}, "branches do not fit: 2 log_a, 1 m, 0 change"),
        (
            {"curve": CURVE | {"change": [1.0e7]}},
            "curve.change: .*branches do not meet: one ends with log10 N = 7, there the next begins with 7.666",
        ),
        ({"curve": {"table": [[1e4, 1e8], [1e3, 1e7]]}}, "cycles must grow and stress ranges fall"),
        ({"cases": [{"run": "shaken", "share": 0.6}] * 2}, "have shares of 1.2 in all, more than a year"),
        ({"cases": [{"run": "gone", "share": 0.6}]}, "there is no folder .*gone; run the case first"),
        ({"cases": [{"run": "shaken", "share": 0.6, "stage": "lay"}]}, '"lay" is no dynamic stage of the run'),
        ({"cases": [{"run": "shaken", "share": 0.6, "skip": 7.75}]}, r"3 record\(s\) of stage shake from 7.75 s on"),
        ({"cases": [{"run": "shaken", "share": 0.6, "skip": 9.0}]}, r"0 record\(s\) of stage shake from 9 s on"),
        ({"arcs": [7.0, 8.0]}, "no node of a wall lies from 7 to 8 m; walls lie from 0 to 6 m"),
        ({"point": 8}, r"point: value 8: no such key here.*did you mean \"points\""),
    ],
)
def test_what_is_refused(folder: Path, more: Mapping, message: str) -> None:
    shutil.rmtree(folder / "damage", ignore_errors=True)
    done = assessed(folder, given(**more))
    assert done.exit_code == 2
    assert "Traceback" not in done.output
    (line,) = done.output.splitlines()
    assert re.search(message, line), line
    assert not (folder / "damage").exists()


@pytest.mark.parametrize(
    ("scene", "message"),
    [
        (shaken(wall=False), "no line type has a wall, from whose stress fatigue follows"),
        (shaken(fields=("effective_tension",)), "results.nc has no bending_moment_y, which the stress follows from"),
        (shaken(elements=3), "has other nodes or walls than"),
    ],
)
def test_runs_that_do_not_fit(folder: Path, scene: Mapping, message: str) -> None:
    scene["stages"][0]["duration"] = 0.5
    run(scene_from_mapping(scene), folder / "other", True)
    done = assessed(folder, given(cases=[{"run": name, "share": 0.5} for name in ("shaken", "other")]))
    assert done.exit_code == 2
    assert message in done.output


def test_a_finished_assessment_is_kept(folder: Path) -> None:
    assessed(folder, given())
    call = ["fatigue", str(folder / "fatigue.yaml"), "-o", str(folder / "damage")]
    done = CliRunner().invoke(app, call)
    assert done.exit_code == 2
    assert "overwrite it with --force" in done.output
