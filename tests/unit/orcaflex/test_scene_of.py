"""Scenes of OrcaFlex's text data: their numbers by closed forms, and what is not carried over, by its line."""

from __future__ import annotations

import cmath
import math
import re
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from riser_soil import Scene, run
from riser_soil.commands.app import app
from riser_soil.errors import SceneError
from riser_soil.imported_scene import ImportedScene
from riser_soil.orcaflex.data_file import read_data
from riser_soil.orcaflex.scene_of import scene_of
from riser_soil.scene.rao import MODES, Rao, read_rao
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.sea.components import wave_number
from riser_soil.sea.spectra import mean_period
from tests.support.orcaflex_data import data_text
from tests.support.said import line_with, telling
from tests.support.seas import components_of

G = 9.80665


def imported(folder: Path, text: str) -> ImportedScene:
    (folder / "riser.yml").write_text(text)
    return scene_of(read_data(folder / "riser.yml"))


def changed(*pairs: tuple[str, str], rows: str | None = None) -> str:
    text = data_text(rows)
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return text


def rao_of(folder: Path, text: str) -> Rao:
    (content,) = imported(folder, text).files.values()
    (folder / "rao.csv").write_text(content)
    return read_rao(folder / "rao.csv")


def test_numbers_in_si_units(tmp_path: Path) -> None:
    """The scene goes from the lower end to the upper one; the file goes the other way."""
    data = imported(tmp_path, data_text()).data
    (hose,) = data["line_types"].values()
    assert hose == {
        "outer_diameter": 0.30, "inner_diameter": 0.20, "mass": 120.0, "EA": 4.0e8, "EI": 5.0e4, "GJ": 1.2e4,
        "max_tension": 2.0e6, "min_bend_radius": 3.0,
        "drag": {"normal": pytest.approx(1.2 * 0.36 / 0.30), "tangential": 0.01},
        "added_mass": {"normal": 1.0, "tangential": 0.0},
    }  # fmt: skip
    water, riser, storm = data["water"], data["riser"], data["stages"][1]
    assert (data["gravity"], water["density"], water["surface_level"], water["depth"]) == (G, 1025.0, 0.0, 100.0)
    assert water["current"]["profile"] == [[-100.0, 0.0, 0.1], [0.0, 0.0, 0.4]]
    assert [(each["length"], each["element_length"]) for each in riser["segments"]] == [(40.0, 4.0), (110.0, 2.0)]
    assert (riser["start"]["position"], riser["contents"]) == ([80.0, 0.0, -99.85], {"density": 800.0})
    assert riser["end"]["position"] == [-20.0 + 20.0, 0.0, -4.0]
    assert data["seabed"] == {"kind": "spring", "stiffness": 200.0e3 * 0.30, "level": -100.0, "contact_at": "outer"}
    assert data["contact"] == {"friction": {"axial": 0.5, "lateral": 0.5}}
    assert (storm["duration"], storm["time_step"], water["waves"]["ramp"]) == (24.0, 0.2, 8.0)
    assert storm["motion"]["end"]["vessel"]["reference"] == [-22.0, 0.0, -1.0]


def test_what_is_not_carried_over_is_reported_by_line(tmp_path: Path) -> None:
    text = data_text()
    remarks = dict(imported(tmp_path, text).remarks)
    words = {line: text.splitlines()[line - 1].split()[0] for line in remarks}
    assert [*words.values()] == ["WindSpeed:", "RAOs:", "LayAzimuth:", "-"]
    line_with([remarks[max(remarks)]], "Lines Other:", "one riser", "--line 'Other'", "--line all")


def test_a_value_that_nothing_knows_is_reported(tmp_path: Path) -> None:
    """Unknown values of the line type, of the line, of a table's column, and an unknown section."""
    text = changed(
        ("    Cl: 0\n", "    Cl: 0\n    Novel: 3\n"),
        ("ConnectionGamma\n", "ConnectionGamma, ConnectionPayoutRate\n"), ("0, 170, 0]", "0, 170, 0, 0.5]"),
        ("Groups:", "Winches:\n  - Name: Pull\n    Length: 3\nGroups:"),
    )  # fmt: skip
    texts = [text for _, text in imported(tmp_path, text).remarks]
    line_with(texts, 'LineTypes 8" hose: Novel 3:', "not known here")
    line_with(texts, "Lines Riser: ConnectionPayoutRate 0.5:", "paid out")
    line_with(texts, "Winches Pull:", "the pull of a winch")


