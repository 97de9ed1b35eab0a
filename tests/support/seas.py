"""The water of a scene, drawn by itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

from riser_soil.assembly.sea import sea_of
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Stage

if TYPE_CHECKING:  # what a scene lacks is not imported
    from riser_soil.sea.components import Components
    from riser_soil.sea.flows import Sea


def water_of(scene: Scene, stage: Stage) -> Sea | None:
    """The water in a stage; None where nothing moves and there is no surface."""
    sea = sea_of(scene)
    return None if sea is None else sea.in_stage(stage).flow


def components_of(scene: Scene) -> Components | None:
    """The components of the waves; None without waves."""
    sea = sea_of(scene)
    return None if sea is None or sea.waves is None else sea.waves.components
