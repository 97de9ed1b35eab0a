"""A deck from a scene: a riser at rest as MoorDyn v2 has it, which `scene_of` reads back."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from riser_soil.core.quantities import Vector
from riser_soil.errors import SceneError
from riser_soil.imported_scene import Remark
from riser_soil.scene.attachments import Attachment
from riser_soil.scene.document import Document
from riser_soil.scene.line_types import LineType
from riser_soil.scene.problem import Path, dotted
from riser_soil.scene.riser import Segment, Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import SpringSeabed

_SAME_ARC = 1e-9  # of the riser's length
_DAMPING = -0.8  # axial damping for MoorDyn's time steps, over an element's critical one
_STEP = 0.5  # over the time of the fastest element's own motion, 1/w; a step of explicit schemes is stable to about 2
_HAS = re.compile(
    r"title|gravity|water\.(density|surface_level|depth)|line_types\.[^.]*\.(outer_diameter|mass|EA|EI\w*)"
    r"|line_types\.[^.]*\.(inner_diameter|submerged_weight|drag\.\w+|added_mass\.\w+|strakes\.(drag|cover))"
    r"|riser\.segments\.\d+\.(line_type|length|elements)|riser\.attachments\.\d+\.\w+"
    r"|riser\.contents\.density|riser\.(start|end)(\.position)?"
    r"|seabed\.(kind|stiffness|level)|contact\.friction\.(axial|lateral)|stages\.\d+\.(name|kind)"
)
_SETTINGS = ("output", "solver", "dimension", "error_bars")  # keys of a run, not of a model
_WHY = {
    r"line_types\..*\.damping": "structural damping; BA is axial alone",
    r"line_types\..*\.GJ": "a deck has no torsion",
    r"riser\.segments\..*\.element_length": "elements of a line are alike there",
    r"seabed\.contact_at": "nodes touch with the axis: the bed is half a diameter higher",
    r"riser\.initial|riser\.unstressed": "a deck begins with straight lines, and finds its rest",
    r"stages\..*\.motion": "held ends are fixed; give them as Coupled, and move them from outside",
}
# What says what the deck has anyway.
_ALIKE = {"contact_at": "axis", "rotation": "free", "unstressed": "straight", "initial": "catenary"}


@dataclass(frozen=True)
class _Piece:
    """A stretch of riser between two points."""

    line_type: str
    length: float
    elements: int


def deck_of(scene: Scene) -> str:
    """The deck's text; SceneError where the riser is none that MoorDyn has."""
    pieces, arcs = _pieces(scene)
    level = _surface(scene)
    names = {name: _word(name, n) for n, name in enumerate(scene.used_line_types)}
    lines = [scene.title, *_head("LINE TYPES", "TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx",
                                 "(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)")]  # fmt: skip
    lines += [_row(names[name], *_properties(scene, name, line)) for name, line in scene.used_line_types.items()]
    lines += _head("POINTS", "ID Attachment X Y Z Mass Volume CdA Ca", "(#) (word) (m) (m) (m) (kg) (m^3) (m^2) (-)")
    lines += [_row(n, *row) for n, row in enumerate(_points(scene, arcs, level), start=1)]
    lines += _head("LINES", "ID LineType AttachA AttachB UnstrLen NumSegs Outputs", "(#) (name) (#) (#) (m) (-) (-)")
    lines += [_row(n, names[p.line_type], n, n + 1, p.length, p.elements, "-") for n, p in enumerate(pieces, start=1)]
    options = {"dtM": _time_step(scene, pieces)} | _options(scene, level)
    lines += [*_head("OPTIONS"), *(_row(value, key) for key, value in options.items())]
    return "\n".join([*lines, *_head("OUTPUTS"), *_head("need this line")]) + "\n"


def _head(*lines: str) -> list[str]:
    return [f"{'-' * 22} {lines[0]} {'-' * 22}", *lines[1:]]


def _row(*cells: object) -> str:
    return " ".join(repr(cell) if isinstance(cell, float) else str(cell) for cell in cells)


