"""What lines of a deck end at: points and ends of rods; where they are, what holds them, what sits on them."""

from __future__ import annotations

import math
from dataclasses import dataclass

from riser_soil.core.quantities import Vector
from riser_soil.moordyn.deck import Deck, DeckRow
from riser_soil.moordyn.names import (
    BODY,
    COUPLED,
    COUPLED_PINNED,
    ENDS,
    FIXED,
    FREE,
    KINDS,
    ON_THE_SEABED,
    PINNED,
    TURBINE,
    split,
)

HELD = ("mass", "volume", "drag_area", "added_mass")  # of a scene's attachments, from these columns
COLUMNS = ("Mass", "Volume", "CdA", "Ca")


@dataclass(frozen=True)
class Node:
    """What a line ends at: its name, the section and row that it is in, and the end A or B of a rod.

    Both ends of a rod of no length are one node, as are the points of a body that is no more than a point.
    """

    name: str
    section: str
    row: DeckRow
    end: str = ""


@dataclass(frozen=True)
class Piece:
    """A line, or a rod that has a length and is free to move, and what its two ends are at."""

    section: str
    row: DeckRow
    ends: tuple[Node, Node]

    @property
    def name(self) -> str:
        """Name of the piece, such as line 3 or rod 1."""
        return f"{self.section[:-1]} {self.row['ID']}"

    def beyond(self, node: Node) -> Node:
        """The end that is not at a node."""
        return self.ends[1] if self.ends[0].name == node.name else self.ends[0]


def pieces_of(deck: Deck) -> list[Piece]:
    """All lines, then the rods that move and have a length."""
    lines = [Piece("lines", row, (_end(deck, row, "AttachA"), _end(deck, row, "AttachB"))) for row in deck.of("lines")]
    for each in lines:
        if each.ends[0].name == each.ends[1].name:
            both = f"{each.name} has both its ends at {each.ends[0].name}"
            raise deck.error(each.row.line, f"{both}; correct one of them")
    moving = (rod for rod in deck.of("rods") if has_length(deck, rod) and kind(deck, "rods", rod)[0] in _MOVE)
    rods = [Piece("rods", rod, (node_at(deck, rod, "rods", "A"), node_at(deck, rod, "rods", "B"))) for rod in moving]
    return [*lines, *rods]


_MOVE = (FREE, PINNED, COUPLED_PINNED)


def _end(deck: Deck, line: DeckRow, column: str) -> Node:
    letters, number, end = split(line[column])
    section = next((name for name, words in ENDS.items() if letters in words and name != "bodies"), None)
    row = deck.numbered(section, str(int(number))) if section and number else None
    if row is None or section is None or (section == "rods" and end not in ("A", "B")):
        problem = f"line {line['ID']} ends at {line[column]}, which the deck does not have"
        raise deck.error(line.line, f"{problem}; correct it")
    return node_at(deck, row, section, end)


def node_at(deck: Deck, row: DeckRow, section: str, end: str = "") -> Node:
    """The node of a point, or of an end of a rod."""
    body = body_of(deck, section, row)
    if body is not None and is_point(deck, body):
        return Node(f"body {body['ID']}", "bodies", body)
    if section == "rods":
        return Node(f"rod {row['ID']}{end if has_length(deck, row) else ''}", section, row, end)
    return Node(f"point {row['ID']}", section, row)


def kind(deck: Deck, section: str, row: DeckRow) -> tuple[str, str]:
    """How a point, rod or body is attached, and the number of the body that it is on; SceneError where unknown."""
    letters, number, pinned = split(row["Attachment"])
    for name, words in KINDS[section].items():
        if (letters if number else letters + pinned) in words and (number or name != BODY):
            on = str(int(number)) if name == BODY else ""
            return (PINNED if on and pinned in KINDS["rods"][PINNED] else name), on
    known = ", ".join(KINDS[section][name][0].capitalize() for name in KINDS[section])
    problem = f"{row['Attachment']} is no attachment of {section}"
    raise deck.error(row.line, f"{problem}; give one of {known}{' with a number' * (BODY in KINDS[section])}")


def body_of(deck: Deck, section: str, row: DeckRow) -> DeckRow | None:
    """The body that a point or a rod is on."""
    number = kind(deck, section, row)[1] if section != "bodies" else ""
    if not number:
        return None
    body = deck.numbered("bodies", number)
    if body is None:
        raise deck.error(row.line, f"{row['Attachment']}: the deck has no body {number}; correct it")
    return body


def is_point(deck: Deck, body: DeckRow) -> bool:
    """Whether a free body is no more than a point: all on it is at its origin, and it has no inertia or one line."""
    if kind(deck, "bodies", body)[0] != FREE:
        return False
    on_it = [(section, row) for section in ("points", "rods") for row in deck.of(section)
             if kind(deck, section, row)[1] == body["ID"]]  # fmt: skip
    at_origin = all(section == "points" and not any(_own(deck, row, "XYZ")) for section, row in on_it)
    ends = [line[column] for line in deck.of("lines") for column in ("AttachA", "AttachB")]
    numbers = [row["ID"] for section, row in on_it if section == "points"]
    few = sum(split(end)[1].lstrip("0") in numbers and split(end)[0] in ENDS["points"] for end in ends) <= 1
    return at_origin and (few or not any(deck.numbers(body, "I", (1, 3))))


