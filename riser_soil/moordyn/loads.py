"""Steady forces of a deck: EXTERNAL LOADS, and FX FY FZ of points."""

from __future__ import annotations

from dataclasses import dataclass

from riser_soil.core.quantities import Vector
from riser_soil.imported_scene import Remark
from riser_soil.moordyn.deck import Deck, DeckRow, as_number
from riser_soil.moordyn.names import ENDS, split
from riser_soil.moordyn.nodes import node_at


@dataclass(frozen=True)
class SteadyForce:
    """A force [N] in global axes, and the deck's line that gives it."""

    force: Vector
    line: int

    @property
    def load(self) -> dict[str, object]:
        """The load of a scene's stage."""
        return {"force": [*self.force], "keep": True}


def forces_of(deck: Deck) -> tuple[dict[str, list[SteadyForce]], list[Remark]]:
    """Forces by the name of the node that they act on; remarks on what damps, and on axes that turn."""
    by_node, remarks = dict[str, list[SteadyForce]](), list[Remark]()
    for row in deck.of("points"):
        if "FX" in row:
            force = _vector([deck.number(row, column) for column in ("FX", "FY", "FZ")])
            by_node.setdefault(node_at(deck, row, "points").name, []).append(SteadyForce(force, row.line))
    for row in deck.of("external loads"):
        name = _object(deck, row)
        by_node.setdefault(name, []).append(SteadyForce(_vector(deck.numbers(row, "Fext", (1, 3))), row.line))
        for column in ("Blin", "Bquad"):
            if any(as_number(word) != 0.0 for word in row[column].split("|")):
                remarks.append((row.line, f"{column} {row[column]} of {row['Object']}: damping"))
        if row.cells.get("CSys", "G").upper() == "L":
            remarks.append((row.line, f"CSys L of {row['Object']}: the force turns with it there, and not here"))
    kept = {name: [each for each in forces if any(each.force)] for name, forces in by_node.items()}
    return {name: forces for name, forces in kept.items() if forces}, remarks


def _vector(numbers: list[float]) -> Vector:
    x, y, z = numbers * 3 if len(numbers) == 1 else numbers
    return x, y, z


def _object(deck: Deck, row: DeckRow) -> str:
    """Name of the node, or of the body, that a load acts on; of a rod its end A."""
    letters, number, _ = split(row["Object"])
    section = next((name for name, words in ENDS.items() if letters in words and letters), None)
    target = deck.numbered(section, str(int(number))) if section and number else None
    if target is None or section is None:
        raise deck.error(row.line, f"{row['Object']}: the deck has no such point, rod or body; correct it")
    return f"body {target['ID']}" if section == "bodies" else node_at(deck, target, section, "A").name
