"""A line of a data file: its sections, contents, attachments, and what its ends are connected to."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from riser_soil.orcaflex.data_file import FORCE, MASS, DataFile, Item, folded, unit_vector
from riser_soil.orcaflex.environment import surface_level, water_depth
from riser_soil.orcaflex.line_types import PipeOfType, line_type, pieces
from riser_soil.orcaflex.variable_data import is_name, points_of
from riser_soil.orcaflex.vessels import place_on
from riser_soil.scene.problem import Path as KeyPath

_ARCS = ("Attachmentz", "AttachmentPosition", "AttachmentArcLength")  # names in version 11 and before
_RELATIVE = ("AttachmentzRelativeTo", "AttachmentRelativeTo", "AttachmentPositionRelativeTo")
_OUT_OF_PLANE = 1e-6  # of a neutral direction that a flex joint in the riser's plane can have
_CLAMPED = 1e4  # of EI over the length of the last element: stiffness of a joint that hardly gives
_ROUNDING = 1e-6  # m: of a height that is added up
_LEVEL = 1e-9  # horizontal distance of the ends [m] below which there is no such plane


@dataclass
class LineEnd:
    """An end: row of its connection, row of its stiffness, place [m], the vessel that carries it."""

    connection: Item
    stiffness: Item | None
    position: list[float] | None
    vessel: Item | None

    @property
    def height(self) -> float:
        """Height z [m]; a free end counts as below all others."""
        return -math.inf if self.position is None else self.position[2]


@dataclass
class LineWithEnds:
    """A line from its lower end to its upper one: as a scene has it, its ends, the pipes at both, its line types by
    name, and by a value's path within the line the file's line that it comes from.
    """

    item: Item
    data: dict[str, Any]
    ends: list[LineEnd]
    at_ends: tuple[PipeOfType, PipeOfType]
    types: dict[str, PipeOfType]
    origins: dict[KeyPath, int] = field(default_factory=dict)


def line_of(file: DataFile, item: Item) -> LineWithEnds | None:
    """The line; None where something of it was refused without which there is no line at all."""
    both, parts = _ends(file, item), list(_segments(file, item))
    if not (both and parts):
        return None
    length = sum(segment["length"] for segment, *_ in parts)
    attachments = _attachments(item, length)
    if both[0].height > both[1].height:
        both, parts = both[::-1], parts[::-1]
        attachments = [each | {"at": [length - at for at in each["at"]][::-1]} for each in attachments]
    clamps = [_clamping(*parts[n][:2]) for n in (0, -1)]
    lower, upper = both
    supports = {
        key: _support(end, lower, upper, clamp)
        for key, end, clamp in zip(("start", "end"), both, clamps, strict=True)
    }
    data: dict[str, Any] = {"segments": [segment for segment, *_ in parts]}
    data |= ({"attachments": attachments} if attachments else {}) | supports
    data |= {"contents": filled} if (filled := _contents(item)) else {}
    types = {segment["line_type"]: pipe for segment, pipe, _ in parts}
    origins: dict[KeyPath, int] = {(): item.line("Name")}
    origins |= {("segments", n): line for n, (*_, line) in enumerate(parts)}
    origins |= {(key,): end.connection.line("Connection") for key, end in zip(("start", "end"), both, strict=True)}
    _remark_on_torsion(item, data)
    return LineWithEnds(item, data, both, (parts[0][1], parts[-1][1]), types, origins)


def lay(line: LineWithEnds, level: float) -> None:
    """Lifts ends that lie below where the line rests on a seabed at this level [m], and says so."""
    for key, end, pipe in zip(("start", "end"), line.ends, line.at_ends, strict=True):
        rest = level + 0.5 * pipe.outermost
        if end.position is not None and end.position[2] < rest:
            depth = rest - end.position[2]
            line.data[key]["position"] = end.position = [*end.position[:2], rest]
            if depth > _ROUNDING:
                text = f"an end {depth:.4g} m below where the line rests on the seabed: it is laid from z = {rest:g} m"
                end.connection.remark("ConnectionZ", text)


def line_types_of(lines: list[LineWithEnds]) -> dict[str, Any]:
    """The scene's line types, by name."""
    return {name: line_type(pipe) for line in lines for name, pipe in line.types.items()}


def _ends(file: DataFile, line: Item) -> list[LineEnd]:
    """Ends A and B."""
    connections, stiffnesses = line.rows("Connection"), line.rows("ConnectionxBendingStiffness")
    if len(connections) != 2:
        line.refuse("Connection", f"{len(connections)} rows of Connection, ConnectionX, ...: it takes two")
        return []
    pairs = zip(connections, stiffnesses if len(stiffnesses) == 2 else [None, None], strict=True)
    return [_end(file, connection, stiffness) for connection, stiffness in pairs]


