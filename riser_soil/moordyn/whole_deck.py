"""A scene of all lines, points, rods and free bodies of a deck, and what of the deck it does not have, line by line."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.quantities import Vector
from riser_soil.imported_scene import ImportedScene, Remark
from riser_soil.moordyn.chains import Chain, all_chains
from riser_soil.moordyn.deck import Deck, DeckRow
from riser_soil.moordyn.joint_places import at_rest, cable_of
from riser_soil.moordyn.loads import SteadyForce, forces_of
from riser_soil.moordyn.names import FREE
from riser_soil.moordyn.nodes import (
    HELD,
    Node,
    body_of,
    free_body,
    has_length,
    is_free,
    is_point,
    kind,
    node_at,
    place,
    properties_at,
)
from riser_soil.moordyn.properties import line_types, stiffen_in_torsion, type_of
from riser_soil.moordyn.riser_of import ImportedRiser, about_fixed, about_free, free_shape, riser_of
from riser_soil.moordyn.scene_of import head_of, lost_sections
from riser_soil.moordyn.settings import Options, options_of, seabed_of
from riser_soil.scene.problem import Path

LEAST_MASS = 1e-3  # of the water that it displaces: of a point that has a volume and no mass


def whole_scene_of(deck: Deck) -> ImportedScene:
    """The whole deck. Lines that free rods, or points without anything, join by twos are one line; other free points
    are joints, placed where they come to rest. SceneError for bodies that are turned.
    """
    options, about_options = options_of(deck)
    forces, about_forces = forces_of(deck)
    every, alone = all_chains(deck, forces), list[Remark]()
    alone += [(piece.row.line, f"{piece.name}: no line ends at it") for chain in every if not chain.lines
              for piece in chain.pieces if not _meets(chain, every)]  # fmt: skip
    chains = [_upward(deck, chain, options) for chain in every if chain.lines or _meets(chain, every)]
    seabed, about_seabed, origins = seabed_of(deck, chains, options)
    types, about_types, type_lines = line_types(deck, (piece for chain in chains for piece in chain.pieces))
    twisted = stiffen_in_torsion(deck, types)
    ends, level = _ends_by_node(chains), seabed.get("seabed", {}).get("level")
    places, about_places = _places(deck, chains, ends, options, forces, level)
    risers = {chain.name: _riser(deck, chain, forces, ends, options, level, places) for chain in chains}
    bodies, about_bodies, body_lines = _bodies(deck, ends, options["rho"], places)
    joints = {name: joint for node in ends.values() for name, joint in _joints(deck, *node, bodies, places)}
    stage = {"name": "hang", "kind": "static"} | _loads(deck, risers, forces, bodies, ends)
    data = head_of(deck, options, types) | {"lines": {name: riser.data for name, riser in risers.items()}}
    data |= ({"bodies": bodies} if bodies else {}) | ({"joints": joints} if joints else {}) | seabed
    data |= {"stages": [stage]}
    remarks = {*deck.remarks, *about_options, *about_seabed, *about_types, *about_forces, *about_bodies, twisted}
    remarks |= {*about_places, *alone} | {remark for riser in risers.values() for remark in riser.remarks}
    remarks |= {*_about_nodes(deck, ends, forces), *_unused(deck, chains), *lost_sections(deck)}
    origins |= type_lines | body_lines
    origins |= {("lines", name, *path): line for name, riser in risers.items() for path, line in riser.origins.items()}
    return ImportedScene(data, sorted(remarks), {}, origins)


def _meets(chain: Chain, others: list[Chain]) -> bool:
    """Whether others end where a chain does."""
    names = {node.name for node in chain.ends}
    return any(names & {node.name for node in other.ends} for other in others if other is not chain)


Ends = dict[str, tuple[Node, list[tuple[Chain, str]]]]
"""Nodes by their names, with the chains that end there, and with which of their ends."""


def _ends_by_node(chains: list[Chain]) -> Ends:
    ends: Ends = {}
    for chain in chains:
        for key, node in zip(("start", "end"), chain.ends, strict=True):
            ends.setdefault(node.name, (node, []))[1].append((chain, key))
    return ends


def _upward(deck: Deck, chain: Chain, options: Options) -> Chain:
    """The chain from its lower end on."""
    depth = options["WtrDpth"]
    first, last = (place(deck, node, -depth if depth > 0.0 else None)[2] for node in chain.ends)
    return chain.reversed() if first > last else chain


def _riser(
    deck: Deck, chain: Chain, forces: dict[str, list[SteadyForce]], ends: Ends, options: Options, level: float | None,
    places: dict[str, Vector],
) -> ImportedRiser:  # fmt: skip
    """A line whose ends are held, shared with others or with a body, or free."""
    riser = riser_of(deck, chain, forces, [node for node in chain.ends if _is_shared(deck, *ends[node.name])])
    rows = [chain.pieces[n].row for n in (0, -1)]
    for key, node, row in zip(("start", "end"), chain.ends, rows, strict=True):
        riser.origins[(key,)] = row.line if node.section == "rods" else node.row.line
        if is_free(deck, node) or free_body(deck, node) is not None:
            riser.data[key] = "free"
        else:
            riser.data[key] = {"position": [*places[node.name]]}
            riser.remarks += about_fixed(deck, node, row.line)
    loose = [node for node in chain.ends if is_free(deck, node) and not _is_shared(deck, *ends[node.name])]
    if loose:
        fixed = [node for node in chain.ends if node not in loose]
        if not fixed:
            raise deck.error(chain.pieces[0].row.line, "no end of it is held or joined; fix or couple one of them")
        points = free_shape(deck, chain, places[fixed[0].name], options["rho"], level)
        riser.data["initial"] = {"points": points[::-1] if loose[0] == chain.ends[0] else points}
    return riser


def _places(
    deck: Deck, chains: list[Chain], ends: Ends, options: Options, forces: dict[str, list[SteadyForce]],
    level: float | None,
) -> tuple[dict[str, Vector], list[Remark]]:  # fmt: skip
    """Where all nodes are; those that lines share where they come to rest, bodies being where the deck has them."""
    places = {name: place(deck, node, level) for name, (node, _) in ends.items()}
    loads, g, rho = dict[str, Array](), options["g"], options["rho"]
    for name, (node, at_it) in ends.items():
        if is_free(deck, node) and _is_shared(deck, node, at_it):
            properties = properties_at(deck, node)
            weight = g * (properties.get("mass", 0.0) - rho * properties.get("volume", 0.0))
            loads[name] = np.sum([[0.0, 0.0, -weight], *(each.force for each in forces.get(name, ()))], axis=0)
    if not loads:
        return places, []
    touched = [chain for chain in chains if loads.keys() & {node.name for node in chain.ends}]
    joined = [chain for chain in touched if all(len(ends[node.name][1]) > 1 or not is_free(deck, node)
                                                for node in chain.ends)]  # fmt: skip
    positions = at_rest([cable_of(deck, chain, rho, g, level) for chain in joined], places, loads)
    if positions is None:
        rows = {ends[name][0].row.line for name in loads}
        remark = "its place at rest is not found; the search begins where the deck has it"
        return places, [(line, remark) for line in rows]
    return places | positions, []


def _is_shared(deck: Deck, node: Node, at_it: list[tuple[Chain, str]]) -> bool:
    """Whether a node is a joint of lines, or of a line and a body."""
    return (is_free(deck, node) and len(at_it) > 1) or free_body(deck, node) is not None


def _joints(
    deck: Deck, node: Node, at_it: list[tuple[Chain, str]], bodies: dict[str, Any], places: dict[str, Vector]
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Joints of all ends at a node: with its body where it has one, else with each other."""
    if not _is_shared(deck, node, at_it):
        return
    ends: list[dict[str, Any]] = [{"line": chain.name, "at": key} for chain, key in at_it]
    if (body := free_body(deck, node)) is not None:
        columns = ("X", "Y", "Z") if node.section == "points" else tuple(f"{axis}{node.end.lower()}" for axis in "XYZ")
        offset = [deck.number(node.row, column) for column in columns]
        ends.insert(0, {"body": _body_name(body), "offset": offset})
    elif _node_body(node) in bodies:
        ends.insert(0, {"body": _node_body(node)})
    first, *others = ends
    if "body" in first:
        pairs, place_of = [(first, each) for each in others], {}
    else:
        pairs, place_of = [*pairwise(ends)], {"position": [*places[node.name]]}
    for m, pair in enumerate(pairs, start=1):
        number = f"_{m}" if len(pairs) > 1 else ""
        yield f"at{_short(node)}{number}", {"kind": "pinned", "between": list(pair), **place_of}


