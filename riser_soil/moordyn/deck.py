"""A deck's text in sections of rows, each with its line number."""

from __future__ import annotations

import math
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
                told = f"{len(words)} entries, where a row of {section.upper()} has {COLUMNS[section]} or more"
                raise SceneError(f"{name}:{number}: {told}; give a deck of MoorDyn v2")
            rows.setdefault(section, []).append(DeckRow(number, words))
    return Deck(name, title, rows)


def _refuse_version_1(section: str, names: list[str], place: str) -> None:
    """In version 1 a line's length comes before its ends, and a point has forces."""
    told = [word.lower() for word in names]
    if (section == "lines" and told[2:3] and told[2].startswith("unstr")) or (section == "points" and "fx" in told):
        raise SceneError(f"{place}: the columns are those of MoorDyn v1; write the deck anew in the format of v2")
