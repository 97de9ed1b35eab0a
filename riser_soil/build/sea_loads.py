"""Loads of the water on the riser, as far as the scene has them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from riser_soil.build.sea import water_of
from riser_soil.part import Part
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage

if TYPE_CHECKING:
    from riser_soil.sea.moving_water import Stream
    from riser_soil.sea.pipe import Pipe
    from riser_soil.sea.still_water import StationLoads
    from riser_soil.sea.wetting import Wetting


def sea_loads(scene: Scene, line: Line, elements: Elements, stage: Stage) -> list[Part]:
    """The parts "morison" and "buoyancy" of a stage."""
    if scene.water is None or not (loaded(scene, elements, stage) or scene.water.surface_level is not None):
        return []
    from riser_soil.sea.pipe import Pipe

    pipe = Pipe(line)
    stream, waves = _stream(scene, pipe, stage), _waves_act(scene, stage)
    wetting = _wetting(scene, pipe, stream if waves else None)
    displaced = scene.water.density * 0.25 * np.pi * elements.outer_diameter**2
    parts: list[Part] = []
    if loaded(scene, elements, stage):
        from riser_soil.sea.morison import Morison

        parts.append(Morison(pipe, _station_loads(scene, pipe, elements, stage)))
    if wetting is not None:
        from riser_soil.sea.buoyancy import Buoyancy

        parts.append(Buoyancy(pipe, wetting, scene.gravity * displaced, flat=not waves))
    return parts