def _short(node: Node) -> str:
    """Short name of a node: a point's number, R and a rod's number and end, B and a body's number."""
    return {"points": "", "rods": "R", "bodies": "B"}[node.section] + node.name.split()[1]


def _node_body(node: Node) -> str:
    """Name of the point body at a node."""
    return f"{node.section.removesuffix('s')}{node.row['ID']}" if node.section == "points" else _body_name(node.row)


def _body_name(row: DeckRow) -> str:
    return f"body{row['ID']}"


def _bodies(
    deck: Deck, ends: Ends, rho: float, places: dict[str, Vector]
) -> tuple[dict[str, Any], list[Remark], dict[Path, int]]:
    """Free nodes that lines share and that have something of their own, and free bodies."""
    bodies, remarks, origins = dict[str, Any](), list[Remark](), dict[Path, int]()
    for node, at_it in ends.values():
        properties = properties_at(deck, node)
        if not is_free(deck, node) or not _is_shared(deck, node, at_it) or not properties:
            continue
        name = _node_body(node)
        remarks += [(node.row.line, about) for about in _with_mass(properties, node.name, rho)]
        bodies[name] = {"kind": "point", "position": [*places[node.name]]} | properties
        origins[("bodies", name)] = node.row.line
    for row in deck.of("bodies"):
        if kind(deck, "bodies", row)[0] == FREE and not is_point(deck, row):
            bodies[_body_name(row)], about = _rigid(deck, row, rho)
            remarks += [(row.line, each) for each in about]
            origins[("bodies", _body_name(row))] = row.line
    return bodies, remarks, origins


