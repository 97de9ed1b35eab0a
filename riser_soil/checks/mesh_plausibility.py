"""Plausibility of the soil's mesh and block: cells and elements against what touches, a block that the riser leaves."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.assembly.soil_sizes import bending_on_soil, touching_width
from riser_soil.assembly.touchdown_forecast import TouchdownForecast
from riser_soil.checks.settlement import Settled, predicted_settlement
from riser_soil.core.arrays import BoolArray
from riser_soil.scene.soil import CellSizes, GeneratedMesh
from riser_soil.soil.grading import PARALLEL

# Part of the settlement that cells which grow away from the riser miss; what wide cells under it may miss beyond that,
# before they are warned of.
GRADED, MISSING = 0.02, 0.1
# Length of the pipe's elements, and of the cells along it, over the length in which the soil bends the pipe.
LONG = 1.5
# Part by which a pipe settles more on sections than on a block, from which on that is told; depth down to which they
# settle alike, within 4 %, in lengths of bending on soil: e^(1.5 - 0.5772), with Euler's constant.
EXCESS, DEEP = 0.05, 2.516


def resolution_in_words(riser: LineAssembly) -> str | None:
    """The cells under the riser against what touches, and what they miss of the settlement; None without them."""
    mesh, soil = _generated(riser), riser.scene.soil
    if mesh is None or soil is None or riser.soil is None:
        return None
    fine, on_mesh = predicted_settlement(riser), predicted_settlement(riser, mesh.across)
    if fine is None or on_mesh is None:
        return None
    width = touching_width(riser.scales, soil.top_law)
    return (
        f"soil under the riser: cells of {size_in_words(mesh)}, where {width:.3g} m touch at rest: it settles by about "
        f"{1000.0 * fine.by_weight:.2g} mm under its weight, at the touchdown point by {1000.0 * fine.deepest:.2g} mm, "
        f"and {missed(on_mesh, fine):.0%} less on these cells"
    )


def missed(on_mesh: Settled, fine: Settled) -> float:
    """The part of the settlement that cells miss which grow to 0.6 of the soil's depth, beside fine ones throughout
    (test_automatic_mesh). Soil so thin that nothing settles has nothing to miss.
    """
    if fine.deepest == 0.0:
        return 0.0
    return GRADED + max(0.0, 1.0 - on_mesh.deepest / fine.deepest)


def excess_of_sections(bending: float, width: float, depth: float) -> float:
    """Part by which a pipe that bends within a length settles more on sections than on a block [m].

    A strip load that varies as cos(x/bending) settles q/(pi E*) (2 ln(4 bending/width) + 2 - 2·0.5772) on a half space,
    by stress along it too, and on sections as a uniform one, see `settlement` (M. A. Biot, Bending of an infinite
    beam on an elastic foundation, J. Appl. Mech. 4 (1937), from memory). Within 5 % of a block, see
    test_sections_against_block.
    """
    return float(max(0.0, np.log(depth / (DEEP * bending))) / (np.log(4.0 * depth / width) - 0.5))


def mesh_warnings(riser: LineAssembly) -> Iterator[str]:
    """Warnings about the soil's mesh and block, each with its numbers."""
    yield from _cells_against_contact(riser)
    yield from _lengths_against_bending(riser)
    yield from _sections_against_bending(riser)
    yield from _oblique(riser)
    yield from _leaves_the_block(riser)


def size_in_words(mesh: GeneratedMesh) -> str:
    """The cells' size under the riser in words."""
    across = f"{mesh.across:.4g} m"
    return f"{mesh.along:.4g} m along and {across} across" if isinstance(mesh.size_at_riser, CellSizes) else across


def _key(mesh: GeneratedMesh) -> str:
    """The key of the cells' size across the riser."""
    return "size_at_riser.across" if isinstance(mesh.size_at_riser, CellSizes) else "size_at_riser"


def _generated(riser: LineAssembly) -> GeneratedMesh | None:
    """The mesh of a scene with the pipe's surface on a block of soil."""
    scene = riser.scene
    if scene.contact is None or scene.contact.at_nodes or scene.soil is None:
        return None
    return scene.soil.mesh if isinstance(scene.soil.mesh, GeneratedMesh) else None


def _cells_against_contact(riser: LineAssembly) -> Iterator[str]:
    """Cells wider than what touches: they bear the pipe as a strip of their own width would."""
    mesh, soil = _generated(riser), riser.scene.soil
    if mesh is None or soil is None:
        return
    fine, on_mesh, size = predicted_settlement(riser), predicted_settlement(riser, mesh.across), mesh.across
    if fine is not None and on_mesh is not None and missed(on_mesh, fine) > GRADED + MISSING:
        width = touching_width(riser.scales, soil.top_law)
        yield (
            f"soil.mesh.{_key(mesh)} {size:.4g} m is {size / width:.2g} times the {width:.3g} m by which the riser "
            f"touches at rest: it settles by about {1000.0 * on_mesh.deepest:.2g} mm, not by the "
            f"{1000.0 * fine.deepest:.2g} mm of fine cells; take at most {0.5 * width:.2g} m where settlement or "
            "stress in the soil matters, or mesh: auto"
        )


