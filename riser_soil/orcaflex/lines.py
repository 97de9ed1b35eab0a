"""A line of a data file: its line types, sections, contents, and what its ends are connected to."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from riser_soil.orcaflex.data_file import FORCE, MASS, DataFile, Item, unit_vector
from riser_soil.orcaflex.environment import surface_level, water_depth
from riser_soil.orcaflex.vessels import place_on

_OUT_OF_PLANE = 1e-6  # of a neutral direction that a flex joint in the riser's plane can have
_LEVEL = 1e-9  # horizontal distance of the ends [m] below which there is no such plane
_EQUAL = 1e-9
_LEFT = {
    "Cs": "slamming", "Ce": "slamming", "Cl": "lift", "CompressionIsLimited": "a limit of compression",
    "ExpansionTable": "expansion", "ClashStiffness": "clashing",
}  # fmt: skip


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


def line_type(item: Item) -> dict[str, Any]:
    """A scene's line type."""
    outer = item.number("OD")
    found = {"outer_diameter": outer, "inner_diameter": item.number("ID", 0.0)} | _section(item, outer)
    _tell(item, outer)
    for ours, theirs, size in (("max_tension", "AllowableTension", FORCE), ("min_bend_radius", "MinRadius", 1.0)):
        if (value := item.numbers(theirs, 1, math.inf)[0]) not in (0.0, math.inf):
            found[ours] = value * size
    return found | _coefficients(item, outer)


def contact_diameter(item: Item) -> float:
    """What lies on the seabed [m]."""
    return item.number("OuterContactDiameter", item.number("OD"))


def friction_of(item: Item) -> tuple[float, float]:
    """Coefficients of friction along and across; before version 11 the latter was called normal."""
    across = item.number("SeabedLateralFrictionCoefficient", item.number("SeabedNormalFrictionCoefficient", 0.0))
    return item.number("SeabedAxialFrictionCoefficient", across), across


def _section(item: Item, outer: float) -> dict[str, Any]:
    category = item.word("Category", "General")
    if category == "Homogeneous pipe":
        return _homogeneous(item, outer)
    if category != "General":
        raise item.error("Category", f"is {category}; only General and Homogeneous pipe can be carried over")
    in_x, in_y = item.numbers("EI", 2, math.inf)
    if math.isfinite(in_y) and abs(in_y - in_x) > _EQUAL * in_x:
        item.left("EI", f"EI about y of {in_y:g}: it is that about x here")
    if not all(map(math.isfinite, (in_x, axial := item.stiffness("EA", math.nan)))):
        key = "EA" if math.isfinite(in_x) else "EI"
        raise item.error(key, f"is {item.get(key)!r}: only plain numbers can be carried over, no tables")
    found = {"mass": item.number("MassPerUnitLength") * MASS, "EA": axial * FORCE, "EI": in_x * FORCE}
    if math.isfinite(twist := item.stiffness("GJ", math.nan)):
        found["GJ"] = twist * FORCE
    return found


def _homogeneous(item: Item, outer: float) -> dict[str, Any]:
    """Of an elastic pipe: E A, E I, G 2 I."""
    inner, E = item.number("ID", 0.0), item.number("E") * FORCE
    for key in ("CoatingThickness", "LiningThickness"):
        if item.number(key, 0.0):
            raise item.error(key, "a coat can't be carried over; save the line type as General")
    area, inertia = math.pi / 4.0 * (outer**2 - inner**2), math.pi / 64.0 * (outer**4 - inner**4)
    twist = E * inertia / (1.0 + item.number("PoissonRatio"))
    return {"mass": item.number("MaterialDensity") * MASS * area, "EA": E * area, "EI": E * inertia, "GJ": twist}


def _coefficients(item: Item, outer: float) -> dict[str, Any]:
    """Drag and added mass; drag on another diameter is on the outer one here."""
    found: dict[str, Any] = {}
    for ours, theirs in (("drag", "Cd"), ("added_mass", "Ca")):
        values = item.get(theirs)
        if any(isinstance(each, str) for each in (values if isinstance(values, list) else [values])):
            item.left(theirs, f"{theirs} by a table ({values}): the line type has no {ours}")
            continue
        x, y, along = item.numbers(theirs, 3, math.nan)
        if math.isfinite(y) and y != x:
            item.left(theirs, f"{theirs} of {y:g} in y: it is that in x here")
        if math.isfinite(x):
            found[ours] = {"normal": x, "tangential": along if math.isfinite(along) else 0.0}
    for way, key in (("normal", "NormalDragLiftDiameter"), ("tangential", "AxialDragLiftDiameter")):
        if "drag" in found:
            found["drag"][way] *= item.number(key, outer) / outer
    return found


def _tell(item: Item, outer: float) -> None:
    for key, what in _LEFT.items():
        if item.word(key) not in ("", "0", "0.0", "No", "None"):
            item.left(key, f"{key} {item.word(key)}: {what}")
    if (ratio := item.number("PoissonRatio", 0.5)) != 0.5:
        item.left("PoissonRatio", f"PoissonRatio {ratio:g}: the pipe stretches with effective tension here, as for 0.5")
    if item.has("OuterContactDiameter") and contact_diameter(item) != outer:
        item.left("OuterContactDiameter", f"OuterContactDiameter {contact_diameter(item):g}: OD touches here")
