"""Consistency checks of the stages and their prescribed motions with the rest of a scene."""

import math
from collections.abc import Iterator

from riser_soil.core.quantities import Vector
from riser_soil.scene.bathymetry import ground_height
from riser_soil.scene.columns import COUNT, LEAST_ROWS
from riser_soil.scene.motions import EndMotion, Table, Vessel, VesselHistory
from riser_soil.scene.problem import Path, Problem
from riser_soil.scene.riser import End, Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Load, MidpointScheme, StaticStage, TimedStage
from riser_soil.scene.vectors import cross, minus, plus

GREATEST_STRAIN = 0.1
"""Strain of a riser pulled straight beyond which a new position must be a mistake."""
DEEPEST = 1.5
"""Diameters that an axis may sink into soil."""
# Part of the way to a place within which its coordinates would do as a displacement, and part of the riser's length
# that such a way has at least.
_SHORT, _FAR = 0.2, 0.25
# What round-off may leave of a displacement [m] or an angle [rad] where the motion is to begin at its middle.
_AT_ZERO = 1e-9
# Part of the stage's duration by which its last step may miss its end.
_LATE = 1e-9


def stage_conflicts(scene: Scene) -> Iterator[Problem]:
    """Conflicts of the stages with each other and with riser and solver."""
    yield from _different_names(scene)
    for n, stage in enumerate(scene.stages):
        for m, load in enumerate(stage.loads):
            yield from _load_on_riser(scene, ("stages", n, "loads", m), load)
            yield from _moment_on_chain(scene, ("stages", n, "loads", m), load)
        if stage.pressure is not None and scene.line.contents is None:
            remedy = "add riser.contents: {density: ...}, or leave it out"
            yield Problem(("stages", n, "pressure"), "is that of the contents, and the riser is empty", remedy)
        if isinstance(stage, DynamicStage):
            yield from _dynamic(scene, n, stage)
        else:
            yield from _at_rest(scene, n)
        if isinstance(stage, StaticStage):
            yield from _moves(scene, n, stage)
        else:
            yield from _motions(scene, n, stage)
    yield from _moves_to_the_ground(scene)
    yield from _reachable_moves(scene)


def _different_names(scene: Scene) -> Iterator[Problem]:
    seen: set[str] = set()
    for n, stage in enumerate(scene.stages):
        if stage.name in seen:
            yield Problem(("stages", n, "name"), "another stage has the same name", "rename one of the two")
        seen.add(stage.name)


def _load_on_riser(scene: Scene, path: Path, load: Load) -> Iterator[Problem]:
    if not isinstance(load.at, float):
        return
    length = scene.line.length
    if load.at > length * (1.0 + 1e-9):
        yield Problem(
            (*path, "at"), f"must not exceed the riser's length ({length:.6g} m)", "correct the arc length"
        )
    elif scene.accuracy is not None:
        return  # a node is put there
    elif load.moment is not None and abs((near := _nearest_node(scene, load.at)) - load.at) > 1e-6 * length:
        allowed = f"a moment must act at a node; the nearest is at {near:.6g} m"
        yield Problem((*path, "at"), allowed, "move the moment there or change the elements")


def _moment_on_chain(scene: Scene, path: Path, load: Load) -> Iterator[Problem]:
    """A moment where all that is beside it has no bending stiffness."""
    if load.moment is None or load.at is None:
        return
    length, first = scene.line.length, 0.0
    at = {"start": 0.0, "end": length}[load.at] if isinstance(load.at, str) else load.at
    beside = list[str]()
    for segment in scene.line.segments:
        if first - 1e-9 * length <= at <= first + segment.length + 1e-9 * length:
            beside.append(segment.line_type)
        first += segment.length
    if beside and not any(max(scene.line_types[name].bending_stiffness) for name in beside):
        allowed = f"line type {beside[0]} has no bending stiffness (EI: 0) and bears no moment"
        yield Problem((*path, "moment"), allowed, "leave the moment out, or give a bending stiffness")


def _nearest_node(scene: Scene, arc: float) -> float:
    return min(scene.line.node_arcs, key=lambda node: abs(node - arc))