def _lengths_against_bending(riser: LineAssembly) -> Iterator[str]:
    """Elements of the pipe on the soil, or cells along it, longer than the soil lets the pipe bend."""
    mesh, soil = _generated(riser), riser.scene.soil
    if mesh is None or soil is None:
        return
    bending = bending_on_soil(riser.elements, soil.top_law)
    if bending == 0.0:  # chain and rope load the soil by their weight, evenly
        return
    above = _elements_above(riser)
    element = float(riser.line.length[above].max(initial=0.0))
    for what, length in (("elements of the riser over the soil", element), ("soil.mesh cells along it", mesh.along)):
        if length > LONG * bending:
            yield (
                f"{what} of {length:.4g} m are long beside the {bending:.3g} m over which the soil bends the pipe, "
                f"(4 EI/E)^(1/4): pressure and settlement vary within one; take at most {0.5 * bending:.2g} m where "
                "stress or settlement under the touchdown point matters"
            )


def _sections_against_bending(riser: LineAssembly) -> Iterator[str]:
    """Sections under a pipe that bends within a length short beside the soil's depth."""
    mesh, soil = _generated(riser), riser.scene.soil
    if mesh is None or soil is None or soil.model == "block":
        return
    assert riser.soil is not None
    bending = bending_on_soil(riser.elements, soil.top_law)
    if bending == 0.0:
        return
    depth = float(riser.soil.whole.grid.high[2] - riser.soil.whole.grid.low[2])
    excess = excess_of_sections(bending, touching_width(riser.scales, soil.top_law), depth)
    if excess > EXCESS:
        yield (
            f"soil.model: sections neglect the soil's stress along the riser: where it bends, within {bending:.3g} m "
            f"on {depth:.3g} m of soil, it settles by about {excess:.0%} more than on a block; take model: block to "
            "judge it"
        )


def _elements_above(riser: LineAssembly) -> BoolArray:
    """Elements (ne,) whose middle lies above the soil's block at first."""
    assert riser.soil is not None
    x = riser.line.to_global(riser.line.x)[:, :2]
    middle, grid = 0.5 * (x[1:] + x[:-1]), riser.soil.whole.grid
    above: BoolArray = np.all((middle >= grid.low[:2]) & (middle <= grid.high[:2]), axis=1)
    return above


def _oblique(riser: LineAssembly) -> Iterator[str]:
    """Long cells under a riser across the axes."""
    mesh, (x, y, _) = _generated(riser), np.abs(riser.line.direction)
    if mesh is not None and isinstance(mesh.size_at_riser, CellSizes) and min(x, y) > PARALLEL * max(x, y):
        yield (
            f"soil.mesh.size_at_riser.along {mesh.along:.4g} m has no effect, as the riser runs across x and y: cells "
            f"are {mesh.across:.4g} m both ways in all the plan that it covers; turn the scene until it runs along x"
        )


def _leaves_the_block(riser: LineAssembly) -> Iterator[str]:
    """A block, or the range of its fine cells, from which the touchdown point moves, by catenaries between the ends as
    they move.
    """
    assert riser.soil is not None
    forecast = riser.touchdown
    if forecast is None:
        return
    yield from _leaves_fine_cells(riser, forecast)
    low, high = riser.soil.whole.grid.low[:2], riser.soil.whole.grid.high[:2]
    beyond = np.maximum(np.maximum(low - forecast.points, forecast.points - high), 0.0).max(axis=1)
    if beyond[0] == 0.0 and beyond.max() > 0.0:
        at = forecast.points[beyond.argmax()]
        yield (
            "the touchdown point leaves the soil's block as the ends move: by statics it comes to x = "
            f"{at[0]:.5g}, y = {at[1]:.5g} m, {beyond.max():.3g} m beyond x from {low[0]:.5g} to {high[0]:.5g} m and "
            f"y from {low[1]:.5g} to {high[1]:.5g} m: enlarge soil.block, or take block: auto"
        )


def _leaves_fine_cells(riser: LineAssembly, forecast: TouchdownForecast) -> Iterator[str]:
    mesh = _generated(riser)
    if mesh is None or mesh.touchdown is None:
        return
    (low, high), axis = mesh.touchdown, int(np.argmax(np.abs(forecast.ahead)))
    at = forecast.points[:, axis]
    if at.min() < low or at.max() > high:
        yield (
            f"soil.mesh.size_at_riser.touchdown is {'xy'[axis]} from {low:.5g} to {high:.5g} m, and by statics the "
            f"touchdown point comes to {'xy'[axis]} from {at.min():.5g} to {at.max():.5g} m, where cells are longer "
            f"than {mesh.along:.4g} m: widen it, or take mesh: auto"
        )
