"""A scene from a deck, and what of the deck it does not have, line by line."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from riser_soil.imported_scene import ImportedScene, Remark
from riser_soil.moordyn.chains import Chain, chain_with
from riser_soil.moordyn.deck import Deck
from riser_soil.moordyn.loads import SteadyForce, forces_of
from riser_soil.moordyn.names import KNOWN
from riser_soil.moordyn.nodes import is_free, place
from riser_soil.moordyn.properties import line_types, stiffen_in_torsion
from riser_soil.moordyn.riser_of import ImportedRiser, about_fixed, free_shape, riser_of, weighs
from riser_soil.moordyn.settings import Options, options_of, seabed_of
from riser_soil.scene.problem import Path

IN_WATER = ("drag", "added_mass")


def scene_of(deck: Deck, line: str | None = None) -> ImportedScene:
    """The scene of one of the deck's lines, with those that it is joined to by free nodes; by default the first's."""
    options, about_options = options_of(deck)
    chain = _upward(deck, chain_with(deck, line), options)
    seabed, about_seabed, bed_lines = seabed_of(deck, [chain], options)
    types, about_types, type_lines = line_types(deck, chain.pieces)
    forces, about_forces = forces_of(deck)
    riser = riser_of(deck, chain, forces)
    _hold(deck, chain, riser, options, seabed.get("seabed", {}).get("level"))
    aside = len(riser.data.get("initial", {}).get("points", ())) > 2
    twisted = [stiffen_in_torsion(deck, types)] if riser.loads or aside else []
    stage = {"name": "hang", "kind": "static"} | ({"loads": riser.loads} if riser.loads else {})
    data = head_of(deck, options, types) | {"riser": riser.data} | seabed | {"stages": [stage]}
    remarks = [*deck.remarks, *about_options, *about_seabed, *about_types, *about_forces, *twisted, *riser.remarks]
    remarks += [*_left_out(deck, chain), *_unused(deck, chain, forces), *lost_sections(deck)]
    own: dict[Path, int] = {("riser",): chain.lines[0].line}
    of_riser: dict[Path, int] = {("riser", *path): number for path, number in riser.origins.items()}
    return ImportedScene(data, sorted({*remarks}), {}, type_lines | bed_lines | own | of_riser)


def head_of(deck: Deck, options: Options, types: dict[str, Any]) -> dict[str, Any]:
    """The first lines of a scene's file."""
    data: dict[str, Any] = {"title": deck.title.strip("- ") or deck.name, "gravity": options["g"]}
    if options["rho"] > 0.0:
        return data | {"water": {"density": options["rho"], "surface_level": 0.0}, "line_types": types}
    dry = {name: {key: kind[key] for key in kind if key not in IN_WATER} for name, kind in types.items()}
    return data | {"line_types": dry}


def _upward(deck: Deck, chain: Chain, options: Options) -> Chain:
    """The chain from its lower end on: the one that hangs, or that what floats is held by; SceneError where nothing
    holds it.
    """
    first, last = (is_free(deck, node) for node in chain.ends)
    if first and last:
        names = " and ".join(node.name for node in chain.ends)
        raise deck.error(chain.lines[0].line, f"no end of it is held: {names} are free; fix or couple one of them")
    if first or last:
        return chain.reversed() if first == (weighs(deck, chain, options["rho"]) < 0.0) else chain
    heights = [_height(deck, chain, n, options) for n in (0, -1)]
    return chain.reversed() if heights[0] > heights[1] else chain


def _height(deck: Deck, chain: Chain, n: int, options: Options) -> float:
    depth = options["WtrDpth"]
    return place(deck, chain.nodes[n], -depth if depth > 0.0 else None)[2]


def _hold(deck: Deck, chain: Chain, riser: ImportedRiser, options: Options, level: float | None) -> None:
    """Add the ends, and a first shape where one of them is free."""
    rows = [chain.pieces[n].row for n in (0, -1)]
    for key, node, row in zip(("start", "end"), chain.ends, rows, strict=True):
        riser.origins[(key,)] = row.line if node.section == "rods" else node.row.line
        if is_free(deck, node):
            riser.data[key] = "free"
            continue
        riser.data[key] = {"position": [*place(deck, node, level)]}
        riser.remarks += about_fixed(deck, node, row.line)
    if "free" in (riser.data["start"], riser.data["end"]):
        fixed = next(place(deck, node, level) for node in chain.ends if not is_free(deck, node))
        points = free_shape(deck, chain, fixed, options["rho"], level)
        riser.data["initial"] = {"points": points[::-1] if riser.data["start"] == "free" else points}


def _left_out(deck: Deck, chain: Chain) -> Iterator[Remark]:
    own = {piece.row.line for piece in chain.pieces} | {node.row.line for node in chain.nodes}
    for row in deck.of("lines"):
        if row.line not in own:
            yield row.line, f"line {row['ID']}: a scene has one riser; --line {row['ID']} imports this one"
    for section in ("bodies", "rods"):
        yield from ((row.line, f"{section}: {' '.join(row.words)}") for row in deck.of(section) if row.line not in own)


def _unused(deck: Deck, chain: Chain, forces: dict[str, list[SteadyForce]]) -> Iterator[Remark]:
    """Forces that do not act on the riser."""
    own = {node.name for node in chain.nodes if is_free(deck, node)}
    for name, several in forces.items():
        if name not in own:
            yield from ((each.line, f"force on {name}, which is not free on this riser") for each in several)


def lost_sections(deck: Deck) -> Iterator[Remark]:
    """Rows of sections that are not imported."""
    for section in deck.rows.keys() - {*KNOWN}:
        yield from ((row.line, f"{section}: {' '.join(row.words)}") for row in deck.of(section))
