"""Assembly of the motion of one end in a stage: moved at rest, by formulas, by tables, or on a vessel."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, assert_never

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.motion.prescribed import (
    AngleOscillation,
    HarmonicMotion,
    RockingSupport,
    SlowMotion,
    SlowTurning,
    SmoothMove,
    SwingingEnd,
)
from riser_soil.riser.line_ends import End, Motion, SupportRotation
from riser_soil.scene.motions import ArcMotion, EndMotion, Harmonic, MotionKind, Rotation, Table, Vessel, VesselHistory
from riser_soil.scene.stages import QuasiStaticStage, TimedStage

if TYPE_CHECKING:
    from riser_soil.assembly.vessels import Vessels


def move_to(end: End, origin: Array, target: Array) -> None:
    """Move an end from origin to target (3,) [m] in a static stage."""
    end.motion = SmoothMove(origin, target)


def move_by(end: End, name: str, origin: Array, stage: TimedStage, given: EndMotion, vessels: Vessels | None) -> None:
    """Move an end that is at origin (3,) [m] as a stage with time begins."""
    for way in given.ways.values():  # rotation last: a table beside it has none of its own
        _set(end, name, origin, stage, way, vessels)
    if isinstance(stage, QuasiStaticStage):  # without rates
        end.motion = SlowMotion(end.motion) if end.motion is not None else None
        end.turning = SlowTurning(end.turning) if end.turning is not None else None


def _set(end: End, name: str, origin: Array, stage: TimedStage, way: MotionKind, vessels: Vessels | None) -> None:
    """One way of moving an end, or of turning it."""
    match way:
        case Harmonic():
            end.motion = _harmonic(origin, way)
        case ArcMotion():
            end.motion = _arc(origin, way)
        case Rotation():
            end.turning = _rocking(way)
        case Table() | VesselHistory() | Vessel():
            from riser_soil.assembly.carried_ends import carry

            carry(end, name, origin, stage, way, vessels)
        case _:
            assert_never(way)


def _harmonic(origin: Array, given: Harmonic) -> Motion:
    return HarmonicMotion(origin, np.array(given.amplitude), given.period, given.ramp, np.array(given.phases))


def _arc(origin: Array, given: ArcMotion) -> Motion:
    swing = AngleOscillation(np.radians(given.amplitude_deg), given.period, given.ramp, np.radians(given.phase_deg))
    return SwingingEnd(origin, np.array(given.hub), np.array(given.axis), swing)


def _rocking(given: Rotation) -> Callable[[float], SupportRotation]:
    swing = AngleOscillation(np.radians(given.amplitude_deg), given.period, given.ramp, np.radians(given.phase_deg))
    return RockingSupport(np.array(given.axis) / np.linalg.norm(given.axis), swing)