def _end(file: DataFile, connection: Item, stiffness: Item | None) -> LineEnd:
    kind = connection.choice("Connection")
    local = [connection.numbers(f"Connection{axis}", 1)[0] for axis in "XYZ"]
    if kind == "free":
        return LineEnd(connection, stiffness, None, None)
    if connection.has("ConnectionzRelativeTo"):
        given = connection.word("ConnectionzRelativeTo")
        connection.refuse("ConnectionzRelativeTo", f"is {given}, over something else; give it as Fixed or Anchored")
    if kind == "fixed":
        return LineEnd(connection, stiffness, local, None)
    if kind == "anchored":
        environment = file.section("Environment")
        local[2] += surface_level(environment) - water_depth(environment)
        return LineEnd(connection, stiffness, local, None)
    vessel = file.find("Vessels", kind)
    if vessel is None:
        given = connection.word("Connection")
        connection.refuse("Connection", f"is {given}, which is no vessel; connect the end to one, or as Fixed")
    return LineEnd(connection, stiffness, local if vessel is None else place_on(vessel, local), vessel)


def _segments(file: DataFile, line: Item) -> Iterator[tuple[dict[str, Any], PipeOfType, int]]:
    """The scene's segments, from end A, each with its pipe and the file's line."""
    rows = line.rows("LineType")
    if not rows:
        line.refuse("LineType", "there is no table LineType, Length, ...; give the line's sections")
    for row in rows:
        name = row.word("LineType")
        item = file.named("LineTypes", name, row, "LineType")
        if item is None:
            continue
        length = row.number("Length") if row.has("Length") or not is_name(item.get("OD")) else math.inf
        parts = pieces(item, length)
        whole = sum(length for length, _ in parts)
        for length, pipe in parts:
            step = "" if len(parts) == 1 else f" {pipe.outer:.6g} x {pipe.inner:.6g}"
            segment = {"line_type": f"{item.title}{step}", "length": length} | _elements(row, length, whole)
            yield segment, pipe, row.line("LineType")


def _elements(row: Item, length: float, whole: float) -> dict[str, Any]:
    """Elements of a piece, by its length [m], of a section whose whole length is given [m]."""
    if row.has("TargetSegmentLength"):
        return {"element_length": row.number("TargetSegmentLength")}
    if row.has("NumberOfSegments"):
        count = row.number("NumberOfSegments")
        apart = length != whole or not math.isfinite(count)
        return {"element_length": whole / count} if apart else {"elements": int(count)}
    row.refuse("TargetSegmentLength", "is missing; give it, or NumberOfSegments")
    return {}


def _contents(line: Item) -> dict[str, Any] | None:
    """The line's contents; None where it is empty."""
    if line.choice("ContentsMethod", "Uniform") != "uniform":
        line.refuse("ContentsMethod", f"is {line.word('ContentsMethod')}; only Uniform can be carried over")
        return None
    contents = {"density": line.number("ContentsDensity", 0.0) * MASS}
    pressure = line.number("ContentsPressure", 0.0) * FORCE
    if pressure and not line.has("ContentsPressureRefZ"):
        text = "ContentsPressure without ContentsPressureRefZ: give the pressure and its level"
        line.remark("ContentsPressure", text)
    elif pressure:
        contents |= {"pressure": pressure, "pressure_level": line.number("ContentsPressureRefZ")}
    return contents if contents["density"] or pressure else None


def _attachments(line: Item, length: float) -> list[dict[str, Any]]:
    """Clumps of the scene, each kind with its arc lengths from end A [m]; other attachments are not carried over."""
    attachments = dict[str, dict[str, Any]]()
    for row in line.rows("AttachmentType"):
        kind = row.word("AttachmentType")
        clump = line.file.find("ClumpTypes", kind)
        if clump is None:
            row.remark("AttachmentType", f"attachment {kind}: only clumps are carried over, and it is none")
            continue
        arc, of = (next((key for key in keys if row.has(key)), keys[0]) for keys in (_ARCS, _RELATIVE))
        at = row.number(arc)
        if (relative := row.choice(of, "End A")) == "end b":
            at = length - at
        elif relative != "end a":
            row.refuse(of, f"is {relative}; give it relative to End A or End B")
        if any(row.numbers(key, 1)[0] for key in ("Attachmentx", "Attachmenty")):
            row.remark("Attachmentx", f"attachment {kind}, beside the line's axis: it sits on it here")
        attachments.setdefault(folded(kind), _clump(clump) | {"at": []})["at"].append(at)
    return [each | {"at": sorted(each["at"])} for each in attachments.values()]