def _word(name: str, number: int) -> str:
    """A name of one word; with its number where it had to change."""
    word = re.sub(r"[^\w.+-]", "_", name)
    return word if word == name else f"{word}_{number + 1}"


def _surface(scene: Scene) -> float:
    """Height of the surface [m], which is 0 in a deck."""
    if scene.water is None or scene.water.surface_level is None:
        raise SceneError("water.surface_level: is missing; a deck's heights count from the surface")
    return scene.water.surface_level


def _properties(scene: Scene, name: str, line: LineType) -> list[float]:
    """Diam to CaAx; contents are part of the mass."""
    path, (about_y, about_z) = f"line_types.{name}", line.bending_stiffness
    if line.outer_diameter is None or line.mass is None:
        raise SceneError(f"{path}: has no outer_diameter or no mass, which a deck needs; give both")
    if line.submerged_weight is not None:
        raise SceneError(f"{path}.submerged_weight: a deck's weight follows from mass and diameter; leave it out")
    if about_y != about_z:
        raise SceneError(f"{path}: EI_y and EI_z differ, and a deck has one EI; give EI")
    filled = scene.line.contents.density * math.pi / 4.0 * line.inner_diameter**2 if scene.line.contents else 0.0
    if line.drag and line.drag.normal is None:
        raise SceneError(f"{path}.drag.by_reynolds: a deck has one coefficient across the line; give normal")
    drag = line.normal_drag, line.drag.tangential if line.drag else 0.0
    added = (line.added_mass.normal, line.added_mass.tangential) if line.added_mass else (0.0, 0.0)
    return [line.outer_diameter, line.mass + filled, line.EA, _DAMPING, about_y, drag[0], added[0], drag[1], added[1]]


def _time_step(scene: Scene, pieces: list[_Piece]) -> float:
    """Time step [s] to two digits, by the fastest motion of a node: stretching, bending, or on the bed's springs."""
    rates, bed = [0.0], scene.seabed.stiffness if isinstance(scene.seabed, SpringSeabed) else 0.0
    for piece in pieces:
        _, mass, EA, _, EI, *_ = _properties(scene, piece.line_type, scene.line_types[piece.line_type])
        size = piece.length / piece.elements
        rates += [4.0 * EA / size**2 / mass, 16.0 * EI / size**4 / mass, bed / mass]
    return float(f"{_STEP / math.sqrt(max(rates)):.1e}")


def _pieces(scene: Scene) -> tuple[list[_Piece], list[float]]:
    """Segments, cut where something is attached, and the arc lengths of their ends."""
    cuts = [arc for each in scene.line.attachments for arc in each.arcs]
    pieces, at = list[_Piece](), [0.0]
    for segment in scene.line.segments:
        pieces += _cut(segment, [arc - at[-1] for arc in cuts], _SAME_ARC * scene.line.length)
        at = [0.0, *(sum(piece.length for piece in pieces[: n + 1]) for n in range(len(pieces)))]
    return pieces, at


def _cut(segment: Segment, arcs: Sequence[float], apart: float) -> Iterator[_Piece]:
    within = sorted({arc for arc in arcs if apart < arc < segment.length - apart})
    for a, b in pairwise([0.0, *within, segment.length]):
        share = round(segment.element_count * (b - a) / segment.length)
        yield _Piece(segment.line_type, b - a, max(1, share))


def _points(scene: Scene, arcs: list[float], level: float) -> Iterator[list[object]]:
    """Attachment, place and what sits there, of each point; free ones lie on a straight line, and find their places."""
    ends = scene.line.start, scene.line.end
    first, last = (end.position if isinstance(end, Support) else None for end in ends)
    if first is None and last is None:
        raise SceneError("riser: both ends are free; a deck needs one that is held")
    for n, arc in enumerate(arcs):
        fixed = (first if n == 0 else None) or (last if n == len(arcs) - 1 else None)
        x, y, z = fixed or _between(first, last, arc, arcs[-1])
        attached = _attached(scene, arc)
        if fixed and attached:
            raise SceneError("riser.attachments: one is at an end that is held, where it has no effect; leave it out")
        what = _sum(attached)
        yield ["Fixed" if fixed else "Free", x, y, z - level, *what]


