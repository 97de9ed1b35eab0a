"""The vertical plane of a two-dimensional scene, and what leaves it; the ends of the riser's initial shape."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, assert_never

from riser_soil.core.quantities import Vector
from riser_soil.scene.motions import ArcMotion, Harmonic, MotionKind, Rotation, Table, Vessel, VesselHistory
from riser_soil.scene.problem import Path
from riser_soil.scene.rao import ROTATIONS, TRANSLATIONS
from riser_soil.scene.riser import Riser, Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.shapes import ArcShape, CircularArc, PointsShape
from riser_soil.scene.stages import StaticStage
from riser_soil.scene.vectors import cross, dot, minus, plus, times
from riser_soil.scene.wave_kinds import GivenSpectrum

# Relative distance from the plane that round-off may leave.
_FLAT = 1e-9
# Part of the largest value in a table under which a value is no motion.
_NEGLIGIBLE = 1e-9
_ORIGIN = (0.0, 0.0, 0.0)
_ALONG_X = (1.0, 0.0, 0.0)


@dataclass(frozen=True)
class VerticalPlane:
    """A vertical plane: a point of it [m], its horizontal unit direction from start to end, the riser's length [m]."""

    origin: Vector
    direction: Vector
    length: float

    @property
    def normal(self) -> Vector:
        """Horizontal unit vector across the plane."""
        return (-self.direction[1], self.direction[0], 0.0)

    def offset(self, vector: Vector) -> float:
        """Component of a vector across the plane."""
        return dot(self.normal, vector)

    def holds_point(self, point: Vector) -> bool:
        arm = minus(point, self.origin)
        return abs(self.offset(arm)) <= _FLAT * max(self.length, math.hypot(*arm))

    def holds_vector(self, vector: Vector) -> bool:
        return abs(self.offset(vector)) <= _FLAT * math.hypot(*vector)

    def holds_axis(self, axis: Vector) -> bool:
        """Whether a rotation or moment about the axis stays in the plane."""
        along = self.offset(axis)
        across = minus(axis, (along * self.normal[0], along * self.normal[1], 0.0))
        return math.hypot(*across) <= _FLAT * math.hypot(*axis)


def vertical_plane(scene: Scene) -> VerticalPlane:
    """The plane through the riser's start and end; along x when they give no direction."""
    points = _ends(scene)
    return VerticalPlane(points[0], _direction(points), scene.line.length)


def resolved_dimension(scene: Scene) -> Literal[2, 3]:
    """2 when the scene says so, or says auto and nothing leaves the vertical plane; else 3, as over a grid of heights,
    which may slope across.
    """
    if scene.dimension != "auto":
        return scene.dimension
    over_a_grid = scene.seabed is not None and scene.seabed.grid is not None
    return 3 if over_a_grid or any(leaving_the_plane(scene)) else 2


def leaving_the_plane(scene: Scene, plane: VerticalPlane | None = None) -> Iterator[Path]:
    """Paths of the values that lead out of a vertical plane, by default the riser's; vortices do wherever the water
    flows.
    """
    plane = plane or vertical_plane(scene)
    yield from (path for path, point in positions(scene) if not plane.holds_point(point))
    yield from (path for path, vector in _vectors(scene) if not plane.holds_vector(vector))
    yield from (path for path, axis in _axes(scene) if not plane.holds_axis(axis))
    if scene.has_dynamic_stage:
        yield from (("line_types", name, "vortex_force") for name, t in scene.used_line_types.items() if t.sheds)


def _ends(scene: Scene) -> tuple[Vector, ...]:
    """Points that fix the plane: the prescribed ends, or those of the unstressed shape."""
    riser = scene.line
    prescribed = tuple(end.position for end in (riser.start, riser.end) if isinstance(end, Support))
    if len(prescribed) == 2:
        return prescribed
    if isinstance(riser.unstressed, PointsShape):
        return riser.unstressed.points
    if isinstance(riser.unstressed, ArcShape):
        arc = riser.unstressed.arc
        return arc.from_point, plus(arc.from_point, cross(arc.axis, (0.0, 0.0, 1.0)))
    return prescribed or ((0.0, 0.0, 0.0),)