def _at_rest(scene: Scene, n: int) -> Iterator[Problem]:
    """Problems that keep a riser from having an equilibrium."""
    if scene.line.is_tied:
        return
    if scene.line.start == scene.line.end == "free":
        remedy = "give an end a position, or make the stage dynamic"
        yield Problem(("stages", n), "a riser with two free ends has no equilibrium", remedy)
    elif _swings_freely(scene):
        remedy = "set rotation: fixed or a stiffness, give the other end a position, or let gravity act"
        yield Problem(
            ("stages", n), "with one freely rotating support and without gravity, it has no equilibrium", remedy
        )


def moves_of(scene: Scene) -> Iterator[tuple[Path, Vector, Vector]]:
    """Paths of the new places of a line's ends, where the end was at first or last moved to, and the place [m]."""
    ends = {"start": scene.line.start, "end": scene.line.end}
    places = {key: end.position for key, end in ends.items() if isinstance(end, Support)}
    for n, stage in enumerate(scene.stages):
        for key in places:
            target = getattr(stage.move, key, None) if isinstance(stage, StaticStage) else None
            if target is not None:
                yield ("stages", n, "move", key), places[key], target
                places[key] = target


def meant_as_displacement(scene: Scene, name: str, before: Vector, place: Vector) -> str:
    """Remedy where a new place of a line's end was probably meant as a displacement; empty where it was not."""
    way = minus(place, before)
    for by in (place, (place[0], place[1], way[2])):
        height = 1.0 if by is place else 0.0
        given, apart = (math.hypot(x, y, height * z) for x, y, z in (place, way))
        if apart > _FAR * scene.line.length and 0.0 < given < _SHORT * apart:
            end = getattr(scene.line, name)
            layback = isinstance(end, Support) and end.hang_off is not None and end.hang_off.by == "layback"
            write = f"give vessel: {{offset: {_written(by)}}}" if layback else f"write {_written(plus(before, by))}"
            return f"move gives the place that an end goes to, not a displacement: to move it by {_written(by)} {write}"
    return ""


def _written(place: Vector) -> str:
    return "[" + ", ".join(f"{x:.6g}" for x in place) + "]"


def _moves(scene: Scene, n: int, stage: StaticStage) -> Iterator[Problem]:
    """New places of ends that can't be moved, or that lie below the ground."""
    ends = {"start": scene.line.start, "end": scene.line.end}
    if stage.move:
        given = [key for key in ends if getattr(stage.move, key) is not None]
        yield from _prescribed(ends, {("stages", n, "move", key): key for key in given})


def _moves_to_the_ground(scene: Scene) -> Iterator[Problem]:
    for path, before, target in moves_of(scene) if scene.contact else ():
        lowest = _lowest(scene, target)
        meant = meant_as_displacement(scene, str(path[-1]), before, target)
        resting = lowest + (0.5 * scene.largest_diameter if scene.contact_at == "outer" else 0.0)
        if target[2] < lowest:
            allowed = f"must not lie below {_of_ground(scene)} (z = {lowest:g} m)"
            yield Problem(path, allowed, meant or "move the end to a higher place")
        elif meant and target[2] <= resting and before[2] - resting > _SHORT * scene.line.length:
            yield Problem(path, f"brings the {path[-1]} from z = {before[2]:g} m down to {_of_ground(scene)}", meant)


def _lowest(scene: Scene, target: Vector) -> float:
    """Height [m] below which an end's axis can't go: that of the ground, or within soil that moves aside."""
    return ground_height(scene, target) - (DEEPEST * scene.largest_diameter if scene.soil_moves else 0.0)


def _of_ground(scene: Scene) -> str:
    return f"{DEEPEST:g} diameters below the seabed" if scene.soil_moves else "the seabed"


def _swings_freely(scene: Scene) -> bool:
    prescribed = [end for end in (scene.line.start, scene.line.end) if isinstance(end, Support)]
    return scene.gravity == 0.0 and len(prescribed) == 1 and prescribed[0].rotation == "free"


def _motions(scene: Scene, n: int, stage: TimedStage) -> Iterator[Problem]:
    if stage.motion:
        ends = {"start": scene.line.start, "end": scene.line.end}
        yield from _prescribed(ends, {("stages", n, "motion", key): key for key in stage.motion.by_end})
        for key, motion in stage.motion.by_end.items():
            yield from motion_conflicts(scene, ("stages", n, "motion", key), motion, stage)


