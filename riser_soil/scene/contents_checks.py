"""Consistency checks of the contents with the riser that they are in."""

from collections.abc import Iterator
from itertools import pairwise

from riser_soil.scene.problem import Path, Problem
from riser_soil.scene.riser import Contents
from riser_soil.scene.scene import Scene

_PATH: Path = ("riser", "contents")


def contents_conflicts(scene: Scene) -> Iterator[Problem]:
    """Conflicts of the contents with the line types, and of slugs with each other."""
    given = scene.riser.contents
    if given is None:
        return
    bores = {line.inner_diameter for line in scene.used_line_types.values()}
    if not any(bores):
        remedy = "give inner_diameter in line_types, or leave out contents"
        yield Problem(_PATH, "no line type of the riser has room for contents", remedy)
    elif given.uneven_or_moving and len(bores) > 1:
        sizes = ", ".join(f"{bore:g}" for bore in sorted(bores))
        allowed = f"flow and slugs need one bore, and inner_diameter is {sizes} m"
        yield Problem(_PATH, allowed, "make them equal, or leave out speed and slugs")
    yield from _somewhere(given)
    yield from _apart(given, scene.riser.length)


def _somewhere(given: Contents) -> Iterator[Problem]:
    for n, slug in enumerate(given.slugs):
        if given.speed == 0.0 and slug.front is None:
            allowed = "slugs stand still without a speed, and nothing says where"
            yield Problem((*_PATH, "slugs", n, "front"), allowed, "give front [m], or riser.contents.speed [m/s]")


def _apart(given: Contents, length: float) -> Iterator[Problem]:
    if len(given.slugs) > 1 and any(slug.spacing for slug in given.slugs):
        allowed = "slugs that follow each other at a spacing are the only ones in a scene"
        yield Problem((*_PATH, "slugs"), allowed, "give one slug with a spacing, or each one with its front")
        return
    placed = sorted((given.front_of(slug, length), n) for n, slug in enumerate(given.slugs))
    for (behind, _), (front, n) in pairwise(placed):
        if front - given.slugs[n].length < behind - 1e-9 * length:
            allowed = f"lies over another one, whose front is at {_arc(given, behind, length):g} m"
            yield Problem((*_PATH, "slugs", n), allowed, "move its front, or shorten it")


def _arc(given: Contents, front: float, length: float) -> float:
    """Arc length of a front that is so far from where the flow comes in [m]."""
    return front if given.speed >= 0.0 else length - front
