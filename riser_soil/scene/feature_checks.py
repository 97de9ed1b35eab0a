"""Checks of a trench or groove: under the riser, along x or y, within the soil's block."""

from collections.abc import Iterator

from riser_soil.scene.plane import vertical_plane
from riser_soil.scene.problem import Path, Problem
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed_features import Trench
from riser_soil.scene.soil import Block

# Component of the riser's direction in plan across an axis that it may have to run along it.
_ASKEW = 1e-6


def feature_conflicts(scene: Scene) -> Iterator[Problem]:
    """Conflicts of the block's trench or groove with the riser and the block."""
    block = scene.soil.given_block if scene.soil else None
    if block is None or block.feature is None:
        return
    direction = vertical_plane(scene).direction
    axis = int(abs(direction[1]) > abs(direction[0]))
    path: Path = ("soil", "block", "trench" if block.trench else "groove")
    if abs(direction[1 - axis]) > _ASKEW:
        allowed = "lies along x or y, and the riser, seen from above, runs askew to both"
        yield Problem(path, allowed, "turn the scene so that the riser runs along x, or give a mesh file")
    elif _half_width(scene, block) <= 0.0:
        yield Problem(path, "needs the pipe's diameter", "give groove.diameter, or outer_diameter of the line types")
    else:
        yield from _within_the_block(scene, block, path, axis)


def _half_width(scene: Scene, block: Block) -> float:
    if block.trench is not None:
        return block.trench.half_width
    return 0.5 * ((block.groove.diameter if block.groove else None) or scene.largest_diameter)


def _within_the_block(scene: Scene, block: Block, path: Path, axis: int) -> Iterator[Problem]:
    """axis: x (0) or y (1), along which the riser runs."""
    wide, line = _half_width(scene, block), vertical_plane(scene).origin[1 - axis]
    low, high = (block.x, block.y)[1 - axis]
    if not low < line - wide < line + wide < high:
        name = "yx"[axis]
        allowed = f"is {2.0 * wide:.4g} m wide at the seabed about {name} = {line:g} m and leaves the block's {name}"
        yield Problem(path, allowed, "widen the block, or take less")
    along = block.feature.along if isinstance(block.feature, Trench) else None
    first, last = (block.x, block.y)[axis]
    if along is not None and not (along[0] < last and along[1] > first):
        allowed = f"lies beyond the block's {'xy'[axis]}, {first:g} to {last:g} m"
        yield Problem((*path, "along"), allowed, "move either")
