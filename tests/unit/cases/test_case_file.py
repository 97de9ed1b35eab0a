"""Case files: what they may hold, the cases that follow, their names, and one line for each mistake."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from riser_soil.cases.expansion import Case, read_cases
from riser_soil.errors import SceneError
from riser_soil.scene.reader import read_scene
from tests.support.case_files import SMALL, case_file, require_refusal
from tests.support.on_ranks import ROOT
from tests.support.pages import blocks


def cases(folder: Path, text: str, *overrides: str) -> list[Case]:
    return read_cases(case_file(folder, text), overrides)[1]


def names(folder: Path, text: str) -> list[str]:
    return [case.name for case in cases(folder, text)]


def test_every_combination_is_a_case(tmp_path: Path) -> None:
    all_cases = cases(
        tmp_path,
        """
        table:
          - {name: light, set: {line_types.pipe.mass: 15.0}}
          - {set: {line_types.pipe.mass: 30.0, riser.start.rotation: fixed}}
        product:
          line_types.pipe.EI: [100.0, 250.5]
          offset:
            near: {riser.end.position.0: 8.5}
            far: {riser.end.position.0: 9.5, title: far out}
        """,
    )
    assert [case.name for case in all_cases] == [
        f"{row}-{EI}-{offset}"
        for row in ("light", "mass=30-rotation=fixed") for EI in ("EI=100", "EI=250.5") for offset in ("near", "far")
    ]  # fmt: skip
    assert all_cases[-1].values == {
        "line_types.pipe.mass": 30.0,
        "riser.start.rotation": "fixed",
        "line_types.pipe.EI": 250.5,
        "riser.end.position.0": 9.5,
        "title": "far out",
    }
    assert len({case.variant.key for case in all_cases}) == 8


def test_a_case_is_the_scene_that_run_would_make_of_it(tmp_path: Path) -> None:
    (case,) = cases(tmp_path, "set: {title: all}\nproduct: {riser.end.position: [[8.0, 0.0, 5.0]]}", "gravity=9.8")
    (tmp_path / "again.yaml").write_text(case.variant.text, encoding="utf-8")
    overrides = ["title=all", "gravity=9.8", "riser.end.position=[8.0, 0.0, 5.0]"]
    assert read_scene(tmp_path / "again.yaml") == read_scene(tmp_path / "small.yaml", overrides)
    assert case.name == "position_1"


def test_short_names_tell_paths_apart(tmp_path: Path) -> None:
    text = "product: {riser.start.position.0: [0.0], riser.end.position.0: [9], line_types.pipe.EI: [1.0e-5]}"
    assert names(tmp_path, text) == ["start_position_0=0-end_position_0=9-EI=1e-05"]


def test_rows_of_a_csv_file(tmp_path: Path) -> None:
    """An empty cell leaves the base's value; a cell is read as --set reads it."""
    rows = "name, line_types.pipe.EI, riser.end.position\n# a remark\nsoft, 100,\nfar, , \"[9.5, 0.0, 4.0]\"\n"
    (tmp_path / "table.csv").write_text(rows, encoding="utf-8")
    all_cases = cases(tmp_path, "table: table.csv")
    assert [(case.name, case.values) for case in all_cases] == [
        ("soft", {"line_types.pipe.EI": 100}),
        ("far", {"riser.end.position": [9.5, 0.0, 4.0]}),
    ]


def test_the_key_changes_with_what_the_results_hang_on(tmp_path: Path) -> None:
    """The scene, and the content of files that it names; not the name of the case nor where its results go."""
    pull = "[{name: pull, kind: dynamic, duration: 1.0, time_step: 0.1, motion: {end: {table: {file: way.csv}}}}]"
    way = "t [s], x [m], y [m], z [m]\n0, 0, 0, 0\n1, 0, 0, 0\n2, 0, 0, 0\n3, 0, 0, {}\n"
    (tmp_path / "way.csv").write_text(way.format("0.1"), encoding="utf-8")

    def key(text: str) -> str:
        return cases(tmp_path, text)[0].variant.key

    first = key(f"table: [{{name: a, set: {{stages: {pull}}}}}]")
    assert key(f"table: [{{name: b, set: {{stages: {pull}, output.directory: x}}}}]") == first
    assert key(f"table: [{{name: a, set: {{stages: {pull}, gravity: 9.8}}}}]") != first
    (tmp_path / "way.csv").write_text(way.format("0.2"), encoding="utf-8")
    assert key(f"table: [{{name: a, set: {{stages: {pull}}}}}]") != first


def test_a_case_is_another_one_where_the_run_that_it_begins_with_has_changed(tmp_path: Path) -> None:
    def key() -> str:
        return cases(tmp_path, f"product: {{initial.from: [{tmp_path / 'hung'}]}}")[0].variant.key

    (tmp_path / "hung").mkdir()
    keys = [key()]
    for state in (b"one", b"another"):
        (tmp_path / "hung/checkpoint.npz").write_bytes(state)
        keys.append(key())
    assert len({*keys}) == 3


