"""Assembly of the motion of an end by a table of six degrees of freedom, or on a vessel."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, assert_never

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.motion.prescribed import TabulatedMotion
from riser_soil.motion.rigid_body import (
    CarriedEnd,
    CarriedFrame,
    CarriedPoint,
    CarriedSupport,
    RigidBody,
    SixDegreeMotion,
)
from riser_soil.riser.line_ends import End
from riser_soil.scene.motions import Table, Vessel, VesselHistory
from riser_soil.scene.rao import TRANSLATIONS
from riser_soil.scene.stages import QuasiStaticStage, TimedStage

if TYPE_CHECKING:
    from riser_soil.assembly.vessels import Vessels


def carry(
    end: End, name: str, origin: Array, stage: TimedStage, way: Table | VesselHistory | Vessel, vessels: Vessels | None
) -> None:
    """Let an end that is at origin (3,) [m] as a stage begins be carried."""
    match way:
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


def _table(given: Table | VesselHistory, stage: TimedStage) -> SixDegreeMotion:
    values = np.hstack([given.displacements, given.rotations])
    straight = isinstance(stage, QuasiStaticStage)
    return TabulatedMotion(np.array(given.columns.values["t"]), values, given.ramp, straight)


def _sail(end: End, origin: Array, given: VesselHistory, stage: TimedStage) -> None:
    """Move an end with a vessel, the end being at origin (3,) as the stage begins."""
    once = lru_cache(maxsize=2)(_table(given, stage))  # a step asks again and again for its beginning and its end
    body = RigidBody(once, np.array([given.axes(mode) for mode in TRANSLATIONS]).T)
    end.motion, end.turning = CarriedPoint(body, origin, np.array(given.reference)), CarriedFrame(body)


def _carry(end: End, origin: Array, six: SixDegreeMotion) -> None:
    once = lru_cache(maxsize=2)(six)  # a step asks again and again for its beginning and its end
    end.motion, end.turning = CarriedEnd(origin, once), CarriedSupport(once)
