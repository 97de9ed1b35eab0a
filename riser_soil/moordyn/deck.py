"""A deck's text in sections of rows, each with its line number, its columns by their headings."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from riser_soil.errors import SceneError
from riser_soil.imported_scene import Remark, text_of
from riser_soil.moordyn.columns import columns_of, fits
from riser_soil.moordyn.names import LISTS, NUMBERED, ROWS, SECTIONS, plain, split

COMMENT = re.compile(r"[#!%]")
OF_MAP = "cb"  # a column of MAP++: friction on the seabed
NEEDED = ("line types", "lines")


@dataclass(frozen=True)
class DeckRow:
    """One row of a section: number of its line, its words, and those of its columns by their names."""

    line: int
    words: tuple[str, ...]
    cells: dict[str, str] = field(default_factory=dict, hash=False, compare=False)

    def __getitem__(self, column: str) -> str:
        return self.cells[column]

    def __contains__(self, column: str) -> bool:
        return column in self.cells


@dataclass(frozen=True)
class Deck:
    """A deck's rows by section; a section that it lacks is empty. title: the first words before its sections.

    remarks: on what of its text is not understood, or by its place alone.
    """

    name: str
    title: str
    rows: dict[str, list[DeckRow]] = field(default_factory=dict)
    remarks: list[Remark] = field(default_factory=list)

    def of(self, section: str) -> list[DeckRow]:
        return self.rows.get(section, [])

    def error(self, line: int, text: str) -> SceneError:
        return SceneError(f"{self.name}:{line}: {text}")

    def number(self, row: DeckRow, column: str, what: str = "") -> float:
        """A finite number of a row, by its column; SceneError where it is none."""
        return self.parsed(row, row[column], what or column)

    def numbers(self, row: DeckRow, column: str, counts: tuple[int, ...]) -> list[float]:
        """The numbers of a word such as 1.0|2.0|3.0; SceneError where there are not as many as one of the counts."""
        values = [self.parsed(row, word, column) for word in row[column].split("|")]
        if len(values) not in counts:
            allowed = " or ".join(map(str, counts))
            raise self.error(row.line, f"{column} is {row[column]!r}, {len(values)} numbers; give {allowed}")
        return values

    def parsed(self, row: DeckRow, word: str, what: str) -> float:
        """A word as a finite number; SceneError where it is none."""
        value = as_number(word)
        if value is None:
            raise self.error(row.line, f"{what} is {word!r}, not a finite number; correct it")
        return value

    def numbered(self, section: str, number: str) -> DeckRow | None:
        """The row of a section with this ID."""
        return next((row for row in self.of(section) if row["ID"] == number), None)


def as_number(word: str) -> float | None:
    """A word as a finite number, also of Fortran (1.0d6); None where it is none."""
    try:
        value = float(word.replace("d", "e").replace("D", "e"))
    except ValueError:
        return None
    return value if math.isfinite(value) else None


@dataclass
class _Block:
    """A header's line and text, and the rows with text that follow it, each with its line number."""

    line: int
    header: str
    rows: list[tuple[int, str]] = field(default_factory=list)


def read_deck(file: Path) -> Deck:
    """The deck in a file; SceneError where it can't be read, or is none of MoorDyn."""
    first, *blocks = _blocks(text_of(file).splitlines())
    deck = Deck(file.name, next((text.strip() for _, text in first.rows), ""))
    known = False
    for block in blocks:
        section = _section_of(block, known)
        if section in SECTIONS:
            _read_table(deck, section, block)
        elif section is not None:
            rows = block.rows[2 * (section in ROWS) :]
            deck.rows.setdefault(section, []).extend(DeckRow(n, words) for n, words in _words(rows))
        elif not known and block.rows and not deck.title:
            deck = Deck(deck.name, block.rows[0][1].strip(), deck.rows, deck.remarks)
        known = known or section is not None
    if not deck.rows.keys() & {*SECTIONS}:
        raise SceneError(f"{file}: is no deck of MoorDyn: no header (---) names a section such as LINE TYPES or LINES")
    for section in NEEDED:
        if not deck.of(section):
            raise SceneError(f"{file}: has no {section.upper()}, and so no riser; give a deck with lines")
    _refuse_twins(deck)
    return deck


def _blocks(lines: list[str]) -> list[_Block]:
    """Rows before the first header, then those below each header."""
    blocks = [_Block(0, "")]
    for number, line in enumerate(lines, start=1):
        if "---" in line:
            blocks.append(_Block(number, " ".join(line.replace("-", " ").split())))
        elif line.strip():
            blocks[-1].rows.append((number, line))
    return blocks


def _section_of(block: _Block, known: bool) -> str | None:
    """The section that a header names; None for a banner before the first section.

    A header may name several, as in LINE TYPES OF ALL LINES: that one counts whose headings follow.
    """
    header = block.header.upper()
    every = {name: table.headers for name, table in SECTIONS.items()} | ROWS | LISTS
    named = [name for name, words in every.items() if any(word in header for word in words)]
    tables = [name for name in named if name in SECTIONS]
    fitting = [name for name in tables if fits(name, _headings(block))]
    if fitting or len(tables) < len(named) or (known and named):
        return (fitting or [name for name in named if name not in tables] or named)[0]
    return block.header.lower() or "rows without a section" if known else None


def _headings(block: _Block) -> list[str]:
    """Words of the row of headings; MoorDyn's first versions have a row with the number of entries before it."""
    while block.rows and as_number(block.rows[0][1].split()[0]) is not None and _counts(block.rows[0][1]):
        del block.rows[0]
    return block.rows[0][1].split() if block.rows else []


def _counts(row: str) -> bool:
    """Whether a row is one such as `4 NLines - number of line objects`."""
    words = row.split()
    return len(words) > 1 and words[1].lower().startswith("n") and words[1][1:].isalpha()


