"""Consistency checks of prescribed motions with their stage and end."""

import math
from collections.abc import Iterator

from riser_soil.scene.motions import EndMotion, Table, Vessel, VesselHistory
from riser_soil.scene.problem import Path, Problem
from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, TimedStage
from riser_soil.scene.time_history import COUNT, LEAST_ROWS
from riser_soil.scene.vectors import cross, minus

# What round-off may leave of a displacement [m] or an angle [rad] where the motion is to begin at its middle.
_AT_ZERO = 1e-9
# Part of the stage's duration by which its last step may miss its end.
_LATE = 1e-9


def motion_conflicts(scene: Scene, path: Path, motion: EndMotion, stage: TimedStage) -> Iterator[Problem]:
    """Conflicts of the motion at a path with the scene and with its stage."""
    yield from _jumps(path, motion)
    if motion.table:
        yield from _table((*path, "table"), motion.table, stage)
    if motion.vessel_history:
        yield from _table((*path, "vessel_history", "file"), motion.vessel_history, stage)
    if motion.vessel:
        yield from _vessel(scene, (*path, "vessel"), motion.vessel, stage)
    end = scene.riser.start if path[-1] == "start" else scene.riser.end
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

