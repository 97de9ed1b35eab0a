"""Kinds of OrcaFlex's data, each by numbers of its own: words, tapers, tables, clumps, clay, several lines; and all
that stands against a scene in one go.
"""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil import Scene, run
from riser_soil.errors import SceneError
from riser_soil.imported_scene import ImportedScene
from riser_soil.orcaflex.data_file import read_data
from riser_soil.orcaflex.scene_of import scene_of
from riser_soil.scene.rao import read_rao
from riser_soil.scene.reader import scene_from_mapping
from tests.support.orcaflex_data import data_text
from tests.support.said import line_with, lines_with

G = 9.80665
PIPE = "Category: Homogeneous pipe\n    E: 200e6\n    MaterialDensity: 7.85"


def changed(*pairs: tuple[str, str]) -> str:
    text = data_text()
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return text


def imported(folder: Path, text: str | bytes, line: str | None = None) -> ImportedScene:
    """The scene, which its reader must take as it is."""
    (folder / "riser.yml").write_bytes(text if isinstance(text, bytes) else text.encode())
    scene = scene_of(read_data(folder / "riser.yml"), line)
    for name, content in scene.files.items():
        (folder / name).write_text(content)
    scene_from_mapping(scene.data, folder)
    return scene


def data_of(folder: Path, *pairs: tuple[str, str]) -> dict[str, Any]:
    return imported(folder, changed(*pairs)).data


def with_table(kind: str, name: str, rows: str, columns: str = "IndependentValue, DependentValue") -> tuple[str, str]:
    table = f"VariableData:\n  {kind}:\n    - Name: {name}\n      {columns}: {rows}\n"
    return "Environment:\n", f"{table}Environment:\n"


def the_types(data: dict[str, Any]) -> list[dict[str, Any]]:
    return list(data["line_types"].values())


def test_quotes_case_and_marks_change_nothing(tmp_path: Path) -> None:
    """Byte-order marks stand before each of several files that were joined; OrcaFlex's words count in any case."""
    plain, spelt = data_text(), data_text()
    for key in ("UnitsSystem", "OD", "MinRadius", "WaveType", "AllowableTension", "RAOOrigin", "Connection,"):
        spelt = spelt.replace(key, key.upper())
    for word in ("Airy", "Anchored", "General\n", "Elastic", "Wheeler stretching", "lags", "xz plane", "Flat"):
        assert word in spelt
        spelt = spelt.replace(f" {word}", f" {word.lower()}")
    spelt = spelt.replace("~", "'~'").replace(": No\n", ": 'No'\n").replace('"8\\" hose"', "x")
    spelt = spelt.replace("VesselType: Barge", "VesselType: BARGE").replace("VesselTypes:", "\ufeffVesselTypes:")
    expected = imported(tmp_path, plain)
    for text in (spelt.encode(), spelt.encode("utf-8-sig"), spelt.encode("utf-16")):
        result = imported(tmp_path, text)
        assert (result.data, result.files) == (expected.data, expected.files)
        assert len(result.remarks) == len(expected.remarks)


def test_all_that_stands_against_a_scene_is_told_at_once(tmp_path: Path) -> None:
    text = changed(
        ("UnitsSystem: SI", "UnitsSystem: US"), ("SeabedSlope: 0", "SeabedSlope: 3"), ("EI: [50", "EI: [Bending"),
        ("ContentsMethod: Uniform", "ContentsMethod: Free flooding"), ("[Anchored, 80", "[Buoy, 80"),
        ("MassPerUnitLength: 0.12", "MassPerUnitLength: heavy"), ("WaveHeight: 2", "WaveHeight: high"),
    )  # fmt: skip
    with pytest.raises(SceneError) as error:
        imported(tmp_path, text)
    lines = str(error.value).splitlines()
    refused = lines[lines.index(line_with(lines, "none is written;", "7")) + 1 :]
    for key in ("UnitsSystem", "SeabedSlope", "EI", "ContentsMethod", "Connection", "MassPerUnitLength", "WaveHeight"):
        (n,) = [int(line.split(":")[1]) for line in lines_with(refused, f"{key}:")]
        assert key in text.splitlines()[n - 1] or "Buoy" in text.splitlines()[n - 1]
    assert len(refused) == 7
    line_with(lines, "not carried over:", "WindSpeed 12:")
    assert not lines_with(lines, "VesselType")  # what a scene would have is not reported as lost


