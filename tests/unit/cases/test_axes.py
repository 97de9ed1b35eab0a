"""Short forms of a case file: the paths of the scene that they set, the names of the cases, and their mistakes."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import pytest

from riser_soil.cases.expansion import Case, read_cases
from riser_soil.errors import SceneError
from tests.support.case_files import require_refusal

SEA = """\
title: A riser in waves
water: {{density: 1025.0, surface_level: 12.0, waves: {waves}}}
line_types: {{pipe: {{EA: 1.0e6, EI: 200.0, GJ: 150.0, mass: 20.0, outer_diameter: 0.1, drag: {{normal: 1.0}}}}}}
riser:
  segments: [{{line_type: pipe, length: 60.0, elements: 8}}]
  start: {{position: [3.0, 4.0, 0.05]}}
  end: {{position: [{end}]}}
seabed: {{kind: spring, stiffness: 1.0e5}}
stages:
  - {{name: hang, kind: static}}
  - {{name: storm, kind: dynamic, duration: 10.0, time_step: 0.1}}
"""
JONSWAP = "{jonswap: {Hs: 1.0, Tp: 6.0, components: 10}}"
END = "27.0, 36.0, 12.0"  # 40 m from the start in plan, along (0.6, 0.8)


def case_file(folder: Path, text: str, waves: str = JONSWAP, end: str = END) -> Path:
    (folder / "sea.yaml").write_text(SEA.format(waves=waves, end=end), encoding="utf-8")
    file = folder / "cases.yaml"
    file.write_text(f"base: sea.yaml\n{dedent(text)}", encoding="utf-8")
    return file


def cases(folder: Path, text: str, waves: str = JONSWAP) -> list[Case]:
    return read_cases(case_file(folder, text, waves))[1]


def test_all_short_forms_together(tmp_path: Path) -> None:
    all_cases = cases(
        tmp_path,
        """
        sea_states: {mild: {Hs: 0.5}, storm: {Hs: 2.0, Tp: 8.0, water.surface_level: 13.0}}
        directions: [90, 180.5]
        offsets: 2.0
        soil:
          lower: {seabed.stiffness: 5.0e4, contact.friction.axial: 0.2}
          upper: {seabed.stiffness: 2.0e5}
        seeds: 3
        product: {line_types.pipe.EI: [150.0]}
        """,
    )
    assert len(all_cases) == 2 * 2 * 3 * 2 * 3
    first, last = all_cases[0], all_cases[-1]
    assert first.name == "mild-direction=90-near-lower-EI=150-seed=1"
    assert last.name == "storm-direction=180.5-far-upper-EI=150-seed=3"
    assert [case.name[-1] for case in all_cases[:4]] == ["1", "2", "3", "1"]
    at = {"vessel.offset": last.values["vessel.offset"]}
    assert at["vessel.offset"] == pytest.approx([1.2, 1.6, 0.0])
    assert last.values == at | {
        "water.waves.jonswap.Hs": 2.0,
        "water.waves.jonswap.Tp": 8.0,
        "water.surface_level": 13.0,
        "water.waves.jonswap.direction_deg": 180.5,
        "seabed.stiffness": 2.0e5,
        "line_types.pipe.EI": 150.0,
        "water.waves.jonswap.seed": 3,
    }
    assert last.labels == {
        "sea state": "storm", "direction": "180.5", "offset": "far", "soil": "upper", "line_types.pipe.EI": "150",
        "seed": "3",
    }  # fmt: skip
    assert last.group == "storm-direction=180.5-far-upper-EI=150"


def test_near_is_towards_the_other_end_and_mean_is_no_offset(tmp_path: Path) -> None:
    all_cases = {case.name: case.values["vessel.offset"] for case in cases(tmp_path, "offsets: 5")}
    assert all_cases["near"] == pytest.approx([-3.0, -4.0, 0.0])
    assert all_cases["mean"] == [0.0, 0.0, 0.0]
    assert all_cases["far"] == pytest.approx([3.0, 4.0, 0.0])


def test_offsets_are_a_share_of_the_water_depth(tmp_path: Path) -> None:
    """The depth is 12 m, and 15 m over a seabed 3 m deeper."""
    for text, distance in (("offsets: 25 %", 3.0), ("set: {seabed.level: -3.0}\noffsets: 20%", 3.0)):
        _, _, far = cases(tmp_path, text)
        assert far.values["vessel.offset"] == pytest.approx([0.6 * distance, 0.8 * distance, 0.0])


def test_near_is_towards_the_end_where_the_start_hangs_from_the_vessel(tmp_path: Path) -> None:
    file = case_file(tmp_path, "offsets: 5.0")
    scene = tmp_path / "sea.yaml"
    turned = scene.read_text().replace(f"[{END}]", "[a]").replace("[3.0, 4.0, 0.05]", f"[{END}]")
    scene.write_text(turned.replace("[a]", "[3.0, 4.0, 0.05]"), encoding="utf-8")
    near, *_ = read_cases(file)[1]
    assert near.values["vessel.offset"] == pytest.approx([-3.0, -4.0, 0.0])


def test_offsets_by_name_are_those_given(tmp_path: Path) -> None:
    all_cases = cases(tmp_path, "offsets: {north: [0, 2.5], low: [1.0, 0.0, -0.5]}")
    assert [(case.name, case.values["vessel.offset"]) for case in all_cases] == [
        ("north", [0.0, 2.5, 0.0]),
        ("low", [1.0, 0.0, -0.5]),
    ]


def test_seeds_in_a_list_and_of_other_spectra(tmp_path: Path) -> None:
    waves = "{pierson_moskowitz: {Hs: 1.0, Tp: 6.0, components: 10}}"
    all_cases = cases(tmp_path, "seeds: [7, 11]", waves)
    assert [case.values for case in all_cases] == [{"water.waves.pierson_moskowitz.seed": n} for n in (7, 11)]
    assert [case.group for case in all_cases] == ["all seeds"] * 2


def test_regular_waves_have_states_and_directions(tmp_path: Path) -> None:
    waves = "{airy: {height: 1.0, period: 6.0}}"
    (case,) = cases(tmp_path, "sea_states: {swell: {height: 0.4, period: 9.0}}\ndirections: [270]", waves)
    assert case.values == {
        "water.waves.airy.height": 0.4, "water.waves.airy.period": 9.0, "water.waves.airy.direction_deg": 270.0,
    }  # fmt: skip


def test_sea_states_of_a_csv_file(tmp_path: Path) -> None:
    (tmp_path / "states.csv").write_text("name, Hs, Tp\nmild, 0.5, 5.0\n, 1.5, 7.0\n", encoding="utf-8")
    all_cases = cases(tmp_path, "sea_states: states.csv")
    assert [case.name for case in all_cases] == ["mild", "Hs=1.5-Tp=7.0"]
    assert [[*case.values.values()] for case in all_cases] == [[0.5, 5.0], [1.5, 7.0]]


def test_rows_of_a_table_that_differ_in_their_seed_are_one_group(tmp_path: Path) -> None:
    rows = "name, water.waves.jonswap.Hs, water.waves.jonswap.seed\na, 1.0, 1\nb, 1.0, 2\nc, 2.0, 1\n"
    (tmp_path / "rows.csv").write_text(rows, encoding="utf-8")
    assert [case.group for case in cases(tmp_path, "table: rows.csv")] == ["Hs=1", "Hs=1", "Hs=2"]


MISTAKES = [
    ("seeds: 0", ":2: seeds: value 0: must be at least 1"),
    ("seeds: [1, -1]", ":2: seeds.1: value -1: must be at least 0"),
    ("seeds: many", ':2: seeds: value "many": must be how many seeds there are, or a list of them'),
    ("seeds: []", ":2: seeds: value []: must have at least 1 entries"),
    ("directions: []", ":2: directions: value []: must have at least 1 entries"),
    ("directions: [north]", ':2: directions.0: value "north": must be a number'),
    ("sea_states: {}", ":2: sea_states: value {}: must have at least 1 entries"),
    ("sea_states: {a/b: {Hs: 1.0}}", "a/b"),
    ("sea_states: {a: {Hx: 1.0}}", ": case a: water.waves.jonswap.Hx=1.0: water.waves.jonswap.Hx: value 1.0: no such"),
    ("soil: {}", ":2: soil: value {}: must have at least 1 entries"),
    ("soil: {lower: {seabed.stifness: 1.0}}", ": case lower: seabed.stifness=1.0: seabed.stifness: value 1.0: no such"),
    ("offsets: -3.0", ":2: offsets: value -3.0: must be "),
    ("offsets: {near: [1.0]}", ":2: offsets.near: value [1.0]: must be a list of 3 values"),
    ("offsets: near", ':2: offsets: value "near": must be a distance [m], a share of the water depth, as 5 %, or a'),
    ("offsets: [5.0]", ":2: offsets: value [5.0]: must be a distance [m], a share of the water depth, as 5 %, or a"),
    ("offsets: -5 %", ':2: offsets: value "-5 %": must be a distance [m], a share of the water depth'),
    ("offsets: 0.0 %", ':2: offsets: value "0.0 %": must be a distance [m], a share of the water depth'),
    (
        "set: {seabed.slope_deg: 1.0}\noffsets: 5 %",
        ": offsets: 5 % of the water depth needs water.depth, or water.surface_level above a level seabed",
    ),
    ("offsets: 2.0\nproduct: {vessel.offset: [[1.0, 0.0]]}", ": vessel.offset: is set 2 times in one case"),
    ("extremes: {fractile: 1.0}\nseeds: 2", ":2: extremes.fractile: value 1.0: must be less than 1"),
    ("extremes: {fractil: 0.9}\nseeds: 2", ":2: extremes.fractil: value 0.9: no such key here"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "says"), MISTAKES, ids=[text[:30] for text, _ in MISTAKES])
def test_a_mistake_is_one_line(text: str, says: str, tmp_path: Path) -> None:
    require_refusal(case_file(tmp_path, text), says)


def test_a_mistake_of_many_cases_is_one_line(tmp_path: Path) -> None:
    file = case_file(tmp_path, "soil: {lower: {seabed.stiffness: -1.0}}\nseeds: 9")
    with pytest.raises(SceneError) as refused:
        read_cases(file)
    (line,) = str(refused.value).splitlines()
    assert line.startswith(f"{file}: case lower-seed=1 and 8 more: seabed.stiffness=-1.0: seabed.stiffness: value -1")


@pytest.mark.parametrize(
    ("text", "waves", "end", "says"),
    [
        (
            "seeds: 3",
            "{airy: {height: 1.0, period: 6.0}}",
            END,
            "seeds: the base scene's waves are airy, which have no seed; leave seeds out",
        ),
        ("directions: [0]", "null", END, "directions: the base scene has no waves; give it one kind under water.waves"),
        (
            "sea_states: {a: {Hs: 1.0}}",
            f"{{trains: [{JONSWAP}, {JONSWAP}]}}",
            END,
            "sea_states: the base scene has several trains of waves; set them by product",
        ),
        ("offsets: 3.0", JONSWAP, "3.0, 4.0, 40.0", "offsets: the riser's ends are above each other"),
    ],
)  # fmt: skip
def test_what_the_base_scene_has_not_is_one_line(text: str, waves: str, end: str, says: str, tmp_path: Path) -> None:
    file = case_file(tmp_path, text, waves, end)
    with pytest.raises(SceneError) as refused:
        read_cases(file)
    (line,) = str(refused.value).splitlines()
    assert line.startswith(f"{file}: {says}")