def _between(first: Vector | None, last: Vector | None, arc: float, length: float) -> Vector:
    """Position on the line between the ends, or below the one that is held."""
    if first is not None and last is not None:
        x, y, z = (a + (b - a) * arc / length for a, b in zip(first, last, strict=True))
        return x, y, z
    end = first or last
    assert end is not None
    return end[0], end[1], end[2] - (arc if first else length - arc)


def _attached(scene: Scene, arc: float) -> list[Attachment]:
    near = _SAME_ARC * scene.line.length
    return [each for each in scene.line.attachments for at in each.arcs if abs(at - arc) <= near]


def _sum(attached: list[Attachment]) -> list[float]:
    """Mass, volume, drag area, and the added mass over that of the water displaced."""
    mass, volume, area = (math.fsum(getattr(a, key) for a in attached) for key in ("mass", "volume", "drag_area"))
    added = math.fsum(each.added_mass * each.volume for each in attached)
    return [mass, volume, area, added / volume if volume else 0.0]


def _options(scene: Scene, level: float) -> dict[str, float]:
    assert scene.water is not None
    options = {"g": scene.gravity, "rho": scene.water.density}
    if isinstance(bed := scene.seabed, SpringSeabed):
        diameter = scene.line_types[scene.line.segments[0].line_type].outer_diameter or 0.0
        axis = scene.seabed_level + (0.5 * diameter if bed.contact_at == "outer" else 0.0)
        options |= {"WtrDpth": level - axis, "kBot": bed.stiffness / diameter, "cBot": 0.0}
    elif scene.has_ground:
        raise SceneError("seabed: a deck has no other ground than kind spring; give its stiffness [N/m2]")
    friction = scene.contact.friction if scene.contact else None
    if friction is not None and friction.axial is not None:
        across = friction.axial if friction.lateral is None else friction.lateral
        alike = {"FrictionCoefficient": across}
        options |= alike if across == friction.axial else {"mu_kA": friction.axial, "mu_kT": across}
    return options


def left_out(document: Document, scene: Scene) -> Iterator[Remark]:
    """Remarks by line."""
    if scene.seabed is not None and len({line.outer_diameter for line in scene.used_line_types.values()}) > 1:
        why = "kBot times the diameter is this of the first segment; of another diameter it is another"
        yield document.where(("seabed", "stiffness"))[0], f"seabed.stiffness: {why}"
    for path, value in _values(document.data, ()):
        name = dotted(path)
        if path[0] in _SETTINGS or value in (None, _ALIKE.get(str(path[-1]))) or _has(path, value):
            continue
        why = next((f": {why}" for pattern, why in _WHY.items() if re.match(pattern, name)), "")
        yield document.where(path)[0], f"{name} {value}{why}"


def _has(path: Path, value: Any) -> bool:
    if path[0] == "stages" and path[-1] in ("kind", "name"):
        return path[-1] == "name" or value == "static"
    if path[0] == "riser" and path[-1] == "rotation":
        return bool(value == "free")
    if path[-1] == "element_length":
        return not isinstance(value, list)
    plain = ("line_types", "name", *path[2:]) if path[0] == "line_types" else path  # a name may have points
    return _HAS.fullmatch(dotted(plain)) is not None


def _values(value: Any, path: Path) -> Iterator[tuple[Path, Any]]:
    """Single values by their places; a list of numbers is one."""
    if isinstance(value, dict):
        for key, each in value.items():
            yield from _values(each, (*path, key))
    elif isinstance(value, list) and any(isinstance(each, dict) for each in value):
        for n, each in enumerate(value):
            yield from _values(each, (*path, n))
    else:
        yield path, value
