"""A deck's text in sections of rows, each with its line number, and one riser from it: lines through free points."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from riser_soil.errors import SceneError
from riser_soil.imported_scene import text_of

# Words of a section's header -> the section, as MoorDyn knows it by several names.
SECTIONS = {
    "LINE TYPES": "line types", "LINE DICTIONARY": "line types",
    "ROD TYPES": "rod types", "ROD DICTIONARY": "rod types",
    "BODIES": "bodies", "BODY LIST": "bodies", "BODY PROPERTIES": "bodies",
    "RODS": "rods", "ROD LIST": "rods", "ROD PROPERTIES": "rods",
    "POINTS": "points", "POINT LIST": "points", "POINT PROPERTIES": "points",
    "CONNECTION PROPERTIES": "points", "NODE PROPERTIES": "points",
    "LINES": "lines", "LINE LIST": "lines", "LINE PROPERTIES": "lines",
    "FAILURE": "failure", "CONTROL": "control", "EXTERNAL LOADS": "external loads",
    "OPTIONS": "options", "SOLVER OPTIONS": "options", "OUTPUTS": "outputs",
}  # fmt: skip
WITH_HEADS = {*SECTIONS.values()} - {"options", "outputs"}  # they begin with a row of names and one of units
COLUMNS = {"line types": 10, "bodies": 8, "rods": 9, "points": 9, "lines": 6, "options": 2}
FREE = ("free", "point", "connect")
FIXED, COUPLED = ("fix", "anchor"), ("vessel", "coupled", "cpld", "pinned")  # how their words begin


@dataclass(frozen=True)
class DeckRow:
    """One row of a section: number of its line, and its words."""

    line: int
    words: tuple[str, ...]


@dataclass(frozen=True)
class Deck:
    """A deck's rows by section; a section that it lacks is empty. title: the first words before its sections."""

    name: str
    title: str
    rows: dict[str, list[DeckRow]] = field(default_factory=dict)

    def of(self, section: str) -> list[DeckRow]:
        return self.rows.get(section, [])

    def error(self, line: int, text: str) -> SceneError:
        return SceneError(f"{self.name}:{line}: {text}")

    def number(self, row: DeckRow, column: int, what: str) -> float:
        """A finite number of a row; SceneError where it is none."""
        try:
            value = float(row.words[column].replace("d", "e").replace("D", "e"))
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise self.error(row.line, f"{what} is {row.words[column]!r}, not a finite number; correct it")
        return value


def read_deck(file: Path) -> Deck:
    """The deck in a file; SceneError where it can't be read, or is none of MoorDyn v2."""
    deck = _in_sections(text_of(file).splitlines(), file.name)
    for section in ("line types", "lines"):
        if not deck.of(section):
            raise SceneError(f"{file}: has no section {section.upper()}; give a deck of MoorDyn v2")
    return deck


def _in_sections(lines: list[str], name: str) -> Deck:
    section, heads, title, rows = "", 0, "", dict[str, list[DeckRow]]()
    for number, line in enumerate(lines, start=1):
        words = tuple(line.split("#")[0].split())
        if line.lstrip().startswith("---"):
            head, heads = " ".join(line.replace("-", " ").split()), 0
            section = SECTIONS.get(head.upper(), head.lower() if section else "")
        elif not section:
            title = title or line.strip()
        elif section in WITH_HEADS and heads < 2:
            heads += 1
            _refuse_version_1(section, line.split(), f"{name}:{number}")
        elif words:
            if len(words) < COLUMNS.get(section, 1):
                reported = f"{len(words)} entries, where a row of {section.upper()} has {COLUMNS[section]} or more"
                raise SceneError(f"{name}:{number}: {reported}; give a deck of MoorDyn v2")
            rows.setdefault(section, []).append(DeckRow(number, words))
    return Deck(name, title, rows)


def _refuse_version_1(section: str, names: list[str], place: str) -> None:
    """In version 1 a line's length comes before its ends, and a point has forces."""
    reported = [word.lower() for word in names]
    if (section == "lines" and reported[2:3] and reported[2].startswith("unstr")) or (
        section == "points" and "fx" in reported
    ):
        raise SceneError(f"{place}: the columns are those of MoorDyn v1; write the deck anew in the format of v2")


