"""Assembly of prescribed end motions as functions of time, and the places of the ends, looked up before a solution."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, assert_never

import numpy as np

from riser_soil.assembly.sea import SeaAssembly
from riser_soil.assembly.stage import times_to_hit
from riser_soil.core.arrays import Array, as_list
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End
from riser_soil.scene.motions import ArcMotion, EndMotion, Harmonic, Rotation, Table, Vessel, VesselHistory
from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, QuasiStaticStage, Stage, StaticStage, TimedStage, varying_in
from riser_soil.solve.adaptive_steps import from_last_to_first

if TYPE_CHECKING:
    from riser_soil.assembly.vessels import Vessels

# Times at which a stage is looked at, at least: a prime number of intervals, as whole periods would always find the
# same.
LOOKS = 98
EndPlaces = dict[str, Array]
"""Positions (nt, 3) [m] of an end that is prescribed at the times of a stage, by its name."""
# Instants of a period, and at most of a stage.
PER_PERIOD, MOST_LOOKS = 24, 20000


def vessels_of(scene: Scene, sea: SeaAssembly | None) -> Vessels | None:
    """The vessels that carry ends; None where there are none."""
    given = [stage.motion for stage in scene.stages if not isinstance(stage, StaticStage) and stage.motion is not None]
    if not any(each.vessel for motion in given for each in motion.by_end.values()):
        return None
    from riser_soil.assembly.vessels import Vessels

    assert sea is not None  # the scene's checks have seen to it
    return Vessels(scene, sea)


def set_motions(line: Line, stage: Stage, vessels: Vessels | None, origins: Array) -> None:
    """Give the prescribed ends their motions in a stage, from their places at its start; without one they stay there.

    origins (2, 3): positions of start and end, see `end_positions`.
    """
    for end, name, origin in ((line.start, "start", origins[0]), (line.end, "end", origins[1])):
        set_motion(end, name, origin, stage, vessels)
    line.begin_stage()


def end_positions(line: Line) -> Array:
    """Present positions of start and end, (2, 3) [m], global axes."""
    return np.stack([line.to_global(line.x[node]) for node in (0, -1)])


def set_motion(end: End, name: str, origin: Array, stage: Stage, vessels: Vessels | None) -> None:
    """Give an end that is at origin (3,) its motion in a stage; with vessels, the stages come in their order."""
    end.motion = end.turning = None
    if isinstance(stage, StaticStage):
        target = getattr(stage.move, name, None)
        if target is None:
            return
        from riser_soil.assembly.end_motions import move_to

        move_to(end, origin, np.asarray(target))
        if vessels is not None:
            vessels.move(name, np.asarray(target) - origin)
    elif stage.motion is not None and name in stage.motion.by_end:
        from riser_soil.assembly.end_motions import move_by

        move_by(end, name, origin, stage, stage.motion.by_end[name], vessels)


def end_places(scene: Scene, sea: SeaAssembly | None) -> Iterator[EndPlaces]:
    """Positions of the prescribed ends (nt, 3) [m] at the times of each stage."""
    ends = {name: getattr(scene.line, name) for name in ("start", "end")}
    last = {name: np.array(given.position) for name, given in ends.items() if isinstance(given, Support)}
    end, vessels = End(prescribed=True), vessels_of(scene, sea)
    for stage in scene.stages:
        place = {}
        for name, origin in last.items():
            set_motion(end, name, origin, stage, vessels)
            motion = end.motion
            place[name] = np.array([origin if motion is None else motion(t)[0] for t in instants(scene, stage)])
            if ends[name].tensioner is not None:
                place[name][:, 2] = origin[2]
        last = {name: x[-1] for name, x in place.items()}
        yield place


def instants(scene: Scene, stage: Stage) -> Array:
    """Times [s] of a stage at which its ends are looked up: often in each period, and at the rows of tables."""
    if isinstance(stage, StaticStage):
        return np.array([0.0, 1.0])
    periods = [period for _, period in periods_of(scene, stage)]
    count = PER_PERIOD * stage.duration / min(periods, default=stage.duration)
    even = np.linspace(0.0, stage.duration, int(np.clip(count, LOOKS, MOST_LOOKS)))
    times = np.unique(np.concatenate([even, *_rows(stage)]))
    return np.asarray(times[times <= stage.duration])


def corners(scene: Scene, stage: QuasiStaticStage) -> list[float]:
    """t of a quasi-static stage where an equilibrium is due whatever its steps are, its end the last: rows of tables,
    parts of periods, ends of ramps, bends of load histories, outputs.
    """
    parts = [np.arange(0.0, stage.duration, period / PER_PERIOD) for _, period in periods_of(scene, stage)]
    met = np.concatenate([times_to_hit(scene, stage), *_rows(stage), *parts])
    return from_last_to_first(stage.duration, as_list(met))[::-1]


def cycle_count(scene: Scene, stage: Stage) -> float:
    """Cycles in a stage: periods of what moves, or turns of a table or load history, two to a cycle."""
    if isinstance(stage, StaticStage):
        return 0.0
    periods = (stage.duration / period for _, period in periods_of(scene, stage))
    given = [np.array(table.displacements) for table in _tables(stage)]
    given += [np.array([factor for _, factor in load.history])[:, None] for load in varying_in(stage) if load.history]
    return max([*periods, *(0.5 * float(_turns(values).max()) for values in given)], default=0.0)


def _turns(values: Array) -> Array:
    """Number of times that each column (n, m) turns back."""
    ways = (np.sign(np.diff(column)) for column in values.T)
    return np.array([np.count_nonzero(np.diff(way[way != 0.0])) for way in ways])


def corner_count(scene: Scene, stage: QuasiStaticStage) -> float:
    """About how many `corners` there are, outputs left out."""
    of_periods = {period: PER_PERIOD * stage.duration / period for _, period in periods_of(scene, stage)}
    bends = [np.array([t for t, _ in load.history or ()]) for load in varying_in(stage)]
    given = np.concatenate([np.array([stage.duration]), *_rows(stage), *bends])
    return sum(of_periods.values()) + float(np.count_nonzero(np.unique(given) > 0.0))


def _rows(stage: TimedStage) -> list[Array]:
    """t of the rows of a stage's tables."""
    return [np.array(table.columns.values["t"]) for table in _tables(stage)]


def _tables(stage: TimedStage) -> list[Table | VesselHistory]:
    motions = stage.motion.by_end.values() if stage.motion is not None else ()
    return [table for motion in motions for table in (motion.table, motion.vessel_history) if table is not None]


def periods_of(scene: Scene, stage: TimedStage) -> Iterator[tuple[str, float]]:
    """Periods [s] of what moves in a stage."""
    if isinstance(stage, DynamicStage) and scene.water is not None and scene.water.waves is not None:
        yield "the waves", scene.water.waves.period
    for line, moved in (("", stage.motion), *((f" of {name}", own.motion) for name, own in stage.lines.items())):
        for name, motion in () if moved is None else moved.by_end.items():
            yield from ((f"the {name}{line}'s {key}", period) for key, period in _own_periods(motion))


def _own_periods(motion: EndMotion) -> Iterator[tuple[str, float]]:
    for key, way in motion.ways.items():
        match way:
            case Harmonic() | ArcMotion() | Rotation():
                yield key, way.period
            case Table() | Vessel() | VesselHistory():  # as fast as its file, or as the waves
                pass
            case _:
                assert_never(way)