def _with_mass(properties: dict[str, float], name: str, rho: float) -> Iterator[str]:
    """Give what has none the least mass."""
    if "mass" not in properties:
        properties["mass"] = LEAST_MASS * rho * properties.get("volume", 0.0) or 1.0
        yield f"{name} has no mass; it gets {properties['mass']:g} kg"


def _rigid(deck: Deck, row: DeckRow, rho: float) -> tuple[dict[str, Any], list[str]]:
    name = f"body {row['ID']}"
    if any(deck.number(row, column) for column in ("r0", "p0", "y0")):
        raise deck.error(row.line, f"{name} is turned; give its points in axes that are not")
    J = deck.numbers(row, "I", (1, 3))
    if not any(J):
        raise deck.error(row.line, f"{name} has no inertia, and what is on it is not all at its origin; give I")
    centre = deck.numbers(row, "CG", (1, 3))
    centre = centre if len(centre) == 3 else [0.0, 0.0, centre[0]]
    drag, added = deck.numbers(row, "CdA", (1, 2, 3, 6)), deck.numbers(row, "Ca", (1, 3))
    mass_and_volume = (deck.number(row, column) for column in ("Mass", "Volume"))
    weight = {key: value for key, value in zip(HELD, mass_and_volume, strict=False) if value}
    about = [*_with_mass(weight, name, rho)]
    return {
        "kind": "rigid", "position": [deck.number(row, column) for column in ("X0", "Y0", "Z0")], **weight,
        "inertia": _three(J), "centre_of_gravity": centre,
        "centre_of_buoyancy": centre,  # MoorDyn lets both act at CG
        "drag_area": _three(drag), "added_mass": _three(added), "rotational_drag": _turning(drag),
    }, about  # fmt: skip


