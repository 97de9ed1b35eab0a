"""Assembly of the prescribed end motions of a stage as functions of time."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING, assert_never

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.quantities import Vector
from riser_soil.riser.ends import End, Motion, SupportRotation
from riser_soil.riser.line import Line
from riser_soil.scene.motions import ArcMotion, Harmonic, MotionKind, Rotation, Table, Vessel, VesselHistory
from riser_soil.scene.rao import TRANSLATIONS
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import QuasiStaticStage, Stage, StaticStage

if TYPE_CHECKING:
    from riser_soil.assembly.vessels import Vessels
    from riser_soil.motion.carried import SixDegreeMotion


def vessels_of(scene: Scene) -> Vessels | None:
    """The vessels that carry ends; None where there are none."""
    given = [stage.motion for stage in scene.stages if not isinstance(stage, StaticStage) and stage.motion is not None]
    if not any(each.vessel for motion in given for each in motion.by_end.values()):
        return None
    from riser_soil.assembly.vessels import Vessels

    return Vessels(scene)


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
        _move(end, origin, target)
        if target is not None and vessels is not None:
            vessels.move(name, np.asarray(target) - origin)
    elif stage.motion is not None and name in stage.motion.by_end:
        for way in stage.motion.by_end[name].ways.values():  # rotation last: a table beside it has none of its own
            _set(end, name, origin, stage, way, vessels)
        if isinstance(stage, QuasiStaticStage):
            _slow(end)


def _move(end: End, origin: Array, target: Vector | None) -> None:
    if target is not None:
        from riser_soil.motion.move import SmoothMove

        end.motion = SmoothMove(origin, np.asarray(target))


def _slow(end: End) -> None:
    """Without rates."""
    from riser_soil.motion.slow import SlowMotion, SlowTurning

    end.motion = SlowMotion(end.motion) if end.motion is not None else None
    end.turning = SlowTurning(end.turning) if end.turning is not None else None


def _set(end: End, name: str, origin: Array, stage: Stage, way: MotionKind, vessels: Vessels | None) -> None:
    """One way of moving an end, or of turning it."""
    match way:
        case Harmonic():
            end.motion = _harmonic(origin, way)
        case ArcMotion():
            end.motion = _arc(origin, way)
        case Rotation():
            end.turning = _rocking(way)
        case Table():
            _carry(end, origin, _table(way, stage))
        case VesselHistory():
            _sail(end, origin, way, stage)
        case Vessel():
            assert vessels is not None
            vessel = vessels.motion(stage, name, origin)
            _carry(end, vessel.attachment.mean, vessel)
        case _:
            assert_never(way)


def _harmonic(origin: Array, given: Harmonic) -> Motion:
    from riser_soil.motion.harmonic import HarmonicMotion

    return HarmonicMotion(origin, np.array(given.amplitude), given.period, given.ramp, np.array(given.phases))


def _arc(origin: Array, given: ArcMotion) -> Motion:
    from riser_soil.motion.swing import AngleOscillation, SwingingEnd

    swing = AngleOscillation(np.radians(given.amplitude_deg), given.period, given.ramp, np.radians(given.phase_deg))
    return SwingingEnd(origin, np.array(given.hub), np.array(given.axis), swing)


def _rocking(given: Rotation) -> Callable[[float], SupportRotation]:
    from riser_soil.motion.swing import AngleOscillation, RockingSupport

    swing = AngleOscillation(np.radians(given.amplitude_deg), given.period, given.ramp, np.radians(given.phase_deg))
    return RockingSupport(np.array(given.axis) / np.linalg.norm(given.axis), swing)


def _table(given: Table | VesselHistory, stage: Stage) -> SixDegreeMotion:
    from riser_soil.motion.table import TabulatedMotion

    values = np.hstack([given.displacements, given.rotations])
    straight = isinstance(stage, QuasiStaticStage)
    return TabulatedMotion(np.array(given.columns.values["t"]), values, given.ramp, straight)


def _sail(end: End, origin: Array, given: VesselHistory, stage: Stage) -> None:
    """With a vessel at which the end is at origin (3,) as the stage begins."""
    from riser_soil.motion.rigid_body import CarriedFrame, CarriedPoint, RigidBody

    once = lru_cache(maxsize=2)(_table(given, stage))  # a step asks again and again for its beginning and its end
    body = RigidBody(once, np.array([given.axes(mode) for mode in TRANSLATIONS]).T)
    end.motion, end.turning = CarriedPoint(body, origin, np.array(given.reference)), CarriedFrame(body)


def _carry(end: End, origin: Array, six: SixDegreeMotion) -> None:
    from riser_soil.motion.carried import CarriedEnd, CarriedSupport

    once = lru_cache(maxsize=2)(six)  # a step asks again and again for its beginning and its end
    end.motion, end.turning = CarriedEnd(origin, once), CarriedSupport(once)
