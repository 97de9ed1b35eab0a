"""Assembly of the hydrodynamic loads: Morison loads and buoyancy at the surface, as far as the scene has them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from riser_soil.assembly.bodies import Body, ModulesInWater, PipeInWater
from riser_soil.assembly.sea import StageWater
from riser_soil.core.arrays import Array
from riser_soil.core.part import Part
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.scene.scene import Scene
from riser_soil.scene.water import Water
from riser_soil.sea.morison import Morison, in_sea, in_still_water, pushed_masses
from riser_soil.sea.stream_kernels import FlowAtStations

NO_DRAG = ((1.0, 0.0),)

if TYPE_CHECKING:
    from riser_soil.riser.attachments import PointAttachment
    from riser_soil.sea.buoyancy import Buoyancy
    from riser_soil.sea.reynolds_drag import ReynoldsTables
    from riser_soil.sea.vortex_law import Shedding
    from riser_soil.sea.vortices import Vortices


def sea_loads(
    scene: Scene,
    water: StageWater,
    line: Line,
    elements: Elements,
    attachments: Sequence[PointAttachment] = (),
) -> list[Part]:
    """The parts "morison", "vortices", "vortices in line" and "buoyancy" of a stage, of the pipe and its modules."""
    density = water.given.density
    bodies: list[Body] = [PipeInWater(density, line, elements, tables_of(scene, water.given, elements))]
    modules = [attachment for attachment in attachments if attachment.volume or attachment.drag_area]
    if modules:
        bodies.append(ModulesInWater(density, line, modules))
    return [part for body in bodies for part in _BodyLoads(water, body).parts()]


def tables_of(scene: Scene, water: Water, elements: Elements) -> ReynoldsTables | None:
    """Drag by Reynolds's number; None where no line type has it."""
    drags = {name: line.drag for name, line in scene.used_line_types.items()}
    rows = {name: drag.by_reynolds for name, drag in drags.items() if drag is not None and drag.by_reynolds}
    if not rows:
        return None
    from riser_soil.sea import reynolds_drag

    of_each = [rows.get(s.line_type) or NO_DRAG for s in scene.line.segments for _ in range(s.element_count)]
    return reynolds_drag.tables_of(water.density, water.kinematic_viscosity, elements.outer_diameter, of_each)


@dataclass(frozen=True)
class _BodyLoads:
    """Hydrodynamic loads on a body in a stage."""

    water: StageWater
    body: Body

    def parts(self) -> Iterator[Part]:
        if self.act:
            yield self.morison
            if (tables := self.body.reynolds) is not None:
                yield self._reynolds_drag(tables)
        if self.water.is_dynamic:
            yield from (self._vortices(shedding, in_line) for in_line, shedding in self.body.shedding.items())
        if self.water.has_surface:
            yield self.buoyancy

    @property
    def act(self) -> bool:
        """Whether the water does more than carry: in motion, or in a stage in which the riser moves."""
        if self.water.is_dynamic:
            return self.body.drags or self.body.adds_mass or self.water.accelerates
        return self.body.drags and self.water.moves

    @cached_property
    def _flow(self) -> FlowAtStations:
        """The water at the body's stations; it may stand still."""
        return FlowAtStations(self.body.pipe, self.water.flow)

    @property
    def morison(self) -> Morison:
        body, still = self.body, not self.water.moves
        if still and not self.water.has_surface and not body.pipe.points_alone:
            return in_still_water(body.pipe, body.drag, body.mass)
        pushed = pushed_masses(body.mass, body.displaced) if self.water.accelerates else None
        return in_sea(self._flow, body.drag, body.mass, pushed, self._span, dissipative=still)

    @property
    def _span(self) -> Array | None:
        """Widths of the sections that get dry; None where the water has no surface."""
        return self.body.span if self.water.has_surface else None

    def _reynolds_drag(self, tables: ReynoldsTables) -> Morison:
        from riser_soil.sea.reynolds_drag import reynolds_drag

        return reynolds_drag(self._flow, tables, self._span, dissipative=not self.water.moves)

    def _vortices(self, shedding: Shedding, in_line: bool) -> Vortices:
        from riser_soil.sea.vortices import Vortices

        return Vortices(self._flow, shedding, in_line, self._span)

    @property
    def buoyancy(self) -> Buoyancy:
        from riser_soil.sea.buoyancy import Buoyancy

        return Buoyancy(self._flow, self.body.dry(self.water.sea.scene.gravity), flat=not self.water.has_waves)
