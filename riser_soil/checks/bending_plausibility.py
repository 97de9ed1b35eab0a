"""Plausibility of the element lengths: too long for the bending, or of very different lengths where waves pass."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from riser_soil.assembly import Assembly
from riser_soil.core.arrays import Array, IntArray

# Elements longer than this share of the boundary layer sqrt(EI/H) blur the bending at touchdown and fixed ends.
LONGEST_ELEMENT = 0.5
# Error of a moment, over the largest one, from which elements are too long for a catenary; see `_long_in_the_bend`.
MOMENT_ERROR = 0.1
# Ratio of neighbouring elements' lengths from which the joint may reflect waves. Static errors don't mind: with ratios
# up to 16 they are those of the longer elements alone. A wave needs some elements.
UNEVEN, WAVE_IN_ELEMENTS = 4.0, 6.0


def bending_warnings(assembly: Assembly) -> Iterator[str]:
    """Warnings about the elements' lengths, each with its numbers."""
    yield from _long_in_boundary_layers(assembly)
    yield from _long_in_the_bend(assembly)
    yield from _uneven_neighbours(assembly)


def nodes_on_ground(assembly: Assembly) -> IntArray:
    """Nodes that lie on the ground in the first shape."""
    heights = assembly.line.to_global(assembly.line.x)[:, 2]
    lowest = heights.min() + 1e-6 * assembly.line.arc[-1]
    return np.flatnonzero(heights < lowest) if assembly.contacts else np.zeros(0, dtype=np.int64)


def _long_in_boundary_layers(assembly: Assembly) -> Iterator[str]:
    """Elements beside a touchdown point or a prescribed rotation against the boundary layer there."""
    if assembly.catenary is None:
        return
    H, line = assembly.catenary.H, assembly.line
    layer = np.sqrt(_stiffness(assembly) / H)
    for place, e in _boundary_layers(assembly):
        if assembly.elements.bends[e] and line.length[e] > LONGEST_ELEMENT * layer[e]:
            yield (
                f"elements {place} are {line.length[e]:.4g} m long, but bending varies there over sqrt(EI/H) = "
                f"{layer[e]:.4g} m (H = {H:.4g} N): take at most {LONGEST_ELEMENT * layer[e]:.3g} m"
            )


def _boundary_layers(assembly: Assembly) -> Iterator[tuple[str, int]]:
    """Places of bending boundary layers in the initial shape, each with an element of the line."""
    line = assembly.line
    if line.start.rotation_fixed:
        yield "at the start", 0
    if line.end.rotation_fixed:
        yield "at the end", line.length.size - 1
    on_ground = nodes_on_ground(assembly)
    if on_ground.size > 1:
        e = min(int(on_ground[-1]), line.length.size - 1)
        yield f"at the touchdown point (arc {line.arc[on_ground[-1]]:.4g} m)", e


def _long_in_the_bend(assembly: Assembly) -> Iterator[str]:
    """Elements whose cubic shape misses the catenary's.

    It is off by L^4 k''/384, k being the curvature, and the tension T makes a moment of that.
    """
    if assembly.catenary is None:
        return
    from riser_soil.riser.catenary import bend_of_curvature, curvature

    line, H, T = assembly.line, assembly.catenary.H, assembly.catenary.tension
    w = np.abs(assembly.elements.weight)
    middle = 0.5 * (T[1:] + T[:-1])
    bends = np.logical_and(_hanging(assembly), assembly.elements.bends)
    error = bends * middle * line.length**4 * bend_of_curvature(w, H, middle) / 384.0
    moment = _stiffness(assembly) * curvature(w, H, np.minimum(T[1:], T[:-1]))
    share = error / float((bends * moment).max(initial=np.finfo(float).tiny))
    e = int(share.argmax())
    if share[e] > MOMENT_ERROR:
        longest = line.length[e] * (0.9 * MOMENT_ERROR / share[e]) ** 0.25
        yield (
            f"elements of {line.length[e]:.4g} m at arc {0.5 * (line.arc[e] + line.arc[e + 1]):.5g} m are too long for "
            f"the riser's bend: under {middle[e]:.4g} N the moment would be off by some T L^4 k''/384 = {error[e]:.3g} "
            f"N.m, {share[e]:.0%} of the largest, {error[e] / share[e]:.3g} N.m: take at most {longest:.3g} m"
        )


def _hanging(assembly: Assembly) -> Array:
    """Whether elements hang free in the first shape (ne,)."""
    on_ground = np.zeros(assembly.line.nodes, dtype=bool)
    on_ground[nodes_on_ground(assembly)] = nodes_on_ground(assembly).size > 1
    return np.asarray(~(on_ground[1:] & on_ground[:-1]))


def _stiffness(assembly: Assembly) -> Array:
    return np.maximum(assembly.elements.EI_y, assembly.elements.EI_z)


def _uneven_neighbours(assembly: Assembly) -> Iterator[str]:
    length, arc = assembly.line.length, assembly.line.arc
    ratio = np.maximum(length[1:] / length[:-1], length[:-1] / length[1:])
    moves = any(stage.kind == "dynamic" for stage in assembly.scene.stages)
    if moves and ratio.size and ratio.max() > UNEVEN * (1.0 + 1e-9):
        e = int(ratio.argmax())
        shortest = WAVE_IN_ELEMENTS * max(length[e : e + 2])
        yield (
            f"elements of {length[e]:.4g} m and {length[e + 1]:.4g} m meet at arc {arc[e + 1]:.4g} m: waves shorter "
            f"than about {shortest:.3g} m, too short for the longer ones, are thrown back there; let the lengths grow, "
            "element_length: [first, last]"
        )