def _three(values: list[float]) -> list[float]:
    """Three values by axis: one for all, one for all and one for rotations, three, or three and three for rotations."""
    return values[:3] if len(values) in (3, 6) else values[:1] * 3


def _turning(values: list[float]) -> list[float]:
    """Constants for rotations: MoorDyn takes those along the axes where a deck has no others."""
    return {1: values * 3, 2: values[1:] * 3, 3: values, 6: values[3:]}[len(values)]


def _loads(
    deck: Deck,
    risers: dict[str, ImportedRiser],
    forces: dict[str, list[SteadyForce]],
    bodies: dict[str, Any],
    ends: Ends,
) -> dict[str, Any]:
    """Loads of the stage, by line and by body."""
    by_line = {name: [*riser.loads] for name, riser in risers.items()}
    free = {f"body {row['ID']}": name for row in deck.of("bodies") if (name := _body_name(row)) in bodies}
    by_body = {name: [each.load for each in forces.get(body, ())] for body, name in free.items()}
    for node, at_it in ends.values():
        if not is_free(deck, node) or not _is_shared(deck, node, at_it) or node.name not in forces:
            continue
        if (name := _node_body(node)) in bodies:
            by_body[name] = [each.load for each in forces[node.name]]
        else:
            chain, key = at_it[0]
            by_line[chain.name] += [{"at": key} | each.load for each in forces[node.name]]
    loads = dict[str, Any]()
    for part, by_name in (("lines", by_line), ("bodies", by_body)):
        if on_it := {name: {"loads": several} for name, several in by_name.items() if several}:
            loads[part] = on_it
    return loads


def _about_nodes(deck: Deck, ends: Ends, forces: dict[str, list[SteadyForce]]) -> Iterator[Remark]:
    """Remarks on what is lost at nodes that lines share, and on forces at fixed nodes."""
    on_bodies = {f"body {row['ID']}" for row in deck.of("bodies") if kind(deck, "bodies", row)[0] == FREE}
    for node, at_it in ends.values():
        if _is_shared(deck, node, at_it):
            yield from about_free(deck, node)
        if node.section == "rods" and (len(at_it) > 1 or free_body(deck, node) is not None):
            yield node.row.line, f"the lines at {node.name} are clamped to it; they are free to turn here"
        if not is_free(deck, node) and node.name in forces:
            yield from ((each.line, f"force on {node.name}, which is held") for each in forces[node.name])
    for name, several in forces.items():
        if name.startswith("body") and name not in on_bodies:
            yield from ((each.line, f"force on {name}, which is held") for each in several)


def _unused(deck: Deck, chains: list[Chain]) -> Iterator[Remark]:
    """Rods that are held, or on bodies: their weight, buoyancy and drag."""
    own = {piece.row.line for chain in chains for piece in chain.pieces}
    for row in deck.of("rods"):
        if row.line in own or not has_length(deck, row):
            continue
        body = body_of(deck, "rods", row)
        about = f"rod {row['ID']} is {'held' if body is None else 'on a body'}: its weight, buoyancy and drag"
        yield row.line, about + ("" if body is None else _lacking_to(deck, body, row))


def _lacking_to(deck: Deck, body: DeckRow, rod: DeckRow) -> str:
    """What a rod's weight and buoyancy are to a free body, in words; none for another body."""
    if kind(deck, "bodies", body)[0] != FREE:
        return ""
    length = math.dist(*(place(deck, node_at(deck, rod, "rods", end)) for end in "AB"))
    mass, diameter = (deck.number(type_of(deck, rod), column) for column in ("Mass/m", "Diam"))
    volume = length * math.pi / 4.0 * diameter**2
    added = f"add {length * mass:.4g} kg to its Mass and {volume:.4g} m3 to its Volume"
    return f"; for body {body['ID']} to have them, {added}"