def test_the_tension_at_rest_is_the_catenarys(tmp_path: Path) -> None:
    """A flexible line on a level seabed: T = w (a + h), its span l - s + a acosh(1 + h/a), s^2 = h^2 + 2 h a."""
    text = changed(
        ("RefCurrentSpeed: 0.4", "RefCurrentSpeed: 0"), ("EI: [50, ~]", "EI: [0.1, ~]"), ("- [2, ~]", "- [0, ~]"),
        ("EA: 4.0e5", "EA: 4.0e7"), ("SeabedLateralFrictionCoefficient: 0.5", "SeabedLateralFrictionCoefficient: 0"),
        ("hose, 40, 4]", "hose, 40, 1]"), ("hose, 110, 2]", "hose, 110, 0.5]"),
        ("StageDuration: [8, 16]\n", "LogEnd: 1\n"),
    )  # fmt: skip
    scene = Scene.from_dict(imported(tmp_path, text).data)
    weight = G * (120.0 + (800.0 * 0.2**2 - 1025.0 * 0.3**2) * math.pi / 4.0)
    height, length, span = 100.0 - 0.15 - 4.0, 150.0, 80.0

    def reached(a: float) -> float:
        return length - math.sqrt(height**2 + 2.0 * height * a) + a * math.acosh(1.0 + height / a)

    low, high = 1e-3, 1e4
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if reached(middle) < span else (low, middle)
    done = run(scene, tmp_path / "out", quiet=True)
    tension = float(np.asarray(done.dataset["effective_tension"])[-1, -1])
    assert tension == pytest.approx(weight * (low + height), rel=2e-3)


@pytest.mark.verify
@pytest.mark.parametrize("name", ["JONSWAP", "Airy"])
def test_the_imported_scene_runs(name: str, tmp_path: Path) -> None:
    text = changed(("WaveType: Airy", f"WaveType: {name}\n      WaveHs: 1\n      WaveTz: 8\n      WaveGamma: 2"))
    (tmp_path / "riser.yml").write_text(text)
    arguments = ["import", str(tmp_path / "riser.yml"), "-o", str(tmp_path / "scene.yaml")]
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 0, done.output
    written = (tmp_path / "scene.yaml").read_text()
    line_with(written, "# riser.yml:42:", "not carried over:", "Environment:", "WindSpeed 12")
    scene = Scene.from_file(tmp_path / "scene.yaml").changed({"stages.1.duration": 2.0})
    assert run(scene, tmp_path / "out", quiet=True).finished
    again = CliRunner().invoke(app, arguments)
    assert (again.exit_code, "--force" in again.output) == (2, True)


@pytest.mark.parametrize(
    ("convention", "relative", "phase"),
    [
        ("lags", "crest", 40.0), ("leads", "crest", -40.0), ("lags", "trough", 220.0), ("leads", "trough", 140.0),
        ("lags", "zero down-crossing", -50.0), ("leads", "zero up-crossing", 230.0),
        ("lags", "zero up-crossing", 130.0),
    ],
)  # fmt: skip
def test_one_response_in_all_phase_conventions(convention: str, relative: str, phase: float, tmp_path: Path) -> None:
    """A response of 2 cos(w t - 40 deg) to a wave of cos(w t): its crest comes at 0, its trough at T/2."""
    rows = "[{period}, 2, PHASE" + ", 0, 0" * 5 + "]"
    text = changed(
        ("RAOPhaseConvention: lags", f"RAOPhaseConvention: {convention}"),
        ("ToConvention: crest", f"ToConvention: {relative}"), rows=rows.replace("PHASE", str(phase)),
    )  # fmt: skip
    surge = rao_of(tmp_path, text).response["surge"][0][0]
    assert surge == pytest.approx(2.0 * cmath.exp(-1j * math.radians(40.0)), abs=1e-9)


