"""Lines of a deck that form one riser: through free points, bodies that are points, and rods that are free."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterator
from dataclasses import dataclass

from riser_soil.errors import SceneError
from riser_soil.moordyn.deck import Deck, DeckRow
from riser_soil.moordyn.nodes import Node, Piece, is_free, pieces_of, properties_at
from riser_soil.moordyn.properties import bends


@dataclass(frozen=True)
class Chain:
    """Pieces from start to end, and the nodes that they end at: one more."""

    pieces: tuple[Piece, ...]
    nodes: tuple[Node, ...]

    @property
    def ends(self) -> tuple[Node, Node]:
        return self.nodes[0], self.nodes[-1]

    @property
    def lines(self) -> list[DeckRow]:
        """The rows of its lines: none of a rod at whose ends others meet."""
        return [piece.row for piece in self.pieces if piece.section == "lines"]

    @property
    def name(self) -> str:
        """Name of the chain, such as line1, line1_2 of two lines, or rod3 of a rod alone."""
        rows = self.lines or [piece.row for piece in self.pieces]
        return ("line" if self.lines else "rod") + "_".join(row["ID"] for row in rows)

    def reversed(self) -> Chain:
        return Chain(self.pieces[::-1], self.nodes[::-1])


def chain_with(deck: Deck, number: str | None) -> Chain:
    """The chain of a line, by default of the deck's first; SceneError where others branch off."""
    every = pieces_of(deck)
    chosen = [each for each in every if each.section == "lines" and number in (None, each.row["ID"])]
    if not chosen:
        known = ", ".join(row["ID"] for row in deck.of("lines"))
        raise SceneError(f"{deck.name}: has no line {number}; it has {known}")
    chain = _through(deck, every, chosen[0])
    for node in chain.ends:
        others = [each for each in _at(every, node) if each not in chain.pieces]
        if is_free(deck, node) and others:
            problem = f"{others[-1].name} is a third at {node.name}; a scene of one riser has no branches"
            raise deck.error(others[-1].row.line, f"{problem}: --line all imports the whole deck")
    return chain


def all_chains(deck: Deck, loaded: Container[str]) -> list[Chain]:
    """Chains of all lines; they end where nodes are held, where there are not two of them, and at some points.

    loaded: names of the nodes at which a force acts. There, or where something sits, cables have a kink; and between
    lines that bend MoorDyn's points are hinges.
    """
    every, chains = pieces_of(deck), list[Chain]()

    def kinked(node: Node) -> bool:
        return node.name in loaded or bool(properties_at(deck, node)) or is_hinge(deck, node, _at(every, node))

    for piece in every:
        if not any(piece in chain.pieces for chain in chains):
            chains.append(_through(deck, every, piece, kinked))
    return chains


def is_hinge(deck: Deck, node: Node, pieces: list[Piece]) -> bool:
    """Whether a node is a point, or a body that is one, between pieces all of which bend."""
    return node.section != "rods" and all(bends(deck, piece) for piece in pieces)


def _at(every: list[Piece], node: Node) -> list[Piece]:
    return [each for each in every if node.name in (each.ends[0].name, each.ends[1].name)]


def _through(
    deck: Deck, every: list[Piece], piece: Piece, ends_at: Callable[[Node], bool] = lambda node: False
) -> Chain:
    seen = {piece}
    before, after = ([*_followed(deck, every, node, seen, ends_at)] for node in piece.ends)
    pieces = (*(each for each, _ in reversed(before)), piece, *(each for each, _ in after))
    nodes = (*(node for _, node in reversed(before)), *piece.ends, *(node for _, node in after))
    return Chain(pieces, nodes)


def _followed(
    deck: Deck, every: list[Piece], node: Node, seen: set[Piece], ends_at: Callable[[Node], bool]
) -> Iterator[tuple[Piece, Node]]:
    """Pieces from a node on, each with the node at its far end, as long as there is one alone that goes on."""
    while is_free(deck, node) and not ends_at(node) and len(there := _at(every, node)) == 2:
        others = [each for each in there if each not in seen]
        if len(others) != 1:
            return
        seen.add(others[0])
        node = others[0].beyond(node)
        yield others[0], node