def test_the_examples_of_the_page_are_those_of_the_demos() -> None:
    example, offsets = (ROOT / "demos" / name / "cases.yaml" for name in ("waves", "offsets"))
    assert blocks(ROOT / "docs/cases.md", "yml") == [each.read_text(encoding="utf-8") for each in (example, offsets)]
    case_file, all_cases = read_cases(example)
    assert (len(all_cases), case_file.statistics.since) == (54, 52.0)
    assert all_cases[-1].name == "storm-direction=195-far-seed=3"


MISTAKES = [
    ("set: {gravity: 9.7}\nproduct: {gravity: [9.8]}", "case gravity=9.8: gravity=9.8: gravity: undoes"),
    (
        "product: {riser.end.position.0: [8.0], riser.end.position: [[8.0, 0.0, 5.0]]}",
        "riser.end.position: undoes",
    ),
    ("bas: other.yaml\nproduct: {gravity: [9.8]}", ':2: bas: value "other.yaml": no such key here, known are base,'),
    ("", ": its cases differ in nothing; give one of sea_states, directions, offsets,"),
    ("table: [{name: a/b, set: {gravity: 9.8}}]", ":2: table.0.name: value \"a/b\": must be a name of at most 100"),
    ("table: [{name: .a, set: {gravity: 9.8}}]", ":2: table.0.name: value \".a\": must be a name of at most 100"),
    ("table: [{name: a, sett: {gravity: 9.8}}]", ":2: table.0.sett: value {\"gravity\": 9.8}: no such key here, "),
    ("table: [{name: a, set: {}}]", ":2: table.0.set: value {}: must have at least 1 entries"),
    ("table: no.csv", ":2: table: value \"no.csv\": "),
    ("product: {gravity: 9.8}", ":2: product.gravity: value 9.8: must be a list of values, or a mapping of names"),
    ("product: {gravity: []}", ":2: product.gravity: value []: must have at least 1 entries"),
    ("product: {gravity: [9.8, 9.8]}", ": 2 cases would be named gravity=9.8; give rows and groups names of their own"),
    (
        "table: [{name: a, set: {gravity: 9.8}}]\nproduct: {gravity: [9.7]}",
        ": gravity: is set 2 times in one case; let one key alone set it",
    ),
    ("product: {gravity: [!!python/object/apply:os.system [ls]]}", ":2: product.gravity.0: tag tag:yaml.org,2002:"),
    ("product: {gravity: [-1.0]}", ": case gravity=-1: gravity=-1.0: gravity: value -1.0: must be at least 0"),
    ("product: {gravty: [9.0]}", ": case gravty=9: gravty=9.0: gravty: value 9.0: no such key here"),
    (f"product: {{title: [{'x' * 120}]}}", "more than 100 letters; give rows and groups short names"),
    (f"product: {{a: {list(range(400))}, b: {list(range(400))}}}", ": 160000 cases, more than 100000; divide them"),
]


@pytest.mark.parametrize(("text", "says"), MISTAKES, ids=[says[:40] for _, says in MISTAKES])
def test_a_mistake_is_reported_in_one_line_before_anything_is_run(text: str, says: str, tmp_path: Path) -> None:
    require_refusal(case_file(tmp_path, text), says)


def test_a_mistake_of_the_base_is_reported_once_whatever_the_number_of_cases(tmp_path: Path) -> None:
    file = case_file(tmp_path, "product: {gravity: [9.7, 9.8, 9.9]}")
    (tmp_path / "small.yaml").write_text(SMALL.replace("mass: 20.0", "mass: -20.0"), encoding="utf-8")
    with pytest.raises(SceneError, match=r"\A.*small.yaml:2: line_types.pipe.mass: value -20.0: [^\n]*\Z"):
        read_cases(file)


def test_mistakes_of_many_cases_are_cut_off(tmp_path: Path) -> None:
    file = case_file(tmp_path, f"product: {{gravity: {json.dumps([-1.0 - n for n in range(30)])}}}")
    with pytest.raises(SceneError) as refused:
        read_cases(file)
    lines = str(refused.value).splitlines()
    assert (len(lines), lines[-1]) == (21, "… and 10 more")


@pytest.mark.parametrize(
    ("table", "says"),
    [
        ("name, gravity\n", "must have a line of paths of the scene, and a row for each case; complete it"),
        ("name, gravity\na\n", "table.csv:2: the row has 1 values for 2 columns; complete it"),
        ("name, gravity, gravity\na, 1, 2\n", "table.csv:1: every column needs a path of its own"),
        ("name, gravity\na, {9.8\n", "table.csv:2:1: not valid YAML"),
    ],
)
def test_a_wrong_csv_file_is_reported_with_its_line(table: str, says: str, tmp_path: Path) -> None:
    (tmp_path / "table.csv").write_text(table, encoding="utf-8")
    with pytest.raises(SceneError) as refused:
        cases(tmp_path, "table: table.csv")
    (line,) = str(refused.value).splitlines()
    assert says in line