def test_raos_in_signs_units_and_the_other_half_circle(tmp_path: Path) -> None:
    radians = changed(("ResponseUnits: degrees", "ResponseUnits: radians"), ("Starboard: down", "Starboard: up"))
    there, here = rao_of(tmp_path, data_text()), rao_of(tmp_path, radians)
    assert [round(math.degrees(each)) for each in there.direction] == [0, 45, 90, 135, 180, 225, 270, 315]
    assert there.frequency[:2] == pytest.approx((2.0 * math.pi / 40.0, 2.0 * math.pi / 2.0))
    for n, mode in enumerate(MODES):
        left, right = there.response[mode][1][0], there.response[mode][7][0]
        assert right == pytest.approx(left * (-1.0) ** n, abs=1e-9)  # sway, roll and yaw change signs
    assert here.response["roll"][1][0] == pytest.approx(-math.degrees(1.0) * there.response["roll"][1][0], rel=1e-9)
    assert there.response["pitch"][1][0] == pytest.approx(math.radians(2.0) * 1j, rel=1e-9)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("Symmetry: xz plane", "Symmetry: Circular", "Symmetry Circular"),
        ("PhaseOrigin: [~, ~, ~]", "PhaseOrigin: [0, 0, 0]", "PhaseOrigin"),
        ("SuperimposedMotion: RAOs + harmonics", "SuperimposedMotion: Time history", "SuperimposedMotion Time history"),
        ("Draught: Laden", "Draught: Empty", "there is no draught Empty"),
        ("- [2, ~]", "- [Infinity, ~]", "clamped: a joint of"),
        ("0, 170, 0]", "30, 170, 0]", "out of the riser's plane"),
        ("PoissonRatio: 0.5", "PoissonRatio: 0.3", "PoissonRatio 0.3"),
        ("OuterContactDiameter: ~", "OuterContactDiameter: 0.4", "OD touches here"),
        ("SeabedAxialFrictionCoefficient: ~", "SeabedAxialFrictionCoefficient: 0", "neither may be 0"),
        ("SeabedShearStiffness: ~", "SeabedShearStiffness: 50", "over D/30"),
        ("Wheeler stretching", "Extrapolation stretching", "KinematicStretchingMethod Extrapolation"),
        ("WaveType: Airy", "WaveType: Ochi-Hubble", "WaveType Ochi-Hubble"),
        ("ContentsPressure: 0", "ContentsPressure: 900", "ContentsPressureRefZ"),
        ("VariationMethod: Interpolated", "VariationMethod: Power law", "current by Power law"),
    ],
)  # fmt: skip
def test_what_a_scene_cannot_have_is_reported(old: str, new: str, message: str, tmp_path: Path) -> None:
    text = changed((old, new))
    pairs = zip(text.splitlines(), data_text().splitlines(), strict=True)
    line = next(n for n, (a, b) in enumerate(pairs, 1) if a != b)
    result = imported(tmp_path, text)
    assert any(message in text and n == line for n, text in result.remarks)
    for name, content in result.files.items():
        (tmp_path / name).write_text(content)
    scene_from_mapping(result.data, tmp_path)


def test_a_flex_joint(tmp_path: Path) -> None:
    """End A's axis points down the line: upwards it leans by what the declination lacks of 180."""
    joint = imported(tmp_path, data_text()).data["riser"]["end"]["rotation"]
    assert joint["stiffness"] == pytest.approx(2.0e3 * 180.0 / math.pi)
    assert joint["neutral_angle"] == pytest.approx(10.0)
    away = imported(tmp_path, changed(("0, 170, 0]", "180, 170, 0]"))).data["riser"]["end"]["rotation"]
    assert away["neutral_angle"] == pytest.approx(-10.0)


def test_a_wave_from_an_origin_in_space_and_time(tmp_path: Path) -> None:
    """The surface as OrcaFlex has it, whose time is 0 after the build-up of 8 s."""
    text = changed(("WaveOrigin: [0, 0]", "WaveOrigin: [12, 5]"), ("WaveDirection: 180", "WaveDirection: 150"))
    result = imported(tmp_path, text)
    for name, content in result.files.items():
        (tmp_path / name).write_text(content)
    waves = components_of(scene_from_mapping(result.data, tmp_path))
    assert waves is not None
    toward, w, t = math.radians(150.0), 2.0 * math.pi / 8.0, 3.7
    k = float(wave_number(np.array([w]), G, 100.0)[0])
    ahead = (30.0 - 12.0) * math.cos(toward) + (-7.0 - 5.0) * math.sin(toward)
    along = 30.0 * np.cos(waves.direction) - 7.0 * np.sin(waves.direction)
    ours = waves.wave_number * along - waves.frequency * (t + 8.0) + waves.phase
    theirs = k * ahead - w * (t - 2.0)
    assert float(waves.amplitude[0] * np.cos(ours)[0]) == pytest.approx(math.cos(theirs), abs=1e-9)


def test_spectra(tmp_path: Path) -> None:
    """Pierson and Moskowitz: m0 = 1/5 and m2 = sqrt(pi/1.25)/4 of x^-5 exp(-1.25 x^-4)."""
    assert mean_period(1.0) == pytest.approx(math.sqrt(0.2 / (0.25 * math.sqrt(math.pi / 1.25))), rel=1e-4)
    sea = "WaveHs: 4\n      WaveTz: 7\n      WaveGamma: 2.5"
    waves = imported(tmp_path, changed(("WaveType: Airy", f"WaveType: JONSWAP\n      {sea}"))).data["water"]["waves"]
    assert waves["jonswap"]["Tp"] == pytest.approx(7.0 / mean_period(2.5))
    waves = imported(tmp_path, changed(("WaveType: Airy", f"WaveType: ISSC\n      {sea}"))).data["water"]["waves"]
    assert waves["pierson_moskowitz"]["Tp"] == pytest.approx(7.0 / mean_period(1.0))