@pytest.mark.parametrize("model", ["Linear", "elastic", "LINEAR"])
def test_a_bed_of_springs_by_its_names(model: str, tmp_path: Path) -> None:
    """What only the other model takes is nothing to report."""
    bed = f"SeabedModel: {model}\n  SoilDensity: 1.6"
    result = imported(tmp_path, changed(("SeabedModel: Elastic", bed)))
    assert result.data["seabed"]["kind"] == "spring"
    assert not lines_with([text for _, text in result.remarks], "SoilDensity")


@pytest.mark.parametrize(
    "depth", ["SeabedOriginDepth: 100", "WaterDepth: 100\n  SeabedOriginDepth: 100", "SeabedOriginZ: -100"]
)
def test_the_depth_by_its_names(depth: str, tmp_path: Path) -> None:
    data = data_of(tmp_path, ("WaterDepth: 100", depth))
    assert (data["water"]["depth"], data["seabed"]["level"]) == (100.0, -100.0)


def test_a_taper_of_steel_keeps_its_mass(tmp_path: Path) -> None:
    """The diameter goes from 0.34 m at end A to 0.30 m over 10 m, then even; Simpson's rule has its volume exactly."""
    text = changed(
        with_table("Linetypediameter", "Joint", "[[0, 0.34], [10, 0.30]]"), ("Category: General", PIPE),
        ("OD: 0.30", "OD: joint"), ('[8" hose, 110, 2]', '[8" hose, 30, 3]'), ('      - [8" hose, 40, 4]\n', ""),
        ("[Anchored, 80, 0, 0.15", "[Fixed, 20, 0, -20"),
    )  # fmt: skip
    result = imported(tmp_path, text)
    segments, types = result.data["riser"]["segments"], result.data["line_types"]
    assert sum(each["length"] for each in segments) == pytest.approx(30.0)
    mass = sum(each["length"] * types[each["line_type"]]["mass"] for each in segments)
    squares = 10.0 / 6.0 * (0.34**2 + 4.0 * 0.32**2 + 0.30**2) + 20.0 * 0.30**2 - 30.0 * 0.20**2
    assert mass == pytest.approx(7850.0 * math.pi / 4.0 * squares, rel=1e-4)
    stiffness = [types[each["line_type"]]["EI"] for each in segments]  # from the lower end, which is end B
    assert stiffness == sorted(stiffness)
    assert all(b < 1.101 * a for a, b in pairwise(stiffness))
    said = line_with([text for _, text in result.remarks], "OD", "table", "pieces", "EI")
    worst = float(said.split("most, ")[1].split(" %")[0])
    D = np.linspace(0.30, 0.34, 2001)
    exact, pieces = D**4 - 0.20**4, np.array(sorted({types[each["line_type"]]["outer_diameter"] for each in segments}))
    nearest = pieces[np.abs(D[:, None] - pieces).argmin(axis=1)]
    assert worst == pytest.approx(100.0 * np.max(np.abs((nearest**4 - 0.20**4) / exact - 1.0)), rel=0.1)


def test_an_outer_diameter_by_a_table_for_any_line_type(tmp_path: Path) -> None:
    table = with_table("LineTypeOuterDiameter", "Cone", "[[0, 0.36], [4, 0.30]]")
    result = imported(tmp_path, changed(table, ("OD: 0.30", "OD: Cone")))
    upper = result.data["riser"]["segments"][-1]
    hose = result.data["line_types"][upper["line_type"]]
    assert hose["outer_diameter"] == pytest.approx(0.36, rel=0.03)
    assert (hose["EI"], hose["mass"]) == (5.0e4, 120.0)
    assert sum(each["length"] for each in result.data["riser"]["segments"]) == pytest.approx(150.0)


