"""All names of MoorDyn's: each option, header, heading and kind of attachment by each of its words, in any case."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain, permutations
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.errors import SceneError
from riser_soil.moordyn import names
from riser_soil.moordyn.columns import columns_of
from riser_soil.moordyn.scene_of import scene_of
from riser_soil.moordyn.whole_deck import whole_scene_of
from tests.support.moordyn_decks import LINES, OPTIONS, POINTS, TYPES, deck_of_text, text_of_deck
from tests.support.said import line_with

CASES = (str.lower, str.upper, str.title)
VALUES = {"g": 9.7, "rho": 1001.0, "WtrDpth": 76.5, "kBot": 7.0e4, "FrictionCoefficient": 0.35}


def imported(folder: Path, **parts: Any) -> tuple[dict[str, Any], list[str]]:
    scene = scene_of(deck_of_text(folder, text_of_deck(**parts)))
    return scene.data, [f"{line}: {what}" for line, what in scene.remarks]


def in_scene(data: dict[str, Any]) -> dict[str, float]:
    friction = data.get("contact", {}).get("friction", {})
    return {
        "g": data["gravity"], "rho": data["water"]["density"], "WtrDpth": -data["seabed"]["level"],
        "kBot": data["seabed"]["stiffness"] / 0.12, "FrictionCoefficient": friction.get("axial", 0.0),
    }  # fmt: skip


@pytest.mark.parametrize(("name", "value"), VALUES.items())
def test_each_option_by_each_of_its_names(name: str, value: float, tmp_path: Path) -> None:
    for word in names.ALIASES[name]:
        for case in CASES:
            others = [row for row in OPTIONS if names.option_of(row.split()[1]) != name]
            data, remarks = imported(tmp_path, options=[*others, f"{value} {case(word)} (its meaning)"])
            assert in_scene(data)[name] == pytest.approx(value), word
            assert len(remarks) == 2, "damping and motion"


def test_options_that_pass_in_silence(tmp_path: Path) -> None:
    rows = [f"0.5 {case(word)}" for word in names.HARMLESS for case in CASES]
    assert imported(tmp_path, options=OPTIONS + rows) == imported(tmp_path)


@pytest.mark.parametrize("word", [*chain(*names.LOST), "kbott", "whatever"])
def test_all_other_options_are_remarks(word: str, tmp_path: Path) -> None:
    """Remarks have line and value, and what they would have done; one without effect is none."""
    for case in CASES:
        data, remarks = imported(tmp_path, options=[*OPTIONS, f"17.5 {case(word)}"])
        assert data == imported(tmp_path)[0]
        said = names.lost_option(word)
        line_with(remarks, "20:", f"{case(word)} 17.5:", said[1] if said else "no option of MoorDyn")
    if said and said[0] is not None:
        assert imported(tmp_path, options=[*OPTIONS, f"{said[0]} {word}"])[1] == imported(tmp_path)[1]


def test_an_option_that_is_nearly_one(tmp_path: Path) -> None:
    line_with(imported(tmp_path, options=[*OPTIONS, "5e4 kbott"])[1], "20:", "kbott 5e4:", "kbot is, if that is meant")


def test_of_an_option_given_twice_the_later_counts(tmp_path: Path) -> None:
    data, remarks = imported(tmp_path, options=[*OPTIONS, "1003 WtrDnsty"])
    assert data["water"]["density"] == 1003.0
    line_with(remarks, "20:", "WtrDnsty 1003", "line 18")


def test_options_with_a_word_too_few_are_remarks(tmp_path: Path) -> None:
    line_with(imported(tmp_path, options=[*OPTIONS, "1003"])[1], "20: 1003:", "skips")


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("WtrDpth 75.0", "WtrDpth 75.0: an option has its value first; write 75.0 WtrDpth"),
        ("dtM 0.001", "dtM 0.001: an option has its value first"),
        ("-75 WtrDpth", "WtrDpth is -75, less than 0; give its size"),
        ("0 g", "g is 0: without gravity no line hangs"),
        ("nan kb", "kb is 'nan', not a finite number"),
    ],
)
def test_options_that_are_refused(row: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=f"deck.dat:20: {said}"):
        imported(tmp_path, options=[*OPTIONS, row])


def test_no_name_has_two_meanings() -> None:
    words = [*chain(*names.ALIASES.values()), *chain(*names.LOST), *names.HARMLESS]
    assert len(words) == len({*words})
    assert all(word == word.lower() for word in words)
    for kinds in names.KINDS.values():
        of_kinds = [*chain(*kinds.values())]
        assert len(of_kinds) == len({*of_kinds})
    for section in names.SECTIONS.values():
        for order in section.orders:
            assert {*order} <= {*section.columns}
            assert not [name for name in section.columns if name not in (*order, *section.optional)]


def headers() -> Iterator[tuple[str, str]]:
    for section in ("line types", "points", "lines"):
        yield from ((section.upper(), words) for words in names.SECTIONS[section].headers)
    yield "OPTIONS", "OPTIONS"


@pytest.mark.parametrize(("usual", "words"), [*headers()])
def test_each_section_by_each_of_its_headers(usual: str, words: str, tmp_path: Path) -> None:
    """Headers have more words around, in any case, also names of other sections."""
    want = imported(tmp_path)
    for case in CASES:
        for before, after in (("", ""), ("some ", ", 90 mm of all points"), ("solver ", " and lines")):
            text = text_of_deck().replace(f"------ {usual} ------", f"--- {case(before + words + after)} -----")
            scene = scene_of(deck_of_text(tmp_path, text))
            assert scene.data == want[0], (before, words, after)


@pytest.mark.parametrize("section", names.SECTIONS)
def test_each_column_by_each_of_its_headings(section: str) -> None:
    """In any case, alone among the usual ones; a heading of two columns stands for each of them in turn."""
    table = names.SECTIONS[section]
    for order in table.orders:
        for n, name in enumerate(order):
            for heading in table.columns[name]:
                for case in CASES:
                    row = [*order]
                    row[n] = case(heading) or "#"
                    assert columns_of(section, row) == ([*order], []), row


def test_columns_in_any_order(tmp_path: Path) -> None:
    want, rng = imported(tmp_path), np.random.default_rng(5)
    for part, rows in (("line_types", TYPES), ("points", POINTS), ("lines", LINES)):
        for _ in range(5):
            order = rng.permutation(len(rows[0].split()))
            mixed = [" ".join(row.split()[n] for n in order) for row in rows]
            data, remarks = imported(tmp_path, **{part: mixed})
            assert data == want[0]
            assert [each for each in remarks if "order" not in each] == want[1]


def test_a_heading_that_is_unknown_is_read_by_its_place(tmp_path: Path) -> None:
    named = [TYPES[0].replace("CdAx", "Tangent"), *TYPES[1:]]
    data, remarks = imported(tmp_path, line_types=named)
    assert data == imported(tmp_path)[0]
    line_with(remarks, "3:", "heading Tangent is read as CdAx")
    mixed = [" ".join([*row.split()[1:], row.split()[0]]) for row in named]
    with pytest.raises(SceneError, match=r"deck.dat:3: headings .* Tangent .* are not those of LINE TYPES"):
        imported(tmp_path, line_types=mixed)


def test_headings_of_two_words(tmp_path: Path) -> None:
    named = [LINES[0].replace("LineType", "Line type").replace("UnstrLen", "Unstr. len"), *LINES[1:]]
    assert imported(tmp_path, lines=named) == imported(tmp_path)


@pytest.mark.parametrize("kind", ["fixed", "coupled"])
def test_each_kind_of_held_point_by_each_of_its_words(kind: str, tmp_path: Path) -> None:
    for word, case in ((word, case) for word in names.KINDS["points"][kind] for case in CASES):
        data, remarks = imported(tmp_path, points=[*POINTS[:3], POINTS[3].replace("Coupled", case(word))])
        assert data["riser"]["end"] == {"position": [6.0, 0.0, -5.0]}
        assert ["motion" in each for each in remarks].count(True) == (kind == "coupled")


def test_each_kind_of_free_point_and_end_by_each_of_its_words(tmp_path: Path) -> None:
    """Two lines at a free point are one riser, whatever it is called."""
    for word, to in ((word, to) for word in names.KINDS["points"]["free"] for to in names.ENDS["points"]):
        points = [*POINTS, f"3 {word} -100 0 -40 20 0 0 0"]
        lines = [*LINES[:2], f"1 rope {to}1 {to}3 150 14 -", f"2 rope {to}3 {to}2 108.5 10 -"]
        riser = imported(tmp_path, points=points, lines=lines)[0]["riser"]
        assert [each["length"] for each in riser["segments"]] == [150.0, 108.5]
        assert riser["attachments"] == [{"at": 150.0, "mass": 20.0}]


BODY = ["ID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG I Volume CdA Ca", "(-)",
        "1 {} 6 0 -5 0 0 0 900 0|0|0.1 30 0.5 1 1"]  # fmt: skip
ROD_TYPES = ["Name Diam Mass/m Cd Ca CdEnd CaEnd", "(-)", "bar 0.2 60 1 1 0 0"]
RODS = ["ID RodType Attachment Xa Ya Za Xb Yb Zb NumSegs Outputs", "(-)", "1 bar {} 0 0 0 0 0 0 0 -"]


@pytest.mark.parametrize("kind", ["fixed", "coupled", "coupled pinned", "free"])
def test_each_kind_of_body_by_each_of_its_words(kind: str, tmp_path: Path) -> None:
    for word, case in ((word, case) for word in names.KINDS["bodies"][kind] for case in CASES):
        bodies = [*BODY[:2], BODY[2].format(case(word))]
        points = [*POINTS[:3], "2 body1 0 0 0 0 0 0 0", "3 Body1 1 0 0 0 0 0 0"]
        text = text_of_deck(points=points, bodies=bodies)
        data = whole_scene_of(deck_of_text(tmp_path, text)).data
        place = {"position": [6.0, 0.0, -5.0]}
        assert data["lines"]["line1"]["end"] == ("free" if kind == "free" else place), word
        assert ("body1" in data.get("bodies", {})) == (kind == "free")


@pytest.mark.parametrize("kind", ["fixed", "pinned", "coupled", "coupled pinned", "free", "body"])
def test_each_kind_of_rod_by_each_of_its_words(kind: str, tmp_path: Path) -> None:
    """A line that ends at a rod of no length."""
    lines = [*LINES[:2], "1 rope 1 R1a 258.5 24 -"]
    for word, case in ((word, case) for word in names.KINDS["rods"][kind] for case in CASES):
        at = f"{word}1" if kind == "body" else word
        data, _ = imported(tmp_path, lines=lines, bodies=[*BODY[:2], BODY[2].format("Coupled")],
                           rod_types=ROD_TYPES, rods=[*RODS[:2], RODS[2].format(case(at))])  # fmt: skip
        place = {"position": [6.0, 0.0, -5.0] if kind == "body" else [0.0, 0.0, 0.0]}
        free = "start" if data["riser"]["start"] == "free" else "end"
        assert data["riser"][free] == ("free" if kind == "free" else place), word


def test_kinds_that_are_none(tmp_path: Path) -> None:
    for word in ("hinge", "body", "turbine1", "coupledd"):
        with pytest.raises(SceneError, match=f"deck.dat:10: .*{word}"):
            imported(tmp_path, points=[*POINTS[:3], POINTS[3].replace("Coupled", word)])


def test_ends_that_are_none(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"deck.dat:14: line 1 has both its ends at point 2"):
        imported(tmp_path, lines=[*LINES[:2], LINES[2].replace("1 2 258", "2 2 258")])
    for word in ("R1A", "9", "X2", "R1"):
        with pytest.raises(SceneError, match=f"deck.dat:14: line 1 ends at {word}"):
            imported(tmp_path, lines=[*LINES[:2], LINES[2].replace("1 2 258", f"1 {word} 258")])


def test_sections_in_any_order(tmp_path: Path) -> None:
    want = imported(tmp_path)[0]
    usual = dict(zip(("LINE TYPES", "POINTS", "LINES", "OPTIONS"), (TYPES, POINTS, LINES, OPTIONS), strict=True))
    for order in permutations(usual):
        rows = [row for name in order for row in (f"--- {name} ---", *usual[name])]
        assert scene_of(deck_of_text(tmp_path, "\n".join(["A rope over a bed", *rows]))).data == want
