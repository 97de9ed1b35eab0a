"""One riser from a deck: lines that follow each other through free points, between two ends that are held."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from riser_soil.errors import SceneError
from riser_soil.moordyn.deck import Deck, DeckRow

FREE = ("free", "point", "connect")
FIXED, COUPLED = ("fix", "anchor"), ("vessel", "coupled", "cpld", "pinned")  # how their words begin


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
