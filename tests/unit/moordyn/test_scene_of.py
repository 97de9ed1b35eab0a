"""Scenes of MoorDyn v2 decks: their numbers, and each entry that is not carried over, by its line."""

from __future__ import annotations

import ast
import math
from pathlib import Path
from types import SimpleNamespace

import pytest
from typer.testing import CliRunner

from riser_soil.commands.app import app
from riser_soil.errors import SceneError
from riser_soil.moordyn.deck import Deck, read_deck
from riser_soil.moordyn.deck_of import deck_of
from riser_soil.moordyn.scene_of import scene_of
from riser_soil.scene.dump import yaml_text
from riser_soil.scene.reader import read_scene, scene_from_mapping
from tests.support.said import line_with, telling
from tests.support.scenes import Mapping

PEER = Path(__file__).parents[3] / "benchmarks" / "peers" / "moordyn.py"
DECK = """--------------------- MoorDyn Input File ---------------------
A lazy wave of a power cable
---------------------- LINE TYPES ----------------------
TypeName   Diam    Mass/m     EA     BA/-zeta    EI        Cd     Ca    CdAx   CaAx   Cl
(name)     (m)     (kg/m)     (N)    (N-s/-)     (N-m^2)   (-)    (-)   (-)    (-)    (-)
cable      0.20    72.0     6.0e8    -0.8        2.0e4     1.2    1.0   0.05   0.1    0
buoyed     0.40    90.0     6.0d8|9.0e8    0     0         1.1    0.9   0.0    0.0    0.3
---------------------- BODIES ----------------------
ID   Attachment  X0     Y0    Z0     r0      p0     y0     Mass  CG*   I*      Volume   CdA*   Ca*
(#)   (word)     (m)    (m)   (m)   (deg)   (deg)  (deg)   (kg)  (m)  (kg-m^2)  (m^3)   (m^2)  (-)
1     coupled     5     0      -10     0       0      0       0     0     0        0       0      0
---------------------- POINTS ----------------------
ID   Attachment  X       Y     Z      Mass   Volume  CdA    Ca
(#)  (word/ID)  (m)     (m)   (m)    (kg)   (m^3)   (m^2)  (-)
1    Body1       1       0      2      0      0       0      0
2    Free        60      0    -40     50      0.2    0.1    0.5
3    Free        90      0    -60      0      0       0      0   # the lower joint
4    Fixed      150      0   -100      0      0       0      0
5    Fixed     -150      0   -100      0      0       0      0
---------------------- LINES ----------------------
ID   LineType   AttachA  AttachB  UnstrLen  NumSegs  LineOutputs
(#)   (name)     (ID)     (ID)      (m)       (-)      (-)
1     cable       1        2         80        40       pt
2     buoyed      2        3         40        20       -
3     cable       4        3         90        45       -
4     cable       5        1        210        50       -
---------------------- EXTERNAL LOADS ----------------------
ID    Object          Fext             Blin          Bquad         CSys
(#)   (name)           (N)            (Ns/m)       (Ns^2/m^2)      (-)
3    Point1       0.0|0.0|0.0     0.0|0.0|0.0     0.0|0.0|0.0      -
---------------------- OPTIONS ----------------------
0.002         dtM           time step
1.0e6         kbot          bottom stiffness (Pa/m)
3.0e5         cbot          bottom damping (Pa-s/m)
100           WtrDpth       depth
9.80665       g
1000.0        rho
0.3           FrictionCoefficient
0             WaveKin
---------------------- OUTPUTS ----------------------
FairTen1
---------------------- need this line ----------------------
"""


def deck(folder: Path, text: str = DECK) -> Deck:
    (folder / "LINE.dat").write_text(text)
    return read_deck(folder / "LINE.dat")


def read(deck: Deck, line: str | None = None) -> Mapping:
    """The scene as it is checked, in plain data."""
    return scene_from_mapping(scene_of(deck, line).data).model_dump(by_alias=True)