def test_a_homogeneous_pipe(tmp_path: Path) -> None:
    text = changed(
        ("Category: General", "Category: Homogeneous pipe\n    E: 200e6\n    MaterialDensity: 7.85"),
        ("PoissonRatio: 0.5", "PoissonRatio: 0.3"),
    )
    (pipe,) = imported(tmp_path, text).data["line_types"].values()
    area, inertia = math.pi / 4.0 * (0.09 - 0.04), math.pi / 64.0 * (0.3**4 - 0.2**4)
    assert (pipe["mass"], pipe["EA"], pipe["EI"]) == pytest.approx((7850.0 * area, 2e11 * area, 2e11 * inertia))
    assert pipe["GJ"] == pytest.approx(2e11 / 2.6 * 2.0 * inertia)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("UnitsSystem: SI", "UnitsSystem: US", r"riser.yml:5: General: UnitsSystem: is US; save it in SI units"),
        ("Lines:", "BaseFile: other.yml\nLines:", r"riser.yml:\d+: BaseFile: takes from another file"),
        ("Lines:", "RestartingFrom: other.yml\nLines:", r"riser.yml:\d+: RestartingFrom: takes from another file"),
        ("General:", "Universal:", "has no General and Lines"),
        ("OD: 0.30", "OD: wide", r"riser.yml:\d+: LineTypes 8\" hose: OD: is 'wide', neither a number nor the name"),
        ("OD: 0.30", "OD: Infinity", r"riser.yml:\d+: .* OD: is Infinity, not a finite number"),
        ("OD: 0.30", "OD: 0", r"riser.yml:\d+: .* OD: is 0; give a number above 0"),
        ("NormalDragLiftDiameter: 0.36", "NormalDragLiftDiameter: 0", r"NormalDragLiftDiameter: is 0; give a number"),
        ("EI: [50, ~]", "EI: [[1, 2], ~]", r"riser.yml:\d+: .* EI: is \[1, 2\], not a number"),
        ("WavePeriod: 8", "WavePeriod: 0", r"riser.yml:\d+: .* WavePeriod: is 0; give a number above 0"),
        ("WaterDepth: 100", "SeabedOriginDepth: 100\n  WaterDepth: 90", r"OriginDepth: gives a depth of 100 m"),
        ("    EA: 4.0e5\n", "", r"riser.yml:\d+: .* EA: is missing"),
        ("Cd: [1.2, ~, 0.01]", "Cd: [Table, ~, 0.01]", r"riser.yml:\d+: .* Cd: is 'Table', neither a number"),
        ("EI: [50, ~]", "EI: [Bending, ~]", r"riser.yml:\d+: .* EI: is 'Bending': a stiffness by a table"),
        ("SeabedSlope: 0", "SeabedSlope: 3", r"riser.yml:\d+: Environment: SeabedSlope: is 3: only a level"),
        ("SeabedModel: Elastic", "SeabedModel: Gravel", r"riser.yml:\d+: .* SeabedModel: is Gravel; give Elastic"),
        ("[Ship, -20", "[Buoy, -20", r"riser.yml:\d+: Lines Riser: Connection: is Buoy, which is no vessel"),
        ("Orientation: [0, 0, 180]", "Orientation: [0, 5, 180]", r"heel 0 and trim 5"),
        ("VesselType: Barge", "VesselType: Tug", r"Vessels Ship: VesselType: Tug is not among the VesselTypes"),
        ('[8" hose, 110', "[pipe, 110", r"Lines Riser: LineType: pipe is not among the LineTypes"),
        ("ContentsMethod: Uniform", "ContentsMethod: Free flooding", r"ContentsMethod: is Free flooding"),
        ("- Name: Ship", "- Name: [Ship", r"riser.yml:\d+: not valid YAML"),
    ],
)  # fmt: skip
def test_a_file_that_gives_no_scene_has_one_line(old: str, new: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=message) as error:
        imported(tmp_path, changed((old, new)))
    *said, last = str(error.value).splitlines()
    assert re.search(message, last)
    assert not said or re.search("none is written; .*: 1$", said[-1])
    assert all("not carried over" in line for line in said[:-1])


def test_no_such_line(tmp_path: Path) -> None:
    (tmp_path / "riser.yml").write_text(data_text())
    with pytest.raises(SceneError, match=telling("no line Third", "Riser, Other")):
        scene_of(read_data(tmp_path / "riser.yml"), "Third")