def has_length(deck: Deck, rod: DeckRow) -> bool:
    """Whether a rod's ends are apart; MoorDyn's rods of 0 segments have no length."""
    a, b = (_own(deck, rod, (f"X{end}", f"Y{end}", f"Z{end}")) for end in "ab")
    return deck.number(rod, "NumSegs") != 0.0 and a != b


def is_free(deck: Deck, node: Node) -> bool:
    """Whether nothing but lines holds a node, on bodies that are free neither."""
    if node.section == "bodies":
        return True
    attached, _ = kind(deck, node.section, node.row)
    if attached in (PINNED, COUPLED_PINNED):
        return node.end == "B" and has_length(deck, node.row)
    return attached == FREE


def free_body(deck: Deck, node: Node) -> DeckRow | None:
    """The free body, more than a point, that a node sits on."""
    body = body_of(deck, node.section, node.row)
    return body if body is not None and kind(deck, "bodies", body)[0] == FREE and not is_free(deck, node) else None


def is_driven(deck: Deck, node: Node) -> bool:
    """Whether a node moves from outside."""
    body = body_of(deck, node.section, node.row)
    attached = kind(deck, node.section, node.row) if body is None else kind(deck, "bodies", body)
    return attached[0] in (COUPLED, COUPLED_PINNED)


def is_anchor(deck: Deck, node: Node) -> bool:
    """Whether a node is held by the ground."""
    body = body_of(deck, node.section, node.row)
    attached = kind(deck, node.section, node.row) if body is None else kind(deck, "bodies", body)
    return attached[0] in (FIXED, PINNED) and not is_free(deck, node)


def place(deck: Deck, node: Node, seabed: float | None = None) -> Vector:
    """Where a node is [m]; seabed: z [m] of the points that are on it by a word. SceneError where it can't be known."""
    row, section = node.row, node.section
    if section == "bodies":
        return _own(deck, row, ("X0", "Y0", "Z0"))
    columns = ("X", "Y", "Z") if section == "points" else tuple(f"{axis}{node.end.lower() or 'a'}" for axis in "XYZ")
    if any(word in row[columns[2]].upper() for word in ON_THE_SEABED):
        if seabed is None:
            raise deck.error(row.line, f"{node.name} is on the {row[columns[2]]}, and no depth is given; give WtrDpth")
        x, y = (deck.number(row, column) for column in columns[:2])
        return x, y, seabed
    _refuse_turbine(deck, row, section)
    x, y, z = _own(deck, row, columns)
    if (body := body_of(deck, section, row)) is None:
        return x, y, z
    _refuse_turbine(deck, body, "bodies")
    at, (x, y, z) = _own(deck, body, ("X0", "Y0", "Z0")), turned(deck, body, (x, y, z))
    return at[0] + x, at[1] + y, at[2] + z


def _refuse_turbine(deck: Deck, row: DeckRow, section: str) -> None:
    if kind(deck, section, row)[0] == TURBINE:
        problem = f"{section[:-1]} {row['ID']} is on {row['Attachment']}, whose place is in another file"
        raise deck.error(row.line, f"{problem}; write Coupled, with its place in global axes")


def turned(deck: Deck, body: DeckRow, arm: Vector) -> Vector:
    """A place on a body that is turned about one axis; SceneError about several, whose order differs by version."""
    angles = _own(deck, body, ("r0", "p0", "y0"))
    axes = [n for n, angle in enumerate(angles) if angle]
    if len(axes) > 1:
        problem = f"body {body['ID']} is turned about {len(axes)} axes, in an order that MoorDyn's versions differ in"
        raise deck.error(body.line, f"{problem}; give what sits on it as Coupled, in global axes")
    out = [*arm]
    for n in axes:
        a, b = (n + 1) % 3, (n + 2) % 3
        c, s = math.cos(math.radians(angles[n])), math.sin(math.radians(angles[n]))
        out[a], out[b] = c * arm[a] - s * arm[b], s * arm[a] + c * arm[b]
    return out[0], out[1], out[2]


def _own(deck: Deck, row: DeckRow, columns: tuple[str, ...] | str) -> Vector:
    """Three numbers of a row."""
    x, y, z = (0.0 if _word(row, column) else deck.number(row, column) for column in columns)
    return x, y, z


def _word(row: DeckRow, column: str) -> bool:
    """Whether a height is given by a word."""
    return any(word in row[column].upper() for word in ON_THE_SEABED)


def properties_at(deck: Deck, node: Node) -> dict[str, float]:
    """Mass, volume, drag area and added mass of what sits at a node, in a scene's keys; nothing of it that is zero."""
    if node.section == "rods":
        return {}
    values = dict(zip(HELD, _on_its_own(deck, node), strict=True))
    if values["volume"] == 0.0:
        del values["added_mass"]
    return {key: value for key, value in values.items() if value != 0.0}


def _on_its_own(deck: Deck, node: Node) -> list[float]:
    if node.section == "points":
        return [deck.number(node.row, column) for column in COLUMNS]
    drag, added = (deck.numbers(node.row, *each) for each in (("CdA", (1, 2, 3, 6)), ("Ca", (1, 3))))
    mass, volume = (deck.number(node.row, column) for column in ("Mass", "Volume"))
    on_it = [row for row in deck.of("points") if kind(deck, "points", row)[1] == node.row["ID"]]
    more = [[deck.number(row, column) for column in COLUMNS] for row in on_it]
    return [mass + sum(m[0] for m in more), volume + sum(m[1] for m in more),
            max(drag[:3] if len(drag) > 2 else drag[:1]) + sum(m[2] for m in more), max(added)]  # fmt: skip
