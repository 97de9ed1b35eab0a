"""Loads of the water on the riser, as far as the scene has them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.arrays import Array
from riser_soil.build.sea import water_of
from riser_soil.part import Part
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage
from riser_soil.scene.water import Water

if TYPE_CHECKING:
    from riser_soil.sea.buoyancy import Buoyancy
    from riser_soil.sea.morison import Morison
    from riser_soil.sea.moving_water import Stream
    from riser_soil.sea.pipe import Pipe
    from riser_soil.sea.still_water import StationLoads, StillWater
    from riser_soil.sea.wetting import Wetting


def sea_loads(scene: Scene, line: Line, elements: Elements, stage: Stage) -> list[Part]:
    """The parts "morison" and "buoyancy" of a stage."""
    if scene.water is None:
        return []
    sea = _Loads(scene, scene.water, line, elements, stage)
    return [*([sea.morison] if sea.act else []), *([sea.buoyancy] if sea.wetting is not None else [])]


@dataclass(frozen=True)
class _Loads:
    """What the water of a scene does to its riser in a stage."""

    scene: Scene
    water: Water
    line: Line
    elements: Elements
    stage: Stage

    @property
    def act(self) -> bool:
        """Whether the water does more than carry: in motion, or in a stage in which the riser moves."""
        drag, added_mass = bool(self.elements.drag.any()), bool(self.elements.added_mass.any())
        if isinstance(self.stage, DynamicStage):
            return drag or added_mass or self.waves
        return drag and self.water.current is not None

    @property
    def waves(self) -> bool:
        return self.water.waves is not None and isinstance(self.stage, DynamicStage)

    @cached_property
    def pipe(self) -> Pipe:
        from riser_soil.sea.pipe import Pipe

        return Pipe(self.line)

    @property
    def displaced(self) -> Array:
        """Mass of the water in the pipe's place [kg/m] (ne,)."""
        return np.asarray(self.water.density * 0.25 * np.pi * self.elements.outer_diameter**2)

    @cached_property
    def stream(self) -> Stream | None:
        """Water that moves."""
        if self.water.current is None and not self.waves:
            return None
        from riser_soil.sea.moving_water import Stream

        water = water_of(self.scene, self.stage)
        assert water is not None
        return Stream(self.pipe, water)

    @cached_property
    def wetting(self) -> Wetting | None:
        """Where the water has a surface; it is level without waves."""
        if self.water.surface_level is None:
            return None
        from riser_soil.sea.wetting import FlatSurface, Wetting

        surface = self.stream if self.waves else None
        return Wetting(self.pipe, surface or FlatSurface(self.pipe, self.water.surface_level))

    @property
    def morison(self) -> Morison:
        from riser_soil.sea.morison import Morison

        return Morison(self.pipe, self._at_stations())

    def _at_stations(self) -> StationLoads:
        """Each thing that the water has adds to what is there without it."""
        from riser_soil.sea.morison_law import added_masses, drag_coefficients
        from riser_soil.sea.still_water import StillWater

        rho, D = self.water.density, self.elements.outer_diameter
        mass = added_masses(rho, D, *self.elements.added_mass.T)
        still = StillWater(self.pipe, drag_coefficients(rho, D, *self.elements.drag.T), mass)
        loads = self._in_motion(still, mass) if self.stream is not None else still
        if self.wetting is None:
            return loads
        from riser_soil.sea.wetting import PartlyWet

        return PartlyWet(loads, self.wetting)

    def _in_motion(self, still: StillWater, mass: Array) -> StationLoads:
        from riser_soil.sea.moving_water import AcceleratedWater, RelativeDrag

        assert self.stream is not None
        drag = RelativeDrag(still, self.stream)
        return AcceleratedWater(drag, self.stream, mass, self.displaced) if self.waves else drag

    @property
    def buoyancy(self) -> Buoyancy:
        from riser_soil.sea.buoyancy import Buoyancy

        assert self.wetting is not None
        return Buoyancy(self.pipe, self.wetting, self.scene.gravity * self.displaced, flat=not self.waves)