def test_a_lazy_wave(tmp_path: Path) -> None:
    """The riser goes from the anchor, along lines that are written in either direction."""
    scene = read(deck(tmp_path))
    riser, cable, buoyed = scene["riser"], scene["line_types"]["cable"], scene["line_types"]["buoyed"]
    segments = [(each["line_type"], each["length"], each["elements"]) for each in riser["segments"]]
    assert segments == [("cable", 90.0, 45), ("buoyed", 40.0, 20), ("cable", 80.0, 40)]
    assert riser["start"]["position"] == (150.0, 0.0, -100.0)
    assert riser["end"]["position"] == (6.0, 0.0, -8.0)
    (joint,) = riser["attachments"]
    values = [joint[key] for key in ("at", "mass", "volume", "drag_area", "added_mass")]
    assert values == [130.0, 50.0, 0.2, 0.1, 0.5]
    assert [cable[key] for key in ("outer_diameter", "mass", "EA", "EI")] == [0.2, 72.0, 6.0e8, 2.0e4]
    assert cable["drag"] == {"normal": 1.2, "tangential": 0.05, "by_reynolds": None}
    assert cable["added_mass"] == {"normal": 1.0, "tangential": 0.1}
    assert (buoyed["EA"], buoyed["EI"]) == (6.0e8, 0.0)
    water, seabed, friction = scene["water"], scene["seabed"], scene["contact"]["friction"]
    assert (scene["gravity"], water["density"], water["surface_level"]) == (9.80665, 1000.0, 0.0)
    assert (seabed["kind"], seabed["level"], seabed["contact_at"]) == ("spring", -100.0, "axis")
    assert seabed["stiffness"] == pytest.approx(1.0e6 * 0.2)
    assert (friction["axial"], friction["lateral"]) == (0.3, 0.3)


def test_what_is_not_carried_over_is_reported_by_line(tmp_path: Path) -> None:
    remarks = dict[int, list[str]]()
    for line, text in scene_of(deck(tmp_path)).remarks:
        remarks.setdefault(line, []).append(text)
    assert sorted(remarks) == [6, 7, 11, 15, 25, 26, 34], "outputs and a force of 0 change nothing"
    for line, word in {6: "BA", 11: "bodies", 15: "motion", 25: "kBot", 26: "--line 4", 34: "cbot"}.items():
        assert word in remarks[line][0]
    assert [text.split()[0] for text in remarks[7]] == ["Cl", "EA"]


def test_another_line_of_the_deck(tmp_path: Path) -> None:
    assert [each["length"] for each in read(deck(tmp_path), "4")["riser"]["segments"]] == [210.0]


def test_the_deck_of_the_comparison_with_moordyn(tmp_path: Path) -> None:
    """Written for MoorDyn from a case, and read again."""
    tree = ast.parse(PEER.read_text())
    text = next(
        ast.literal_eval(node.value)
        for node in tree.body
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "DECK"
    )
    case = SimpleNamespace(
        diameter=0.1, mass=12.5, EA=1.5e6, EI=0.57, drag=1.1, added_mass=0.9, length=25.0,
    )  # fmt: skip
    written = text.format(
        case=case, damping=0.8, start=(0.0, -5.0), end=(18.0, -1.0), elements=30, time_step=1e-3, gravity=9.81,
        water=998.0, depth=5.0, relaxed=0, kBot=2.0e4 / case.diameter,
    )  # fmt: skip
    scene = read(deck(tmp_path, written))
    (kind,), (segment,) = scene["line_types"].values(), scene["riser"]["segments"]
    known = vars(case) | {"outer_diameter": case.diameter}
    assert [kind[key] for key in ("outer_diameter", "mass", "EA", "EI")] == [
        known[key] for key in ("outer_diameter", "mass", "EA", "EI")
    ]
    assert (kind["drag"]["normal"], kind["added_mass"]["normal"]) == (case.drag, case.added_mass)
    assert (segment["length"], segment["elements"]) == (case.length, 30)
    assert (scene["riser"]["start"]["position"], scene["riser"]["end"]["position"]) == ((0, 0, -5.0), (18.0, 0, -1.0))
    assert scene["seabed"]["stiffness"] == pytest.approx(2.0e4)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("3     cable       4        3", "3     cable       4        2", "LINE.dat:25: line 3 is a third at"),
        ("1     cable       1        2", "1     chain       1        2", r"LINE.dat:23: line type chain is not among"),
        ("6.0e8    -0.8", "stiff.dat    -0.8", r"LINE.dat:6: EA of cable is 'stiff.dat', a curve"),
        ("80        40", "80        nan", r"LINE.dat:23: NumSegs is 'nan', not a finite number"),
        ("150      0   -100      0      0       0      0", "150 0 -100", r"LINE.dat:18: 5 entries, where a row"),
        ("1     cable       1        2", "1     cable       9        2", r"LINE.dat:23: line 1 ends at 9, which"),
        ("5     0      -10     0       0", "5     0      -10     5       3", "LINE.dat:11: body 1 is turned about 2"),
        ("ID   LineType   AttachA  AttachB  UnstrLen", "ID   LineType   UnstrLen", r"LINE.dat:21: headings .* LINES"),
        ("LINES -", "CABLES -", "has no LINES"),
    ],
)  # fmt: skip
def test_decks_that_give_no_scene(old: str, new: str, message: str, tmp_path: Path) -> None:
    assert old in DECK
    with pytest.raises(SceneError, match=message):
        scene_of(deck(tmp_path, DECK.replace(old, new)))