def test_drag_by_reynolds_number(tmp_path: Path) -> None:
    """OrcaFlex's force and number are those of the drag diameter, 0.36 m, the scene's of the outer one, 0.30 m."""
    table = with_table("Dragcoefficient", "Smooth", "[[0, 1.3], [120e3, 1.2], [600e3, 0.6]]")
    data = data_of(tmp_path, table, ("Cd: [1.2, ~, 0.01]", "Cd: [smooth, ~, 0.02]"))
    (hose,) = the_types(data)
    numbers = [(1.0 / 1.2, 1.3 * 1.2), (1e5, 1.2 * 1.2), (5e5, 0.6 * 1.2)]
    assert hose["drag"]["by_reynolds"] == [pytest.approx(pair) for pair in numbers]
    assert hose["drag"]["tangential"] == 0.02
    assert data["water"]["kinematic_viscosity"] == 1.35e-6


@pytest.mark.parametrize(("across", "along"), [("Cdn", "Cdz"), ("Cdx", "Cdz")])
def test_drag_and_added_mass_by_single_names(across: str, along: str, tmp_path: Path) -> None:
    added = f"{across.replace('d', 'a')}: 0.8\n    Caz: 0.1"
    drag = ("Cd: [1.2, ~, 0.01]", f"{across}: 0.9\n    {along}: 0.04")
    data = data_of(tmp_path, drag, ("NormalDragLiftDiameter: 0.36", "Cs: 0"), ("Ca: [1, ~, 0]", added))
    (hose,) = the_types(data)
    assert hose["drag"] == {"normal": pytest.approx(0.9), "tangential": 0.04}
    assert hose["added_mass"] == {"normal": 0.8, "tangential": 0.1}


@pytest.mark.parametrize(
    ("given", "EI", "GJ"), [("GJ: 0", "[50, ~]", 5.0e4), ("GJ: ~", "[50, ~]", 5.0e4), ("GJ: 0", "[0, ~]", 1e-4 * 3.6e7)]
)
def test_a_line_that_does_not_twist(given: str, EI: str, GJ: float, tmp_path: Path) -> None:
    """Torsion as stiff as bending, or 1e-4 EA D^2 of a chain, and said so."""
    result = imported(tmp_path, changed(("GJ: 12", given), ("EI: [50, ~]", f"EI: {EI}")))
    (hose,) = the_types(result.data)
    assert hose["GJ"] == pytest.approx(GJ)
    line_with([text for _, text in result.remarks], "GJ", "does not twist", f"{GJ:g} N.m2")


def test_torsion_that_is_left_out_has_no_effect(tmp_path: Path) -> None:
    """In space, under a current across, with one end free to spin: tensions are the same at any GJ."""
    text = changed(("GJ: 12", "GJ: 0"), ("StageDuration: [8, 16]\n", "LogEnd: 1\n"))
    scene = Scene.from_dict(imported(tmp_path, text).data)
    other = scene.changed({'line_types.8" hose.GJ': 500.0})
    tensions = [
        run(each, tmp_path / f"out{n}", quiet=True)["effective_tension"][-1]
        for n, each in enumerate((scene, other))
    ]
    assert tensions[0] == pytest.approx(tensions[1], rel=1e-6)


def test_coats_and_linings(tmp_path: Path) -> None:
    """Coats have mass and take up room, and no stiffness."""
    columns = "LayerThickness, LayerMaterialDensity"
    layers = with_table("Coatingsorlinings", "Coat", "[[0.01, 0.9], [0.04, 0.6]]", columns)
    coat = f"{PIPE}\n    CoatingThickness: Coat\n    LiningThickness: 0.005\n    LiningMaterialDensity: 1.1"
    (pipe,) = the_types(data_of(tmp_path, layers, ("Category: General", coat)))
    assert (pipe["outer_diameter"], pipe["inner_diameter"]) == (pytest.approx(0.40), pytest.approx(0.19))
    assert pipe["pipe_diameter"] == pytest.approx(0.30)
    ring = [7.85 * (0.30**2 - 0.20**2), 0.9 * (0.32**2 - 0.30**2), 0.6 * (0.40**2 - 0.32**2), 1.1 * (0.20**2 - 0.19**2)]
    assert pipe["mass"] == pytest.approx(1000.0 * math.pi / 4.0 * sum(ring))
    assert pipe["EI"] == pytest.approx(2e11 * math.pi / 64.0 * (0.30**4 - 0.20**4))


