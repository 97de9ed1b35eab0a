"""Plausibility of prescribed motions: velocity jumps, ends too far apart, time steps too long for the periods."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.assembly.motions import LOOKS, end_places, instants, periods_of, set_motion, vessels_of
from riser_soil.assembly.sea import sea_of
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.riser.line_ends import End
from riser_soil.scene.bathymetry import ground_height
from riser_soil.scene.line_checks import path_of_line
from riser_soil.scene.lines import by_line
from riser_soil.scene.problem import dotted
from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.stage_checks import DEEPEST, GREATEST_STRAIN, meant_as_displacement, moves_of
from riser_soil.scene.stages import DynamicStage, StaticStage

# Part of the top speed by which an end's velocity may jump.
JUMP = 0.02
# Longest time step over the shortest period.
LONGEST_STEP = 0.1
# Strain of a riser pulled straight between its ends from which they are too far apart for most pipes.
STRETCHED = 0.01
ROUND_OFF = 1e-9  # of the riser's length: by which an end may lie below where it may be


class EndVelocities(NamedTuple):
    """Velocities of an end as a stage begins and as it ends (3,), and its top speed: [m/s], or [deg/s] of turning."""

    moves: bool
    first: Array
    last: Array
    top: float


STILL = EndVelocities(False, np.zeros(3), np.zeros(3), 0.0)
VelocitiesByEnd = dict[str, EndVelocities]
"""By the unit, m/s and deg/s."""


def motion_warnings(riser: LineAssembly) -> Iterator[str]:
    """Warnings about prescribed motions and time steps, each with its numbers."""
    scene = riser.scene
    for name, support in (("start", scene.line.start), ("end", scene.line.end)):
        if isinstance(support, Support):
            yield from _shocks(riser, name, support)
    yield from _displaced(scene)
    yield from _stretched(riser)
    for n, stage in enumerate(scene.stages):
        if isinstance(stage, DynamicStage):
            yield from _long_steps(scene, f"stages.{n}.time_step", stage)


def farthest_move(riser: LineAssembly) -> float:
    """The largest distance [m] of an end from where it was at first, in all stages."""
    places = riser.end_places
    distances = [np.linalg.norm(x - places[0][name][0], axis=1).max() for place in places for name, x in place.items()]
    return float(max(distances, default=0.0))


def top_speed(riser: LineAssembly) -> float:
    """The largest speed [m/s] of an end in dynamic stages."""
    ends = [(name, getattr(riser.scene.line, name)) for name in ("start", "end")]
    courses = [_courses(riser, name, end) for name, end in ends if isinstance(end, Support)]
    moving = zip(riser.scene.stages, *courses, strict=True)
    speeds = [each["m/s"].top for stage, *course in moving if isinstance(stage, DynamicStage) for each in course]
    return max(speeds, default=0.0)


def refuse_unreachable(scene: Scene) -> None:
    """Raises SceneError where motions take ends farther apart than the lines reach, or below the ground."""
    for name, view in by_line(scene).items():
        for n, (stage, place) in enumerate(zip(view.stages, end_places(view, sea_of(view)), strict=True)):
            if not isinstance(stage, StaticStage) and stage.motion is not None:
                path = dotted(path_of_line(("stages", n, "motion"), name) if name else ("stages", n, "motion"))
                times = instants(view, stage)
                _refuse_deep(view, path, place, times)
                _refuse_far(view, path, place, times)


def _refuse_far(scene: Scene, path: str, place: dict[str, Array], times: Array) -> None:
    fixed = (isinstance(end, Support) and not end.jointed for end in (scene.line.start, scene.line.end))
    if not all(fixed):
        return
    apart, length = np.linalg.norm(place["end"] - place["start"], axis=1), scene.line.length
    at = int(apart.argmax())
    if apart[at] > (1.0 + GREATEST_STRAIN) * length:
        raise SceneError(
            f"{path}: takes the ends {apart[at]:.6g} m apart at {times[at]:.4g} s, but the riser is only {length:.6g} "
            "m long; make the motion smaller, or lengthen the segments; check the units of its amplitude or table"
        )


def _refuse_deep(scene: Scene, path: str, place: dict[str, Array], times: Array) -> None:
    for name, x in place.items() if scene.contact is not None else ():
        at = int(x[:, 2].argmin())
        ground = ground_height(scene, (float(x[at, 0]), float(x[at, 1]), float(x[at, 2])))
        if x[at, 2] < ground - DEEPEST * scene.largest_diameter - ROUND_OFF * scene.line.length:
            raise SceneError(
                f"{path}: takes the {name} to z = {x[at, 2]:.6g} m at {times[at]:.4g} s, below the ground at "
                f"{ground:.6g} m; make the motion smaller; check the units of its amplitude or table"
            )


def _displaced(scene: Scene) -> Iterator[str]:
    """New places that were probably meant as displacements."""
    for path, before, place in moves_of(scene):
        if meant := meant_as_displacement(scene, str(path[-1]), before, place):
            yield f"{dotted(path)}: moves the {path[-1]} by {math.dist(before, place):.6g} m: {meant}"


def _stretched(riser: LineAssembly) -> Iterator[str]:
    """Ends that go farther apart than the riser is long."""
    scene, length = riser.scene, riser.scene.line.length
    for n, (stage, place) in enumerate(zip(scene.stages, riser.end_places, strict=True)):
        moves = stage.move if isinstance(stage, StaticStage) else stage.motion
        if moves is None or len(place) < 2:
            continue
        apart = np.linalg.norm(place["end"] - place["start"], axis=1)
        at = int(apart.argmax())
        strain = float(apart[at]) / length - 1.0
        if strain > STRETCHED:
            when = f" at {instants(scene, stage)[at]:.4g} s" if not isinstance(stage, StaticStage) else ""
            key = "move" if isinstance(stage, StaticStage) else "motion"
            yield (
                f"stages.{n}.{key}: the ends come to be {apart[at]:.6g} m apart{when}, but the riser is only "
                f"{length:.6g} m long: it is stretched by {strain:.2%} and more; lengthen the segments, bring the ends "
                "together or make their motions smaller"
            )


def _shocks(riser: LineAssembly, name: str, support: Support) -> Iterator[str]:
    """Jumps of an end's velocity between stages; a static stage leaves no velocities to go on from."""
    courses = list(_courses(riser, name, support))
    rest: VelocitiesByEnd = {"m/s": STILL, "deg/s": STILL}
    for n, (before, after) in enumerate(pairwise([rest, *courses])):
        if not isinstance(riser.scene.stages[n], DynamicStage):
            continue
        for unit in rest:
            yield from _shock(f"stages.{n}", name, unit, before[unit], after[unit])


