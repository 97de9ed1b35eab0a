"""Assembly of the soil block: its extent and the sizes of its cells."""

from __future__ import annotations

from typing import assert_never

from riser_soil.scene.plane import resolved_dimension, vertical_plane
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed_features import Groove, Trench
from riser_soil.scene.soil import Block, GeneratedMesh, SoilScene
from riser_soil.scene.soil_layers import boundaries
from riser_soil.soil.grading import BlockSpec, Point
from riser_soil.soil.seabed_feature import FeatureSpec, GrooveSpec, TrenchSpec

ZERO = 1e-9  # slopes in plan, and distances over the block's width, below which they count as zero


def block_of(scene: Scene, soil: SoilScene, riser: tuple[Point, Point]) -> BlockSpec:
    """A block that is fine under a line; riser: two points of it in plan [m]."""
    assert isinstance(soil.block, Block)  # the scene's checks have seen to it, and `with_sizes`
    assert isinstance(soil.mesh, GeneratedMesh)
    return BlockSpec(
        x=soil.block.x,
        y=soil.block.y,
        depth=soil.block.depth,
        size_at_riser=soil.mesh.across,
        size_far=soil.mesh.size_far,
        level=scene.seabed_level,
        kind=soil.mesh.kind,
        riser=riser,
        along=soil.mesh.along,
        touchdown=soil.mesh.touchdown if soil.model == "block" else None,
        strip=soil.mesh.strip,
        boundaries=boundaries(soil.layers or ()),
        feature=_feature_of(scene, soil.block),
        half=not why_all(scene, soil),
    )


def why_all(scene: Scene, soil: SoilScene) -> str:
    """Why all of the soil is computed; empty where half is, as it and the riser are symmetric about the riser's plane.
    Sizes are chosen.
    """
    plane = vertical_plane(scene)
    across = int(abs(plane.direction[1]) < abs(plane.direction[0]))
    if soil.symmetry == "whole":
        return "soil.symmetry is whole"
    if soil.forms is not None:
        return "terms of soil.forms may not be symmetric"
    if not isinstance(soil.mesh, GeneratedMesh) or soil.mesh.kind != "hex":
        return "it is no block of hexahedra"
    if soil.is_linear:
        return "it is linear, and may be condensed"
    if resolved_dimension(scene) == 3 and scene.line.across is None:
        return "the riser moves in three dimensions"
    if abs(plane.direction[across]) > ZERO:
        return "the riser runs across x and y"
    assert isinstance(soil.block, Block)
    low, high = (soil.block.x, soil.block.y)[across]
    if abs(0.5 * (low + high) - plane.origin[across]) > ZERO * (high - low):
        return f"the riser does not lie in the middle of soil.block.{'xy'[across]}"
    return ""


def _feature_of(scene: Scene, block: Block) -> FeatureSpec | None:
    match block.feature:
        case Trench() as trench:
            ramp = trench.run_out or trench.side
            return TrenchSpec(trench.depth, trench.width, trench.side, trench.along, ramp)
        case Groove() as groove:
            diameter = groove.diameter or scene.largest_diameter
            return GrooveSpec(groove.embedment * diameter, 0.5 * diameter)
        case None:
            return None
        case _:
            assert_never(block.feature)
