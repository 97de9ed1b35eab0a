"""What a deck does not have of a scene, key by key, as the scene's file gives it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from riser_soil.imported_scene import Remark
from riser_soil.scene.document import Document
from riser_soil.scene.problem import Path, dotted
from riser_soil.scene.scene import Scene

_HAS = re.compile(
    r"title|gravity|water\.(density|surface_level|depth)|line_types\.[^.]*\.(outer_diameter|mass|EA|EI\w*)"
    r"|line_types\.[^.]*\.(inner_diameter|submerged_weight|drag\.\w+|added_mass\.\w+)"
    r"|riser\.segments\.\d+\.(line_type|length|elements)|riser\.attachments\.\d+\.\w+"
    r"|riser\.contents\.density|riser\.(start|end)(\.position)?"
    r"|seabed\.(kind|stiffness|level)|contact\.friction\.(axial|lateral)|stages\.\d+\.(name|kind)"
)
_SETTINGS = ("output", "solver", "dimension", "error_bars")  # of a run
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
