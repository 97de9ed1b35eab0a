"""Segments graded by element lengths that are asked for along the riser, in stretches of steadily growing elements."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.quantities import MOST_ELEMENTS
from riser_soil.errors import SceneError
from riser_soil.scene.riser import Segment, graded_count
from riser_soil.scene.scene import Scene

FEWEST = 12  # elements along the whole riser
GROWTH = 0.3  # of the length of elements from one to the next
STRAIGHT = 0.15  # in the logarithm of h, what a stretch of steadily growing elements may be off
SAMPLES = 400
SAME_PLACE = 1e-6  # of the riser's length


def broken(scene: Scene) -> Iterator[tuple[Segment, ...]]:
    """Each segment of one line in parts with ends where something acts within it: there shear jumps, and moments need
    nodes.
    """
    begin, near = 0.0, SAME_PLACE * scene.line.length
    for segment in scene.line.segments:
        end, cuts = begin + segment.length, [begin]
        for place in sorted(_places(scene)):
            if cuts[-1] + near < place < end - near:
                cuts.append(place)
        lengths = [segment.length] if len(cuts) == 1 else [b - a for a, b in pairwise([*cuts, end])]
        yield tuple(segment.model_copy(update={"length": length}) for length in lengths)
        begin = end


def _places(scene: Scene) -> Iterator[float]:
    """Arc lengths [m] of point loads and attachments."""
    for stage in scene.stages:
        yield from (load.at for load in stage.loads if isinstance(load.at, float))
    for attachment in scene.line.attachments:
        yield from attachment.arcs


def graded(segments: Sequence[Segment], arc: Array, lengths: Array) -> tuple[Segment, ...]:
    """The segments, each in stretches of steadily growing elements.

    lengths: (nn,) m, of elements at most, at the arc lengths (nn,) [m], from 0 to the segments' end; inf where any will
    do. Raises SceneError where they ask for more elements than a riser may have.
    """
    arc, lengths = growing(arc, lengths)
    stretches, begin = list[Segment](), 0.0
    for segment in segments:
        stretches += _stretches(segment, begin, arc, lengths)
        begin += segment.length
    return tuple(stretches)


def growing(arc: Array, lengths: Array) -> tuple[Array, Array]:
    """Lengths between the nodes, too, that grow slowly from where they are least; arc and lengths (n,)."""
    beside = np.minimum(lengths, np.minimum(np.append(lengths[1:], np.inf), np.insert(lengths[:-1], 0, np.inf)))
    fine = np.union1d(arc, np.linspace(arc[0], arc[-1], SAMPLES))
    reach = beside[None, :] + GROWTH * np.abs(fine[:, None] - arc[None, :])
    return fine, np.minimum(reach.min(axis=1), (arc[-1] - arc[0]) / FEWEST)


def _stretches(segment: Segment, begin: float, arc: Array, lengths: Array) -> list[Segment]:
    end = begin + segment.length
    inner = arc[(arc > begin) & (arc < end)]
    at = np.concatenate([[begin], inner, [end]])
    h = np.minimum(np.interp(at, arc, lengths), 0.5 * segment.length)
    corners = _long_enough(at, h, _corners(at, np.log(h)))
    sizes = [to_four_figures(each) for each in h]
    return [_stretch(segment, float(at[j] - at[i]), (sizes[i], sizes[j])) for i, j in pairwise(corners)]


def _stretch(segment: Segment, length: float, elements: tuple[float, float]) -> Segment:
    if (count := graded_count(length, *elements)) > MOST_ELEMENTS:
        asked = f"the bend of {length:.4g} m asks for {count:.4g} elements, of {min(elements):.3g} m at least"
        remedy = f"check EI of line type {segment.line_type}, or give 0 to a chain"
        raise SceneError(f"riser.segments: {asked}, more than {MOST_ELEMENTS}; {remedy}")
    return segment.model_copy(update={"length": length, "elements": None, "element_length": elements})


def _corners(x: Array, y: Array) -> list[int]:
    """Indices at which a polygon that follows y(x) has its corners (Ramer 1972; Douglas and Peucker 1973)."""
    off = np.abs(y - np.interp(x, x[[0, -1]], y[[0, -1]]))
    worst = int(off.argmax())
    if off[worst] <= STRAIGHT:
        return [0, len(x) - 1]
    return [*_corners(x[: worst + 1], y[: worst + 1]), *(worst + i for i in _corners(x[worst:], y[worst:])[1:])]


def _long_enough(x: Array, h: Array, corners: list[int]) -> list[int]:
    """Without corners that leave less than two elements between them; the shorter length stays."""
    kept = corners[:1]
    for at in corners[1:-1]:
        if x[at] - x[kept[-1]] >= 2.0 * h[at] and x[corners[-1]] - x[at] >= 2.0 * h[at]:
            kept.append(at)
    return [*kept, corners[-1]]


def to_four_figures(length: float) -> float:
    """A length rounded to four figures."""
    return float(f"{length:.4g}")
