"""Elements as bending asks for: a proposal for `check`, and plausibility of the lengths of a scene."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.assembly.graded_segments import broken, graded, growing
from riser_soil.assembly.riser import elements_of
from riser_soil.assembly.shape import catenary_between, resting_level
from riser_soil.assembly.touchdown_forecast import extreme_places
from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.errors import SceneError
from riser_soil.riser.catenary import Catenary, bend_of_curvature, curvature
from riser_soil.riser.sections import Elements
from riser_soil.scene.riser import Segment, Support
from riser_soil.scene.scene import Scene

# Elements longer than this share of the boundary layer sqrt(EI/H) blur the bending at touchdown and fixed ends.
LONGEST_ELEMENT = 0.5
# Error of a moment, over the largest one, from which elements are too long for a catenary; see `_long_in_the_bend`.
MOMENT_ERROR = 0.1
# Ratio of neighbouring elements' lengths from which the joint may reflect waves. Static errors don't mind: with ratios
# up to 16 they are those of the longer elements alone. A wave needs some elements.
UNEVEN, WAVE_IN_ELEMENTS = 4.0, 6.0
SHARE = 0.01  # of the largest moment, that elements may miss in a bend
OF_LAYER = 0.25  # of the boundary layer sqrt(EI/T) beside touchdown points and clamped ends
FINE, LEAST = 400, 4  # elements that the cable's shape is looked at by: of the riser, of a segment
LONG, MANY = 1.5, 1.5  # times what is proposed: elements' lengths, and their number, that are worth a word
LIFTED = 1e-6  # of the length: what hangs


def bending_warnings(riser: LineAssembly) -> Iterator[str]:
    """Warnings about the elements' lengths, each with its numbers."""
    yield from _long_in_boundary_layers(riser)
    yield from _long_in_the_bend(riser)
    yield from _uneven_neighbours(riser)


def nodes_on_ground(riser: LineAssembly) -> IntArray:
    """Nodes that lie on the ground in the first shape."""
    heights = riser.line.to_global(riser.line.x)[:, 2]
    lowest = heights.min() + 1e-6 * riser.line.arc[-1]
    return np.flatnonzero(heights < lowest) if riser.contacts else np.zeros(0, dtype=np.int64)


def _long_in_boundary_layers(riser: LineAssembly) -> Iterator[str]:
    """Elements beside a touchdown point or a prescribed rotation against the boundary layer there."""
    if riser.catenary is None:
        return
    H, line = riser.catenary.H, riser.line
    layer = np.sqrt(_stiffness(riser) / H)
    for place, e in _boundary_layers(riser):
        if riser.elements.bends[e] and line.length[e] > LONGEST_ELEMENT * layer[e]:
            yield (
                f"elements {place} are {line.length[e]:.4g} m long, but bending varies there over sqrt(EI/H) = "
                f"{layer[e]:.4g} m (H = {H:.4g} N): take at most {LONGEST_ELEMENT * layer[e]:.3g} m"
            )


def _boundary_layers(riser: LineAssembly) -> Iterator[tuple[str, int]]:
    """Places of bending boundary layers in the initial shape, each with an element of the line."""
    line = riser.line
    if line.start.rotation_fixed:
        yield "at the start", 0
    if line.end.rotation_fixed:
        yield "at the end", line.length.size - 1
    on_ground = nodes_on_ground(riser)
    if on_ground.size > 1:
        e = min(int(on_ground[-1]), line.length.size - 1)
        yield f"at the touchdown point (arc {line.arc[on_ground[-1]]:.4g} m)", e


def _long_in_the_bend(riser: LineAssembly) -> Iterator[str]:
    """Elements whose cubic shape misses the catenary's.

    It is off by L^4 k''/384, k being the curvature, and the tension T makes a moment of that.
    """
    if riser.catenary is None:
        return
    line, H, T = riser.line, riser.catenary.H, riser.catenary.tension
    w = np.abs(riser.elements.weight)
    middle = 0.5 * (T[1:] + T[:-1])
    bends = np.logical_and(_hanging(riser), riser.elements.bends)
    error = bends * middle * line.length**4 * bend_of_curvature(w, H, middle) / 384.0
    moment = _stiffness(riser) * curvature(w, H, np.minimum(T[1:], T[:-1]))
    share = error / float((bends * moment).max(initial=np.finfo(float).tiny))
    e = int(share.argmax())
    if share[e] > MOMENT_ERROR:
        longest = line.length[e] * (0.9 * MOMENT_ERROR / share[e]) ** 0.25
        yield (
            f"elements of {line.length[e]:.4g} m at arc {0.5 * (line.arc[e] + line.arc[e + 1]):.5g} m are too long for "
            f"the riser's bend: under {middle[e]:.4g} N the moment would be off by some T L^4 k''/384 = {error[e]:.3g} "
            f"N.m, {share[e]:.0%} of the largest, {error[e] / share[e]:.3g} N.m: take at most {longest:.3g} m"
        )