def test_the_command_writes_a_scene_once(tmp_path: Path) -> None:
    deck(tmp_path)
    arguments = ["import", str(tmp_path / "LINE.dat"), "-o", str(tmp_path / "scene.yaml")]
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 0
    line_with(done.output, "LINE.dat:34:", "not carried over:", "cbot 3.0e5:", "seabed's damping")
    assert read_scene(tmp_path / "scene.yaml") == scene_from_mapping(scene_of(deck(tmp_path)).data)
    line_with((tmp_path / "scene.yaml").read_text(), "# LINE.dat:34:", "not carried over")
    again = CliRunner().invoke(app, arguments)
    assert (again.exit_code, "--force" in again.output) == (2, True)


@pytest.mark.parametrize(
    ("rows", "friction"),
    [
        ("0.4 mu_kA\n0.6 mu_kT", (0.4, 0.6)),
        ("0.3 FrictionCoefficient", (0.3, 0.3)),
    ],
)
def test_friction_along_and_across(rows: str, friction: tuple[float, float], tmp_path: Path) -> None:
    """MoorDyn-F has two coefficients, MoorDyn-C one."""
    given = read(deck(tmp_path, DECK.replace("0.3           FrictionCoefficient", rows)))["contact"]["friction"]
    assert (given["axial"], given["lateral"]) == friction


def test_friction_in_one_direction_alone_is_reported(tmp_path: Path) -> None:
    """Each of the two coefficients of MoorDyn-F is 0 where it is not given."""
    imported = scene_of(deck(tmp_path, DECK.replace("0.3           FrictionCoefficient", "0.6 MU_KT")))
    assert "contact" not in imported.data
    line_with([f"{line}: {text}" for line, text in imported.remarks], "38:", "friction", "0 along", "0.6 across")


@pytest.mark.parametrize("friction", ["0.3           Fric", "0.3           mu_kA\n0.5 mu_kT\n0.1 Fric"])
@pytest.mark.parametrize("line", ["1", "4"])
def test_a_scene_comes_back_from_its_deck(line: str, friction: str, tmp_path: Path) -> None:
    """The scene of a deck, its deck, and that one's scene, which has all its numbers to the last digit."""
    first = scene_of(deck(tmp_path, DECK.replace("0.3           Fric", friction)), line)
    scene = scene_from_mapping(first.data)
    (tmp_path / "back.dat").write_text(deck_of(scene))
    back = scene_of(read_deck(tmp_path / "back.dat"))
    assert scene_from_mapping(back.data) == scene
    assert back.data == first.data
    words = {text.split()[0] for _, text in back.remarks}
    assert words == {"BA/-zeta"} | ({"kBot"} if line == "1" else set())  # of two diameters


def test_the_step_of_a_deck_is_short_enough(tmp_path: Path) -> None:
    """Half of 1/w of the fastest node: w^2 = 4 EA/m l^2, elements of 4.2 m."""
    text = deck_of(scene_from_mapping(scene_of(deck(tmp_path), "4").data))
    (step,) = (line.split()[0] for line in text.splitlines() if line.endswith("dtM"))
    assert float(step) == pytest.approx(0.25 * 4.2 * math.sqrt(72.0 / 6.0e8), rel=0.05)


