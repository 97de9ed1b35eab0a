"""Numbers of a scene in the unit of another system: each is told with its likely unit and what it would be in SI units;
scenes as they should be are told of nothing.
"""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from riser_soil.checks.check import describe
from riser_soil.commands.app import app
from riser_soil.drafts.text import draft
from riser_soil.drafts.wishes import KINDS, Wishes
from riser_soil.scene.document import parse
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.sizes import doubts
from tests.support.said import line_with

ROOT = Path(__file__).resolve().parents[3]
MM, INCH, PSI = 1e-3, 0.0254, 6894.757

STEEL: dict[str, Any] = {
    "outer_diameter": 0.3239, "inner_diameter": 0.2731, "mass": 187.0, "EA": 4.93e9, "EI": 5.53e7, "GJ": 4.26e7,
    "min_bend_radius": 40.0, "max_tension": 3.0e6, "wall": {"yield_stress": 4.48e8, "design_factor": 0.67},
    "drag": {"normal": 1.0}, "added_mass": {"normal": 1.0},
}  # fmt: skip
FLEXIBLE: dict[str, Any] = {
    "outer_diameter": 0.42, "inner_diameter": 0.25, "mass": 280.0, "EA": 6.0e8, "EI": 1.4e5, "GJ": 1.1e6,
}  # fmt: skip
CLAY = {"kind": "randolph-quiggin", "su": 2.4e3, "su_gradient": 1.3e3, "unit_weight": 5.2e3}
SCENE: dict[str, Any] = {
    "gravity": 9.81,
    "water": {
        "density": 1026.0, "surface_level": 900.0,
        "current": {"profile": [[0.0, 0.0, 0.0], [900.0, 1.1, 0.6]]},
        "waves": {"jonswap": {"Hs": 5.5, "Tp": 11.0, "seed": 3}},
    },
    "line_types": {"steel": STEEL, "flexible": FLEXIBLE},
    "riser": {
        "contents": {"density": 780.0, "pressure": 2.1e7},
        "segments": [
            {"line_type": "steel", "length": 600.0, "element_length": 5.0},
            {"line_type": "flexible", "length": 700.0, "element_length": 5.0},
        ],
        "start": {"position": [0.0, 0.0, 0.16195]},
        "end": {"position": [700.0, 0.0, 880.0], "hang_off": {"angle": 15.0}},
    },
    "seabed": {"kind": "hysteretic", "law": CLAY},
    "stages": [
        {"name": "rest", "kind": "static", "pressure": 2.5e7},
        {"name": "storm", "kind": "dynamic", "duration": 20.0, "time_step": 0.1, "motion": {
            "end": {"harmonic": {"amplitude": [1.1, 0.0, 1.4], "period": 11.0}}}},
    ],
}  # fmt: skip

# path: what one of another unit is in SI units, by the unit's name.
UNITS: dict[str, dict[str, float]] = {
    "gravity": {"cm/s2": 0.01},
    "water.density": {"t/m3": 1e3, "lb/ft3": 16.01846},
    "water.surface_level": {"mm": MM},
    "water.current.profile.1.1": {"cm/s": 0.01},
    "water.waves.jonswap.Hs": {"cm": 0.01, "mm": MM},
    "water.waves.jonswap.Tp": {"ms": 1e-3},
    "line_types.steel.outer_diameter": {"mm": MM, "inches": INCH},
    "line_types.steel.inner_diameter": {"mm": MM, "inches": INCH},
    "line_types.steel.mass": {"t/m": 1e3, "lb/ft": 1.488164, "kN/m": 101.936, "N/m": 0.101936},
    "line_types.steel.EA": {"kN": 1e3, "MN": 1e6},
    "line_types.steel.EI": {"kN.m2": 1e3},
    "line_types.steel.GJ": {"kN.m2": 1e3},
    "line_types.steel.min_bend_radius": {"mm": MM},
    "line_types.steel.max_tension": {"kN": 1e3},
    "line_types.steel.wall.yield_stress": {"MPa": 1e6, "ksi": 1e3 * PSI, "psi": PSI, "kPa": 1e3},
    "line_types.flexible.outer_diameter": {"mm": MM, "inches": INCH},
    "line_types.flexible.mass": {"t/m": 1e3},
    "line_types.flexible.EA": {"kN": 1e3, "MN": 1e6},
    "line_types.flexible.EI": {"kN.m2": 1e3},
    "riser.contents.density": {"t/m3": 1e3},
    "riser.contents.pressure": {"MPa": 1e6, "bar": 1e5},
    "riser.segments.1.length": {"mm": MM},
    "riser.end.position.2": {"mm": MM},
    "riser.end.hang_off.angle": {"rad": 57.29578},
    "seabed.law.su": {"kPa": 1e3},
    "seabed.law.su_gradient": {"kPa/m": 1e3},
    "seabed.law.unit_weight": {"kN/m3": 1e3},
    "stages.0.pressure": {"MPa": 1e6, "bar": 1e5},
    "stages.1.motion.end.harmonic.amplitude.2": {"mm": MM, "cm": 0.01},
}
EACH = [(path, unit, factor) for path, units in UNITS.items() for unit, factor in units.items()]


