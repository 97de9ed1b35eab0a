"""Consistency checks of an end that hangs off with the rest of the scene."""

from collections.abc import Iterator

from riser_soil.scene.problem import Path, Problem
from riser_soil.scene.scene import Scene


def hang_off_conflicts(scene: Scene) -> Iterator[Problem]:
    """What a hang-off needs of the rest of the scene."""
    ends = {"start": scene.riser.start, "end": scene.riser.end}
    asking = [name for name, end in ends.items() if end != "free" and end.hang_off is not None]
    if len(asking) > 1:
        yield Problem(("riser", "end", "hang_off"), "both ends hang off", "leave hang_off out of one of them")
    for name in asking[:1]:
        path: Path = ("riser", name, "hang_off")
        yield from (Problem(path, *told) for told in _wanting(scene, name))


def _wanting(scene: Scene, name: str) -> Iterator[tuple[str, str]]:
    """What is wrong, and what to do."""
    other = "end" if name == "start" else "start"
    here, there, first = getattr(scene.riser, name), getattr(scene.riser, other), scene.stages[0]
    if scene.accuracy is not None:
        yield "is solved for on elements, which accuracy chooses later", "give elements and time steps"
    if there == "free" or scene.riser.initial != "catenary":
        yield f"needs a catenary to begin with, between this end and the {other}", "give both a position, and gravity"
        return
    if first.kind != "static":
        yield f"is that of the first stage at rest, and the first stage is {first.kind}", "begin with a static stage"
    elif first.move is not None:
        yield "is that of the first stage, which moves an end", "let a later stage move it"
    if here.position[2] <= there.position[2]:
        yield f"the {name} is not above the {other}", "give it to the upper end, or correct the positions"
    if here.position[:2] == there.position[:2]:
        yield f"the {name} is right above the {other}", "give a position aside of it: it tells the direction"