def _hanging(riser: LineAssembly) -> Array:
    """Whether elements hang free in the first shape (ne,)."""
    on_ground = np.zeros(riser.line.nodes, dtype=bool)
    on_ground[nodes_on_ground(riser)] = nodes_on_ground(riser).size > 1
    return np.asarray(~(on_ground[1:] & on_ground[:-1]))


def _stiffness(riser: LineAssembly) -> Array:
    return np.maximum(riser.elements.EI_y, riser.elements.EI_z)


def _uneven_neighbours(riser: LineAssembly) -> Iterator[str]:
    length, arc = riser.line.length, riser.line.arc
    ratio = np.maximum(length[1:] / length[:-1], length[:-1] / length[1:])
    if riser.scene.has_dynamic_stage and ratio.size and ratio.max() > UNEVEN * (1.0 + 1e-9):
        e = int(ratio.argmax())
        shortest = WAVE_IN_ELEMENTS * max(length[e : e + 2])
        yield (
            f"elements of {length[e]:.4g} m and {length[e + 1]:.4g} m meet at arc {arc[e + 1]:.4g} m: waves shorter "
            f"than about {shortest:.3g} m, too short for the longer ones, are thrown back there; let the lengths grow, "
            "element_length: [first, last]"
        )


def proposal(riser: LineAssembly, path: str) -> str:
    """Segments of a line in words, with line feeds; "" where the elements are right already, or no cable tells.

    path: of the line in the scene.
    """
    asked, given = asked_lengths(riser), riser.scene.line.segments
    if asked is None:
        return ""
    try:
        segments = segments_for(riser.scene, *asked)
    except SceneError as err:  # more elements than a riser may have
        return f"elements graded as the riser's bend asks for: none, {str(err).partition(': ')[2]}"
    few, many = (sum(segment.element_count for segment in each) for each in (segments, given))
    if many < MANY * few and _excess(riser.line.arc, *asked) < LONG:
        return ""
    head = (
        f"elements graded as the riser's bend asks for, for {SHARE:.0%} of the largest moment at rest: {few} in place "
        f"of {many}; {path}.segments:"
    )
    return "\n".join([head, *(f"  - {_as_in_scene(segment)}" for segment in segments)])


def asked_lengths(riser: LineAssembly) -> tuple[Array, Array] | None:
    """Arc lengths (n,) [m] and the lengths (n,) [m] of elements there, at most; None where the riser is no cable
    between two places, or soil has a say.
    """
    scene = riser.scene
    supported = all(isinstance(end, Support) for end in (scene.line.start, scene.line.end))
    if riser.catenary is None or scene.soil is not None or not supported:
        return None
    fine = scene.model_copy(update={"riser": scene.line.model_copy(update={"segments": _fine(scene)})})
    elements = elements_of(fine)
    try:
        ends = extreme_places(riser.end_places)
        shapes = [catenary_between(fine, elements, riser.attachments, *each) for each in ends]
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
        for segment in scene.line.segments
        for elements in [max(LEAST, round(FINE * segment.length / scene.line.length))]
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
    """Tension in the middle of the elements (ne,) [N]."""
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
    for end, at in ((scene.line.start, 0), (scene.line.end, -1)):
        beside[at] |= isinstance(end, Support) and end.rotation != "free"
    for hangs in hanging:
        edges = np.flatnonzero(np.diff(hangs))
        beside[edges] = beside[edges + 1] = True
    return beside | (np.any(hanging, axis=0) & ~np.all(hanging, axis=0))


def _as_in_scene(segment: Segment) -> str:
    """A segment in the words of a scene file."""
    first, last = segment.element_lengths[0], segment.element_lengths[-1]
    size = f"{first:.3g}" if abs(first - last) < 0.01 * first else f"[{first:.3g}, {last:.3g}]"
    return f"{{line_type: {segment.line_type}, length: {segment.length:.6g}, element_length: {size}}}"
