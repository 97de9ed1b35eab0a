"""Where prescribed motions lead: vectors and axes that must lie in the riser's plane, or across it, to stay in it."""

import math
from collections.abc import Iterator

from riser_soil.scene.motions import EndMotion
from riser_soil.scene.problem import Path
from riser_soil.scene.quantities import Vector

# Part of the largest value in a table under which a value is no motion.
_NEGLIGIBLE = 1e-9


def displacements(path: Path, motion: EndMotion) -> Iterator[tuple[Path, Vector]]:
    """Vectors along which an end is displaced."""
    if motion.harmonic:
        a, p = motion.harmonic.amplitude, motion.harmonic.phases
        for part in (math.cos, math.sin):
            yield (*path, "harmonic", "amplitude"), (a[0] * part(p[0]), a[1] * part(p[1]), a[2] * part(p[2]))
    if motion.table:
        yield from (((*path, "table"), row) for row in _felt(motion.table.displacements))


def rotation_axes(path: Path, motion: EndMotion) -> Iterator[tuple[Path, Vector]]:
    """Axes about which an end or its support turns."""
    if motion.arc:
        yield (*path, "arc", "plane"), motion.arc.axis
    if motion.rotation:
        yield (*path, "rotation", "axis"), motion.rotation.axis
    if motion.table:
        yield from (((*path, "table"), row) for row in _felt(motion.table.rotations))


def _felt(rows: list[Vector]) -> Iterator[Vector]:
    """The rows' values but for what round-off leaves in a file."""
    least = _NEGLIGIBLE * max(abs(value) for row in rows for value in row)
    for x, y, z in dict.fromkeys(rows):
        yield x * (abs(x) > least), y * (abs(y) > least), z * (abs(z) > least)
