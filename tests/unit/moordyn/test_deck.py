"""Old and new formats of decks, and rows that do not fit them: forces, areas and masses keep their meaning."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from riser_soil.errors import SceneError
from riser_soil.moordyn.deck import read_deck
from riser_soil.moordyn.scene_of import scene_of
from riser_soil.scene.reader import scene_from_mapping
from tests.support.moordyn_decks import LINES, POINTS, TYPES, deck_of_text, text_of_deck
from tests.support.said import line_with

VERSION_1 = """MoorDyn v1
Two pieces of chain
---------------------- LINE DICTIONARY --------------------
1  NTypes  - number of line types
LineType Diam MassDenInAir EA BA/-zeta Can Cat Cdn Cdt
(-) (m) (kg/m) (N) (Pa-s/-) (-) (-) (-) (-)
chain 0.11 150 5.5e8 -1.0 0.9 0.2 1.6 0.3
---------------------- NODE PROPERTIES --------------------
3 NConnects
Node Type X Y Z M V FX FY FZ CdA CA
(-) (-) (m) (m) (m) (kg) (m^3) (kN) (kN) (kN) (m^2) (-)
1 Fix -400 0 -90 0 0 0 0 0 0 0
2 Vessel 0 0 -10 0 0 0 0 0 0 0
3 Connect -150 0 -60 800 0.3 0 0 -2500 0.7 0.4
---------------------- LINE PROPERTIES --------------------
2 NLines - number of line objects
Line LineType UnstrLen NumSegs NodeAnch NodeFair Flags/Outputs
(-) (-) (m) (-) (-) (-) (-)
1 chain 260 26 1 3 p
2 chain 165 20 3 2 p
---------------------- SOLVER OPTIONS ---------------------
0.001 dtM
90 WtrDpth
---------------------- OUTPUTS ----------------------------
FairTen1
--------------------- need this line ----------------------
"""


def imported(folder: Path, text: str) -> tuple[dict[str, Any], list[str]]:
    scene = scene_of(deck_of_text(folder, text))
    scene_from_mapping(scene.data)
    return scene.data, [f"{line}: {what}" for line, what in scene.remarks]


def test_a_deck_of_version_1(tmp_path: Path) -> None:
    data, remarks = imported(tmp_path, VERSION_1)
    chain = data["line_types"]["chain"]
    assert [chain[key] for key in ("outer_diameter", "mass", "EA", "EI")] == [0.11, 150.0, 5.5e8, 0.0]
    assert chain["drag"] == {"normal": 1.6, "tangential": 0.3}
    assert chain["added_mass"] == {"normal": 0.9, "tangential": 0.2}
    riser = data["riser"]
    assert [(each["length"], each["elements"]) for each in riser["segments"]] == [(260.0, 26), (165.0, 20)]
    (joint,) = riser["attachments"]
    assert joint == {"at": 260.0, "mass": 800.0, "volume": 0.3, "drag_area": 0.7, "added_mass": 0.4}
    assert data["stages"][0]["loads"] == [{"at": 260.0, "force": [0.0, 0.0, -2500.0], "keep": True}]
    assert data["seabed"]["stiffness"] == pytest.approx(3.0e6 * 0.11)
    assert [each.split(":")[0] for each in remarks] == ["7", "7", "13"], "damping, torsion, motion"


def test_headings_of_version_1_over_entries_of_version_2(tmp_path: Path) -> None:
    """Entries of lines that can't be in the order of their headings; points whose further columns would be 0 anyway."""
    text = VERSION_1.replace("1 chain 260 26 1 3 p", "1 chain 1 3 260 26 p")
    text = text.replace("2 chain 165 20 3 2 p", "2 chain 3 2 165.5 20 p")
    text = text.replace("1 Fix -400 0 -90 0 0 0 0 0 0 0", "1 Fix -400 0 -90 0 0 0 0")
    data, remarks = imported(tmp_path, text)
    assert [(each["length"], each["elements"]) for each in data["riser"]["segments"]] == [(260.0, 26), (165.5, 20)]
    line_with(remarks, "17:", "entries of LINES", "unlike their headings")
    with pytest.raises(SceneError, match=r"deck.dat:12: 9 entries, where a row of POINTS has 12; give CdA, Ca"):
        imported(tmp_path, text.replace("1 Fix -400 0 -90 0 0 0 0", "1 Fix -400 0 -90 0 0 1.5 0"))


