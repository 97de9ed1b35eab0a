"""Elements as the bend of a cable between the riser's ends asks for, wherever these come to be; nothing is solved."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from riser_soil.assembly import Assembly
from riser_soil.assembly.graded_segments import broken, graded, growing
from riser_soil.assembly.riser import elements_of
from riser_soil.assembly.shape import catenary_between, resting_level
from riser_soil.assembly.touchdown_forecast import extreme_places
from riser_soil.core.arrays import Array, BoolArray
from riser_soil.errors import SceneError
from riser_soil.riser.catenary import Catenary, bend_of_curvature, curvature
from riser_soil.riser.sections import Elements
from riser_soil.scene.riser import Segment, Support
from riser_soil.scene.scene import Scene

SHARE = 0.01  # of the largest moment, that elements may miss in a bend
OF_LAYER = 0.25  # of the boundary layer sqrt(EI/T) beside touchdown points and clamped ends
FINE, LEAST = 400, 4  # elements that the cable's shape is looked at by: of the riser, of a segment
LONG, MANY = 1.5, 1.5  # times what is proposed: elements' lengths, and their number, that are worth a word
LIFTED = 1e-6  # of the length: what hangs


def proposal(assembly: Assembly) -> str:
    """Segments in words, with line feeds; "" where the elements are right already, or no cable tells."""
    asked, given = asked_lengths(assembly), assembly.scene.riser.segments
    if asked is None:
        return ""
    segments = segments_for(assembly.scene, *asked)
    few, many = (sum(segment.element_count for segment in each) for each in (segments, given))
    if many < MANY * few and _excess(assembly.line.arc, *asked) < LONG:
        return ""
    head = (
        f"elements graded as the riser's bend asks for, for {SHARE:.0%} of the largest moment at rest: {few} in place "
        f"of {many}; riser.segments:"
    )
    return "\n".join([head, *(f"  - {_told(segment)}" for segment in segments)])


def asked_lengths(assembly: Assembly) -> tuple[Array, Array] | None:
    """Arc lengths (n,) [m] and the lengths (n,) [m] of elements there, at most; None where the riser is no cable
    between two places, or soil has a say.
    """
    scene = assembly.scene
    supported = all(isinstance(end, Support) for end in (scene.riser.start, scene.riser.end))
    if assembly.catenary is None or scene.soil is not None or not supported:
        return None
    fine = scene.model_copy(update={"riser": scene.riser.model_copy(update={"segments": _fine(scene)})})
    elements = elements_of(fine)
    try:
        shapes = [catenary_between(fine, elements, assembly.attachments, *ends) for ends in extreme_places(scene)]
    except SceneError:  # ends farther apart than the riser is long: told elsewhere
        return None
    lengths = _lengths(scene, elements, shapes)
    return growing(elements.arc, np.minimum(np.append(lengths, np.inf), np.insert(lengths, 0, np.inf)))


def segments_for(scene: Scene, arc: Array, lengths: Array) -> tuple[Segment, ...]:
    """The riser's segments with elements of lengths (n,) [m] at arc lengths (n,) [m], at most."""
    return graded([part for segment in broken(scene) for part in segment], arc, lengths)


def _excess(nodes: Array, arc: Array, lengths: Array) -> float:
    """Length of the elements between nodes over what is asked for at the nearer end, where it is most."""
    asked = np.interp(nodes, arc, lengths)
    return float((np.diff(nodes) / np.maximum(asked[1:], asked[:-1])).max())


def _fine(scene: Scene) -> tuple[Segment, ...]:
    return tuple(
        segment.model_copy(update={"elements": elements, "element_length": None})
        for segment in scene.riser.segments
        for elements in [max(LEAST, round(FINE * segment.length / scene.riser.length))]
    )


def _lengths(scene: Scene, elements: Elements, shapes: Sequence[Catenary]) -> Array:
    """Lengths of elements (ne,) [m] by the bend of each shape, and by the boundary layers; inf where all will do."""
    EI = np.maximum(elements.EI_y, elements.EI_z) * elements.bends
    hanging = [_hangs(scene, elements, shape) for shape in shapes]
    pairs = list(zip(shapes, hanging, strict=True))
    w = np.abs(elements.weight)
    moment = max(float((EI * hangs * curvature(w, shape.H, _tension(shape))).max()) for shape, hangs in pairs)
    of_bend = np.min([_of_bend(elements, shape, hangs, moment) for shape, hangs in pairs], axis=0)
    tension = np.max([_tension(shape) for shape in shapes], axis=0)
    of_layer = np.where(_layers(scene, hanging) & (EI > 0.0), OF_LAYER * np.sqrt(EI / tension), np.inf)
    return np.minimum(of_bend, of_layer)


def _hangs(scene: Scene, elements: Elements, shape: Catenary) -> BoolArray:
    """Whether elements hang free (ne,)."""
    position = shape.curve.position
    above = position[:, 2] > resting_level(scene, elements, position[[0, -1]]) + LIFTED * elements.arc[-1]
    return above[1:] | above[:-1]


def _tension(shape: Catenary) -> Array:
    """In the middle of the elements (ne,) [N]."""
    return 0.5 * (shape.tension[1:] + shape.tension[:-1])


def _of_bend(elements: Elements, shape: Catenary, hangs: BoolArray, moment: float) -> Array:
    """Lengths (ne,) [m] at which an element misses T L^4 k''/384, see `bending_plausibility`, and no more."""
    T = _tension(shape)
    second = hangs * elements.bends * bend_of_curvature(np.abs(elements.weight), shape.H, T)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(second > 0.0, (384.0 * SHARE * moment / T / second) ** 0.25, np.inf)


def _layers(scene: Scene, hanging: Sequence[BoolArray]) -> BoolArray:
    """Elements (ne,) beside clamped ends, and those that touch down in some shapes and hang in others."""
    beside: BoolArray = np.zeros(hanging[0].size, dtype=bool)
    for end, at in ((scene.riser.start, 0), (scene.riser.end, -1)):
        beside[at] |= isinstance(end, Support) and end.rotation != "free"
    for hangs in hanging:
        edges = np.flatnonzero(np.diff(hangs))
        beside[edges] = beside[edges + 1] = True
    return beside | (np.any(hanging, axis=0) & ~np.all(hanging, axis=0))


def _told(segment: Segment) -> str:
    """As a scene file has it."""
    first, last = segment.element_lengths[0], segment.element_lengths[-1]
    size = f"{first:.3g}" if abs(first - last) < 0.01 * first else f"[{first:.3g}, {last:.3g}]"
    return f"{{line_type: {segment.line_type}, length: {segment.length:.6g}, element_length: {size}}}"
