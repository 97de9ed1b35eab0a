"""Elements of chain and rope, cut where the line bends more sharply than they are long.

A line without bending stiffness that is too long to pull at its anchor hangs straight down to a heap on the seabed, or
in two legs side by side. Its bend there has the radius H/w and begins somewhere within an element; what of that element
hangs is in doubt by half its length, and the tension at the top with it. A float or a clump makes a kink: the elements
beside it share one slope there, and bow away from the two straight legs by half the angle a that the line turns by. By
the shallow arch of their cubics that takes up the length h a^2/30, h being the length of an element.

The scene's nodes stay, new ones come between them. Beside a bend elements are as long as a share of its radius, or of
the height where it has hardly any radius; beside a kink so that the length taken up is a small share of the line's.
They grow with the distance from it. Where the first shape bends gently nothing is cut.
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
from riser_soil.scene.stages import DynamicStage

SHARP = 1.0  # of an element: radius of a bend that it can't follow
OF_RADIUS = 0.5  # of that radius: elements beside it
FINEST = 5e-4  # of the line's height: the shortest elements
FINEST_MOVED = 0.1  # the same beside a heap under an end that moves: there shorter ones fold as they come down
TAKEN_UP = 1e-5  # of the line's length: by the elements beside a kink
ARCH = 30.0  # h a^2/ARCH is taken up there
GROWTH = 0.3  # of the distance from a bend or a kink
LEAST_CUT = 1.5  # elements asked for in place of one, from which it is cut
SHORTEST = 1e-2  # of the line's length: the least height that counts
SAMPLES = 2001  # of an element, by which it is cut
GRID = 1e-6  # of the line's length: places of new nodes, so that round-off does not move them


def cut_at_sharp_bends(scene: Scene) -> Scene:
    """The scene with the elements of chain and rope cut; itself where there are none to cut."""
    given = {name: line.segments for name, line in risers(scene).items()}
    cut = dict(given)
    for name, view in by_line(scene).items():
        if (bends := _sharp_bends(view)) is not None:
            cut[name] = tuple(_cut(given[name], *bends))
    return scene if cut == given else with_segments(scene, cut)


def _sharp_bends(scene: Scene) -> tuple[Array, Array] | None:
    """Arc lengths of sharp bends and kinks (n,) of one line, and elements' lengths (n,) beside them [m]; None without
    any.
    """
    start, end = scene.line.start, scene.line.end
    if scene.line.initial != "catenary" or scene.soil is not None:
        return None
    if not (isinstance(start, Support) and isinstance(end, Support)):
        return None
    elements = elements_of(scene)
    if elements.bends.any():
        return None
    try:
        places, attachments = (np.array(start.position), np.array(end.position)), attachments_of(scene)
        cable = catenary_between(scene, elements, attachments, *places)
    except SceneError:  # said where the line is built
        return None
    attached = np.array([each.arc for each in attachments if 0.0 < each.arc < elements.arc[-1]])
    sharp = [_kinks(cable, elements, attached)]
    if not (start.jointed or end.jointed):  # else where its ends come to rest is not known before they do
        bends, lengths = _bends(cable, elements)
        if cable.heaped and any(isinstance(each, DynamicStage) and each.motion for each in scene.stages):
            lengths = np.maximum(lengths, FINEST_MOVED * np.ptp(cable.curve.position[:, 2]))
        sharp.append((bends, lengths))
    arcs, lengths = (np.concatenate(each) for each in zip(*sharp, strict=True))
    height = max(float(np.ptp(cable.curve.position[:, 2])), SHORTEST * float(elements.arc[-1]))
    return (arcs, np.maximum(lengths, FINEST * height)) if arcs.size else None


def _bends(cable: Catenary, elements: Elements) -> tuple[Array, Array]:
    """Sharp bends: arc lengths and elements' lengths beside them (n,) [m]."""
    arcs = cable.bends
    e = np.clip(np.searchsorted(elements.arc, arcs, side="right") - 1, 0, elements.length.size - 1)
    radius = cable.H / np.abs(elements.weight[e]) * (0.0 if cable.heaped or cable.folded else 1.0)
    sharp = radius < SHARP * elements.length[e]
    return arcs[sharp], OF_RADIUS * radius[sharp]


def _kinks(cable: Catenary, elements: Elements, attached: Array) -> tuple[Array, Array]:
    """Kinks where something is attached, at arc lengths (m,) [m]: arc lengths of those, and elements' lengths beside
    them (n,) [m].
    """
    least = TAKEN_UP * ARCH * elements.arc[-1] / float(elements.length.max())
    angle = cable.turns(attached)
    kinked = angle**2 > least
    return attached[kinked], TAKEN_UP * ARCH * elements.arc[-1] / angle[kinked] ** 2


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