def test_contents_and_attachments_within_a_segment(tmp_path: Path) -> None:
    """Contents count in the mass; what sits within a segment cuts it; a bed that bears the outside is half a diameter
    higher for the axis; heights count from the surface.
    """
    data = scene_of(deck(tmp_path), "4").data
    (segment,), kind = data["riser"]["segments"], data["line_types"]["cable"]
    kind["inner_diameter"], data["seabed"]["contact_at"] = 0.1, "outer"
    data["riser"]["contents"] = {"density": 900.0}
    data["riser"]["attachments"] = [{"at": [63.0, 84.0], "mass": 70.0, "volume": 0.1}]
    data["water"]["surface_level"] = 20.0
    (tmp_path / "back.dat").write_text(deck_of(scene_from_mapping(data)))
    back = scene_of(read_deck(tmp_path / "back.dat")).data
    assert back["line_types"]["cable"]["mass"] == pytest.approx(kind["mass"] + 900.0 * math.pi / 4.0 * 0.1**2)
    assert [each["length"] for each in back["riser"]["segments"]] == pytest.approx([63.0, 21.0, 126.0])
    assert [each["elements"] for each in back["riser"]["segments"]] == [15, 5, 30]
    assert [each["at"] for each in back["riser"]["attachments"]] == pytest.approx([63.0, 84.0])
    assert back["seabed"]["level"] == -100.0 - 20.0 + 0.1
    assert back["riser"]["start"]["position"][2] == data["riser"]["start"]["position"][2] - 20.0
    assert segment["elements"] == 50


def test_the_export_tells_what_a_deck_lacks(tmp_path: Path) -> None:
    text = tmp_path / "scene.yaml"
    data = scene_of(deck(tmp_path), "4").data
    data["water"] |= {"current": {"profile": [[0.0, 0.5, 0.0]]}}
    data["line_types"]["cable"] |= {"GJ": 100.0, "damping": {"ratio": 0.01, "frequency": 0.1}}
    data["stages"] += [{"name": "later", "kind": "dynamic", "duration": 2.0, "time_step": 0.1}]
    text.write_text(yaml_text(data))
    done = CliRunner().invoke(app, ["export", str(text), "-o", str(tmp_path / "out.dat")])
    assert done.exit_code == 0, done.output
    remarks = [
        line.split("not in the deck: ")[1].split()[0] for line in done.output.splitlines() if "not in the" in line
    ]
    assert remarks == [
        "water.current.profile", "line_types.cable.GJ", "line_types.cable.damping.ratio",
        "line_types.cable.damping.frequency", "stages.1.kind", "stages.1.duration", "stages.1.time_step",
    ]  # fmt: skip
    again = CliRunner().invoke(app, ["export", str(text), "-o", str(tmp_path / "out.dat")])
    assert (again.exit_code, "--force" in again.output) == (2, True)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"water": {"density": 1000.0}}, "water.surface_level: is missing"),
        ({"seabed": {"kind": "rigid", "level": -101.0}}, "seabed: a deck has no other ground than kind spring"),
    ],
)
def test_scenes_that_give_no_deck(change: Mapping, message: str, tmp_path: Path) -> None:
    data = scene_of(deck(tmp_path), "4").data | change
    (tmp_path / "scene.yaml").write_text(yaml_text(data))
    done = CliRunner().invoke(app, ["export", str(tmp_path / "scene.yaml"), "-o", str(tmp_path / "out.dat")])
    assert done.exit_code == 2
    assert message in done.output
    assert not (tmp_path / "out.dat").exists()


def test_a_deck_has_one_drag_coefficient(tmp_path: Path) -> None:
    data = scene_of(deck(tmp_path), "4").data
    data["line_types"]["cable"]["drag"] = {"by_reynolds": [[1e4, 1.2], [1e6, 0.7]]}
    with pytest.raises(SceneError, match=telling("line_types.cable.drag.by_reynolds:", "deck has one")):
        deck_of(scene_from_mapping(data))
