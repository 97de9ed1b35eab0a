"""Plausibility of seabed and soil: penalty stiffness, contact at nodes, soil out of reach or off the seabed."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.assembly.contact_laws import smoothing
from riser_soil.assembly.motions import cycle_count
from riser_soil.assembly.scales import contact_radius
from riser_soil.checks.bending_plausibility import nodes_on_ground
from riser_soil.checks.mesh_plausibility import mesh_warnings, size_in_words
from riser_soil.checks.motion_plausibility import farthest_move, top_speed
from riser_soil.core.arrays import Array
from riser_soil.scene.bathymetry import ground_height
from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import SpringSeabed
from riser_soil.scene.soil import GeneratedMesh
from riser_soil.scene.stages import DynamicStage, varying_in

# Bounds of the penalty stiffness over the soil's Young's modulus: below it hides the soil, above it costs iterations.
SOFT, STIFF = 1.0, 1e4
# Force of the rounded corner at gap zero over the riser's weight, from which the corner is more than a corner.
CORNER = 20.0
# How far the riser may come down for each metre that an end moves, and for each of its length under loads or in moving
# water.
LOWERED, DRIVEN = 5.0, 0.1
MANY_CYCLES = 10
LEAST_SUNK = 1e-6  # m: an end no deeper in the seabed lies on it
# Points of each element that are looked at, and the part of a mesh's height by which its top may miss the seabed.
POINTS, OFF_LEVEL = 20, 1e-3
# Weight over what clay bears at its surface from which small strain is warned of: V/(su D) = 1.3, an embedment of D/25.
SUNK_AT = 0.25


def ground_warnings(riser: LineAssembly) -> Iterator[str]:
    """Warnings about seabed, soil and contact, each with its numbers."""
    yield from _penalty_against_soil(riser)
    yield from _corner_against_weight(riser)
    yield from _beyond_the_grid(riser)
    yield from _ends_below(riser.scene)
    if riser.soil is not None:
        from riser_soil.checks.soil_edge import edge_warnings
        from riser_soil.checks.soil_mesh import quality_warnings

        yield from quality_warnings(riser)
        yield from edge_warnings(riser)
        yield from _nothing_below(riser)
        yield from _nodes_without_friction(riser)
        yield from _nodes_on_soil(riser)
        yield from mesh_warnings(riser)
        yield from _small_strain(riser)
        yield from _unrenewed(riser)
        yield from _top_off_the_seabed(riser)
        yield from _out_of_reach(riser)
        yield from _rate_without_effect(riser)
        yield from _forgets(riser.scene)


def _forgets(scene: Scene) -> Iterator[str]:
    """Many cycles on clay whose loops do not close."""
    cycles = sum(cycle_count(scene, stage) for stage in scene.stages)
    laws = [] if scene.soil is None else [law for law in scene.soil.laws if law.forgets_at is not None]
    if laws and cycles >= MANY_CYCLES:
        yield (
            f"soil: {laws[0].kind} lets go of a mean stress, half of it in each cycle of {laws[0].forgets_at:.2%} "
            f"shear strain, and strains on in each under a mean load; the scene has {cycles:.4g} cycles (limit "
            f"{MANY_CYCLES}): take iwan, whose loops close; riser-soil material shows both"
        )


def _beyond_the_grid(riser: LineAssembly) -> Iterator[str]:
    """Nodes of the first shape, as of a free end, above no heights of the seabed."""
    seabed = riser.scene.seabed
    if seabed is None or seabed.grid is None:
        return
    line, heights = riser.line, seabed.grid.heights
    beyond = [s for s, x in zip(line.arc, line.to_global(line.x), strict=True) if not heights.holds(x[0], x[1])]
    if beyond:
        yield (
            f"seabed.grid: {len(beyond)} nodes of the riser's first shape, from arc {beyond[0]:.4g} to "
            f"{beyond[-1]:.4g} m, lie beyond the grid, {heights.extent}, where the seabed goes straight on: take a "
            "grid that reaches farther"
        )


def _ends_below(scene: Scene) -> Iterator[str]:
    """Ends below a seabed of springs."""
    if not isinstance(scene.seabed, SpringSeabed) or scene.contact is None:
        return
    for key, end in (("start", scene.line.start), ("end", scene.line.end)):
        sunk = ground_height(scene, end.position) - end.position[2] if isinstance(end, Support) else 0.0
        if sunk > LEAST_SUNK:
            yield (
                f"riser.{key}.position: lies {sunk:.4g} m below the seabed: the riser is laid from there, and the "
                f"seabed's springs push it up by {1e-3 * scene.seabed.stiffness * sunk:.4g} kN/m at the end; if that "
                "is not meant, correct the end's z or the seabed's level"
            )


def _nothing_below(riser: LineAssembly) -> Iterator[str]:
    """Nodes that lie beyond the soil where there is no seabed beside it."""
    assert riser.soil is not None
    grid, nodes = riser.soil.whole.grid, nodes_on_ground(riser)
    xy = riser.line.to_global(riser.line.x)[nodes, :2]
    beyond = riser.line.arc[nodes[np.any((xy < grid.low[:2]) | (xy > grid.high[:2]), axis=1)]]
    if riser.scene.seabed is None and nodes.size > 1 and beyond.size:
        yield (
            f"{beyond.size} nodes of the riser, from arc {beyond[0]:.4g} to {beyond[-1]:.4g} m, lie beyond the soil, "
            "where nothing bears them: add seabed, which acts beside the soil, or enlarge the soil"
        )


def _nodes_without_friction(riser: LineAssembly) -> Iterator[str]:
    settings = riser.scene.contact
    if settings is None or not settings.at_nodes:
        return
    for key in ("friction", "suction"):
        if getattr(settings, key) is not None:
            yield (
                f"contact.{key} acts on the seabed only: on the soil, {_extent(riser)}, the riser's nodes have no "
                f"{key}; leave out contact.method: node"
            )


def _nodes_on_soil(riser: LineAssembly) -> Iterator[str]:
    """Contact at nodes, whose settlement converges to nothing as cells and elements are refined."""
    scene = riser.scene
    if scene.contact is None or not scene.contact.at_nodes or scene.soil is None:
        return
    mesh = scene.soil.mesh
    cells = f"cells of {size_in_words(mesh)}" if isinstance(mesh, GeneratedMesh) else "the mesh's cells"
    yield (
        f"the pipe, D = {_diameter(riser):.4g} m, touches the soil at its nodes only, "
        f"{riser.line.length.min():.4g} m apart, on {cells}: its settlement, the soil's stress and whether it "
        "yields depend on these two sizes; contact.method: surface lets it touch all along"
    )


def _small_strain(riser: LineAssembly) -> Iterator[str]:
    """Soil that yields at small strain under a pipe that it bears only on its strength."""
    scene = riser.scene
    if scene.soil is None or scene.soil.is_linear or scene.soil_moves:
        return
    bearing, weight = scene.soil.top_law.bearing(_diameter(riser)), riser.scales.weight
    if bearing is not None and weight > SUNK_AT * bearing.capacity:
        yield (
            f"the soil is computed at small strain, and the riser's weight, {weight:.4g} N/m, is "
            f"{weight / bearing.capacity:.0%} of the {bearing.capacity:.4g} N/m that its clay bears at the surface "
            f"(limit {SUNK_AT:.0%}): it sinks in by more than small strain follows, and is borne too little; take "
            "soil.strain: large and contact.method: surface"
        )


def _unrenewed(riser: LineAssembly) -> Iterator[str]:
    """Cells that move and are not made anew."""
    if riser.scene.soil_moves and riser.soil is not None and riser.soil.mesh_renewal is None:
        yield (
            "the soil's cells move with it, and under contact at nodes get no new mesh on the way: a run ends where "
            "one folds, as where the pipe sinks in by some 0.3 diameters; take contact.method: surface"
        )


def _top_off_the_seabed(riser: LineAssembly) -> Iterator[str]:
    """A mesh whose top is nowhere at the seabed; known where the soil's surface is."""
    assert riser.soil is not None
    z, level = riser.soil.whole.surface.points[:, 2], riser.scene.seabed_level
    near = OFF_LEVEL * float(riser.soil.whole.grid.high[2] - riser.soil.whole.grid.low[2])
    if z.size and not z.min() - near <= level <= z.max() + near:
        yield (
            f"soil.mesh: the soil's top lies {z.min():.5g} to {z.max():.5g} m high and nowhere at the seabed, z = "
            f"{level:.5g} m, from where its depth, stress and strength are counted: move the mesh, or seabed.level"
        )