def test_forces_without_headings_are_refused(tmp_path: Path) -> None:
    """MoorDyn takes the 8th to 10th of twelve entries for forces, and their headings call them areas."""
    twelve = [*POINTS[:3], POINTS[3] + " 0 0.3 0.5"]
    with pytest.raises(SceneError, match=r"deck.dat:10: 12 entries under 9 headings"):
        imported(tmp_path, text_of_deck(points=twelve))
    idle = [*POINTS[:3], POINTS[3] + " 0 0 0"]
    line_with(imported(tmp_path, text_of_deck(points=idle))[1], "10:", "0 0 0:", "without a heading")


@pytest.mark.parametrize(
    ("part", "old", "new", "said"),
    [
        ("lines", "24 -", "24 - and more", "14: and more: entries without a heading"),
        ("line_types", "0.04 0.02", "0.04 0.02 0.4", "5: 0.4: entries without a heading"),
        ("points", "-5 0 0 0 0", "-5 0 0 0 0 the fairlead", "10: the fairlead: entries without a heading"),
    ],
)
def test_entries_beyond_the_columns_are_reported(part: str, old: str, new: str, said: str, tmp_path: Path) -> None:
    rows = {"lines": LINES, "line_types": TYPES, "points": POINTS}[part]
    more = {part.replace("_", " ").upper(): [row.replace(old, new) for row in rows]}
    data, remarks = imported(tmp_path, text_of_deck(more))
    assert data == imported(tmp_path, text_of_deck())[0]
    assert said in remarks


def test_columns_that_moordyn_does_not_have(tmp_path: Path) -> None:
    """Values of unknown columns are reported, unless they are 0."""
    extra = [TYPES[0] + " MBL", TYPES[1] + " (N)", TYPES[2] + " 2e6", TYPES[2].replace("rope", "spare") + " 0"]
    line_with(imported(tmp_path, text_of_deck(line_types=extra))[1], "5:", "2e6 under MBL", "LINE TYPES")


def test_comments_and_empty_rows(tmp_path: Path) -> None:
    text = text_of_deck().replace("1 rope 1 2", "\n# a note\n! another\n1 rope 1 2").replace("24 -", "24 - % last")
    assert imported(tmp_path, text)[0] == imported(tmp_path, text_of_deck())[0]


def test_ends_and_numbers_in_other_spellings(tmp_path: Path) -> None:
    text = text_of_deck().replace("1 rope 1 2 258.5", "01 rope p1 Point02 2.585d2").replace("4.2e7", "4.2D+7")
    assert imported(tmp_path, text)[0] == imported(tmp_path, text_of_deck())[0]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("(-) (-) (m) (m) (m) (kg) (m3) (m2) (-)\n", "", r"deck.dat:8: an entry of POINTS in the place of the units"),
        ("2 Coupled", "1 Coupled", r"deck.dat:10: ID 1 of POINTS is that of line 9, too"),
        ("ID Attachment X Y Z Mass", "Nr Where E N Up Kilo", "deck.dat:7: headings Nr Where .* MoorDyn has ID At"),
        ("Name Diam Mass/m EA BA/-zeta", "LineType Diam MassDenInAir EA CB", r"deck.dat:3: .* are headings of MAP\+\+"),
        ("4.2e7", "curve.txt", r"deck.dat:5: EA of rope is 'curve.txt', a curve from a file"),
        ("4.2e7 -0.9 0 1.3 1.1 0.04 0.02", "4.2e7 -0.9 0 1.3 1.1", r"deck.dat:5: 8 entries, .* give CdAx, CaAx"),
    ],
)
def test_what_is_refused(old: str, new: str, message: str, tmp_path: Path) -> None:
    text = text_of_deck()
    assert text.count(old) == 1
    with pytest.raises(SceneError, match=message):
        imported(tmp_path, text.replace(old, new))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("any: [1, 2]\n", "is no deck of MoorDyn: no header"),
        (text_of_deck().replace("- LINES -", "- CABLES -"), "has no LINES, and so no riser"),
    ],
)
def test_what_is_no_deck(text: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "deck.dat").write_text(text)
    with pytest.raises(SceneError, match=message):
        read_deck(tmp_path / "deck.dat")


def test_a_banner_that_names_a_section_is_none(tmp_path: Path) -> None:
    text = f"---- MoorDyn input file of all LINES ----\n{text_of_deck()}"
    assert imported(tmp_path, text)[0] == imported(tmp_path, text_of_deck())[0]