def put(data: Any, path: str, value: Any) -> Any:
    """A copy with a value at a path, and the value that was there."""
    changed = copy.deepcopy(data)
    *way, last = (int(word) if word.isdecimal() else word for word in path.split("."))
    place = changed
    for key in way:
        place = place[key]
    before, place[last] = place[last], value
    return changed, before


def said(data: Any) -> dict[str, str]:
    return {".".join(map(str, path)): text for path, text in doubts(data)}


@pytest.mark.parametrize(("path", "unit", "factor"), EACH)
def test_each_number_in_another_unit_is_told_with_what_it_would_be(path: str, unit: str, factor: float) -> None:
    _, right = put(SCENE, path, None)
    text = said(put(SCENE, path, right / factor)[0])
    assert path in text, text
    line_with(text[path], f"in {unit}", f"{right:.4g}")
    assert f"{right / factor:g}" in text[path]


def test_a_scene_in_si_units_is_told_of_nothing() -> None:
    assert said(SCENE) == {}
    assert scene_from_mapping(SCENE).title == "untitled"


# The right value, and other units, of keys that the scene above does not have, by their paths.
OTHERS: dict[str, tuple[float, dict[str, float]]] = {
    "seabed.stiffness": (1.2e5, {"kN/m2": 1e3}),
    "contact.stiffness": (2.0e6, {"MN/m2": 1e6}),
    "soil.law.su": (3.1e3, {"kPa": 1e3}),
    "soil.law.E": (1.7e6, {"kPa": 1e3, "MPa": 1e6}),
    "soil.submerged_unit_weight": (6.1e3, {"kN/m3": 1e3}),
    "soil.layers.0.law.su": (3.1e3, {"kPa": 1e3}),
    "soil.layers.0.law.su_gradient": (1.1e3, {"kPa/m": 1e3}),
    "soil.block.depth": (3.0, {"mm": MM}),
    "water.waves.trains.0.airy.height": (6.0, {"cm": 0.01}),
    "water.waves.regular.period": (12.0, {"ms": 1e-3}),
    "water.current.history.0.profile.0.2": (0.9, {"cm/s": 0.01}),
    "water.depth": (850.0, {"mm": MM}),
    "lines.left.contents.density": (850.0, {"t/m3": 1e3}),
    "lines.left.contents.slugs.0.density": (850.0, {"t/m3": 1e3}),
    "lines.left.start.position.2": (50.0, {"mm": MM}),
    "riser.end.bend_stiffener.E": (6.8e7, {"MPa": 1e6, "ksi": 1e3 * PSI}),
    "riser.end.bend_stiffener.density": (1150.0, {"t/m3": 1e3}),
    "riser.end.bend_stiffener.base_diameter": (0.7, {"mm": MM, "inches": INCH}),
    "line_types.pipe.wall.inner_diameter": (0.2, {"mm": MM, "inches": INCH}),
    "bodies.buoy.mass": (2.4e4, {"t": 1e3}),
    "riser.attachments.0.mass": (350.0, {"t": 1e3}),
}


def nested(path: str, value: float, beside: dict[str, float]) -> Any:
    """Plain data with one value at a path, and others beside it; lists where a part of the path is a number."""
    *way, last = path.split(".")
    data: Any = {last: value, **beside} if not last.isdecimal() else [0.0] * int(last) + [value]
    for key in reversed(way):
        data = [data] if key.isdecimal() else {key: data}
    return data


@pytest.mark.parametrize("path", OTHERS)
def test_each_number_that_stands_alone(path: str) -> None:
    right, units = OTHERS[path]
    beside = {"volume": 2e-3 * right} if path.endswith("mass") else {}
    assert said(nested(path, right, beside)) == {}
    for unit, factor in units.items():
        text = said(nested(path, right / factor, beside))
        line_with(text[path], f"in {unit}", f"{right:.4g}")


def forces(**end: Any) -> Any:
    """The scene with another end at its top."""
    return put(SCENE, "riser.end", {"position": [700.0, 0.0, 880.0], **end})[0]


def test_tensions_by_what_hangs() -> None:
    """1300 m of riser weigh some 1.3 MN in the water."""
    for end in ({"hang_off": {"tension": 1.5e6}}, {"tensioner": {"tension": 1.9e6}}):
        assert said(forces(**end)) == {}
    line_with(said(forces(hang_off={"tension": 1500.0}))["riser.end.hang_off.tension"], "in kN, 1.5e+06 N")
    line_with(said(forces(tensioner={"tension": 1900.0}))["riser.end.tensioner.tension"], "in kN, 1.9e+06 N")