def _direction(points: tuple[Vector, ...]) -> Vector:
    chord = minus(points[-1], points[0])
    span = math.hypot(chord[0], chord[1])
    if span <= _FLAT * math.hypot(*chord) or span == 0.0:
        return (1.0, 0.0, 0.0)
    return (chord[0] / span, chord[1] / span, 0.0)


def positions(scene: Scene) -> Iterator[tuple[Path, Vector]]:
    """Positions of the riser in the scene, but for those of joints."""
    riser = scene.line
    for key, end in {"start": riser.start, "end": riser.end}.items():
        if isinstance(end, Support) and not end.jointed:
            yield ("riser", key, "position"), end.position
    for key, shape in {"unstressed": riser.unstressed, "initial": riser.initial}.items():
        if isinstance(shape, PointsShape):
            yield from ((("riser", key, "points", n), point) for n, point in enumerate(shape.points))
    if isinstance(riser.unstressed, ArcShape):
        yield ("riser", "unstressed", "arc", "from"), riser.unstressed.arc.from_point
    for n, stage in enumerate(scene.stages):
        if isinstance(stage, StaticStage) and stage.move:
            targets = {"start": stage.move.start, "end": stage.move.end}
            yield from ((("stages", n, "move", key), p) for key, p in targets.items() if p is not None)


def _vectors(scene: Scene) -> Iterator[tuple[Path, Vector]]:
    """Forces, displacements, currents and directions of waves in the scene."""
    yield from _flows(scene)
    for n, stage in enumerate(scene.stages):
        for m, load in enumerate(stage.loads):
            given = {"force": load.force, "distributed": load.distributed}
            yield from ((("stages", n, "loads", m, key), v) for key, v in given.items() if v is not None)
    yield from displacements(scene)


def _flows(scene: Scene) -> Iterator[tuple[Path, Vector]]:
    """Directions of current and waves."""
    current = scene.water.current if scene.water else None
    for path, profile in current.each if current else ():
        yield from ((("water", "current", *path, n), (ux, uy, 0.0)) for n, (_, ux, uy) in enumerate(profile))
    waves = scene.water.waves if scene.water else None
    if waves:
        for path, train in waves.each:
            key = "direction_deg" if len(train.toward) == 1 else "spreading"
            if isinstance(train, GivenSpectrum) and train.table.toward:
                key = "file"
            for angle in train.toward:
                yield ("water", "waves", *path, key), (math.cos(angle), math.sin(angle), 0.0)


def _axes(scene: Scene) -> Iterator[tuple[Path, Vector]]:
    """Moments and axes of rotation in the scene."""
    for n, stage in enumerate(scene.stages):
        for m, load in enumerate(stage.loads):
            if load.moment is not None:
                yield ("stages", n, "loads", m, "moment"), load.moment
    yield from rotation_axes(scene)
    if isinstance(scene.line.unstressed, ArcShape):
        yield ("riser", "unstressed", "arc", "axis"), scene.line.unstressed.arc.axis


def displacements(scene: Scene) -> Iterator[tuple[Path, Vector]]:
    """Vectors along which motions displace the ends."""
    for path, way in _ways(scene):
        match way:
            case Harmonic(amplitude=a, phases=p):
                for part in (math.cos, math.sin):
                    yield (*path, "amplitude"), (a[0] * part(p[0]), a[1] * part(p[1]), a[2] * part(p[2]))
            case Table():
                yield from ((path, row) for row in _felt(way.displacements))
            case Vessel():
                yield from _modes(scene, path, way, TRANSLATIONS)
            case VesselHistory():
                yield from (((*path, "file"), way.axes(mode)) for mode in TRANSLATIONS if mode in way.moving)
            case ArcMotion() | Rotation():  # their axes tell
                pass
            case _:
                assert_never(way)


