"""Consistency checks of what sits at the riser's ends with the rest of the scene."""

from collections.abc import Iterator

from riser_soil.scene.problem import Path, Problem
from riser_soil.scene.riser import Segment, Support
from riser_soil.scene.scene import Scene

FEWEST = 4  # elements along a bend stiffener


def end_conflicts(scene: Scene) -> Iterator[Problem]:
    """Bend stiffeners that are clamped to nothing, or fit on no pipe; tensioners that hold nothing."""
    yield from _tensioners(scene)
    for name, at in (("start", 0), ("end", -1)):
        end = getattr(scene.line, name)
        if isinstance(end, Support) and end.bend_stiffener is not None:
            path: Path = ("riser", name, "bend_stiffener")
            yield from (Problem((*path, *key), *words) for key, words in _wanting(scene, end, at))


def _tensioners(scene: Scene) -> Iterator[Problem]:
    ends = {"start": scene.line.start, "end": scene.line.end}
    fixed = [name for name, end in ends.items() if isinstance(end, Support) and end.tensioner is None]
    for name, end in ends.items():
        if not isinstance(end, Support) or end.tensioner is None:
            continue
        path: Path = ("riser", name, "tensioner")
        if not fixed:
            yield Problem(path, "nothing holds the riser's height", "give the other end a position without a tensioner")
        if end.hang_off is not None:
            yield Problem(path, "the end asks for a hang_off, too", "leave one of the two out")


def _wanting(scene: Scene, end: Support, at: int) -> Iterator[tuple[tuple[str, ...], tuple[str, str]]]:
    stiffener, segment = end.bend_stiffener, scene.line.segments[at]
    assert stiffener is not None
    diameter = scene.line_types[segment.line_type].outer_diameter
    if end.rotation == "free":
        yield (), ("has no base to bend against where rotation is free", "set rotation: fixed, or give a stiffness")
    if diameter is None:
        yield (), (f"line type {segment.line_type} has no diameter", "give its outer_diameter")
    elif stiffener.tip_diameter < diameter:
        yield ("tip_diameter",), (f"is less than the pipe's ({diameter:g} m)", "correct one of the two diameters")
    if stiffener.length > 0.5 * segment.length:
        allowed = f"must be at most half as long as the segment at this end ({segment.length:g} m)"
        yield ("length",), (allowed, "shorten it, or lengthen the segment")
    elif scene.accuracy is None and (long := _longest(segment, at, stiffener.length)) > stiffener.length / FEWEST:
        allowed = f"has elements of {long:.3g} m on its {stiffener.length:g} m: at least {FEWEST} are needed"
        yield (), (allowed, "take shorter elements at this end, as by element_length: [first, last]")


def _longest(segment: Segment, at: int, length: float) -> float:
    """The longest element [m] of a segment within a length from the riser's end."""
    lengths = segment.element_lengths[:: 1 if at == 0 else -1]
    within, along = list[float](), 0.0
    for each in lengths:
        if along >= length:
            break
        within.append(each)
        along += each
    return max(within)


def hang_off_conflicts(scene: Scene) -> Iterator[Problem]:
    """What a hang-off needs of the rest of the scene."""
    ends = {"start": scene.line.start, "end": scene.line.end}
    asking = [name for name, end in ends.items() if end != "free" and end.hang_off is not None]
    if len(asking) > 1:
        yield Problem(("riser", "end", "hang_off"), "both ends hang off", "leave hang_off out of one of them")
    for name in asking[:1]:
        path: Path = ("riser", name, "hang_off")
        yield from (Problem(path, *words) for words in _wanting_of_hang_off(scene, name))


def _wanting_of_hang_off(scene: Scene, name: str) -> Iterator[tuple[str, str]]:
    """Problems of a hang-off, with their remedies."""
    other = "end" if name == "start" else "start"
    here, there, first = getattr(scene.line, name), getattr(scene.line, other), scene.stages[0]
    if scene.accuracy is not None:
        yield "is solved for on elements, which accuracy chooses later", "give elements and time steps"
    if there == "free" or scene.line.initial != "catenary":
        yield f"needs a catenary to begin with, between this end and the {other}", "give both a position, and gravity"
        return
    if first.kind != "static":
        yield f"is that of the first stage at rest, and the first stage is {first.kind}", "begin with a static stage"
    elif first.move is not None:
        yield "is that of the first stage, which moves an end", "let a later stage move it"
    if here.hang_off.by == "anchor" and there.jointed:
        yield f"by: anchor moves the {other}, which a joint holds", "take by: layback or length"
    if here.position[2] <= there.position[2]:
        yield f"the {name} is not above the {other}", "give it to the upper end, or correct the positions"
    if here.position[:2] == there.position[:2]:
        yield f"the {name} is right above the {other}", "give a position aside of it: it gives the direction"