@dataclass(frozen=True)
class Chain:
    """Rows of the lines from start to end, and the names of what they end at, as the lines have them: one more."""

    lines: tuple[DeckRow, ...]
    joints: tuple[str, ...]

    def reversed(self) -> Chain:
        return Chain(self.lines[::-1], self.joints[::-1])


def chain_with(deck: Deck, number: str | None) -> Chain:
    """The chain of a line, by default of the deck's first."""
    rows = deck.of("lines")
    chosen = [row for row in rows if number is None or row.words[0] == number]
    if not chosen:
        known = ", ".join(row.words[0] for row in rows)
        raise SceneError(f"{deck.name}: has no line {number}; it has {known}")
    first = chosen[0]
    before, after = (_followed(deck, first, joint) for joint in first.words[2:4])
    lines = (*(row for row, _ in reversed(before)), first, *(row for row, _ in after))
    joints = (*(joint for _, joint in reversed(before)), *first.words[2:4], *(joint for _, joint in after))
    return Chain(lines, joints)


def _followed(deck: Deck, row: DeckRow, joint: str) -> list[tuple[DeckRow, str]]:
    """Lines from a joint of a line on, each with the joint at its far end."""
    found, seen = list[tuple[DeckRow, str]](), {row.line}
    while is_free(deck, joint):
        others = [each for each in deck.of("lines") if joint in each.words[2:4] and each.line not in seen]
        if not others:
            break
        if len(others) > 1:
            raise deck.error(others[1].line, f"a third line at point {joint}; a scene has one riser, without branches")
        row = others[0]
        seen.add(row.line)
        joint = row.words[3] if row.words[2] == joint else row.words[2]
        found.append((row, joint))
    return found


def point(deck: Deck, name: str) -> DeckRow | None:
    """The row of a point; None for a rod's end."""
    return next((row for row in deck.of("points") if row.words[0] == name), None)


def is_free(deck: Deck, name: str) -> bool:
    row = point(deck, name)
    return row is not None and row.words[1].lower() in FREE


def place(deck: Deck, name: str, line: DeckRow) -> tuple[float, float, float]:
    """Where a point or a rod's end is [m]; SceneError where that can't be known."""
    row = point(deck, name)
    if row is not None:
        return _in_global(deck, row, row.words[1].lower(), 2)
    if name[:1] in "Rr" and name[-1:] in "ABab":
        rod = next((each for each in deck.of("rods") if each.words[0] == name[1:-1]), None)
        if rod is not None:
            return _in_global(deck, rod, rod.words[2].lower(), 3 if name[-1] in "Aa" else 6)
    raise deck.error(line.line, f"line {line.words[0]} ends at {name}, which the deck does not have; correct it")


def _in_global(deck: Deck, row: DeckRow, kind: str, first: int) -> tuple[float, float, float]:
    x, y, z = (deck.number(row, first + n, "a coordinate") for n in range(3))
    if kind.startswith((*FIXED, *COUPLED, *FREE)):
        return x, y, z
    body = next((each for each in deck.of("bodies") if kind.removesuffix("pinned") == f"body{each.words[0]}"), None)
    if body is None:
        raise deck.error(row.line, f"{row.words[0]} is attached to {kind}, whose place is unknown; give it as Coupled")
    turned = [deck.number(body, n, "an angle") for n in range(5, 8)]
    if any(turned):
        raise deck.error(body.line, f"body {body.words[0]} is turned; give what sits on it as Coupled, in global axes")
    at = [deck.number(body, 2 + n, "a coordinate") for n in range(3)]
    return at[0] + x, at[1] + y, at[2] + z


def elsewhere(deck: Deck, chain: Chain) -> Iterator[DeckRow]:
    """Lines that the chain does not have."""
    own = {row.line for row in chain.lines}
    yield from (row for row in deck.of("lines") if row.line not in own)
