"""A line of a data file: its sections, contents, and what its ends are connected to."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from riser_soil.orcaflex.data_file import FORCE, MASS, DataFile, Item, unit_vector
from riser_soil.orcaflex.environment import surface_level, water_depth
from riser_soil.orcaflex.vessels import place_on

_OUT_OF_PLANE = 1e-6  # of a neutral direction that a flex joint in the riser's plane can have
_LEVEL = 1e-9  # horizontal distance of the ends [m] below which there is no such plane


@dataclass
class LineEnd:
    """An end: row of its connection, row of its stiffness, place [m], the vessel that carries it."""

    connection: Item
    stiffness: Item | None
    position: list[float] | None
    vessel: Item | None


def chosen(file: DataFile, name: str | None) -> Item:
    """The line of this name, by default the file's first."""
    lines = file.objects("Lines")
    found = [each for each in lines if name is None or each.word("Name") == name]
    if not found:
        known = ", ".join(each.word("Name") for each in lines)
        raise file.section("General").error("Lines", f"there is no line {name or 'at all'}; it has {known or 'none'}")
    for n, each in enumerate(lines):
        if each.word("Name") != found[0].word("Name"):
            each.left("Name", f"a scene has one riser; --line {each.word('Name')!r} imports this one")
            file.read.add(("Lines", n))
    return found[0]


def ends(file: DataFile, line: Item) -> list[LineEnd]:
    """Ends A and B."""
    connections, stiffnesses = line.rows("Connection"), line.rows("ConnectionxBendingStiffness")
    if len(connections) != 2:
        raise line.error("Connection", f"{len(connections)} rows of Connection, ConnectionX, ...: it takes two")
    pairs = zip(connections, stiffnesses if len(stiffnesses) == 2 else [None, None], strict=True)
    return [_end(file, connection, stiffness) for connection, stiffness in pairs]


def segments(line: Item) -> list[dict[str, Any]]:
    """The scene's segments, from end A."""
    if not (rows := line.rows("LineType")):
        raise line.error("LineType", "there is no table LineType, Length, ...; give the line's sections")
    return [_segment(row) for row in rows]


def contents(line: Item) -> dict[str, Any] | None:
    """What fills the line; None where it is empty."""
    method = line.word("ContentsMethod", "Uniform")
    if method != "Uniform":
        raise line.error("ContentsMethod", f"is {method}; only Uniform can be carried over")
    found = {"density": line.number("ContentsDensity", 0.0) * MASS}
    pressure = line.number("ContentsPressure", 0.0) * FORCE
    if pressure and not line.has("ContentsPressureRefZ"):
        line.left("ContentsPressure", "ContentsPressure without ContentsPressureRefZ: give the pressure and its level")
    elif pressure:
        found |= {"pressure": pressure, "pressure_level": line.number("ContentsPressureRefZ")}
    return found if found["density"] or pressure else None


def support(end: LineEnd, lower: LineEnd, upper: LineEnd) -> Any:
    """An end as a scene has it: free, or its position and how it turns."""
    if end.position is None:
        return "free"
    return {"position": end.position} | _rotation(end, lower, upper)


def _end(file: DataFile, connection: Item, stiffness: Item | None) -> LineEnd:
    kind = connection.word("Connection")
    local = connection.numbers("ConnectionX", 1) + connection.numbers("ConnectionY", 1)
    local += connection.numbers("ConnectionZ", 1)
    if kind == "Free":
        return LineEnd(connection, stiffness, None, None)
    if connection.has("ConnectionzRelativeTo"):
        raise connection.error("ConnectionzRelativeTo", "a height over something else; give it as Fixed or Anchored")
    if kind == "Fixed":
        return LineEnd(connection, stiffness, local, None)
    if kind == "Anchored":
        environment = file.section("Environment")
        local[2] += surface_level(environment) - water_depth(environment)
        return LineEnd(connection, stiffness, local, None)
    vessel = next((each for each in file.objects("Vessels") if each.word("Name") == kind), None)
    if vessel is None:
        raise connection.error("Connection", f"is {kind}, which is no vessel; connect the end to one, or as Fixed")
    return LineEnd(connection, stiffness, place_on(vessel, local), vessel)


def _segment(row: Item) -> dict[str, Any]:
    found: dict[str, Any] = {"line_type": row.word("LineType"), "length": row.number("Length")}
    if row.has("TargetSegmentLength"):
        return found | {"element_length": row.number("TargetSegmentLength")}
    if row.has("NumberOfSegments"):
        return found | {"elements": int(row.number("NumberOfSegments"))}
    raise row.error("TargetSegmentLength", "is missing; give it, or NumberOfSegments")


def _rotation(end: LineEnd, lower: LineEnd, upper: LineEnd) -> dict[str, Any]:
    """Of a hinge nothing; of a flex joint in the riser's plane its stiffness and neutral angle."""
    row = end.stiffness
    for key in ("ConnectionAzimuth", "ConnectionDeclination", "ConnectionGamma"):
        end.connection.get(key)  # of no effect on a hinge
    size, across = (0.0, 0.0) if row is None else (
        row.stiffness("ConnectionxBendingStiffness", 0.0), row.stiffness("ConnectionyBendingStiffness", math.nan)
    )  # fmt: skip
    if row is None or size == 0.0:
        return {}
    if math.isinf(size):
        row.left("ConnectionxBendingStiffness", "clamped in a direction of its own: the end is free to turn here")
        return {}
    angle = _neutral_angle(end, lower, upper)
    if angle is None:
        end.connection.left("ConnectionAzimuth", "a joint out of the riser's plane: the end is free to turn here")
        return {}
    if math.isfinite(across) and across != size:
        row.left("ConnectionyBendingStiffness", f"{across:g} about y: it is that about x here")
    return {"rotation": {"stiffness": math.degrees(size * FORCE), "neutral_angle": angle}}


def _neutral_angle(end: LineEnd, lower: LineEnd, upper: LineEnd) -> float | None:
    """Of the line followed upwards from the vertical [deg], positive towards the upper end; None out of their plane.

    An end's own axis points from A to B: down by the declination from z, its azimuth from x towards y.
    """
    x, y = unit_vector(end.connection.number("ConnectionAzimuth", 0.0))
    down, across = unit_vector(end.connection.number("ConnectionDeclination", 0.0))
    axis = [across * x, across * y, down]
    if lower.position is None or upper.position is None:
        return None
    dx, dy = (upper.position[n] - lower.position[n] for n in range(2))
    if (span := math.hypot(dx, dy)) < _LEVEL:
        return None
    sign = -1.0 if axis[2] < 0.0 or (axis[2] == 0.0 and axis[0] * dx + axis[1] * dy < 0.0) else 1.0
    along, out = (axis[0] * dx + axis[1] * dy) / span, (axis[1] * dx - axis[0] * dy) / span
    return math.degrees(math.atan2(sign * along, sign * axis[2])) if abs(out) < _OUT_OF_PLANE else None
