"""The riser, or one of several lines, of a chain of a deck: segments, attachments, ends, and a first shape."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from riser_soil.core.quantities import Vector
from riser_soil.imported_scene import Remark
from riser_soil.moordyn.chains import Chain, is_hinge
from riser_soil.moordyn.deck import Deck, as_number
from riser_soil.moordyn.loads import SteadyForce
from riser_soil.moordyn.nodes import (
    COLUMNS,
    Node,
    Piece,
    free_body,
    has_length,
    is_driven,
    is_free,
    place,
    properties_at,
)
from riser_soil.moordyn.properties import about_ends, net_weight, type_name, type_of
from riser_soil.scene.problem import Path


@dataclass
class ImportedRiser:
    """A riser's keys, the loads on it, remarks, and the deck's line of each key."""

    data: dict[str, Any]
    loads: list[dict[str, Any]] = field(default_factory=list)
    remarks: list[Remark] = field(default_factory=list)
    origins: dict[Path, int] = field(default_factory=dict)


def riser_of(
    deck: Deck, chain: Chain, forces: dict[str, list[SteadyForce]], shared: Sequence[Node] = ()
) -> ImportedRiser:
    """Segments, and what sits and pulls at free nodes of a chain, but for those shared with others."""
    riser, arc = ImportedRiser({"segments": []}), 0.0
    attachments = list[dict[str, Any]]()
    for n, node in enumerate(chain.nodes):
        if n > 0:
            arc += _add_segment(deck, chain, n - 1, riser)
        if not is_free(deck, node) or node in shared:
            continue
        riser.remarks += [*about_free(deck, node)]
        if 0 < n < len(chain.pieces) and is_hinge(deck, node, [*chain.pieces[n - 1 : n + 1]]):
            hinge = f"{node.name} is a hinge between lines that bend; bending goes on here"
            riser.remarks.append((node.row.line, hinge))
        if properties := properties_at(deck, node):
            riser.origins[("attachments", len(attachments))] = node.row.line
            attachments.append({"at": arc} | properties)
        at = {0: "start", len(chain.pieces): "end"}.get(n, arc)
        riser.loads += [{"at": at} | each.load for each in forces.get(node.name, ())]
    if attachments:
        riser.data["attachments"] = attachments
    return riser


def _add_segment(deck: Deck, chain: Chain, n: int, riser: ImportedRiser) -> float:
    """Add a segment; its length [m]."""
    piece, segments = chain.pieces[n], riser.data["segments"]
    riser.origins[("segments", len(segments))] = piece.row.line
    length, elements = length_of(deck, piece), int(deck.number(piece.row, "NumSegs"))
    segments.append({"line_type": type_name(piece), "length": length, "elements": elements})
    return length


def length_of(deck: Deck, piece: Piece) -> float:
    """Unstretched length of a line, or length of a rod [m]."""
    if piece.section == "lines":
        return deck.number(piece.row, "UnstrLen")
    return math.dist(*(place(deck, end) for end in piece.ends))


def about_free(deck: Deck, node: Node) -> list[Remark]:
    """Remarks on what a free node has and the scene does not."""
    if node.section == "rods" and not has_length(deck, node.row):
        return [(node.row.line, about) for about in about_ends(type_of(deck, node.row))]
    if node.section != "bodies":
        return []
    return [(node.row.line, f"the rotation of {node.name}, which is a point here"), *_about_axes(deck, node)]


def _about_axes(deck: Deck, node: Node) -> list[Remark]:
    drag, added = (deck.numbers(node.row, *each) for each in (("CdA", (1, 2, 3, 6)), ("Ca", (1, 3))))
    if len({*(drag[:3] if len(drag) > 2 else drag[:1])}) == 1 == len({*added}):
        return []
    coefficients = f"CdA {node.row['CdA']} and Ca {node.row['Ca']} of {node.name}"
    return [(node.row.line, f"{coefficients}: the largest of each counts in all directions")]


def about_fixed(deck: Deck, node: Node, line: int) -> list[Remark]:
    """What the scene does not have of a node that holds an end; line: of the deck, where it has the end."""
    remarks = list[Remark]()
    if node.section == "rods":
        remarks.append((line, f"the line is clamped to {node.name}; its end is free to turn here"))
    if is_driven(deck, node):
        remarks.append((node.row.line, f"the motion of {node.name}, which comes from outside: the end is fixed"))
    elif free_body(deck, node) is not None:
        remarks.append((node.row.line, f"{node.name} is on a free body; the end is fixed: --line all has both"))
    own = [column for column in COLUMNS[:3] if node.section == "points" and as_number(node.row[column]) != 0.0]
    if own:
        remarks.append((node.row.line, f"{', '.join(own)} of {node.name}, which is held"))
    return remarks


def free_shape(deck: Deck, chain: Chain, fixed: Vector, rho: float, level: float | None) -> list[list[float]]:
    """Points of a first shape from the held end of a chain on: down, or up where it floats, to the seabed or the
    surface, and along it to the side where the deck has the free end.

    rho: density of the water [kg/m3]. level: height of the seabed [m], None where there is none.
    """
    length = math.fsum(length_of(deck, piece) for piece in chain.pieces)
    x, y, z = fixed
    floats = weighs(deck, chain, rho) < 0.0
    room = max(0.0, -z) if floats else math.inf if level is None else max(0.0, z - level)
    upright = min(length, room)
    turn = [x, y, z + upright if floats else z - upright]
    points = [[x, y, z], turn] if upright > 0.0 else [[x, y, z]]
    if length > upright:
        free = next(place(deck, node, level) for node in chain.ends if is_free(deck, node))
        aside = math.hypot(free[0] - x, free[1] - y)
        way = ((free[0] - x) / aside, (free[1] - y) / aside) if aside > 0.0 else (1.0, 0.0)
        points.append([x + way[0] * (length - upright), y + way[1] * (length - upright), turn[2]])
    return points


def weighs(deck: Deck, chain: Chain, rho: float) -> float:
    """What a chain and all at its free nodes weigh in water of a density rho [kg/m3], as a mass [kg]."""
    total = math.fsum(length_of(deck, piece) * net_weight(deck, piece, rho) for piece in chain.pieces)
    for node in chain.nodes:
        if is_free(deck, node):
            properties = properties_at(deck, node)
            total += properties.get("mass", 0.0) - rho * properties.get("volume", 0.0)
    return total