def test_a_submerged_weight_in_another_unit() -> None:
    """187 kg/m of steel, its bore full of 780 kg/m3, weigh 187 + 45.7 - 84.5 kg/m in the water, 1453.6 N/m."""
    weight = "line_types.steel.submerged_weight"
    given = copy.deepcopy(SCENE)
    for value, unit in ((1453.0, ""), (1.453, "in kN/m, 1453 N/m"), (148.1, "in kg/m, 1453 N/m"), (900.0, "")):
        given["line_types"]["steel"]["submerged_weight"] = value
        assert (weight in said(given)) == bool(unit)
        if unit:
            assert unit in said(given)[weight]


def test_a_whole_scene_in_tonnes_and_kilonewtons() -> None:
    """Each line type by its own numbers, though they fit one another."""
    changed = copy.deepcopy(SCENE)
    for pipe in changed["line_types"].values():
        for key in ("mass", "EA", "EI", "GJ"):
            pipe[key] /= 1e3
    for key in ("mass", "EA"):
        for name in ("steel", "flexible"):
            assert f"line_types.{name}.{key}" in said(changed)
    assert "line_types.steel.EI" in said(changed)


@pytest.mark.parametrize("file", sorted([*ROOT.glob("demos/**/*.yaml"), *ROOT.glob("tests/scenes/*.yaml")]), ids=str)
def test_no_demo_is_told_of_anything(file: Path) -> None:
    assert said(parse(file.read_text(), str(file)).data) == {}


@pytest.mark.parametrize("kind", KINDS)
def test_no_draft_is_told_of_anything(kind: str) -> None:
    for diameter in (0.06, 0.168275, 0.27305, 0.508, 1.2192):
        assert said(parse(draft(kind, Wishes(diameter=diameter), "test"), "test").data) == {}


def written(folder: Path, **changes: Any) -> Path:
    """A small scene of a flexible pipe on springs, with other numbers in the place of some."""
    numbers = {"outer_diameter": 0.3, "mass": 120.0, "EA": 3.0e8} | changes
    file = folder / "scene.yaml"
    file.write_text(
        "water: {density: 1025.0}\n"
        "line_types:\n"
        "  pipe:\n"
        f"    outer_diameter: {numbers['outer_diameter']}\n"
        f"    mass: {numbers['mass']}\n"
        f"    EA: {numbers['EA']}\n"
        "    EI: 5.0e4\n"
        "riser:\n"
        "  segments: [{line_type: pipe, length: 150.0, element_length: 3.0}]\n"
        "  start: {position: [0.0, 0.0, 0.15]}\n"
        "  end: {position: [80.0, 0.0, 100.0]}\n"
        "seabed: {kind: spring, stiffness: 1.0e5}\n"
        "stages: [{name: hang, kind: static}]\n"
    )
    return file


def test_check_warns_of_it(tmp_path: Path) -> None:
    report = describe(read_scene(written(tmp_path, mass=0.12)))
    line_with(report, "warning: line_types.pipe.mass: 0.12 kg/m", "in t/m, 120 kg/m")
    assert "line_types" not in describe(read_scene(written(tmp_path)))


def test_a_diameter_is_in_the_unit_that_suits_its_mass() -> None:
    """10 3/4 in with 140 kg/m: 10.75 mm would be a bar of 1,500 t/m3. A wide float of 500 kg/m3 is plausible."""
    pipe = {"outer_diameter": 10.75, "inner_diameter": 9.5, "mass": 101.0, "EA": 2.65e9}
    text = said({"line_types": {"pipe": pipe}})
    assert set(text) == {"line_types.pipe.outer_diameter", "line_types.pipe.inner_diameter"}
    assert text["line_types.pipe.outer_diameter"].endswith("is it in inches, 0.2731 m?")
    wide = {"outer_diameter": 3.0, "inner_diameter": 0.3, "mass": 3500.0, "EA": 2.65e9}
    assert said({"line_types": {"pipe": wide}}) == {}


@pytest.mark.parametrize(("change", "meant"), [({"outer_diameter": 300.0}, "in mm, 0.3 m"), ({"mass": 0.12}, "in t/m")])
def test_it_is_said_before_what_is_refused(change: dict[str, float], meant: str, tmp_path: Path) -> None:
    """A diameter of 300 m puts the ends below the ground; a lighter riser is refused for another mistake."""
    file = written(tmp_path, **change)
    old, new = ("kind: static", "kind: stat") if "mass" in change else ("spring, stiffness: 1.0e5", "rigid")
    file.write_text(file.read_text().replace(old, new))
    done = CliRunner().invoke(app, ["check", str(file)])
    first, *others = done.output.splitlines()
    (key,) = change
    line_with([first], f"scene.yaml:{4 if key == 'outer_diameter' else 5}: line_types.pipe.{key}: ", meant)
    assert (done.exit_code, bool(others)) == (2, True)


def test_a_new_draft_names_the_unit_before_it_refuses(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, ["new", "flexible", "--diameter", "300"])
    assert done.exit_code == 2
    line_with(done.output.splitlines()[:1], "--diameter", "in mm, 0.3 m")
    warned = CliRunner().invoke(app, ["new", "flexible", "--diameter", "10.75", "--depth", "900"]).output
    line_with(warned, "warning: line_types.pipe.outer_diameter", "in inches, 0.2731 m")
