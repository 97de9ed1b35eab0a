"""Automatic cells of a scene, so many times as large."""

from __future__ import annotations

from riser_soil.assembly import sized
from riser_soil.scene.scene import Scene
from riser_soil.scene.soil import CellSizes, GeneratedMesh


def scaled(scene: Scene, across: float = 1.0, along: float = 1.0) -> Scene:
    """The scene with its automatic cells so many times as large across, and downwards, and along."""
    scene = sized(scene)
    assert scene.soil is not None
    mesh = scene.soil.mesh
    assert isinstance(mesh, GeneratedMesh)
    given = mesh.size_at_riser
    assert isinstance(given, CellSizes)
    sizes = CellSizes(along=along * given.along, across=across * given.across, strip=given.strip)
    mesh = mesh.model_copy(update={"size_at_riser": sizes, "size_far": across * mesh.size_far})
    return scene.model_copy(update={"soil": scene.soil.model_copy(update={"mesh": mesh})})