def _dynamic(scene: Scene, n: int, stage: DynamicStage) -> Iterator[Problem]:
    yield from _midpoint(scene, n, stage)
    key = "duration" if stage.time_step == "auto" else "time_step"
    smallest = scene.solver.min_time_step
    if smallest != "auto" and smallest > getattr(stage, key):
        allowed = f"must not be smaller than solver.min_time_step ({smallest:g} s)"
        yield Problem(
            ("stages", n, key), allowed, f"lower solver.min_time_step or take a longer {key}"
        )


def _midpoint(scene: Scene, n: int, stage: DynamicStage) -> Iterator[Problem]:
    """Limits of the midpoint rule, which has no forces or rotations at the end of a step only."""
    if not isinstance(stage.scheme, MidpointScheme):
        return
    path, remedy = ("stages", n, "scheme"), "choose another scheme"
    if scene.contact:
        yield Problem(path, "the midpoint rule would make energy out of contact", remedy)
    if scene.line.inner_flow is not None:
        yield Problem(path, "the midpoint rule has no contents that flow or are uneven", remedy)
    for key, motion in stage.motion.by_end.items() if stage.motion else ():
        end = getattr(scene.line, key)
        if isinstance(end, Support) and end.rotation == "fixed" and motion.turns:
            yield Problem(path, f"the midpoint rule can't turn a fixed end, and the riser's {key} turns", remedy)


def _prescribed(ends: dict[str, End], places: dict[Path, str]) -> Iterator[Problem]:
    """Only ends with a prescribed position can be moved."""
    for path, key in places.items():
        if ends[key] == "free":
            remedy = f"give riser.{key} a position, or leave this out"
            yield Problem(path, f"riser.{key} is free and can't be moved", remedy)


def _reachable_moves(scene: Scene) -> Iterator[Problem]:
    """The ends' positions stage by stage, against the riser's length."""
    start, end = scene.line.start, scene.line.end
    if not isinstance(start, Support) or not isinstance(end, Support):
        return
    places, length = {"start": start.position, "end": end.position}, scene.line.length
    moves = [*moves_of(scene)]
    for n in range(len(scene.stages)):
        moved = [(str(path[-1]), before, place) for path, before, place in moves if path[1] == n]
        places |= {name: place for name, _, place in moved}
        apart = math.dist(places["start"], places["end"])
        if moved and apart > (1.0 + GREATEST_STRAIN) * length:
            allowed = f"pulls the ends {apart:.6g} m apart, but the riser is only {length:.6g} m long"
            meant = next(filter(None, (meant_as_displacement(scene, *each) for each in moved)), "")
            yield Problem(("stages", n, "move"), allowed, meant or "bring the ends together or lengthen the segments")


def motion_conflicts(scene: Scene, path: Path, motion: EndMotion, stage: TimedStage) -> Iterator[Problem]:
    """Conflicts of the motion at a path with the scene and with its stage."""
    yield from _jumps(path, motion)
    if motion.table:
        yield from _table((*path, "table"), motion.table, stage)
    if motion.vessel_history:
        yield from _table((*path, "vessel_history", "file"), motion.vessel_history, stage)
    if motion.vessel:
        yield from _vessel(scene, (*path, "vessel"), motion.vessel, stage)
    end = scene.line.start if path[-1] == "start" else scene.line.end
    if motion.rotation and isinstance(end, Support) and end.rotation == "free":
        allowed = f"riser.{path[-1]}.rotation is free, so that nothing turns with the support"
        yield Problem((*path, "rotation"), allowed, "set it to fixed or a stiffness, or leave this out")
    if motion.arc and isinstance(end, Support) and not any(cross(motion.arc.axis, minus(end.position, motion.arc.hub))):
        yield Problem((*path, "arc", "hub"), f"the {path[-1]} lies at its hub and can't turn about it", "move the hub")