def test_a_pipe_without_stiffness_in_torsion_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="PoissonRatio: is -1; give one above -1"):
        imported(tmp_path, changed(("Category: General", PIPE), ("PoissonRatio: 0.5", "PoissonRatio: -1")))


def test_raos_at_no_period_and_without_end(tmp_path: Path) -> None:
    """Heave is 0.8 at 2 s and 0 at none: 0.4 at 1 s; at 40 s 0.8, 1 in endless waves: 0.9 at half the frequency."""
    none, endless = f"- [0{', 0' * 12}]", "- [Infinity, 1, 90, 0, 0, 1, 10, 0, 0, 0, 0, 0, 0]"
    imported(tmp_path, changed((none, f"{none}\n                {endless}")))
    rao = read_rao(next(tmp_path.glob("*_rao.csv")))
    heave = np.abs(np.array(rao.response["heave"][0]))
    at = [2.0 * math.pi / 80.0, 2.0 * math.pi / 40.0, 2.0 * math.pi / 2.0, 2.0 * math.pi / 1.0, 2.0 * math.pi / 0.02]
    assert np.interp(at, rao.frequency, heave) == pytest.approx([0.9, 0.8, 0.8, 0.4, 0.008], rel=2e-3)


def test_raos_of_a_vessel_alike_in_both_planes(tmp_path: Path) -> None:
    """Waves from ahead move it as waves from astern do, but for the signs of surge, pitch and yaw."""
    both = ("Symmetry: xz plane", "Symmetry: xz and yz planes")
    imported(tmp_path, changed(both, ("RAODirection: 180", "RAODirection: 90")))
    rao = read_rao(next(tmp_path.glob("*_rao.csv")))
    ahead, astern = rao.direction.index(pytest.approx(math.pi)), rao.direction.index(0.0)
    for mode, sign in zip(("surge", "sway", "heave", "roll", "pitch", "yaw"), (-1, 1, 1, 1, -1, -1), strict=True):
        assert rao.response[mode][ahead] == pytest.approx(tuple(sign * x for x in rao.response[mode][astern]))


CLAY = """Nonlinear soil model
  SoilShearStrengthAtMudline: 3.5
  SoilShearStrengthGradient: 1.2
  SoilDensity: 1.55
"""


@pytest.mark.parametrize(
    "parameters",
    [
        "  SoilPowerLawParameterA: 5.5\n  SoilPowerLawParameterB: 0.3\n  SoilNormalisedMaximumStiffness: 180\n"
        "  SoilSuctionResistanceRatio: 0.5\n  SoilNormalisedSuctionDecayDistance: 0.8\n"
        "  SoilRepenetrationOffsetAfterUplift: 0.4\n  SoilBuoyancyFactor: 1.4\n",
        "  Parameter a: 5.5\n  Parameter b: 0.3\n  Kmax: 180\n  fsuc: 0.5\n  lambda_suc: 0.8\n"
        "  lambda_rep: 0.4\n  fb: 1.4\n",
        "  SeabedSoilModelParameters:\n    a: 5.5\n    b: 0.3\n    Kmax: 180\n    fsuc: 0.5\n    lambda_suc: 0.8\n"
        "    lambda_rep: 0.4\n    fb: 1.4\n",
    ],
)
def test_clay_by_randolph_and_quiggin(parameters: str, tmp_path: Path) -> None:
    result = imported(tmp_path, changed(("SeabedModel: Elastic\n", f"SeabedModel: {CLAY}{parameters}")))
    assert result.data["seabed"] == {
        "kind": "hysteretic", "level": -100.0, "contact_at": "outer",
        "law": {
            "kind": "randolph-quiggin", "su": 3500.0, "su_gradient": 1200.0, "a": 5.5, "b": 0.3, "K_max": 180.0,
            "unit_weight": pytest.approx(525.0 * G), "f_suc": 0.5, "lambda_suc": 0.8, "lambda_rep": 0.4, "f_b": 1.4,
        },
    }  # fmt: skip
    assert not lines_with([text for _, text in result.remarks], "oil")