def rotation_axes(scene: Scene) -> Iterator[tuple[Path, Vector]]:
    """Axes about which motions turn the ends or their supports."""
    for path, way in _ways(scene):
        match way:
            case ArcMotion():
                yield (*path, "plane"), way.axis
            case Rotation():
                yield (*path, "axis"), way.axis
            case Table():
                yield from ((path, row) for row in _felt(way.rotations))
            case Vessel():
                yield from _modes(scene, path, way, ROTATIONS)
            case VesselHistory():
                yield from (((*path, "file"), way.axes(mode)) for mode in ROTATIONS if mode in way.moving)
            case Harmonic():
                pass
            case _:
                assert_never(way)


def _ways(scene: Scene) -> Iterator[tuple[Path, MotionKind]]:
    """All motions of the ends, stage by stage."""
    for n, stage in enumerate(scene.stages):
        if not isinstance(stage, StaticStage) and stage.motion:
            for end, motion in stage.motion.by_end.items():
                yield from ((("stages", n, "motion", end, key), way) for key, way in motion.ways.items())


def _modes(scene: Scene, path: Path, vessel: Vessel, among: tuple[str, ...]) -> Iterator[tuple[Path, Vector]]:
    """Modes in which a vessel responds to the scene's waves."""
    waves = scene.water.waves if scene.water else None
    if waves:
        heading = math.radians(vessel.heading_deg)
        moving = {mode for toward in waves.toward for mode in vessel.table.moving(toward - heading)}
        yield from (((*path, "rao"), vessel.axes(mode)) for mode in among if mode in moving)


def _felt(rows: list[Vector]) -> Iterator[Vector]:
    """The rows' values but for what round-off leaves in a file."""
    least = _NEGLIGIBLE * max(abs(value) for row in rows for value in row)
    for x, y, z in dict.fromkeys(rows):
        yield x * (abs(x) > least), y * (abs(y) > least), z * (abs(z) > least)


def initial_ends(riser: Riser) -> tuple[Vector, Vector]:
    """Start and end of the initial shape [m]; they must lie at the prescribed positions of the ends."""
    start, end = (e.position if isinstance(e, Support) else None for e in (riser.start, riser.end))
    if isinstance(riser.initial, PointsShape):
        return riser.initial.points[0], riser.initial.points[-1]
    if riser.initial != "unstressed" and start is not None and end is not None:
        return start, end
    if riser.initial == "unstressed" and isinstance(riser.unstressed, PointsShape):
        return riser.unstressed.points[0], riser.unstressed.points[-1]
    if riser.initial == "unstressed" and isinstance(riser.unstressed, ArcShape):
        return riser.unstressed.arc.from_point, _far_end(riser.unstressed.arc)
    return _straight(start, end, riser.length)


def _straight(start: Vector | None, end: Vector | None, length: float) -> tuple[Vector, Vector]:
    """A straight unstressed riser: from start towards end; along +x when an end is free."""
    first = start or _ORIGIN
    chord = minus(end, first) if start and end else _ALONG_X
    distance = math.hypot(*chord)
    direction = times(1.0 / distance, chord) if distance > 0.0 else _ALONG_X
    return first, plus(first, times(length, direction))


def _far_end(arc: CircularArc) -> Vector:
    """The arc's last point, by Rodrigues' formula."""
    axis = times(1.0 / math.hypot(*arc.axis), arc.axis)
    arm, angle = minus(arc.from_point, arc.centre), math.radians(arc.angle_deg)
    turned = plus(times(math.cos(angle), arm), times(math.sin(angle), cross(axis, arm)))
    return plus(arc.centre, plus(turned, times((1.0 - math.cos(angle)) * dot(axis, arm), axis)))
