"""Chapters on many cases: governing ones, sensitivity, seeds, code checks, fatigue, modes; a scene that reads back."""

from __future__ import annotations

import csv
import json
import shutil
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from ruamel.yaml import YAML

from riser_soil.report.basis import ends_in_words
from riser_soil.report.document import Heading, Item, Paragraph, PictureBlock, Points, TableBlock, numbered
from riser_soil.report.report import document_of
from riser_soil.report.report_file import of_folders
from riser_soil.report.reproduction import pruned, scene_text
from riser_soil.report.sources import Sources, opened, short_names
from riser_soil.report.tables import ReportTable
from riser_soil.results import Run
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.whole_run import run as run_scene
from tests.support.on_ranks import ROOT
from tests.support.recorded_run import record
from tests.support.said import line_with
from tests.support.scenes import prescribed, riser_scene, static

Changed = Callable[[dict[str, Any]], None]


def write_cases(
    folder: Path, run: Path, axes: Sequence[str], rows: Mapping[str, tuple[Mapping[str, str], Changed]]
) -> None:
    """A folder of riser-soil cases: a copy of the run for each, its summary changed.

    axes: heads of the columns behind the name. rows: values by these heads, and what is done to the summary.
    """
    (folder / "cases").mkdir(parents=True)
    with (folder / "cases.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["case", *axes, "status", "reason", "seconds [s]", "machine"])
        for name, (values, changed) in rows.items():
            writer.writerow([name, *(values.get(axis, "") for axis in axes), "0", "", "1", "here"])
            place = folder / "cases" / name
            shutil.copytree(run, place)
            summary = json.loads((place / "summary.json").read_text(encoding="utf-8"))
            changed(summary)
            (place / "summary.json").write_text(json.dumps(summary), encoding="utf-8")


def scaled(figure: str, factor: float, stage: int = 1) -> Changed:
    """Multiplies a figure's extremes in a stage of a summary."""

    def change(summary: dict[str, Any]) -> None:
        extremes = summary["stages"][stage]["extremes"][figure]
        for side in ("min", "max"):
            extremes[side] *= factor

    return change


def write_fatigue(folder: Path, arc: Sequence[float], damage: Sequence[float], **design: Any) -> None:
    """A folder of riser-soil fatigue with two points around each section, of which the second has a tenth."""
    folder.mkdir()
    with (folder / "fatigue.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["arc_m", "angle_deg", "diameter_m", "thickness_m", "damage_per_year", "life_years"])
        for s, largest in zip(arc, damage, strict=True):
            for angle, share in ((90.0, 1.0), (270.0, 0.1)):
                life = 1.0 / (share * largest) if largest else float("inf")
                writer.writerow([s, angle, 0.3, 0.02, share * largest, life])
    worst = max(damage)
    sea = {"height": 3.0, "period": 9.0, "direction_deg": 180.0}
    each = {"seconds": 600.0, "standard_error": 0.1, "touchdown_arc": [28.0, 33.0], "sea": sea}
    numbers = {
        "curve": {"name": "DNV D, air", "source": "DNVGL-RP-C203 (April 2016), Table 2-1"},
        "stress_concentration": 1.2, "factor_on_ranges": 1.25, "surface": "outer", "points": 2, "share": 0.9,
        "largest": {"damage_per_year": worst, "standard_error": 0.079},
        "design": {"life_years": None, "fatigue_factor": 1.0, "utilisation": None} | design,
        "cases": [
            {"run": "../results/sea_states/calm", "share": 0.7, "damage_per_year": 0.25 * worst} | each,
            {"run": "/home/someone/storm", "share": 0.2, "damage_per_year": 0.75 * worst} | each,
        ],
        "warnings": [],
    }  # fmt: skip
    (folder / "fatigue.json").write_text(json.dumps(numbers), encoding="utf-8")


SCENE = (ROOT / "demos/first_scene.yaml").read_text(encoding="utf-8")
MOMENT = "max_bending_moment"
FACTORS = {"mean": (1.0, 1.2, 1.1), "near": (1.5, 1.9, 1.4), "far": (0.8, 0.7, 0.9)}  # of the moment, by seed


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("chapters") / "run"
    record(folder, duration=0.4)
    (folder / "scene.yaml").write_text(SCENE, encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def cases(run: Path) -> Path:
    """Three offsets by three seeds, and two soils at the mean offset with the first seed."""
    rows: dict[str, tuple[dict[str, str], Changed]] = {}
    for offset, factors in FACTORS.items():
        for seed, factor in enumerate(factors, 1):
            x = {"near": -5.0, "mean": 0.0, "far": 5.0}[offset]
            axes = {"offset": offset, "soil": "best", "seed": str(seed), "vessel.offset": f"[{x}, 0.0]"}
            rows[f"{offset}-best-seed={seed}"] = (axes, moved(x, scaled(MOMENT, factor)))
    for soil, factor in {"lower": 0.95, "upper": 1.0 + 1e-9}.items():
        axes = {"offset": "mean", "soil": soil, "seed": "1", "vessel.offset": "[0.0, 0.0]"}
        rows[f"mean-{soil}-seed=1"] = (axes | {"seabed.stiffness": "1"}, moved(0.0, scaled(MOMENT, factor)))
    folder = run.parent / "cases"
    write_cases(folder, run, ("offset", "soil", "seed", "vessel.offset", "seabed.stiffness"), rows)
    for soil, stiffness in {"lower": 3.0e4, "upper": 3.0e5}.items():
        scene = SCENE.replace("stiffness: 1.0e5", f"stiffness: {stiffness}")
        (folder / "cases" / f"mean-{soil}-seed=1" / "scene.yaml").write_text(scene, encoding="utf-8")
    return folder


def moved(x: float, change: Changed) -> Changed:
    """A change, and an offset of the vessel."""

    def both(summary: dict[str, Any]) -> None:
        change(summary)
        summary["vessel"] = {"offset": [x, 0.0, 0.0], "ends": {}}

    return both


def opened_at(*folders: Path, **options: Any) -> Sources:
    return opened(of_folders([*folders], options))


def items_of(sources: Sources) -> list[Item]:
    return numbered(document_of(sources))


def table(items: list[Item], key: str) -> ReportTable:
    return next(item.content for item in items if isinstance(item, TableBlock) and item.key == key)


def said(items: list[Item]) -> str:
    return "\n".join(item.text for item in items if isinstance(item, Paragraph))


def test_one_document_has_a_row_a_case_and_names_the_governing_one(run: Path, cases: Path) -> None:
    items = items_of(opened_at(cases))
    moments = {row[0]: float(row[3]) for row in table(items, "extremes").rows}
    own = 1e-3 * Run(run).summary["stages"][1]["extremes"][MOMENT]["max"]
    assert len(moments) == 11
    assert moments["near-best-seed=2"] == pytest.approx(1.9 * own, rel=1e-3)
    entry = next(row for row in table(items, "summary").rows if row[0] == "maximum bending moment")
    assert entry[3] == "near-best-seed=2"
    assert float(entry[1]) == pytest.approx(1.9 * own, rel=1e-3)
    titles = [item.title for item in items if isinstance(item, Heading) and item.level == 1]
    assert titles.count("Extremes") == 1


def test_seeds_are_one_group_with_mean_and_extreme(run: Path, cases: Path) -> None:
    sources = opened_at(cases)
    assert {name: len(group) for name, group in sources.groups.items()} == {
        "mean, best": 3, "near, best": 3, "far, best": 3, "mean, lower": 1, "mean, upper": 1,
    }  # fmt: skip
    own = 1e-3 * Run(run).summary["stages"][1]["extremes"][MOMENT]["max"]
    rows = table(items_of(sources), "seeds").rows
    entry = next(row for row in rows if row[:2] == ["near, best", "maximum bending moment"])
    assert [float(value) for value in entry[3:]] == pytest.approx(
        [3, own * np.mean(FACTORS["near"]), own * np.std(FACTORS["near"], ddof=1), own * 1.9], rel=1e-3
    )


def test_a_parameter_is_varied_alone_and_what_is_less_than_the_error_bar_is_a_dash(cases: Path) -> None:
    """Offsets are compared over three seeds, soils with the reference's first seed."""
    items = items_of(opened_at(cases))
    content = table(items, "sensitivity")
    at = next(n for n, head in enumerate(content.head) if "bending moment" in head)
    rows = {(row[0], row[1]): row[at] for row in content.rows}
    mean = np.mean(FACTORS["mean"])
    for offset in ("near", "far"):
        change = 100.0 * (np.mean(FACTORS[offset]) / mean - 1.0)
        assert float(rows["offset", offset].replace("−", "-").removesuffix(" %")) == pytest.approx(change, rel=1e-2)
    assert float(rows["soil", "lower"].replace("−", "-").removesuffix(" %")) == pytest.approx(-5.0, rel=1e-2)
    assert rows["soil", "upper"] == "–"
    assert [item for item in items if isinstance(item, PictureBlock) and item.caption.startswith("Tornado")]


def test_an_error_bar_decides_what_a_difference_is(run: Path, tmp_path: Path) -> None:
    own = Run(run).summary["stages"][1]["extremes"][MOMENT]["max"]

    def barred(share: float) -> Changed:
        def change(summary: dict[str, Any]) -> None:
            scaled(MOMENT, 1.02)(summary)
            bar = {"stage": "heave", "name": "largest bending moment", "unit": "N.m", "value": own, "bar": share * own}
            summary["error_bars"] = {"quantities": [bar | {"by_source": {}}]}

        return change

    axes = ("vessel.offset",)
    rows = {"a": ({"vessel.offset": "[0, 0]"}, moved(0.0, lambda _: None))}
    for name, share in (("wide", 0.05), ("narrow", 0.001)):
        rows[name] = ({"vessel.offset": "[1, 0]"}, moved(1.0, barred(share)))
        write_cases(tmp_path / name, run, axes, rows)
        content = table(items_of(opened_at(tmp_path / name, reference="a")), "sensitivity")
        at = next(n for n, head in enumerate(content.head) if "bending moment" in head)
        assert content.rows[1][at] == {"wide": "–", "narrow": "+2 %"}[name]
        del rows[name]


def test_the_appendix_has_a_row_a_case_of_what_differs(run: Path, tmp_path: Path) -> None:
    """A value that all cases share is in the input file alone."""
    axes = ("vessel.offset", "water.density")
    places = {"near": 0.0, "far": 1.0}
    given = {name: {"vessel.offset": f"[{place}, 0]", "water.density": "1025.0"} for name, place in places.items()}
    rows = {name: (values, moved(places[name], lambda _: None)) for name, values in given.items()}
    write_cases(tmp_path, run, axes, rows)
    content = table(items_of(opened_at(tmp_path, reference="near")), "differences")
    assert [head.replace("\u200b", "") for head in content.head] == ["load case", "vessel.offset"]
    assert [list(row) for row in content.rows] == [["near", "0, 0"], ["far", "1, 0"]]


def test_error_bars_asked_for_in_some_cases_are_no_parameter(run: Path, tmp_path: Path) -> None:
    """A key of the scene without a dot is a value, not an axis of the case file."""
    axes = ("soil", "vessel.offset", "error_bars")
    rows: dict[str, tuple[dict[str, str], Changed]] = {
        "a": ({"soil": "soft", "vessel.offset": "[0, 0]"}, moved(0.0, lambda _: None)),
        "b": ({"soil": "stiff", "vessel.offset": "[0, 0]", "error_bars": "True"}, moved(0.0, lambda _: None)),
    }
    write_cases(tmp_path, run, axes, rows)
    content = table(items_of(opened_at(tmp_path)), "cases")
    assert list(content.head) == ["load case", "soil"]
    assert [list(row) for row in content.rows] == [["a", "soft"], ["b", "stiff"]]


def test_static_configurations_that_are_one_have_one_row(cases: Path) -> None:
    rows = table(items_of(opened_at(cases)), "static").rows
    assert len(rows) == 1, "offsets and seeds of the recorded run hang alike"
    assert rows[0][0] == "all load cases"


def test_a_warning_of_several_cases_is_one_point_in_words_of_the_field(run: Path, tmp_path: Path) -> None:
    def warned(summary: dict[str, Any]) -> None:
        summary["warnings"] = ["heave: off by 3 % (limit 2 %), see /home/x/scene.yaml"]

    rows = {name: ({"seed": name}, warned if name != "3" else lambda _: None) for name in "123"}
    write_cases(tmp_path / "cases", run, ("seed",), rows)
    (points,) = (item for item in items_of(opened_at(tmp_path / "cases")) if isinstance(item, Points))
    assert points.items == ["heave: off by 3 % (limit 2 %), see scene.yaml (1, 2)"]


def test_failed_cases_are_named_with_their_reason(run: Path, tmp_path: Path) -> None:
    write_cases(tmp_path / "cases", run, ("seed",), {"a": ({"seed": "1"}, lambda _: None)})
    with (tmp_path / "cases" / "cases.csv").open("a", newline="", encoding="utf-8") as file:
        csv.writer(file).writerow(["b", "2", "3", "no convergence in /home/x/cases/b at 3 s", "1", "here"])
    line_with(said(items_of(opened_at(tmp_path / "cases"))), "Not computed", "b: no convergence in b at 3 s")


def test_characteristic_extremes_are_those_of_the_cases_folder(run: Path, tmp_path: Path) -> None:
    write_cases(tmp_path / "cases", run, ("seed",), {str(n): ({"seed": str(n)}, lambda _: None) for n in (1, 2, 3)})
    row = {
        "group": "storm", "quantity": "heave: top tension", "unit": "N", "extreme": "largest", "seeds": "3",
        "simulated [s]": "1.2", "mean": "1.0e6", "standard deviation": "1e4", "of seeds": "1.1e6",
        "duration [s]": "10800", "most probable": "1.15e6", "fractile": "0.9", "characteristic": "1.2e6",
        "low": "1.1e6", "high": "1.3e6", "confidence": "0.95", "location": "1", "scale": "1",
    }  # fmt: skip
    with (tmp_path / "cases" / "characteristic.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(row))
        writer.writeheader()
        writer.writerow(row)
        writer.writerow(row | {"quantity": "heave: code utilisation", "standard deviation": "1e-9"})
        none = dict.fromkeys(("characteristic", "low", "high"), "")
        writer.writerow(row | {"quantity": "heave: touchdown arc", "unit": "m"} | none)
    content = table(items_of(opened_at(tmp_path / "cases")), "characteristic")
    assert content.rows[0] == ["storm", "tension at the hang-off", "kN", "3", "1000", "1100", "1200", "1100", "1300"]
    assert [cells[1] for cells in content.rows] == ["tension at the hang-off", "arc length of the TDP"], "that scatter"
    assert content.rows[1][-3:] == ["–", "–", "–"]
    line_with(content.note, "90 % fractile", "3 hours", "95 % confidence")


def test_code_checks_name_clause_case_and_place(run: Path, tmp_path: Path) -> None:
    def checked(utilisation: float) -> Changed:
        def change(summary: dict[str, Any]) -> None:
            summary["stages"][1]["code_check"] = [
                {
                    "line_type": "flexible", "code": "DNV-ST-F201", "check": check, "clause": "5.5", "utilisation": use,
                    "variable": "combined_loading_utilisation", "limit_state": "ULS", "safety_class": "high",
                    "arc": 30.0, "time": 0.3, "exceeded": use > 1.0,
                }
                for check, use in (("combined loading", utilisation), ("bursting", 0.5))
            ]  # fmt: skip

        return change

    axes = {"a": ({"seed": "1"}, checked(0.81)), "b": ({"seed": "2"}, checked(0.92))}
    write_cases(tmp_path / "cases", run, ("seed",), axes)
    items = items_of(opened_at(tmp_path / "cases"))
    rows = table(items, "checks").rows
    assert len(rows) == 2
    assert rows[0][:6] == ["flexible", "DNV-ST-F201", "combined loading", "ULS", "high", "0.920"]
    assert rows[0][6:8] == ["b", "heave"]
    line_with(table(items, "checks").note, "combined loading: 5.5")
    assert "No code check" not in said(items)
    line_with(said(items), "All checks are fulfilled")
    write_cases(tmp_path / "beyond", run, ("seed",), {"a": ({"seed": "1"}, checked(1.03))})
    line_with(said(items_of(opened_at(tmp_path / "beyond"))), "Exceeded", "combined loading of flexible", "1.030 in a")
    write_cases(tmp_path / "just", run, ("seed",), {"a": ({"seed": "1"}, checked(1.0003))})
    just = said(items_of(opened_at(tmp_path / "just")))
    line_with(just, "Exceeded", "combined loading of flexible", "1.000 in a")
    assert "All checks are fulfilled" not in just


def test_fatigue_has_life_hotspots_and_shares(run: Path, tmp_path: Path) -> None:
    arc, damage = np.linspace(0.0, 148.0, 38), np.full(38, 1e-6)
    damage[8], damage[9], damage[25] = 2.0e-3, 1.9e-3, 5.0e-4
    write_fatigue(tmp_path / "damage", arc.tolist(), damage.tolist(), life_years=20.0, fatigue_factor=10.0)
    items = items_of(opened_at(run, tmp_path / "damage"))
    hotspots = table(items, "hotspots").rows
    places = [tuple(float(row[n]) for n in (1, 2, 4)) for row in hotspots[:2]]
    assert places == [(32.0, 90.0, 500.0), (100.0, 90.0, 2000.0)]
    assert float(hotspots[0][5]) == pytest.approx(20.0 * 10.0 / 500.0)
    assert [(row[0], row[3]) for row in table(items, "shares").rows] == [("storm", "75"), ("calm", "25")]
    assert [row[:5] for row in table(items, "scatter").rows] == [
        ["calm", "3", "9", "180", "70"], ["storm", "3", "9", "180", "20"],
    ]  # fmt: skip
    line_with(said(items), "500 years", "arc length 32 m", "20 years", "(DFF) of 10", "200 years", "fulfilled", "8 %")
    summary = next(row for row in table(items, "summary").rows if row[0] == "shortest fatigue life")
    assert (summary[1], summary[-1]) == ("500", "0.400")
    asked = items_of(opened_at(run, tmp_path / "damage", required_life=60.0))
    line_with(said(asked), "Exceeded", "fatigue life, utilisation 1.2")


def test_sea_states_have_their_folder_s_last_name_unless_two_are_the_same() -> None:
    named = short_names(["../results/seas/cases/Hs1", "/home/someone/Hs2", "east/cases/Hs3", "west/cases/Hs3", "Hs4"])
    assert [*named.values()] == ["Hs1", "Hs2", "east/cases/Hs3", "west/cases/Hs3", "Hs4"]
    assert short_names(["deep/Hs1", "Hs1", "deep/Hs1"]) == {"deep/Hs1": "deep/Hs1", "Hs1": "Hs1"}


def test_warnings_on_fatigue_call_sea_states_by_the_same_names(run: Path, tmp_path: Path) -> None:
    write_fatigue(tmp_path / "damage", [0.0, 50.0, 100.0], [0.0, 1e-3, 0.0])
    file = tmp_path / "damage/fatigue.json"
    numbers = json.loads(file.read_text(encoding="utf-8"))
    numbers["warnings"] = [f"{numbers['cases'][0]['run']}: few records"]
    file.write_text(json.dumps(numbers), encoding="utf-8")
    points = [text for item in items_of(opened_at(run, tmp_path / "damage")) if isinstance(item, Points)
              for text in item.items]  # fmt: skip
    assert "calm: few records" in points


def test_the_basis_has_bend_stiffener_and_flex_joint() -> None:
    file = ROOT / "demos/flexible_report/scene.yaml"
    stiffened = " ".join(ends_in_words(read_scene(file)))
    line_with([stiffened], "End B cannot turn against its support.", "bend stiffener at end B is 3.5 m long")
    line_with([stiffened], "800 mm at its base", "340 mm at its tip", "70 MPa")
    jointed = read_scene(file, ["riser.end.bend_stiffener=null", "riser.end.rotation={stiffness: 2.0e4}"])
    assert [*ends_in_words(jointed)] == ["End B has a flex joint of 20 kN m/rad."]


def test_the_summary_says_what_is_not_assessed_and_why(run: Path, tmp_path: Path) -> None:
    line_with(said(items_of(opened_at(run))), "Fatigue is not assessed.", "Natural periods are not computed.")
    reason = {"fatigue": "S-N data come from the maker"}
    explained = items_of(opened_at(run, not_assessed=reason))
    line_with(said(explained), "Fatigue is not assessed: S-N data come from the maker.")
    assert not [item for item in explained if isinstance(item, Heading) and item.title == "Fatigue"]
    write_fatigue(tmp_path / "damage", [0.0, 50.0], [0.0, 1e-3])
    assert "Fatigue is not assessed" not in said(items_of(opened_at(run, tmp_path / "damage")))


def test_life_without_end_and_damage_nowhere(run: Path, tmp_path: Path) -> None:
    write_fatigue(tmp_path / "damage", [0.0, 50.0, 100.0], [0.0, 0.0, 0.0])
    items = items_of(opened_at(run, tmp_path / "damage"))
    line_with(said(items), "There is no damage")
    for item in items:
        if isinstance(item, PictureBlock) and item.caption.startswith("Fatigue"):
            assert item.drawing.content(".svg")


def test_modes_have_periods_and_shapes(run: Path, tmp_path: Path) -> None:
    place = tmp_path / "modes"
    place.mkdir()
    arc = np.linspace(0.0, 100.0, 11)
    with h5py.File(place / "modes.nc", "w") as file:
        file.attrs["stage"] = "lay"
        file["frequency"], file["share"] = np.array([0.05, 0.1]), np.array([[0.9, 0.1, 0.0], [0.8, 0.2, 0.0]])
        file["direction"] = ["in plane", "out of plane", "axial"]
        file["arc"], file["position"] = arc, np.column_stack([arc, 0.0 * arc, 0.2 * arc])
        file["shape"] = np.stack([np.column_stack([0.0 * arc, 0.0 * arc, np.sin(k * arc / 30.0)]) for k in (1, 2)])
    items = items_of(opened_at(run, place))
    content = table(items, "modes")
    assert content.rows[0][:3] == ["1", "0.05", "20"]
    assert "axial [%]" not in content.head
    begins = "Shapes of the first 2"
    (shapes,) = (item for item in items if isinstance(item, PictureBlock) and item.caption.startswith(begins))
    assert shapes.drawing.content(".svg")


def test_a_scene_in_the_appendix_has_nothing_absent_and_names_of_files_alone() -> None:
    absent: dict[str, Any] = {"none": None, "empty": {"a": None}, "list": []}
    given = {"rao": "/home/x/rao.csv", "stages": [{"b": None, "c": [0.0]}]} | absent
    assert pruned(given) == {"rao": "rao.csv", "stages": [{"c": [0.0]}]}


def test_a_line_without_anything_along_time_is_reported(tmp_path: Path) -> None:
    """A riser that hangs, without seabed, water and motion; its scene reads back from the appendix as it was."""
    pipe = {"EA": 1.0e8, "EI": 1.0e3, "mass": 20.0, "submerged_weight": 100.0, "outer_diameter": 0.2}
    ends = {"start": prescribed(0.0, 0.0, 10.0), "end": prescribed(30.0, 0.0, 20.0, rotation={"stiffness": 10.0})}
    more = ends | {"riser": {"initial": "catenary"}, "gravity": 9.81}
    scene = scene_from_mapping(riser_scene(static(), pipe=pipe, length=40.0, elements=8, **more))
    run_scene(scene, tmp_path / "run")
    sources = opened_at(tmp_path / "run")
    items = items_of(sources)
    assert [item.title for item in items if isinstance(item, Heading) and item.level == 1] == [
        "Summary", "Basis", "Static configuration", "Code checks", "Numerical quality",
        "How to reproduce the results", "Input file",
    ]  # fmt: skip
    line_with(said(items), "one load case, computed by static analysis")
    assert "End B has a flex joint of 0.01 kN m/rad." in said(items)
    assert table(items, "static reactions").rows
    assert not [row for row in table(items, "summary").rows if "seabed" in row[0]], "there is none"
    written = YAML(typ="safe").load(scene_text(sources.first))
    assert scene_from_mapping(written) == Run(tmp_path / "run").read_scene()
    assert json.dumps(written).count("null") == 0
    for item in items:
        if isinstance(item, PictureBlock):
            assert item.drawing.content(".svg")
    assert not [item for item in items if isinstance(item, Points)]


def test_what_is_not_recorded_along_the_line_has_no_picture(tmp_path: Path) -> None:
    """Two runs of the first scene that record no field: all that is drawn can be drawn."""
    for name, amplitude in (("a", 1.5), ("b", 1.0)):
        scene = YAML(typ="safe").load(SCENE)
        scene["output"]["fields"] = []
        scene["stages"][1]["duration"] = 0.3
        scene["stages"][1]["motion"]["end"]["harmonic"]["amplitude"] = [0.0, 0.0, amplitude]
        run_scene(scene_from_mapping(scene), tmp_path / name)
    pictures = [item for item in items_of(opened_at(tmp_path / "a", tmp_path / "b")) if isinstance(item, PictureBlock)]
    assert [item for item in pictures if item.caption.startswith("Ends in time")]
    assert [item for item in pictures if item.caption.startswith("Static shapes")] == [], "they hang alike"
    for item in pictures:
        assert item.drawing.content(".svg")