def _out_of_reach(riser: LineAssembly) -> Iterator[str]:
    """Soil that the first shape is farther above than the ends' motions, loads and water may lower it."""
    assert riser.soil is not None
    scene, grid = riser.scene, riser.soil.whole.grid
    points, underside = _along(riser)
    above = np.all((points[:, :2] >= grid.low[:2]) & (points[:, :2] <= grid.high[:2]), axis=1)
    gap = float(np.min((underside - scene.seabed_level)[above], initial=np.inf))
    moved = farthest_move(riser)
    reach = LOWERED * moved + DRIVEN * scene.line.length * _driven(scene) + 2.0 * _diameter(riser)
    if gap <= reach:
        return
    where = f"hangs {gap:.4g} m above it" if np.isfinite(gap) else "is not above it"
    down = points[underside.argmin()]
    yield (
        f"the riser does not reach the soil, {_extent(riser)}: in its first shape it {where}, and its ends move by "
        f"no more than {moved:.4g} m; it is lowest at x = {down[0]:.5g}, y = {down[1]:.5g} m: move the soil there"
    )


def _driven(scene: Scene) -> bool:
    """Whether more moves the riser than its ends."""
    water = scene.water is not None and (scene.water.current is not None or scene.water.waves is not None)
    return water or any(map(varying_in, scene.stages))


