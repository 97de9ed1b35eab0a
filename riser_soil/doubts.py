"""Physical doubts about a scene as it is built, each with its numbers and a remedy."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from riser_soil.arrays import IntArray
from riser_soil.build import World
from riser_soil.build.ground import smoothing
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage

# Elements longer than this share of the boundary layer sqrt(EI/H) blur the bending at touchdown and fixed ends.
LONGEST_ELEMENT = 0.5
# Ratio of neighbouring elements' lengths from which the joint may reflect waves. Static errors don't mind: with ratios
# up to 16 they are those of the longer elements alone. A wave needs some elements.
UNEVEN, WAVE_IN_ELEMENTS = 4.0, 6.0
# Bounds of the penalty stiffness over the soil's Young's modulus: below it hides the soil, above it costs iterations.
SOFT, STIFF = 1.0, 1e4
# Force of the rounded corner at gap zero over the riser's weight, from which the corner is more than a corner.
CORNER = 20.0


def physical_warnings(world: World) -> Iterator[str]:
    """What a riser engineer would question, each with its numbers; collective."""
    yield from _light_pipes(world)
    yield from _coarse_elements(world)
    yield from _uneven_neighbours(world)
    yield from _penalty_against_soil(world)
    yield from _corner_against_weight(world)
    yield from _nothing_below(world)
    yield from _beyond_the_rao(world)
    if world.scene.water is not None and world.scene.water.waves is not None:
        from riser_soil.wave_doubts import wave_doubts

        yield from wave_doubts(world.scene)
    if _swings(world.scene):
        from riser_soil.motion_doubts import motion_doubts

        yield from motion_doubts(world.scene)


def _swings(scene: Scene) -> bool:
    """Whether ends move or waves come in a dynamic stage."""
    waves = scene.water is not None and scene.water.waves is not None
    stages = [stage for stage in scene.stages if isinstance(stage, DynamicStage)]
    return any(waves or stage.motion is not None for stage in stages)


def _light_pipes(world: World) -> Iterator[str]:
    weight, arc = world.elements.weight, world.line.arc
    light = np.flatnonzero(weight < 0.0)
    if light.size:
        yield (
            f"submerged weight is negative, {weight[light].min():.4g} N/m, from arc {arc[light[0]]:.4g} m on: the "
            "pipe floats; check mass, contents and diameters, or give submerged_weight"
        )


def _coarse_elements(world: World) -> Iterator[str]:
    """Elements beside a touchdown point or a held rotation against the boundary layer there."""
    if world.catenary is None:
        return
    H, line = world.catenary.H, world.line
    layer = np.sqrt(np.maximum(world.elements.EI_y, world.elements.EI_z) / H)
    for place, e in _boundary_layers(world):
        if line.length[e] > LONGEST_ELEMENT * layer[e]:
            yield (
                f"elements {place} are {line.length[e]:.4g} m long, but bending varies there over sqrt(EI/H) = "
                f"{layer[e]:.4g} m (H = {H:.4g} N): take at most {LONGEST_ELEMENT * layer[e]:.3g} m"
            )


def _uneven_neighbours(world: World) -> Iterator[str]:
    length, arc = world.line.length, world.line.arc
    ratio = np.maximum(length[1:] / length[:-1], length[:-1] / length[1:])
    moves = any(stage.kind == "dynamic" for stage in world.scene.stages)
    if moves and ratio.size and ratio.max() > UNEVEN * (1.0 + 1e-9):
        e = int(ratio.argmax())
        shortest = WAVE_IN_ELEMENTS * max(length[e : e + 2])
        yield (
            f"elements of {length[e]:.4g} m and {length[e + 1]:.4g} m meet at arc {arc[e + 1]:.4g} m: waves shorter "
            f"than about {shortest:.3g} m, too short for the longer ones, are thrown back there; let the lengths grow, "
            "element_length: [first, last]"
        )


def _boundary_layers(world: World) -> Iterator[tuple[str, int]]:
    """Where bending has boundary layers in the first shape, each with an element of the line."""
    line = world.line
    if line.start.rotation_fixed:
        yield "at the start", 0
    if line.end.rotation_fixed:
        yield "at the end", line.length.size - 1
    lying = _lying(world)
    if lying.size > 1:
        yield f"at the touchdown point (arc {line.arc[lying[-1]]:.4g} m)", min(int(lying[-1]), line.length.size - 1)


def _lying(world: World) -> IntArray:
    """Nodes that lie on the ground in the first shape."""
    heights = world.line.to_global(world.line.x)[:, 2]
    lowest = heights.min() + 1e-6 * world.line.arc[-1]
    return np.flatnonzero(heights < lowest) if world.contacts else np.zeros(0, dtype=np.int64)


def _nothing_below(world: World) -> Iterator[str]:
    """Nodes that lie beyond the soil where there is no seabed beside it."""
    if world.soil is None or world.scene.seabed is not None:
        return
    grid, lying = world.soil.grid, _lying(world)
    xy = world.line.to_global(world.line.x)[lying, :2]
    beyond = world.line.arc[lying[np.any((xy < grid.low[:2]) | (xy > grid.high[:2]), axis=1)]]
    if lying.size > 1 and beyond.size:
        yield (
            f"{beyond.size} nodes of the riser, from arc {beyond[0]:.4g} to {beyond[-1]:.4g} m, lie beyond the soil, "
            "where nothing bears them: add seabed, which acts beside the soil, or enlarge the soil"
        )


def _beyond_the_rao(world: World) -> Iterator[str]:
    """Waves outside the frequencies of a vessel's table."""
    for path, beyond in (world.vessels.beyond if world.vessels is not None else {}).items():
        yield (
            f"{path}: {100.0 * beyond.below:.3g} % of the waves' energy lies below the table's first frequency, "
            f"{beyond.first:.4g} rad/s, where the vessel moves as there, and {100.0 * beyond.above:.3g} % above its "
            f"last, {beyond.last:.4g} rad/s, where it doesn't move: by the table's ends that is little; longer tables "
            "would tell"
        )


def _penalty_against_soil(world: World) -> Iterator[str]:
    if world.scene.soil is None:
        return
    E, k = world.scene.soil.law.surface_modulus, world.contact_stiffness["soil"]
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


def _corner_against_weight(world: World) -> Iterator[str]:
    """A stiff penalty rounded over a long way pushes hard before anything touches."""
    settings = world.scene.contact
    if settings is None:
        return
    for ground, k in world.contact_stiffness.items():
        width = smoothing(settings, world, ground)
        force = 0.25 * k * width
        if force > CORNER * world.weight:
            yield (
                f"contact on the {ground} pushes {force:.4g} N/m at the moment of touching, {force / world.weight:.2g} "
                f"times the riser's weight, as its stiffness of {k:.4g} N/m2 is rounded over contact.smoothing = "
                f"{width:g} m: take at most {4.0 * world.weight / k:.2g} m, or a lower stiffness"
            )
