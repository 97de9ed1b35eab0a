"""Overrides that a run would not see: of places and lengths that are solved for, as the scene's are first guesses."""

from collections.abc import Iterator
from typing import Any, NamedTuple

from riser_soil.scene.document import Document
from riser_soil.scene.lines import ENDS, risers
from riser_soil.scene.problem import Missing, Path, Problem, value_at
from riser_soil.scene.riser import Riser, Support
from riser_soil.scene.scene import Scene


class Guess(NamedTuple):
    """A value that is solved for: its path, what finds it, and what to do in place of changing it."""

    path: Path
    reason: str
    remedy: str


def void_overrides(document: Document, scene: Scene) -> Iterator[Problem]:
    """Overrides of the document that change nothing but a first guess of its scene."""
    guesses = [*_guesses(scene)] if document.replaced else []
    for path, before in document.replaced.items():
        changed = (guess for guess in guesses if _is_changed(document, guess, path, before))
        if (guess := next(changed, None)) is not None:
            yield Problem(path, f"is a first guess: {guess.reason}", guess.remedy)


def _is_changed(document: Document, guess: Guess, path: Path, before: Any) -> bool:
    """Whether an override at a path changed a guess that the scene had: the value alone, or the list in which it is."""
    if path not in (guess.path, guess.path[:-1]) or isinstance(before, Missing):
        return False
    return bool(value_at(before, guess.path[len(path) :]) != value_at(document.data, guess.path))


def _guesses(scene: Scene) -> Iterator[Guess]:
    for line, riser in risers(scene).items():
        path: Path = ("lines", line) if line else ("riser",)
        for end in ENDS:
            yield from _of_end(path, riser, end)
    if scene.stages[0].kind != "dynamic":
        for key in ("bodies", "joints"):
            for name in getattr(scene, key):
                rest = "the first stage brings it to rest from here"
                remedy = "change what holds it: ends, lengths, weights; another guess is for the scene file"
                yield from (Guess((key, name, "position", axis), rest, remedy) for axis in range(3))


def _of_end(path: Path, riser: Riser, end: str) -> Iterator[Guess]:
    """The coordinate that is solved for, of an end that hangs off or has a tensioner."""
    support, other = getattr(riser, end), "start" if end == "end" else "end"
    if not isinstance(support, Support):
        return
    if support.tensioner is not None:
        reason = f"the {end}'s tensioner lets it go up and down"
        yield Guess((*path, end, "position", 2), reason, "change the tension or the segments")
    if support.hang_off is None:
        return
    by = support.hang_off.by
    if by == "length":
        number = 0 if end == "end" else len(riser.segments) - 1
        reason = f"the {end}'s hang_off finds this length"
        yield Guess((*path, "segments", number, "length"), reason, "change another segment, or leave hang_off out")
        return
    reason = f"the {end}'s hang_off finds the distance between the ends"
    remedy = "for an offset of the vessel set vessel.offset: [dx, dy]; else leave hang_off out, or edit the scene file"
    for moved in (end,) if by == "layback" else (end, other):
        yield from (Guess((*path, moved, "position", axis), reason, remedy) for axis in (0, 1))