def _clump(item: Item) -> dict[str, Any]:
    """A clump, which has one drag area and one coefficient of added mass in all directions: those in x here."""
    areas, drags, added = (_by_axis(item, key) for key in ("DragArea", "Cd", "Ca"))
    by_axis = [area * drag for area, drag in zip(areas, drags, strict=True)]
    for key, values in (("DragArea", by_axis), ("Ca", added)):
        if len({*values}) > 1:
            shown = ", ".join(f"{value:g}" for value in values)
            what = "Cd times DragArea" if key == "DragArea" else key
            item.remark(key, f"{what} of {shown} in x, y, z: that in x here, in all directions")
    clump = {"mass": item.number("Mass", 0.0) * MASS, "volume": item.number("Volume", 0.0), "drag_area": by_axis[0]}
    clump |= {"added_mass": added[0]} if clump["volume"] else {}
    return {key: value for key, value in clump.items() if value != 0.0}


def _by_axis(item: Item, key: str) -> list[float]:
    """Values in x, y and z; in y as in x where it is not given."""
    x, y, z = item.numbers(key, 3, math.nan)
    return [each if math.isfinite(each) else other for each, other in ((x, 0.0), (y, x), (z, 0.0))]


def _clamping(segment: dict[str, Any], pipe: PipeOfType) -> float:
    """Stiffness of a joint that hardly gives beside the line's last element [kN.m/deg]; 0 of a chain's, which may."""
    length = segment.get("element_length") or segment["length"] / segment.get("elements", 1)
    return math.radians(_CLAMPED * line_type(pipe).get("EI", math.nan) / length) / FORCE


def _support(end: LineEnd, lower: LineEnd, upper: LineEnd, clamp: float) -> Any:
    """An end as a scene has it: free, or its position and how it turns. clamp: as of `_clamping`."""
    if end.position is None:
        return "free"
    return {"position": end.position} | _rotation(end, lower, upper, clamp)


def _rotation(end: LineEnd, lower: LineEnd, upper: LineEnd, clamp: float) -> dict[str, Any]:
    """Rotation of an end: none for a hinge, stiffness and neutral angle for a flex joint in the riser's plane.

    A clamped end is a very stiff one, as a scene's own clamp has the direction of the initial shape.
    """
    row = end.stiffness
    for key in ("ConnectionAzimuth", "ConnectionDeclination", "ConnectionGamma"):
        end.connection.get(key)  # without effect on a hinge
    if row is None:
        return {}
    size, across = _joint_stiffness(row), row.word("ConnectionyBendingStiffness")
    if size == 0.0:
        return {}
    if math.isinf(size):
        size = clamp
        if size == 0.0:
            return {}
        text = f"clamped: a joint of {size:.4g} kN.m/deg here, {_CLAMPED:g} times EI over the last element's length"
        row.remark("ConnectionxBendingStiffness", text)
    angle = _neutral_angle(end, lower, upper)
    if angle is None:
        end.connection.remark("ConnectionAzimuth", "a joint out of the riser's plane: the end is free to turn here")
        return {}
    if across not in ("", row.word("ConnectionxBendingStiffness")):
        row.remark("ConnectionyBendingStiffness", f"{across} about y: it is that about x here")
    return {"rotation": {"stiffness": math.degrees(size * FORCE), "neutral_angle": angle}}


def _joint_stiffness(row: Item) -> float:
    """About x [kN.m/deg]; of a table of angles and moments the slope from its beginning."""
    key = "ConnectionxBendingStiffness"
    if not is_name(name := row.get(key)):
        return row.stiffness(key, 0.0)
    points = points_of(row, key, name)
    if len(points) < 2:
        return math.nan if not points else row.refuse(key, f"the table {name} needs two rows; correct it")
    (x0, y0), (x1, y1) = points[:2]
    slope, (x, y) = (y1 - y0) / (x1 - x0), points[-1]
    row.remark(key, f"a joint by the table {name}: its slope at {x0:g} deg, {slope:.4g} kN.m/deg, for all angles; "
             f"at {x:g} deg the moment would be {y:g} kN.m")  # fmt: skip
    return slope


def _neutral_angle(end: LineEnd, lower: LineEnd, upper: LineEnd) -> float | None:
    """Angle of the line, followed upwards, from the vertical [deg], positive towards the upper end; None out of the
    ends' plane.

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


def _remark_on_torsion(item: Item, data: dict[str, Any]) -> None:
    """A line without torsion bears a torque here if both ends keep it from spinning, in three dimensions."""
    clamped = [key for key in ("start", "end") if "rotation" in data[key]]
    if len(clamped) == 2 and item.choice("IncludeTorsion", "No") == "no":
        text = "both flex joints keep the line from spinning here, so that its GJ bears torque in three dimensions"
        item.remark("IncludeTorsion", f"IncludeTorsion No: {text}")
    item.get("IncludeTorsion")
