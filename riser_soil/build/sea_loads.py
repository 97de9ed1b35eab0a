"""Loads of the water on the riser, as far as the scene has them."""

from __future__ import annotations

from riser_soil.part import Part
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Stage


def sea_loads(scene: Scene, line: Line, elements: Elements, stage: Stage) -> list[Part]:
    """The parts "morison" and "buoyancy" of a stage."""
    if scene.water is None or stage.kind == "static" or not (elements.drag.any() or elements.added_mass.any()):
        return []
    from riser_soil.sea import morison_law
    from riser_soil.sea.morison import Morison
    from riser_soil.sea.pipe import Pipe
    from riser_soil.sea.still_water import StillWater

    rho, D, pipe = scene.water.density, elements.outer_diameter, Pipe(line)
    drag = morison_law.drag_coefficients(rho, D, *elements.drag.T)
    return [Morison(pipe, StillWater(pipe, drag, morison_law.added_masses(rho, D, *elements.added_mass.T)))]
