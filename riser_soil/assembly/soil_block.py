"""Assembly of the soil block: its extent and the sizes of its cells."""

from __future__ import annotations

from riser_soil.scene.scene import Scene
from riser_soil.scene.soil import Block, GeneratedMesh, SoilScene
from riser_soil.scene.soil_layers import boundaries
from riser_soil.soil.grading import BlockSpec, Point


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
        strip=soil.mesh.strip,
        boundaries=boundaries(soil.layers or ()),
    )
