"""Layout of a draft: stretches of the line with their elements, and places of its ends, by depth and weight."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from riser_soil.drafts.hanging_shapes import Hanging, HangingLine, Stretch, free_hanging, lazy_wave
from riser_soil.drafts.pipes import CrossSection, buoyant
from riser_soil.drafts.wishes import Kind
from riser_soil.errors import SceneError

PIPE, FLOATS = "pipe", "buoyant"
BELOW, ABOVE = 0.1, 10.0  # the hang-off lies this part of the depth below the surface, at most so many metres
OVERPULL = 1.4  # top tension over the submerged weight, of a riser that stands
SHALLOW = 10.0  # diameters of water that a line needs to hang in
ELEMENTS, BENDS = 60, 8.0  # of a whole line, at least; of the length a = H/w over which a catenary bends
STIFF = 2.0  # times sqrt(a sqrt(EI/H)), beyond which elements miss the bend's moment
FINE, ZONE = 0.25, 3.0  # element and half of the touchdown zone, over the boundary layer sqrt(EI/H)
GROWTH = 0.2  # of elements from one to the next
Place = tuple[float, float, float]


class Cut(NamedTuple):
    """A stretch of the line with its first and last element [m]."""

    line_type: str
    length: float
    first: float
    last: float


class LineLayout(NamedTuple):
    """A line in its scene: line types by name, stretches from start to end, places of both ends [m]; the tension that
    holds one that stands up [N].
    """

    pipes: dict[str, CrossSection]
    cuts: tuple[Cut, ...]
    start: Place
    end: Place
    tension: float | None = None


def layout_of(kind: Kind, pipe: CrossSection, depth: float) -> LineLayout:
    """The line of a kind in water of a depth [m]; SceneError where it is too shallow.

    The start rests on the ground by half a diameter, as the scene has it.
    """
    if depth < SHALLOW * pipe.outer:
        problem = f"too shallow for a line of {pipe.outer:.3g} m"
        raise SceneError(f"--depth {depth:g}: {problem}: take {SHALLOW * pipe.outer:.3g} m or more")
    return _hanging(kind, pipe, depth) if kind.hangs else _upright(pipe, depth)


def _upright(pipe: CrossSection, depth: float) -> LineLayout:
    top, tension = depth + min(BELOW * depth, ABOVE), OVERPULL * pipe.weight * depth
    cut = Cut(PIPE, top, top / ELEMENTS, top / ELEMENTS)
    return LineLayout({PIPE: pipe}, (cut,), (0.0, 0.0, 0.0), (0.0, 0.0, top), tension)


def _hanging(kind: Kind, pipe: CrossSection, depth: float) -> LineLayout:
    low, high = 0.5 * pipe.outer, depth - min(BELOW * depth, ABOVE)
    pipes, line = {PIPE: pipe}, HangingLine(PIPE, pipe.weight, pipe.EA)
    hanging = free_hanging(line, high - low, kind.angle)
    if kind.floats:
        pipes[FLOATS] = buoyant(pipe)
        hanging = lazy_wave(line, HangingLine(FLOATS, pipes[FLOATS].weight, pipe.EA), high - low, kind.angle)
    laid = kind.laid * depth
    cuts = tuple(_cuts(pipe, hanging, laid / (1.0 + pipe.weight * hanging.a / pipe.EA)))
    return LineLayout(pipes, cuts, (0.0, 0.0, low), (laid + hanging.across, 0.0, high))


def _cuts(pipe: CrossSection, hanging: Hanging, laid: float) -> Iterator[Cut]:
    """Fine elements about the touchdown point of a pipe that bends, which grow to both sides."""
    first, *others = hanging.stretches
    layer = math.sqrt(pipe.EI / (pipe.weight * hanging.a))
    coarse = min((laid + math.fsum(each.length for each in hanging.stretches)) / ELEMENTS, hanging.a / BENDS)
    if layer > 0.0:
        coarse = min(coarse, STIFF * math.sqrt(layer * hanging.a))
    yield from _touchdown(first, laid, coarse, layer)
    yield from (Cut(each.line_type, each.length, coarse, coarse) for each in others)


def _touchdown(first: Stretch, laid: float, coarse: float, layer: float) -> Iterator[Cut]:
    name, fine = first.line_type, FINE * layer
    if layer == 0.0 or fine >= coarse:
        yield Cut(name, laid + first.length, coarse, coarse)
        return
    half = min(ZONE * layer, 0.3 * laid, 0.3 * first.length)
    yield from _laid(name, laid - half, fine, coarse)
    yield Cut(name, 2.0 * half, fine, fine)
    yield from _growing(name, first.length - half, fine, coarse)


def _laid(name: str, length: float, fine: float, coarse: float) -> Iterator[Cut]:
    """Fine elements at both ends: beside the start, too, the pipe bends, as it sinks into the bed and the start does
    not.
    """
    grows = (coarse - fine) / GROWTH
    level = length - 2.0 * grows
    middle = coarse if level > 2.0 * coarse else min(coarse, fine + 0.5 * GROWTH * length)
    each = grows if level > 2.0 * coarse else 0.5 * length
    yield Cut(name, each, fine, middle)
    if level > 2.0 * coarse:
        yield Cut(name, level, coarse, coarse)
    yield Cut(name, each, middle, fine)


def _growing(name: str, length: float, fine: float, coarse: float) -> Iterator[Cut]:
    """Elements that grow to the coarse ones, as soon as they may."""
    grows = (coarse - fine) / GROWTH
    if length < grows + 2.0 * coarse:
        yield Cut(name, length, fine, coarse)
    else:
        yield from (Cut(name, grows, fine, coarse), Cut(name, length - grows, coarse, coarse))
