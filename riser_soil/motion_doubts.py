"""Doubts about prescribed motions and waves in time: ends that start or stop with a shock, steps that are too long."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple, assert_never

import numpy as np

from riser_soil.arrays import Array
from riser_soil.build.motions import set_motion, vessels_of
from riser_soil.riser.ends import End
from riser_soil.scene.motions import Arc, EndMotion, Harmonic, Rotation, Table, Vessel
from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage

# Part of the top speed by which an end's velocity may jump.
JUMP = 0.02
# Times at which speeds are looked up: a prime number of intervals, as whole periods would always find the same.
LOOKS = 98
# Longest time step over the shortest period.
LONGEST_STEP = 0.1


class Course(NamedTuple):
    """Velocities of an end as a stage begins and as it ends (3,), and its top speed: [m/s], or [deg/s] of turning."""

    moves: bool
    first: Array
    last: Array
    top: float


STILL = Course(False, np.zeros(3), np.zeros(3), 0.0)
Courses = dict[str, Course]
"""By the unit, m/s and deg/s."""


def motion_doubts(scene: Scene) -> Iterator[str]:
    """What an engineer would question about motions and time steps, each with its numbers."""
    for name, support in (("start", scene.riser.start), ("end", scene.riser.end)):
        if isinstance(support, Support):
            yield from _shocks(scene, name, support)
    for n, stage in enumerate(scene.stages):
        if isinstance(stage, DynamicStage):
            yield from _long_steps(scene, f"stages.{n}.time_step", stage)


def _shocks(scene: Scene, name: str, support: Support) -> Iterator[str]:
    """Jumps of an end's velocity between stages; a static stage leaves no velocities to go on from."""
    courses = list(_courses(scene, name, support))
    rest: Courses = {"m/s": STILL, "deg/s": STILL}
    for n, (before, after) in enumerate(pairwise([rest, *courses])):
        if not isinstance(scene.stages[n], DynamicStage):
            continue
        for unit in rest:
            yield from _shock(f"stages.{n}", name, unit, before[unit], after[unit])


def _shock(path: str, name: str, unit: str, before: Course, after: Course) -> Iterator[str]:
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


def _courses(scene: Scene, name: str, support: Support) -> Iterator[Courses]:
    """What each stage does with an end."""
    end, position, vessels = End(held=True), np.array(support.position), vessels_of(scene)
    for stage in scene.stages:
        set_motion(end, name, position, stage, vessels)
        duration = stage.duration if isinstance(stage, DynamicStage) else 1.0
        yield _course(end, np.linspace(0.0, duration, LOOKS), support.rotation != "free")
        position = position if end.motion is None else end.motion(duration)[0]


def _course(end: End, times: Array, turns: bool) -> Courses:
    velocities = None if end.motion is None else np.array([end.motion(t)[1] for t in times])
    spins = None
    if end.turning is not None and turns:
        spins = np.degrees([end.turning(t).angular_velocity for t in times])
    return {"m/s": _told(velocities), "deg/s": _told(spins)}


def _told(velocities: Array | None) -> Course:
    if velocities is None:
        return STILL
    return Course(True, velocities[0], velocities[-1], float(np.linalg.norm(velocities, axis=1).max()))


def _long_steps(scene: Scene, path: str, stage: DynamicStage) -> Iterator[str]:
    periods = dict(_periods(scene, stage))
    if not periods:
        return
    what = min(periods, key=lambda name: periods[name])
    longest = LONGEST_STEP * periods[what]
    if stage.time_step != "auto" and stage.time_step > longest * (1.0 + 1e-9):
        yield (
            f"{path}: steps of {stage.time_step:g} s are long beside the period of {what}, {periods[what]:g} s: take "
            f"at most a tenth of it, {longest:.3g} s"
        )


def _periods(scene: Scene, stage: DynamicStage) -> Iterator[tuple[str, float]]:
    """Periods [s] of what moves in a stage."""
    if scene.water is not None and scene.water.waves is not None:
        yield "the waves", scene.water.waves.period
    if stage.motion is not None:
        for name, motion in stage.motion.by_end.items():
            yield from ((f"the {name}'s {key}", period) for key, period in _own_periods(motion))


def _own_periods(motion: EndMotion) -> Iterator[tuple[str, float]]:
    for key, way in motion.ways.items():
        match way:
            case Harmonic() | Arc() | Rotation():
                yield key, way.period
            case Table() | Vessel():  # as fast as its file, or as the waves
                pass
            case _:
                assert_never(way)
