"""Where prescribed motions lead: vectors and axes that must lie in the riser's plane, or across it, to stay in it."""

import math
from collections.abc import Iterator

from riser_soil.scene.motions import EndMotion
from riser_soil.scene.problem import Path
from riser_soil.scene.quantities import Vector
from riser_soil.scene.rao import ROTATIONS, TRANSLATIONS
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage

# Part of the largest value in a table under which a value is no motion.
_NEGLIGIBLE = 1e-9


def displacements(scene: Scene) -> Iterator[tuple[Path, Vector]]:
    """Vectors along which motions displace the ends."""
    for path, motion in _motions(scene):
        if motion.harmonic:
            a, p = motion.harmonic.amplitude, motion.harmonic.phases
            for part in (math.cos, math.sin):
                yield (*path, "harmonic", "amplitude"), (a[0] * part(p[0]), a[1] * part(p[1]), a[2] * part(p[2]))
        if motion.table:
            yield from (((*path, "table"), row) for row in _felt(motion.table.displacements))
        yield from _modes(scene, path, motion, TRANSLATIONS)


def rotation_axes(scene: Scene) -> Iterator[tuple[Path, Vector]]:
    """Axes about which motions turn the ends or their supports."""
    for path, motion in _motions(scene):
        if motion.arc:
            yield (*path, "arc", "plane"), motion.arc.axis
        if motion.rotation:
            yield (*path, "rotation", "axis"), motion.rotation.axis
        if motion.table:
            yield from (((*path, "table"), row) for row in _felt(motion.table.rotations))
        yield from _modes(scene, path, motion, ROTATIONS)


def _motions(scene: Scene) -> Iterator[tuple[Path, EndMotion]]:
    for n, stage in enumerate(scene.stages):
        if isinstance(stage, DynamicStage) and stage.motion:
            yield from ((("stages", n, "motion", key), motion) for key, motion in stage.motion.by_end.items())


def _modes(scene: Scene, path: Path, motion: EndMotion, among: tuple[str, ...]) -> Iterator[tuple[Path, Vector]]:
    """What a vessel does in the scene's waves."""
    waves = scene.water.waves if scene.water else None
    if motion.vessel and waves:
        moving = motion.vessel.table.moving(math.radians(waves.direction_deg - motion.vessel.heading_deg))
        yield from (((*path, "vessel", "rao"), motion.vessel.axes(mode)) for mode in among if mode in moving)


def _felt(rows: list[Vector]) -> Iterator[Vector]:
    """The rows' values but for what round-off leaves in a file."""
    least = _NEGLIGIBLE * max(abs(value) for row in rows for value in row)
    for x, y, z in dict.fromkeys(rows):
        yield x * (abs(x) > least), y * (abs(y) > least), z * (abs(z) > least)
