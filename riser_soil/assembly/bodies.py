"""Bodies that carry hydrodynamic loads: the pipe, and the buoyancy modules and clump weights on it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.sea.morison_law import added_masses, drag_coefficients
from riser_soil.sea.pipe import Pipe, alike, diameters, pipe_at

if TYPE_CHECKING:
    from riser_soil.riser.attachments import PointAttachment
    from riser_soil.sea.buoyancy import Dry
    from riser_soil.sea.reynolds_drag import ReynoldsTables
    from riser_soil.sea.vortex_law import Shedding


@dataclass(frozen=True)
class Body(ABC):
    """A body on the line in water of density rho [kg/m3], at stations (ne, ng); forces and masses are per length,
    those of single modules as they are.
    """

    rho: float
    line: Line

    @property
    @abstractmethod
    def pipe(self) -> Pipe:
        """Its stations."""

    @property
    @abstractmethod
    def drags(self) -> bool:
        """Whether it has drag."""

    @property
    @abstractmethod
    def adds_mass(self) -> bool:
        """Whether it has added mass."""

    @property
    def shedding(self) -> dict[bool, Shedding]:
        """Its vortices, by whether they push in line with the flow; empty where there are none."""
        return {}

    @property
    def reynolds(self) -> ReynoldsTables | None:
        """Its drag by Reynolds's number, where it has any."""
        return None

    @property
    @abstractmethod
    def drag(self) -> Array:
        """Coefficients of drag (ne, 2), normal and tangential, see `MovingWaterData`."""

    @property
    @abstractmethod
    def mass(self) -> Array:
        """Added mass (ne, 2), normal and tangential."""

    @property
    @abstractmethod
    def displaced(self) -> Array:
        """Mass of the water in its place (ne,)."""

    @property
    @abstractmethod
    def span(self) -> Array:
        """Widths (ne, ng) [m] of the sections that get wet."""

    @abstractmethod
    def dry(self, gravity: float) -> Dry:
        """Its lost buoyancy where it is dry."""


@dataclass(frozen=True)
class PipeInWater(Body):
    """The pipe."""

    elements: Elements
    tables: ReynoldsTables | None = None

    @cached_property
    def pipe(self) -> Pipe:
        return Pipe(self.line)

    @property
    def drags(self) -> bool:
        return bool(self.elements.drag.any()) or self.tables is not None

    @property
    def adds_mass(self) -> bool:
        return bool(self.elements.added_mass.any())

    @property
    def reynolds(self) -> ReynoldsTables | None:
        return self.tables

    @property
    def shedding(self) -> dict[bool, Shedding]:
        given = {False: self.elements.vortices, True: self.elements.in_line_vortices}
        return {in_line: self._shedding(values) for in_line, values in given.items() if values[:, 0].any()}

    def _shedding(self, given: Array) -> Shedding:
        from riser_soil.sea.vortex_law import Shedding

        (coefficient, middle, width), diameter = given.T.copy(), self.elements.outer_diameter
        return Shedding(0.5 * self.rho * diameter * coefficient, diameter, middle, width)

    @property
    def drag(self) -> Array:
        return drag_coefficients(self.rho, self.elements.outer_diameter, *self.elements.drag.T)

    @cached_property
    def mass(self) -> Array:
        return added_masses(self.rho, self.elements.outer_diameter, *self.elements.added_mass.T)

    @property
    def displaced(self) -> Array:
        return np.asarray(self.rho * 0.25 * np.pi * self.elements.outer_diameter**2)

    @property
    def span(self) -> Array:
        return self.pipe.span

    def dry(self, gravity: float) -> Dry:
        from riser_soil.sea.buoyancy import dry_pipe

        return dry_pipe(gravity * self.displaced)


@dataclass(frozen=True)
class ModulesInWater(Body):
    """Modules, each with a volume or a drag area."""

    modules: Sequence[PointAttachment]

    @cached_property
    def pipe(self) -> Pipe:
        return pipe_at(self.line, self.modules)

    @property
    def drags(self) -> bool:
        return any(module.drag_area for module in self.modules)

    @property
    def adds_mass(self) -> bool:
        return any(module.added_mass for module in self.modules)

    @property
    def drag(self) -> Array:
        return alike(0.5 * self.rho * self._of("drag_area"))

    @cached_property
    def mass(self) -> Array:
        return alike(self._of("added_mass") * self.displaced)

    @property
    def displaced(self) -> Array:
        return self.rho * self._of("volume")

    @property
    def span(self) -> Array:
        return diameters(self.modules)[:, None]

    def dry(self, gravity: float) -> Dry:
        from riser_soil.sea.buoyancy import dry_stations

        return dry_stations(self.span, gravity * self.displaced)

    def _of(self, name: str) -> Array:
        return np.array([getattr(module, name) for module in self.modules], dtype=float)
