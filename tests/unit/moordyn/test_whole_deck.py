"""Whole decks of MoorDyn v2: lines, free points with and without mass, free bodies; what is refused and reported."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from riser_soil.commands.app import app
from riser_soil.errors import SceneError
from riser_soil.moordyn.deck import read_deck
from riser_soil.moordyn.whole_deck import whole_scene_of
from riser_soil.scene.bodies import SolidBody
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.riser import Support

DECK = """--------------------- MoorDyn Input File ---------------------
A spar on three lines, one of them in two parts, and a buoy
---------------------- LINE TYPES ----------------------
TypeName   Diam    Mass/m     EA     BA/-zeta    EI        Cd     Ca    CdAx   CaAx
(name)     (m)     (kg/m)     (N)    (N-s/-)     (N-m^2)   (-)    (-)   (-)    (-)
chain      0.10    50.0     4.0e8    0           0         1.2    1.0   0.05   0.0
rope       0.15    20.0     2.0e8    0           1.0e4     1.2    1.0   0.05   0.0
---------------------- BODIES ----------------------
ID   Attachment  X0     Y0    Z0     r0      p0     y0     Mass    CG    I             Volume  CdA          Ca
(#)   (word)     (m)    (m)   (m)   (deg)   (deg)  (deg)   (kg)    (m)   (kg-m^2)      (m^3)   (m^2)        (-)
1     free        0     0      -30    0       0      0     2.0e4   -2.0  8e4|8e4|4e4   80.0    20.0|300.0   0.6|0.6|0.3
---------------------- POINTS ----------------------
ID   Attachment  X       Y     Z      Mass   Volume  CdA    Ca
(#)  (word/ID)  (m)     (m)   (m)    (kg)   (m^3)   (m^2)  (-)
1    Fixed      200      0   -100      0      0       0      0
2    Fixed     -100   173.2  -100      0      0       0      0
3    Fixed     -100  -173.2  -100      0      0       0      0
4    Body1       2       0     -3      0      0       0      0
5    Body1      -1   1.732     -3      0      0       0      0
6    Body1      -1  -1.732     -3      0      0       0      0
7    Free       100      0    -65      0      0       0      0
8    Free      -50    -86.6   -40    500     2.0     0.8    0.5
---------------------- LINES ----------------------
ID   LineType   AttachA  AttachB  UnstrLen  NumSegs  LineOutputs
(#)   (name)     (ID)     (ID)      (m)       (-)      (-)
1     chain       1        7        110        20       p
2     rope        4        7        105        20       -
3     rope        2        5        212        40       -
4     chain       3        8        130        20       -
5     rope        8        6         100       20       -
---------------------- OPTIONS ----------------------
100           WtrDpth
1.0e5         kbot
1025.0        rho
"""


def imported(tmp_path: Path, text: str = DECK) -> tuple[dict[str, Any], list[str]]:
    file = tmp_path / "deck.dat"
    file.write_text(text)
    scene = whole_scene_of(read_deck(file))
    return scene.data, [f"{line}: {what}" for line, what in scene.remarks]


def test_a_whole_deck(tmp_path: Path) -> None:
    data, remarks = imported(tmp_path)
    scene = scene_from_mapping(data)
    assert [*scene.lines] == ["line1_2", "line3", "line4", "line5"]
    assert [line.length for line in scene.lines.values()] == [215.0, 212.0, 130.0, 100.0]
    anchor = scene.lines["line3"].start
    assert isinstance(anchor, Support)
    assert anchor.position == (-100.0, 173.2, -100.0)
    point, body = scene.bodies["point8"], scene.bodies["body1"]
    assert (body.kind, body.position, body.mass, body.volume) == ("rigid", (0.0, 0.0, -30.0), 2.0e4, 80.0)
    assert isinstance(body, SolidBody)
    assert body.centre_of_gravity == body.centre_of_buoyancy == (0.0, 0.0, -2.0), "MoorDyn lets both act there"
    assert body.drag_area == (20.0, 20.0, 20.0)
    assert body.rotational_drag == (300.0, 300.0, 300.0)
    assert body.added_mass == (0.6, 0.6, 0.3)
    assert (point.kind, point.mass, point.volume) == ("point", 500.0, 2.0)
    between = {name: joint.model_dump(exclude_none=True)["between"] for name, joint in scene.joints.items()}
    assert [*between] == ["at4", "at5", "at8_1", "at8_2", "at6"], "chain and rope are one where nothing sits"
    assert between["at4"][0] == {"body": "body1", "offset": (2.0, 0.0, -3.0)}
    assert [(each[1]["line"], each[1]["at"]) for each in between.values()] == [
        ("line1_2", "end"), ("line3", "end"), ("line4", "end"), ("line5", "start"), ("line5", "end"),
    ]  # fmt: skip
    assert [each for each in remarks if "GJ" in each] != []
    assert scene.seabed is not None


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("-30    0       0      0 ", "-30    0       9.0    0 ", "deck.dat:11: body 1 is turned"),
        ("20.0|300.0   0.6|0.6|0.3", "20.0|300.0", "deck.dat:11: 13 entries, where a row of BODIES has 14; give Ca"),
        ("8e4|8e4|4e4", "0", "deck.dat:11: body 1 has no inertia"),
        ("8e4|8e4|4e4", "8e4|4e4", "deck.dat:11: I is '8e4|4e4', 2 numbers; give 1 or 3"),
    ],
)
def test_what_is_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        imported(tmp_path, DECK.replace(old, new))


def test_the_command_writes_the_whole_deck(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("deck.dat").write_text(DECK)
    result = CliRunner().invoke(app, ["import", "deck.dat", "--line", "all", "-o", "all.yaml"])
    assert result.exit_code == 0, result.output
    assert len(read_scene("all.yaml").joints) == 5
