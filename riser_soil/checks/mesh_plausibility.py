"""Plausibility of the soil's mesh and block: cells and elements against what touches, a block that the riser leaves."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from riser_soil.assembly import Assembly
from riser_soil.assembly.ground import contact_width
from riser_soil.assembly.soil_sizes import bending_on_soil, touching_width
from riser_soil.assembly.touchdown_forecast import forecast
from riser_soil.core.arrays import BoolArray
from riser_soil.scene.soil import CellSizes, GeneratedMesh
from riser_soil.soil.grading import PARALLEL

# Cells of this part of the width that touches bear the pipe as the width itself does; how much wider ones are told.
# (From 10 slices of elastic soil: 1.4 to 2.1, see test_surface_contact.)
LIKE_CONTACT, WIDE_CELLS = 1.75, 1.5
# Part of the settlement that cells which grow away from the riser miss.
GRADED = 0.02
# Length of the pipe's elements, and of the cells along it, over the length in which the soil bends the pipe.
LONG = 1.5
# Part by which a pipe settles more on sections than on a block, from which on that is told; depth down to which they
# settle alike, within 4 %, in lengths of bending on soil: e^(1.5 - 0.5772), with Euler's constant.
EXCESS, DEEP = 0.05, 2.516


def told_resolution(assembly: Assembly) -> str | None:
    """The cells under the riser against what touches, and what they miss of the settlement; None without them."""
    mesh, soil = _generated(assembly), assembly.scene.soil
    if mesh is None or soil is None or assembly.soil is None:
        return None
    width = touching_width(assembly.scales, soil.top_law)
    missing = missed(mesh.across, width, float(assembly.soil.grid.high[2] - assembly.soil.grid.low[2]))
    more = ", by more where it yields" if missing > GRADED and soil.top_law.bearing(width) is not None else ""
    return (
        f"soil under the riser: cells of {told_size(mesh)}, where {width:.3g} m touch at rest: its settlement may be "
        f"{missing:.0%} too small{more}"
    )


def missed(size: float, width: float, depth: float) -> float:
    """The part of a pipe's settlement that cells of a size across it miss, of a width that touches and a depth [m].

    A strip load settles q/(pi E*) (2 ln(4 depth/width) - 1), and cells wider than the pressure spread it over
    LIKE_CONTACT times their size; cells that grow to 0.6 of the depth miss GRADED (test_automatic_mesh). That is
    elastic soil: where it yields, wide cells miss more (test_automatic_mesh_on_demo).
    """
    return float(GRADED + max(0.0, np.log(LIKE_CONTACT * size / width)) / (np.log(4.0 * depth / width) - 0.5))


def excess_of_sections(bending: float, width: float, depth: float) -> float:
    """By what part of it a pipe that bends within a length settles more on sections than on a block [m].

    A strip load that varies as cos(x/bending) settles q/(pi E*) (2 ln(4 bending/width) + 2 - 2·0.5772) on a half space,
    by stress along it too, and on sections as a uniform one, see `missed` (M. A. Biot, Bending of an infinite beam on
    an elastic foundation, J. Appl. Mech. 4 (1937), from memory). Within 5 % of a block (test_sections_against_block).
    """
    return float(max(0.0, np.log(depth / (DEEP * bending))) / (np.log(4.0 * depth / width) - 0.5))


def mesh_warnings(assembly: Assembly) -> Iterator[str]:
    """Warnings about the soil's mesh and block, each with its numbers."""
    yield from _cells_against_contact(assembly)
    yield from _lengths_against_bending(assembly)
    yield from _sections_against_bending(assembly)
    yield from _oblique(assembly)
    yield from _leaves_the_block(assembly)


def told_size(mesh: GeneratedMesh) -> str:
    """The cells' size under the riser in words."""
    across = f"{mesh.across:.4g} m"
    return f"{mesh.along:.4g} m along and {across} across" if isinstance(mesh.size_at_riser, CellSizes) else across


def _key(mesh: GeneratedMesh) -> str:
    """The key of the cells' size across the riser."""
    return "size_at_riser.across" if isinstance(mesh.size_at_riser, CellSizes) else "size_at_riser"


def _generated(assembly: Assembly) -> GeneratedMesh | None:
    """The mesh of a scene with the pipe's surface on a block of soil."""
    scene = assembly.scene
    if scene.contact is None or scene.contact.at_nodes or scene.soil is None:
        return None
    return scene.soil.mesh if isinstance(scene.soil.mesh, GeneratedMesh) else None


