"""Consistency checks of the vessel's offset with the rest of a scene."""

from collections.abc import Iterator

from riser_soil.scene.lines import ENDS, acts_on, by_line, risers
from riser_soil.scene.motions import EndMotion, Vessel, VesselHistory
from riser_soil.scene.problem import Path, Problem, hint
from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import StaticStage
from riser_soil.scene.variants import LineEnd, end_name, end_named, vessel_ends

_PATH: Path = ("vessel",)


def vessel_conflicts(scene: Scene) -> Iterator[Problem]:
    """What a vessel's offset needs: ends that can be moved and hang from one vessel, and a static stage to move them
    in, after which no other stage moves them.
    """
    if scene.vessel is None:
        return
    problems = [*_named(scene)]
    yield from problems
    if problems:
        return
    ends = vessel_ends(scene)
    if not ends:
        allowed = "no line has an upper end with a position that could hang from it"
        yield Problem((*_PATH, "ends"), allowed, "name the ends that do, as ends: [end]")
        return
    yield from _static_first(scene)
    yield from _moved_again(scene, ends)
    yield from _of_one_vessel(scene, ends)
    yield from _heaves(scene, ends)


def _named(scene: Scene) -> Iterator[Problem]:
    """Ends that are named, and are not there, or no end to be moved."""
    assert scene.vessel is not None
    known = [end_name((line, end)) for line in risers(scene) for end in ENDS]
    for n, name in enumerate(scene.vessel.ends or ()):
        path: Path = (*_PATH, "ends", n)
        if name not in known:
            yield Problem(path, f"must be one of {', '.join(known)}", f"name one of them{hint(name, known)}")
        elif name in (scene.vessel.ends or ())[:n]:
            yield Problem(path, "is named before", "leave one of the two out")
        elif not isinstance(_end(scene, end_named(name)), Support):
            yield Problem(path, "has no position, and can't be moved", "leave it out, or give the end a position")


def _static_first(scene: Scene) -> Iterator[Problem]:
    first = scene.stages[0]
    if not isinstance(first, StaticStage):
        allowed = f"is reached in the first stage, which must be static and is {first.kind}"
        remedy = "begin with a static stage, or place end, hub and reference yourself"
        yield Problem((*_PATH, "offset"), allowed, remedy)


def _moved_again(scene: Scene, ends: list[LineEnd]) -> Iterator[Problem]:
    """`move` gives a place of its own, at which the offset would be lost without a word."""
    for line, end in ends:
        for n, stage in enumerate(scene.stages):
            if isinstance(stage, StaticStage) and getattr(acts_on(stage, line).move, end, None) is not None:
                path: Path = ("stages", n, *(("lines", line) if line else ()), "move", end)
                allowed = f"moves {end_name((line, end))} to a place without vessel.offset"
                yield Problem(path, allowed, "leave out vessel.offset and add it to this place, or leave out the move")


def _of_one_vessel(scene: Scene, ends: list[LineEnd]) -> Iterator[Problem]:
    """All ends that motions put on a vessel must be moved with it, and by default there must be but one."""
    assert scene.vessel is not None
    every = {(line, end): vessels_of_end(scene, line, end) for line in risers(scene) for end in ENDS}
    moved = [vessel for key in ends for vessel in every[key]]
    for key, carriers in every.items():
        if key not in ends and any(vessel in moved for vessel in carriers):
            allowed = f"motions put {end_name(key)} on the same vessel, which would stay behind"
            yield Problem((*_PATH, "ends"), allowed, f"name {end_name(key)} among them, too")
        elif key not in ends and carriers and scene.vessel.ends is None:
            allowed = f"motions put {end_name(key)} on a vessel, and by default only upper ends are moved"
            yield Problem((*_PATH, "ends"), allowed, "name the ends of the vessel that has the offset")
    carried = [key for key in ends if every[key]]
    apart = [key for key in carried[1:] if not any(vessel in every[carried[0]] for vessel in every[key])]
    if scene.vessel.ends is None and apart:
        allowed = f"motions put {end_name(carried[0])} and {end_name(apart[0])} on vessels of different references"
        yield Problem((*_PATH, "ends"), allowed, "name the ends of the vessel that has the offset")


def vessels_of_end(scene: Scene, line: str, end: str) -> list[Vessel | VesselHistory]:
    """Vessels of which an end is part, stage by stage."""
    motions = (getattr(acts_on(stage, line), "motion", None) for stage in scene.stages)
    given: list[EndMotion] = [each.by_end[end] for each in motions if each is not None and end in each.by_end]
    return [way for each in given for way in each.ways.values() if isinstance(way, Vessel | VesselHistory)]


def _heaves(scene: Scene, ends: list[LineEnd]) -> Iterator[Problem]:
    assert scene.vessel is not None
    if scene.vessel.offset[2] == 0.0:
        return
    for key in ends:
        end = _end(scene, key)
        if isinstance(end, Support) and end.tensioner is not None:
            allowed = f"its tensioner keeps dz from {end_name(key)}"
            yield Problem((*_PATH, "offset"), allowed, "give [dx, dy]")


def _end(scene: Scene, key: LineEnd) -> object:
    """A line's end, None where a joint holds it: it can't be moved then."""
    line, end = key
    view = by_line(scene)[line]
    given = getattr(view.line, end)
    return None if isinstance(given, Support) and given.jointed else given
