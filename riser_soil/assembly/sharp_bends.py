"""Elements of slack chain and rope, cut where the line bends more sharply than they are long.

A line without bending stiffness that is too long to pull at its anchor hangs straight down to a heap on the seabed, or
in two legs side by side. Its bend there has the radius H/w and begins somewhere within an element; what of that element
hangs is in doubt by half its length, and the tension at the top with it. The scene's nodes stay, new ones come between
them: elements are as long as the bend's radius beside it, or as a small share of the height where it has hardly any
radius, and grow with the distance from it. Where the first shape bends gently nothing is cut.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

import numpy as np

from riser_soil.assembly.riser import attachments_of, elements_of
from riser_soil.assembly.shape import catenary_between
from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.riser.catenary import Catenary
from riser_soil.riser.sections import Elements
from riser_soil.scene.lines import by_line, risers, with_segments
from riser_soil.scene.riser import Segment, Support
from riser_soil.scene.scene import Scene

SHARP = 1.0  # of an element: radius of a bend that it can't follow
OF_RADIUS = 0.5  # of that radius: elements beside it
FINEST = 1e-3  # of the line's height: the shortest elements
GROWTH = 0.3  # of the distance from a bend
LEAST_CUT = 1.5  # elements asked for in place of one, from which it is cut
SHORTEST = 1e-2  # of the line's length: the least height that counts
SAMPLES = 2001  # of an element, by which it is cut
GRID = 1e-6  # of the line's length: places of new nodes, so that round-off does not move them


def cut_at_sharp_bends(scene: Scene) -> Scene:
    """The scene with the elements of slack chain and rope cut; itself where there are none to cut."""
    given = {name: line.segments for name, line in risers(scene).items()}
    cut = dict(given)
    for name, view in by_line(scene).items():
        if (bends := _sharp_bends(view)) is not None:
            cut[name] = tuple(_cut(given[name], *bends))
    return scene if cut == given else with_segments(scene, cut)


def _sharp_bends(scene: Scene) -> tuple[Array, Array] | None:
    """Arc lengths of sharp bends (n,) of one line, and elements' lengths (n,) beside them [m]; None without any."""
    start, end = scene.line.start, scene.line.end
    if scene.line.initial != "catenary" or scene.soil is not None:
        return None
    if not all(isinstance(each, Support) and not each.jointed for each in (start, end)):
        return None
    assert isinstance(start, Support)
    assert isinstance(end, Support)
    elements = elements_of(scene)
    if elements.bends.any():
        return None
    try:
        places = np.array(start.position), np.array(end.position)
        cable = catenary_between(scene, elements, attachments_of(scene), *places)
    except SceneError:  # said where the line is built
        return None
    return _sharp(cable, elements)


def _sharp(cable: Catenary, elements: Elements) -> tuple[Array, Array] | None:
    arcs = cable.bends
    e = np.clip(np.searchsorted(elements.arc, arcs, side="right") - 1, 0, elements.length.size - 1)
    radius = cable.H / np.abs(elements.weight[e]) * (0.0 if cable.heaped else 1.0)
    sharp = radius < SHARP * elements.length[e]
    if not sharp.any():
        return None
    height = float(np.ptp(cable.curve.position[:, 2]))
    return arcs[sharp], np.maximum(OF_RADIUS * radius[sharp], FINEST * max(height, SHORTEST * elements.arc[-1]))


def _cut(segments: tuple[Segment, ...], arcs: Array, lengths: Array) -> Iterator[Segment]:
    """The segments, equal elements beside each other in one."""
    grid, begin = GRID * sum(segment.length for segment in segments), 0.0
    for segment in segments:
        pieces = list[float]()
        for length in segment.element_lengths:
            pieces += _pieces(begin, length, arcs, lengths, grid)
            begin += length
        if len(pieces) == segment.element_count:
            yield segment
            continue
        for each, run in groupby(pieces):
            count = len(list(run))
            yield segment.model_copy(update={"length": count * each, "elements": count, "element_length": None})


def _pieces(begin: float, length: float, arcs: Array, lengths: Array, grid: float) -> list[float]:
    """Lengths of the parts of one element."""
    s = begin + length * np.linspace(0.0, 1.0, SAMPLES)
    allowed = (lengths + GROWTH * np.abs(s[:, None] - arcs)).min(axis=1)
    asked = np.append(0.0, np.cumsum(0.5 * (1.0 / allowed[1:] + 1.0 / allowed[:-1]) * np.diff(s)))
    if asked[-1] < LEAST_CUT:
        return [length]
    count = int(np.ceil(asked[-1]))
    nodes = np.interp(np.arange(1, count) / count * asked[-1], asked, s - begin)
    at = [0.0, *(grid * np.round(nodes / grid)), length]
    return [float(value) for value in np.diff(at)]