def _read_table(deck: Deck, section: str, block: _Block) -> None:
    headings = _headings(block)
    if not block.rows:
        return
    line = block.rows[0][0]
    if section == "line types" and OF_MAP in map(plain, headings):
        raise deck.error(line, f"{' '.join(headings)} are headings of MAP++; give a deck of MoorDyn")
    columns = columns_of(section, headings)
    if columns is None:
        order = " ".join(SECTIONS[section].orders[0])
        problem = f"headings {' '.join(headings)} are not those of {section.upper()}"
        raise deck.error(line, f"{problem}; correct them: MoorDyn has {order}")
    names, remarks = columns
    deck.remarks.extend((line, remark) for remark in remarks)
    if [name for name in names if name] not in [[*order[: len(names)]] for order in SECTIONS[section].orders]:
        deck.remarks.append((line, f"the columns of {section.upper()} are in an order that no MoorDyn has"))
    if len(block.rows) > 1 and _is_data(names, block.rows[1][1]):
        problem = f"an entry of {section.upper()} in the place of the units, which MoorDyn skips"
        raise deck.error(block.rows[1][0], f"{problem}; write a row of units under the headings")
    rows = [*_words(block.rows[2:])]
    if section == "lines" and (other := _other_order(names, [words for _, words in rows])) is not None:
        names = [*other]
        deck.remarks.append((line, f"entries of LINES are in the order {' '.join(other)}, unlike their headings"))
    for number, words in rows:
        deck.rows.setdefault(section, []).append(_row(deck, section, names, headings, number, words))


def _other_order(names: list[str | None], rows: list[tuple[str, ...]]) -> tuple[str, ...] | None:
    """MoorDyn's order of LINES that the entries are in where they can't be in that of their headings."""
    if all(_can_be_lines(names, words) for words in rows):
        return None
    orders = (order[: len(names)] for order in SECTIONS["lines"].orders)
    return next((order for order in orders if all(_can_be_lines(order, words) for words in rows)), None)


def _can_be_lines(names: Sequence[str | None], words: tuple[str, ...]) -> bool:
    """Whether the number of segments is one, and the ends have numbers without a fraction."""
    cells = dict(zip(names, words, strict=False))
    segments = as_number(cells.get("NumSegs", ""))
    ends = [cells.get(name, "") for name in ("AttachA", "AttachB")]
    whole = segments is not None and segments == int(segments)
    return whole and all(split(end)[1] and "." not in end for end in ends)


def _is_data(names: list[str | None], text: str) -> bool:
    """Whether a row has a number in the column of a quantity."""
    quantities = {"Diam", "X", "X0", "Xa", "UnstrLen"}
    cells = zip(names, text.split(), strict=False)
    return any(name in quantities and as_number(word) is not None for name, word in cells)


def _words(rows: list[tuple[int, str]]) -> Iterator[tuple[int, tuple[str, ...]]]:
    """Words of each row before its comment, but for rows that have none."""
    for number, text in rows:
        if words := tuple(COMMENT.split(text)[0].split()):
            yield number, words


def _row(
    deck: Deck, section: str, names: list[str | None], headings: list[str], line: int, words: tuple[str, ...]
) -> DeckRow:
    table = SECTIONS[section]
    cells = {name: word for name, word in zip(names, words, strict=False) if name is not None}
    newest = table.orders[0]
    if len(names) > len(words) == len(newest) and not any(
        as_number(word) != 0.0 for known, name, word in zip(names, newest, words, strict=False) if known != name
    ):
        cells = dict(zip(newest, words, strict=True))  # other columns would be 0 anyway
    lacking = [name for name in names[len(words) :] if name is not None and name not in {*table.optional, *cells}]
    if lacking:
        problem = f"{len(words)} entries, where a row of {section.upper()} has {len(names)}"
        raise deck.error(line, f"{problem}; give {', '.join(lacking)}")
    for name, heading, word in zip(names, headings, words, strict=False):
        if name is None and as_number(word) != 0.0:
            deck.remarks.append((line, f"{word} under {heading}, which is no column of {section.upper()}"))
    if beyond := words[len(names) :]:
        _beyond_the_columns(deck, section, line, words, beyond)
    if "ID" in cells:
        cells["ID"] = _plain_number(cells["ID"])
    return DeckRow(line, words, cells)


def _beyond_the_columns(deck: Deck, section: str, line: int, words: tuple[str, ...], beyond: tuple[str, ...]) -> None:
    """Refuse entries without a heading; MoorDyn takes those of a point for forces."""
    first = len(words) - len(beyond)
    numbers = [value for word in words[7:] if (value := as_number(word))]
    if section == "points" and first == 9 and len(words) >= 12 and numbers and as_number(beyond[0]) is not None:
        problem = f"{len(words)} entries under {first} headings, of which MoorDyn takes the 8th to 10th for forces"
        raise deck.error(line, f"{problem}; name the columns FX FY FZ, or leave out what is too much")
    deck.remarks.append((line, f"{' '.join(beyond)}: entries without a heading"))


def _plain_number(word: str) -> str:
    """An ID as what refers to it has it: without letters before it, or zeros."""
    number = split(word)[1]
    return str(int(number)) if number else word


def _refuse_twins(deck: Deck) -> None:
    keys = {"line types": "Name", "rod types": "Name"} | dict.fromkeys(NUMBERED, "ID")
    for section, key in keys.items():
        seen = dict[str, int]()
        for row in deck.of(section):
            if row[key] in seen:
                problem = f"{key} {row[key]} of {section.upper()} is that of line {seen[row[key]]}, too"
                raise deck.error(row.line, f"{problem}; give it another")
            seen[row[key]] = row.line