def _rate_without_effect(riser: LineAssembly) -> Iterator[str]:
    """A reference rate of shear beyond that of the fastest end over the diameter, where ends alone move."""
    scene = riser.scene
    assert scene.soil is not None
    reference, dynamic = scene.soil.reference_rate, [s for s in scene.stages if isinstance(s, DynamicStage)]
    if reference is None:
        return
    if not dynamic:
        yield "soil.law.rate: static stages are slow and the scene has no other: it changes nothing; leave it out"
    elif not _driven(scene):
        fastest = top_speed(riser) / _diameter(riser)
        if fastest < reference:
            yield (
                f"soil.law.rate: the reference, {reference:.3g} 1/s, is more than the fastest end makes over a "
                f"diameter, {fastest:.3g} 1/s: clay gains next to nothing; check its unit, 1 % an hour is 2.8e-6 1/s"
            )


def _along(riser: LineAssembly) -> tuple[Array, Array]:
    """Points (n, 3) of the line, straight between its nodes, and the height of its underside there (n,)."""
    line = riser.line
    share = np.linspace(0.0, 1.0, POINTS)[:, None]
    x = line.to_global(line.x)
    points = (x[:-1, None] + share * np.diff(x, axis=0)[:, None]).reshape(-1, 3)
    return points, points[:, 2] - np.repeat(contact_radius(riser.scene, riser.elements), POINTS)


def _diameter(riser: LineAssembly) -> float:
    return float(riser.elements.outer_diameter.max())


def _extent(riser: LineAssembly) -> str:
    assert riser.soil is not None
    (x0, y0, _), (x1, y1, _) = riser.soil.whole.grid.low, riser.soil.whole.grid.high
    return f"x from {x0:.5g} to {x1:.5g} m and y from {y0:.5g} to {y1:.5g} m"


def _penalty_against_soil(riser: LineAssembly) -> Iterator[str]:
    if riser.scene.soil is None:
        return
    E = riser.scene.soil.top_law.surface_modulus(riser.scales.diameter)
    k = riser.contact_stiffness["soil"]
    if k < SOFT * E:
        yield (
            f"contact.stiffness {k:.4g} N/m2 is below the soil's Young's modulus at the surface, {E:.4g} Pa: the pipe "
            f"sinks through the penalty, not into the soil; take at least {10.0 * E:.4g} N/m2 or auto"
        )
    if k > STIFF * E:
        yield (
            f"contact.stiffness {k:.4g} N/m2 is {k / E:.2g} times the soil's Young's modulus at the surface, "
            f"{E:.4g} Pa: no more accurate than a tenth of that, and Newton needs more iterations; take auto"
        )


def _corner_against_weight(riser: LineAssembly) -> Iterator[str]:
    """A stiff penalty rounded over a long way pushes hard before anything touches."""
    settings, weight = riser.scene.contact, riser.scales.weight
    if settings is None:
        return
    for ground, k in riser.contact_stiffness.items():
        width = smoothing(settings, riser.scales, ground, k)
        force = 0.25 * k * width
        if force > CORNER * weight:
            yield (
                f"contact on the {ground} pushes {force:.4g} N/m at the moment of touching, {force / weight:.2g} "
                f"times the riser's weight, as its stiffness of {k:.4g} N/m2 is rounded over contact.smoothing = "
                f"{width:g} m: take at most {4.0 * weight / k:.2g} m, or a lower stiffness"
            )