def test_clay_by_defaults_says_so_and_needs_its_strength(tmp_path: Path) -> None:
    result = imported(tmp_path, changed(("SeabedModel: Elastic\n", f"SeabedModel: {CLAY.lower()}  SoilNovel: 3\n")))
    assert "K_max" not in result.data["seabed"]["law"]
    remarks = [text for _, text in result.remarks]
    line_with(remarks, "law's default here", "a 6", "K_max 200", "f_b 1.5")
    line_with(remarks, "SoilNovel 3:", "not known here")
    with pytest.raises(SceneError, match="SoilShearStrengthAtMudline: is missing"):
        imported(tmp_path, changed(("SeabedModel: Elastic", "SeabedModel: Non-linear soil model")))


CLUMPS = """ClumpTypes:
  - Name: Float
    Mass: 0.4
    Volume: 0.9
    DragArea: [2, ~, 3]
    Cd: [0.8, ~, 0.9]
    Ca: [0.5, ~, 0.5]
Environment:
"""
HUNG = """AttachmentType, Attachmentx, Attachmenty, Attachmentz, AttachmentzRelativeTo:
      - [Float, 0, 0, 30, End A]
      - [float, 0, 0, 100, End B]
      - [Chain, 0, 0, 20, End A]
    ContentsMethod: Uniform"""


def test_clumps(tmp_path: Path) -> None:
    """At 30 and 50 m from end A, which is the upper one of 150 m."""
    result = imported(tmp_path, changed(("Environment:\n", CLUMPS), ("ContentsMethod: Uniform", HUNG)))
    (float_,) = result.data["riser"]["attachments"]
    assert float_ == {"at": [100.0, 120.0], "mass": 400.0, "volume": 0.9, "drag_area": 1.6, "added_mass": 0.5}
    remarks = [text for _, text in result.remarks]
    line_with(remarks, "ClumpTypes Float:", "1.6, 1.6, 2.7")
    line_with(remarks, "attachment Chain:", "only clumps")


def test_a_joint_by_a_table(tmp_path: Path) -> None:
    table = with_table("Bendingconnectionstiffness", "Flex", "[[0, 0], [0.5, 4], [10, 30]]")
    result = imported(tmp_path, changed(table, ("- [2, ~]", "- [Flex, ~]")))
    assert result.data["riser"]["end"]["rotation"]["stiffness"] == pytest.approx(math.degrees(8.0e3))
    line_with([text for _, text in result.remarks], "table Flex", "8 kN.m/deg", "10 deg", "30 kN.m")


def test_a_clamped_end_keeps_its_direction(tmp_path: Path) -> None:
    """End A's axis points 170 deg down from z: upwards the line leans by 10 deg, so that it is 80 deg steep."""
    clamp = ("- [2, ~]", "- [Infinity, ~]")
    result = imported(tmp_path, changed(clamp, ("StageDuration: [8, 16]\n", "LogEnd: 1\n"), ("Speed: 0.4", "Speed: 0")))
    joint = result.data["riser"]["end"]["rotation"]
    assert joint == {"stiffness": pytest.approx(1e4 * 5.0e4 / 2.0), "neutral_angle": pytest.approx(10.0)}
    done = run(Scene.from_dict(result.data), tmp_path / "out", quiet=True)
    assert done.summary["stages"][-1]["final"]["end"]["angle_deg"] == pytest.approx(80.0, abs=0.02)
    chain = imported(tmp_path, changed(clamp, ("EI: [50, ~]", "EI: [0, ~]")))
    assert "rotation" not in chain.data["riser"]["end"]
    assert not lines_with([text for _, text in chain.remarks], "clamped")