def _cells_against_contact(assembly: Assembly) -> Iterator[str]:
    """Cells wider than what touches: they bear the pipe as a strip of their own width would."""
    mesh, scales, soil = _generated(assembly), assembly.scales, assembly.scene.soil
    if mesh is None or soil is None or soil.top_law.surface_modulus(assembly.scales.diameter) <= 0.0:
        return
    E, size = soil.top_law.surface_modulus(scales.diameter), mesh.across
    width = contact_width(scales, E)
    finest = width / LIKE_CONTACT
    if size > WIDE_CELLS * finest:
        missing = 2.0 * scales.weight / (np.pi * 4.0 / 3.0 * E) * np.log(size / finest)
        yield (
            f"soil.mesh.{_key(mesh)} {size:.4g} m is {size / width:.2g} times the {width:.3g} m by which the riser "
            f"touches elastic soil under its weight: it settles by about {1000.0 * missing:.2g} mm less than on a fine "
            f"mesh; take at most {0.5 * width:.2g} m where settlement or stress in the soil matters, or mesh: auto"
        )


def _lengths_against_bending(assembly: Assembly) -> Iterator[str]:
    """Elements of the pipe on the soil, or cells along it, longer than the soil lets the pipe bend."""
    mesh, soil = _generated(assembly), assembly.scene.soil
    if mesh is None or soil is None:
        return
    bending = bending_on_soil(assembly.elements, soil.top_law)
    above = _elements_above(assembly)
    element = float(assembly.line.length[above].max(initial=0.0))
    for what, length in (("elements of the riser over the soil", element), ("soil.mesh cells along it", mesh.along)):
        if length > LONG * bending:
            yield (
                f"{what} of {length:.4g} m are long beside the {bending:.3g} m over which the soil bends the pipe, "
                f"(4 EI/E)^(1/4): pressure and settlement vary within one; take at most {0.5 * bending:.2g} m where "
                "stress or settlement under the touchdown point matters"
            )


def _sections_against_bending(assembly: Assembly) -> Iterator[str]:
    """Sections under a pipe that bends within a length short beside the soil's depth."""
    mesh, soil = _generated(assembly), assembly.scene.soil
    if mesh is None or soil is None or soil.model == "block":
        return
    assert assembly.soil is not None
    bending = bending_on_soil(assembly.elements, soil.top_law)
    depth = float(assembly.soil.grid.high[2] - assembly.soil.grid.low[2])
    excess = excess_of_sections(bending, touching_width(assembly.scales, soil.top_law), depth)
    if excess > EXCESS:
        yield (
            f"soil.model: sections leave out the soil's stress along the riser: where it bends, within {bending:.3g} m "
            f"on {depth:.3g} m of soil, it settles by about {excess:.0%} more than on a block; take model: block to "
            "judge it"
        )


def _elements_above(assembly: Assembly) -> BoolArray:
    """Elements (ne,) whose middle lies above the soil's block at first."""
    assert assembly.soil is not None
    x = assembly.line.to_global(assembly.line.x)[:, :2]
    middle, grid = 0.5 * (x[1:] + x[:-1]), assembly.soil.grid
    above: BoolArray = np.all((middle >= grid.low[:2]) & (middle <= grid.high[:2]), axis=1)
    return above


def _oblique(assembly: Assembly) -> Iterator[str]:
    """Long cells under a riser across the axes."""
    mesh, (x, y, _) = _generated(assembly), np.abs(assembly.line.direction)
    if mesh is not None and isinstance(mesh.size_at_riser, CellSizes) and min(x, y) > PARALLEL * max(x, y):
        yield (
            f"soil.mesh.size_at_riser.along {mesh.along:.4g} m has no effect, as the riser runs across x and y: cells "
            f"are {mesh.across:.4g} m both ways in all the plan that it covers; turn the scene until it runs along x"
        )


def _leaves_the_block(assembly: Assembly) -> Iterator[str]:
    """A block from which the touchdown point moves, by catenaries between the ends as they move."""
    assert assembly.soil is not None
    found = forecast(assembly.scene, assembly.elements)
    if found is None:
        return
    low, high = assembly.soil.grid.low[:2], assembly.soil.grid.high[:2]
    beyond = np.maximum(np.maximum(low - found.points, found.points - high), 0.0).max(axis=1)
    if beyond[0] == 0.0 and beyond.max() > 0.0:
        at = found.points[beyond.argmax()]
        yield (
            "the touchdown point leaves the soil's block as the ends move: by statics it comes to x = "
            f"{at[0]:.5g}, y = {at[1]:.5g} m, {beyond.max():.3g} m beyond x from {low[0]:.5g} to {high[0]:.5g} m and "
            f"y from {low[1]:.5g} to {high[1]:.5g} m: enlarge soil.block, or take block: auto"
        )