def _vessel(scene: Scene, path: Path, vessel: Vessel, stage: TimedStage) -> Iterator[Problem]:
    waves = scene.water.waves if scene.water else None
    if not isinstance(stage, DynamicStage):
        remedy = "give its motions as vessel_history, or make the stage dynamic"
        yield Problem(path, f"a vessel answers waves, and a {stage.kind} stage has none", remedy)
        return
    if waves is None:
        yield Problem(path, "a vessel moves in waves, and the scene has none", "add water.waves, or leave this out")
        return
    if waves.ramp == 0.0 and vessel.ramp is None:
        allowed = f"without a ramp, as the waves have none, the {path[3]} would jump as the stage begins"
        yield Problem((*path, "ramp"), allowed, "give a ramp [s]")
    for toward in waves.toward:
        relative = math.degrees(toward) - vessel.heading_deg
        gap = vessel.table.gap(math.radians(relative))
        if gap is None:
            continue
        first, last = (f"{math.degrees(direction):.6g}" for direction in gap)
        angle = f"{relative % 360.0:.6g} deg to the heading"
        allowed = f"waves run at {angle}, but the table's nearest directions are {first} and {last} deg"
        yield Problem((*path, "rao"), allowed, "add rows for directions at most 45 deg apart")
        return


def _jumps(path: Path, motion: EndMotion) -> Iterator[Problem]:
    """Without a ramp a motion must begin at its middle."""
    if motion.harmonic and not motion.harmonic.ramp:
        h = motion.harmonic
        jump = math.hypot(*(a * math.sin(phase) for a, phase in zip(h.amplitude, h.phases, strict=True)))
        if jump > _AT_ZERO * math.hypot(*h.amplitude):
            yield _jump((*path, "harmonic", "phase_deg"), f"{jump:.4g} m")
    for key, swing in {"arc": motion.arc, "rotation": motion.rotation}.items():
        if swing and not swing.ramp:
            angle = abs(swing.amplitude_deg * math.sin(math.radians(swing.phase_deg)))
            if angle > _AT_ZERO * abs(swing.amplitude_deg):
                yield _jump((*path, key, "phase_deg"), f"{angle:.4g} deg")


def _table(path: Path, table: Table | VesselHistory, stage: TimedStage) -> Iterator[Problem]:
    """Times count from the stage's beginning, to its end."""
    time, unit = table.columns.values["t"], table.columns.units["t"]
    if isinstance(stage, DynamicStage) and (wrong := [*_no_time_history(path, table)]):
        yield from wrong
    elif time[0] != 0.0 or time[-1] < stage.duration * (1.0 - _LATE):
        t = "" if unit == COUNT else " s"
        covers, lasts = f"covers {time[0]:g} to {time[-1]:g}{t}", f"lasts from 0 to {stage.duration:g}{t}"
        remedy = f"begin the table at 0{t}, the stage's beginning, and let it last to its end"
        yield Problem(path, f"{table.file} {covers}, but the stage {lasts}", remedy)
    elif not table.ramp:
        yield from _table_jumps(path, table)


def _no_time_history(path: Path, table: Table | VesselHistory) -> Iterator[Problem]:
    """What a dynamic stage, which joins the rows by cubic splines in time, asks for beyond a quasi-static one."""
    rows, unit = table.columns.rows, table.columns.units["t"]
    if rows < LEAST_ROWS:
        allowed = f"{table.file}: a table of {rows} rows; cubic splines need at least {LEAST_ROWS}"
        yield Problem(path, allowed, "add rows, or make the stage quasi-static")
    if unit == COUNT:
        allowed = f"{table.file}:{table.columns.header}: t counts [{COUNT}], and a dynamic stage goes by time"
        yield Problem(path, allowed, "give t [s], or make the stage quasi-static")


def _table_jumps(path: Path, table: Table | VesselHistory) -> Iterator[Problem]:
    x, angle = math.hypot(*table.displacements[0]), math.degrees(math.hypot(*table.rotations[0]))
    if x > _AT_ZERO or angle > _AT_ZERO:
        how_far = f"{x:.4g} m" if x > _AT_ZERO else f"{angle:.4g} deg"
        allowed = f"{table.file}:{table.columns.lines[0]}: {_jump(path, how_far).allowed}"
        yield Problem(path, allowed, "give a ramp [s] beside the file, or a first row of zeros")


def _jump(path: Path, how_far: str) -> Problem:
    allowed = f"without a ramp the {path[3]} would jump by {how_far} as the stage begins"
    return Problem(path, allowed, "give a ramp [s], or phase_deg: 0")
