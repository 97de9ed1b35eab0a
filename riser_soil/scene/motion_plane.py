"""Plane motion check: vectors and axes of prescribed motions that must lie in the riser's plane or normal to it."""

import math
from collections.abc import Iterator
from typing import assert_never

from riser_soil.core.quantities import Vector
from riser_soil.scene.motions import ArcMotion, Harmonic, MotionKind, Rotation, Table, Vessel, VesselHistory
from riser_soil.scene.problem import Path
from riser_soil.scene.rao import ROTATIONS, TRANSLATIONS
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import StaticStage

# Part of the largest value in a table under which a value is no motion.
_NEGLIGIBLE = 1e-9


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