OTHER = """- Name: Other
    TopEnd: End A
    Connection, ConnectionX, ConnectionY, ConnectionZ:
      - [Fixed, 10, 30, -2]
      - [Anchored, 90, 30, 0.15]
    LineType, Length, NumberOfSegments:
      - [8" hose, 150, 30]
"""


def test_all_lines(tmp_path: Path) -> None:
    text = changed(("- Name: Other\n    TopEnd: End A\n", OTHER))
    result = imported(tmp_path, text, "all")
    assert list(result.data["lines"]) == ["Riser", "Other"]
    assert result.data["lines"]["Other"]["segments"] == [{"line_type": '8" hose', "length": 150.0, "elements": 30}]
    moved = result.data["stages"][1]["lines"]
    assert list(moved) == ["Riser"]
    assert moved["Riser"]["motion"]["end"]["vessel"]["rao"] in result.files
    assert not lines_with([text for _, text in result.remarks], "one riser")
    alone = imported(tmp_path, text, "other").data
    assert alone["riser"]["end"]["position"] == [10.0, 30.0, -2.0]


@pytest.mark.parametrize(("z", "depth"), [("0", "0.15 m"), ("-2.5", "2.65 m")])
def test_an_end_in_the_seabed_is_laid_from_it(z: str, depth: str, tmp_path: Path) -> None:
    """The pipe's axis rests half its diameter of 0.3 m above the bed at -100 m."""
    result = imported(tmp_path, changed(("[Anchored, 80, 0, 0.15", f"[Anchored, 80, 0, {z}")))
    assert result.data["riser"]["start"]["position"] == [80.0, 0.0, -99.85]
    line_with([text for _, text in result.remarks], "Lines Riser:", depth, "z = -99.85 m")
    resting = imported(tmp_path, data_text())
    assert not lines_with([text for _, text in resting.remarks], "laid from")


def test_values_have_the_lines_they_come_from(tmp_path: Path) -> None:
    """So that what a check finds wrong with the scene is said of the file."""
    text = changed(('[8" hose, 110, 2]', '[8" hose, 110, 20]'))
    result = imported(tmp_path, text)
    lines = text.splitlines()
    expected = {
        ("riser",): "- Name: Riser", ("riser", "segments", 1): "110, 20", ("riser", "start"): "Anchored",
        ("riser", "end"): "[Ship", ("line_types", '8" hose'): '- Name: 8" hose', ("water", "waves"): "WaveTrains:",
        ("seabed",): "SeabedModel", ("stages",): "StageDuration",
    }  # fmt: skip
    for path, words in expected.items():
        assert words in lines[result.origins[path] - 1]


def test_binary_data_are_refused_by_their_name(tmp_path: Path) -> None:
    (tmp_path / "riser.dat").write_bytes(b"\x08ORCAFLEX\x00\x0b\x00\x00")
    with pytest.raises(SceneError, match=r"riser.dat: is binary data of OrcaFlex; save it there as text data"):
        read_data(tmp_path / "riser.dat")


def test_what_cannot_change_an_answer_is_not_reported(tmp_path: Path) -> None:
    """Names, pens, logs and OrcaFlex's own numerics; but not what only looks like them."""
    text = changed(
        ("    Cl: 0\n", "    Cl: 0\n    ContactPen: [5, Solid, White]\n    TensionTorqueCoupling: 4\n"),
        ("LogPrecision: Single", "LogPrecision: Single\n  ImplicitTolerance: 1e-5\n  RampStartTime: -4"),
        ("WindSpeed: 12", "WindDirection: 30\n  WaveKinematicsCutoffDepth: 20\n  MoonpoolOpen: 4"),
        ("Method: Implicit time domain", "Method: Frequency domain"),
    )  # fmt: skip
    remarks = [text for _, text in imported(tmp_path, text).remarks]
    assert not [each for each in remarks if "Pen" in each or "Tolerance" in each or "WindDirection" in each]
    texts = ("TensionTorqueCoupling 4:", "RampStartTime -4:", "WaveKinematicsCutoffDepth 20:", "MoonpoolOpen 4:")
    for name in (*texts, "DynamicsSolutionMethod Frequency domain:"):
        line_with(remarks, name)