def _shock(path: str, name: str, unit: str, before: EndVelocities, after: EndVelocities) -> Iterator[str]:
    jump, top = float(np.linalg.norm(after.first - before.last)), max(before.top, after.top)
    if jump <= JUMP * top:
        return
    if after.moves and not np.linalg.norm(before.last) > JUMP * top:
        yield (
            f"{path}.motion.{name}: the {name} starts at {jump:.3g} {unit} from rest, at once, which sends a shock "
            "through the riser: give the motion a ramp [s]"
        )
    else:
        how = "takes up another motion" if after.moves else "stops dead"
        yield (
            f"{path}: the {name} {how} as the stage begins, its velocity jumping by {jump:.3g} {unit}, which sends a "
            "shock through the riser: let the motion before it come to rest (a table can), or make one stage of the "
            "two; a ramp smooths a motion's beginning only"
        )


def _courses(riser: LineAssembly, name: str, support: Support) -> Iterator[VelocitiesByEnd]:
    """Velocities of an end in each stage."""
    end, position, vessels = End(prescribed=True), np.array(support.position), vessels_of(riser.scene, riser.sea)
    for stage in riser.scene.stages:
        set_motion(end, name, position, stage, vessels)
        yield _course(end, np.linspace(0.0, stage.end, LOOKS), support.rotation != "free")
        position = position if end.motion is None else end.motion(stage.end)[0]


def _course(end: End, times: Array, turns: bool) -> VelocitiesByEnd:
    velocities = None if end.motion is None else np.array([end.motion(t)[1] for t in times])
    spins = None
    if end.turning is not None and turns:
        spins = np.degrees([end.turning(t).angular_velocity for t in times])
    return {"m/s": _end_velocities(velocities), "deg/s": _end_velocities(spins)}


def _end_velocities(velocities: Array | None) -> EndVelocities:
    if velocities is None:
        return STILL
    return EndVelocities(True, velocities[0], velocities[-1], float(np.linalg.norm(velocities, axis=1).max()))


def _long_steps(scene: Scene, path: str, stage: DynamicStage) -> Iterator[str]:
    periods = dict(periods_of(scene, stage))
    if not periods:
        return
    what = min(periods, key=lambda name: periods[name])
    longest = LONGEST_STEP * periods[what]
    if stage.time_step != "auto" and stage.time_step > longest * (1.0 + 1e-9):
        yield (
            f"{path}: steps of {stage.time_step:g} s are long beside the period of {what}, {periods[what]:g} s: take "
            f"at most a tenth of it, {longest:.3g} s"
        )
