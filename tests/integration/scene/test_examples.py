"""The example scenes are read; their echo resolves to itself; the schema describes every key."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from riser_soil import __version__
from riser_soil.__main__ import app
from riser_soil.core.outputs import OF_SOIL
from riser_soil.results.netcdf import SERIES
from riser_soil.scene.dump import dump_scene, schema_text
from riser_soil.scene.output import ALL_FIELDS
from riser_soil.scene.plane import initial_ends, resolved_dimension, vertical_plane
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.shapes import ArcShape
from riser_soil.scene.soil import MeshFile
from riser_soil.scene.stages import DynamicStage, GeneralizedAlphaScheme

ROOT = Path(__file__).parents[3]
SCENES = {
    "bend": ROOT / "tests/scenes/bend45.yaml",
    "catenary": ROOT / "tests/scenes/catenary.yaml",
    "stages": ROOT / "tests/scenes/catenary-three-stages.yaml",
    "tank": ROOT / "tests/scenes/tank.yaml",
    "clay": ROOT / "tests/scenes/touchdown_on_block.yaml",
}


@pytest.mark.parametrize("name", SCENES)
def test_echo_resolves_to_itself(name: str, tmp_path: Path) -> None:
    scene = read_scene(SCENES[name])
    text = dump_scene(scene)
    file = tmp_path / "scene.yaml"
    file.write_text(text, encoding="utf-8")
    again = read_scene(file)
    assert again == scene
    assert dump_scene(again) == text


@pytest.mark.parametrize("name", SCENES)
def test_echo_names_every_default(name: str, tmp_path: Path) -> None:
    text = dump_scene(read_scene(SCENES[name]))
    for key in ("gravity:", "dimension:", "initial:", "tolerance:", "fields:", "GJ:", "unstressed:"):
        assert key in text


def test_echo_is_read_by_yaml_1_1_as_well() -> None:
    from ruamel.yaml import YAML

    yaml = YAML(typ="safe", pure=True)
    yaml.version = (1, 1)
    solver = yaml.load(dump_scene(read_scene(SCENES["bend"])))["solver"]
    assert solver.pop("min_time_step") == "auto"
    assert [solver.pop(key) for key in ("newton", "soil", "linear")] == ["compiled", "auto", "auto"]
    assert solver.pop("petsc_options") == {}
    assert solver
    assert all(isinstance(value, int | float) for value in solver.values())


def test_catenary_as_it_is_written() -> None:
    scene = read_scene(SCENES["catenary"])
    line = scene.line_types["flexible"]
    assert (line.EA, line.EI, line.mass) == (15.38e8, 20.96e3, 57.5)
    assert line.bending_stiffness == (20.96e3, 20.96e3)
    assert scene.line.initial == "catenary"
    assert scene.line.length == 350.0
    assert (scene.seabed, scene.soil, scene.contact) == (None, None, None)
    surge = scene.stages[1]
    assert isinstance(surge, DynamicStage)
    assert surge.motion is not None
    assert surge.motion.start is None
    assert surge.motion.end is not None
    assert surge.motion.end.harmonic is not None
    assert surge.motion.end.harmonic.amplitude == (2.01, 0.0, 0.0)
    assert isinstance(surge.scheme, GeneralizedAlphaScheme)


def test_clay_has_contact_and_elements_by_length() -> None:
    scene = read_scene(SCENES["clay"])
    assert scene.contact is not None
    assert scene.contact.stiffness == "auto"
    assert [len(segment.element_lengths) for segment in scene.line.segments] == [100, 49]
    assert scene.seabed_level == 0.0
    assert scene.contact_at == "outer"


@pytest.mark.parametrize(("name", "dimension"), [("bend", 3), ("catenary", 2), ("stages", 2), ("tank", 2), ("clay", 2)])
def test_dimension_follows_from_what_leaves_the_plane(name: str, dimension: int) -> None:
    assert resolved_dimension(read_scene(SCENES[name])) == dimension


def catenary_with(*overrides: str) -> Any:
    return read_scene(SCENES["catenary"], ["line_types.flexible.GJ=1.0e4", *overrides])


@pytest.mark.parametrize(
    ("override", "dimension"),
    [
        ("dimension=3", 3),
        ("riser.end.position=[90.0, 120.0, 150.0]", 3),
        ("stages.1.motion.end.harmonic.amplitude=[0.0, 0.0, 1.0]", 2),
        ("stages.1.motion.end.harmonic.amplitude=[0.0, 1.0, 0.0]", 3),
        ("stages.1.motion.end.harmonic.phase_deg=[90.0, 5.0, 0.0]", 2),
        ("stages.1.motion.end={arc: {hub: [150, 0, 160], amplitude_deg: 9, period: 9}}", 2),
        ("stages.1.motion.end={arc: {hub: [150, 0, 160], amplitude_deg: 9, period: 9, plane: yz}}", 3),
        ("stages.1.motion.end={arc: {hub: [160, 0, 150], amplitude_deg: 9, period: 9, plane: xy}}", 3),
        ("riser.end.rotation=fixed", 2),
        ("stages.0.loads=[{at: end, moment: [0.0, 1.0, 0.0]}]", 2),
        ("stages.0.loads=[{at: end, moment: [0.0, 0.0, 1.0]}]", 3),
        ("stages.0.loads=[{distributed: [0.0, 1.0, 0.0]}]", 3),
        ("stages.0.move={end: [140.0, 0.0, 150.0]}", 2),
        ("stages.0.move={end: [140.0, 1.0, 150.0]}", 3),
        ("riser.initial={points: [[0, 0, 0], [90, 5, 0], [150, 0, 150]]}", 3),
    ],
)
def test_what_leaves_the_plane_makes_three_dimensions(override: str, dimension: int) -> None:
    assert resolved_dimension(catenary_with(override)) == dimension


def test_plane_turns_with_the_ends() -> None:
    scene = catenary_with(
        "riser.end.position=[90.0, 120.0, 150.0]",
        "stages.1.motion.end.harmonic.amplitude=[0.6, 0.8, 0.5]",
    )
    plane = vertical_plane(scene)
    assert plane.direction == pytest.approx((0.6, 0.8, 0.0), abs=1e-15)
    assert resolved_dimension(scene) == 2


@pytest.mark.parametrize(("axis", "dimension"), [([0.0, -1.0, 0.0], 2), ([0.0, 1.0, 1.0], 3)])
def test_a_support_that_rocks_across_the_plane_stays_in_it(axis: list[float], dimension: int) -> None:
    rocking = {"axis": axis, "amplitude_deg": 5.0, "period": 9.0}
    scene = catenary_with("riser.end.rotation=fixed", f"stages.1.motion.end={{rotation: {rocking}}}")
    assert resolved_dimension(scene) == dimension


@pytest.mark.parametrize(("phases", "dimension"), [([0.0, 0.0, 40.0], 2), ([0.0, 40.0, 0.0], 3)])
def test_phases_lead_an_oblique_motion_out_of_its_plane(phases: list[float], dimension: int) -> None:
    end = "stages.1.motion.end.harmonic"
    oblique = ("riser.end.position=[90.0, 120.0, 150.0]", f"{end}.amplitude=[0.6, 0.8, 0.5]")
    assert resolved_dimension(catenary_with(*oblique, f"{end}.phase_deg={phases}")) == dimension


def test_arc_in_a_vertical_plane_is_planar() -> None:
    arc = "riser.unstressed={arc: {centre: [0, 0, 100], from: [0, 0, 0], angle_deg: 45, axis: [0, -1, 0]}}"
    load = "stages.0.loads=[{at: end, force: [0, 0, 600]}]"
    scene = read_scene(SCENES["bend"], [arc, load])
    assert resolved_dimension(scene) == 2
    assert abs(vertical_plane(scene).direction[0]) == 1.0


def test_arc_knows_its_radius_and_length() -> None:
    scene = read_scene(SCENES["bend"])
    shape = scene.line.unstressed
    assert isinstance(shape, ArcShape)
    assert shape.arc.radius == pytest.approx(100.0, rel=1e-15)
    assert shape.arc.length == pytest.approx(78.53981634, rel=1e-9)


@pytest.mark.parametrize(
    "off",
    [
        "contact.friction=null",
        "contact.suction=null",
        "soil.inertia=false",
        "water.current=null",
        "water.surface_level=null",
        "line_types.flexible.rotary_inertia=false",
        "line_types.flexible.damping=null",
        "contact=null",
        "riser.contents.density=850",
        "line_types.flexible.drag=null",
    ],
)
def test_values_that_switch_off_are_accepted(off: str) -> None:
    assert read_scene(SCENES["clay"], [off]).title == "Touchdown on soft clay"


def test_what_can_be_touched_brings_contact() -> None:
    base = read_scene(SCENES["catenary"])
    assert base.contact is None
    assert catenary_with("seabed={kind: rigid, level: -200.0}").contact is not None


@pytest.mark.parametrize(
    ("gravity", "end", "initial"),
    [(9.81, 10.0, "catenary"), (0.0, 20.0, "unstressed"), (9.81, None, "unstressed")],
)
def test_initial_follows_from_ends_and_gravity(gravity: float, end: float | None, initial: str) -> None:
    scene = {
        "gravity": gravity,
        "line_types": {"a": {"EA": 1e6, "EI": 1e3, "mass": 1.0, "GJ": 1e3}},
        "riser": {
            "segments": [{"line_type": "a", "length": 20, "elements": 2}],
            "start": {"position": [0.0, 0.0, 0.0]},
            "end": "free" if end is None else {"position": [end, 0.0, 0.0]},
        },
        "stages": [{"name": "a", "kind": "static"}],
    }
    assert scene_from_mapping(scene).line.initial == initial


@pytest.mark.parametrize(
    ("overrides", "ends"),
    [
        ((), ((0, 0, 0), (70.710678, 29.289322, 0))),
        (("riser.unstressed.arc.axis=[0, 0, -3]",), ((0, 0, 0), (-70.710678, 29.289322, 0))),
        (("riser.unstressed=straight",), ((0, 0, 0), (78.539816, 0, 0))),
        (("riser.unstressed={points: [[0, 0, 0], [0, 78, 0]]}",), ((0, 0, 0), (0, 78, 0))),
        (("riser.initial={points: [[0, 0, 0], [0, 0, 78]]}",), ((0, 0, 0), (0, 0, 78))),
        (
            ("riser.initial=straight", "riser.unstressed=straight", "riser.end={position: [0, 79, 0]}"),
            ((0, 0, 0), (0, 79, 0)),
        ),
    ],
)
def test_initial_shape_has_its_ends_where_they_are_held(overrides: tuple[str, ...], ends: Any) -> None:
    start, end = initial_ends(read_scene(SCENES["bend"], overrides).line)
    assert start == pytest.approx(ends[0], abs=1e-6)
    assert end == pytest.approx(ends[1], abs=1e-6)


def test_mesh_file_is_sought_beside_the_scene(tmp_path: Path) -> None:
    (tmp_path / "trench.msh").write_text("mesh", encoding="utf-8")
    text = SCENES["clay"].read_text(encoding="utf-8")
    file = tmp_path / "scene.yaml"
    file.write_text(text, encoding="utf-8")
    scene = read_scene(file, ["soil.block=null", "soil.mesh={file: trench.msh}"])
    assert scene.soil is not None
    assert isinstance(scene.soil.mesh, MeshFile)
    assert scene.soil.mesh.file == tmp_path / "trench.msh"
    echo = tmp_path / "elsewhere" / "scene.yaml"
    echo.parent.mkdir()
    echo.write_text(dump_scene(scene), encoding="utf-8")
    assert read_scene(echo) == scene


def test_merge_keys_serve_line_types(tmp_path: Path) -> None:
    text = SCENES["catenary"].read_text(encoding="utf-8")
    text = text.replace("  flexible:\n", "  flexible: &flexible\n")
    text = text.replace("riser:\n", "  stiff: {<<: *flexible, EI: 9.0e4}\nriser:\n", 1)
    file = tmp_path / "scene.yaml"
    file.write_text(text, encoding="utf-8")
    types = read_scene(file).line_types
    assert types["stiff"].EI == 9.0e4
    assert types["stiff"].EA == types["flexible"].EA


def test_fields_of_the_language_are_those_of_the_recorder() -> None:
    along_riser = {name for name, variable in SERIES.items() if "arc" in variable.dims} - {"position"}
    across = {name for name, variable in SERIES.items() if "offset" in variable.dims}
    assert set(ALL_FIELDS) == along_riser | across | {output.name for output in OF_SOIL}


def _properties(schema: Any) -> Any:
    """All properties of all mappings of a JSON schema."""
    for mapping in [schema, *schema["$defs"].values()]:
        yield from mapping.get("properties", {}).items()


def test_schema_describes_every_key_and_is_closed() -> None:
    """But for the parameters of a law of one's own, which its class knows."""
    schema = json.loads(schema_text())
    properties = list(_properties(schema))
    assert len(properties) > 80
    for name, content in properties:
        assert content.get("description"), name
    definitions = {"Scene": schema, **schema["$defs"]}
    objects = {name: each for name, each in definitions.items() if each.get("type") == "object"}
    assert {name for name, each in objects.items() if each["additionalProperties"] is not False} == {"ImportedLaw"}


def test_numbers_in_the_schema_carry_their_bounds() -> None:
    definitions = json.loads(schema_text())["$defs"]
    assert definitions["Segment"]["properties"]["length"]["exclusiveMinimum"] == 0
    assert definitions["VonMises"]["properties"]["nu"]["exclusiveMaximum"] == 0.5


def test_schema_and_version_commands() -> None:
    assert json.loads(CliRunner().invoke(app, ["schema"]).output)["title"] == "Scene"
    assert CliRunner().invoke(app, ["--version"]).output == f"riser-soil {__version__}\n"
