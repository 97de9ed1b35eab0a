"""What belongs to one line of an assembly: its parts in all stages, its ground, and where its ends are."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly.motions import EndPlaces, end_places, end_positions, set_motions, vessels_of
from riser_soil.assembly.riser import (
    attached_weight,
    attachments_of,
    elements_of,
    line_of,
    pressures_of,
    spins_freely,
    springs_of,
)
from riser_soil.assembly.scales import Scales, scales_of
from riser_soil.assembly.sea import SeaAssembly
from riser_soil.assembly.shape import least_bend
from riser_soil.assembly.stage import loads_on_line
from riser_soil.assembly.touchdown_forecast import TouchdownForecast, forecast
from riser_soil.core.arrays import Array
from riser_soil.core.part import Part
from riser_soil.core.saved_state import Saved
from riser_soil.riser.attachments import PointAttachment
from riser_soil.riser.beam import Beam
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.riser.wall_stress import Pressures, WallSections, walls_of
from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, MovedEnds, Stage, StaticStage, pressure_in

if TYPE_CHECKING:
    from riser_soil.assembly.soil_assembly import SoilAssembly
    from riser_soil.assembly.vessels import Vessels
    from riser_soil.code_checks.line_checks import LineChecks
    from riser_soil.contact.contact import RiserContact
    from riser_soil.contact.friction import CoulombFriction
    from riser_soil.contact.seabed_contact import SeabedContact
    from riser_soil.contact.soil_friction import SoilFriction
    from riser_soil.riser.catenary import Catenary

MOST_STRETCHED = 10.0  # lengths of the line: an end farther beyond its place is there by stretch that no pipe bears


@dataclass(eq=False)
class LineAssembly:
    """A line's field and lasting parts; what its scene lacks is None.

    scene: of this line alone, see `scene.lines.by_line`. parts: those in all stages, without contact and friction.
    catenary: the first shape, None for other ones.
    attachments: point masses and buoyancy modules on the line; their weight less buoyancy is among `parts`.
    pressures: inside and outside the pipe; None where the wall tension is not known. vessels: those that carry ends.
    spins: whether nothing but inertia keeps it from spinning about its own axis. sea: the water of the whole scene.
    soil: what it lies on, with their contact and friction. seabed: contact with the seabed, friction: on that.
    contact_stiffness [N/m2]: force per length and penetration, by ground (soil, seabed).
    start_places: by the names of the stages begun so far, where the ends were then (2, 3) [m]: their motions follow
    from it. stage: the last one begun, as this line sees it.
    """

    scene: Scene
    line: Line
    elements: Elements
    parts: list[Part]
    catenary: Catenary | None
    attachments: tuple[PointAttachment, ...]
    pressures: Pressures | None
    vessels: Vessels | None
    spins: bool
    sea: SeaAssembly | None = None
    soil: SoilAssembly | None = None
    seabed: SeabedContact | None = None
    friction: CoulombFriction | None = None
    contact_stiffness: dict[str, float] = field(default_factory=dict)
    start_places: dict[str, Array] = field(default_factory=dict)
    stage: Stage | None = None

    @property
    def contacts(self) -> list[RiserContact]:
        """Its contact parts."""
        on_soil: list[RiserContact] = [] if self.soil is None else [self.soil.contact]
        return on_soil if self.seabed is None else [*on_soil, self.seabed]

    @property
    def frictions(self) -> list[CoulombFriction | SoilFriction]:
        """Its friction parts."""
        on_soil = None if self.soil is None else self.soil.friction
        return [friction for friction in (self.friction, on_soil) if friction is not None]

    @cached_property
    def scales(self) -> Scales:
        return scales_of(self.elements)

    @property
    def contact_period(self) -> float:
        """Shortest period [s] on the stiffness of its contact, on soil in series with the soil's own; nan where it
        touches nothing.
        """
        stiffness = dict(self.contact_stiffness)
        if "soil" in stiffness and self.scene.soil is not None:
            E = self.scene.soil.top_law.surface_modulus(self.scales.diameter)
            stiffness["soil"] *= E / (E + stiffness["soil"])
        stiffest = max(stiffness.values(), default=math.nan)
        return 2.0 * math.pi * math.sqrt(float(self.elements.mass.min()) / stiffest)

    @cached_property
    def end_places(self) -> list[EndPlaces]:
        """Places of the line's ends, stage by stage."""
        return list(end_places(self.scene, self.sea))

    @cached_property
    def touchdown(self) -> TouchdownForecast | None:
        """Touchdown point by the line's statics as a cable; None where no cable between its ends comes down."""
        return forecast(self.scene, self.elements, self.end_places)

    @cached_property
    def wall_sections(self) -> WallSections | None:
        """Sections of the walls that bear stress; None where no line type has one."""
        if not self.elements.wall_outer_diameter.any():
            return None
        return walls_of(self.elements)

    def code_checks(self) -> LineChecks | None:
        """Its code checks, at the beginning of a run; None where the scene asks for none of its line types."""
        segments, names = self.scene.line.segments, self.scene.used_line_types
        if not any(check.applies_to(name) for check in self.scene.code_check for name in names):
            return None
        from riser_soil.code_checks.line_checks import LineChecks

        of_elements = [segment.line_type for segment in segments for _ in segment.element_lengths]
        return LineChecks(self.scene, of_elements, self.elements.borne_by_pipe, self.line.arc)

    @property
    def slack(self) -> float:
        """Distance of the end of the initial shape from its prescribed position [m]."""
        return self.catenary.slack if self.catenary is not None else 0.0

    @property
    def too_slack(self) -> str:
        """Error message where a riser too slack for its elements finds no equilibrium."""
        bend = least_bend(self.elements)
        if bend == 0.0:
            return (
                f"the riser is slack: with a bend that its elements can follow its end would lie {self.slack:.4g} m "
                "beyond its place, and no way back there was found; take shorter segments, move the ends apart, or "
                "take shorter elements"
            )
        return (
            f"the riser is slack: with a bend that its elements can follow its end would lie {self.slack:.4g} m beyond "
            "its place, and no way back there was found; take shorter segments, move the ends apart, or take "
            f"elements well below (EI/w)^(1/3) = {bend:.3g} m, the length over which it bends under its own weight"
        )

    @property
    def too_soft(self) -> str:
        """Error message where a slack riser would stretch to many times its length under its own weight, else empty."""
        L, elements = float(self.line.arc[-1]), self.elements
        if self.slack <= MOST_STRETCHED * L:
            return ""
        weight = float(np.abs(elements.weight) @ elements.length)
        return (
            f"the riser is too soft along its axis: hung with a bend that its elements can follow its end would lie "
            f"{self.slack:.4g} m beyond its place, {self.slack / L:.3g} times its length of {L:.4g} m, by stretch; "
            f"give an EA well above its weight, {weight:.3g} N (the least EA given is {elements.EA.min():.3g} N)"
        )

    @property
    def laying(self) -> MovedEnds | None:
        """How the end of a slack line comes to its prescribed position before the scene's stages; None where it is
        there, or a joint takes it there.
        """
        end = self.scene.line.end
        supported = isinstance(end, Support) and not end.jointed
        if self.slack == 0.0 or not supported or self.scene.initial is not None:
            return None
        assert isinstance(end, Support)
        return MovedEnds(end=end.position)

    def own_stage(self, stage: Stage) -> Stage:
        """The stage of this line within a stage of the whole scene."""
        return next(own for own in self.scene.stages if own.name == stage.name)

    def begin(self, stage: Stage) -> list[Part]:
        """Set the ends in motion; the line's parts in a stage, without contact and friction."""
        self.start_places[stage.name] = end_positions(self.line)
        return self.enter(self.own_stage(stage), self.start_places[stage.name])

    def lay(self, stage: StaticStage) -> list[Part]:
        """Move the ends of a slack line to their places; the line's parts meanwhile, without a current's drag, contact
        and friction.
        """
        own = stage.model_copy(update={"move": self.laying})
        return [part for part in self.enter(own, end_positions(self.line)) if not part.traits.follows]

    def resume(self, before: Sequence[Stage], stage: Stage) -> list[Part]:
        """The parts of the last stage that was begun, of a line that was restored. before: the stages before."""
        for earlier in before:
            set_motions(self.line, self.own_stage(earlier), self.vessels, self.start_places[earlier.name])
        return self.enter(self.own_stage(stage), self.start_places[stage.name])

    def enter(self, stage: Stage, origins: Array) -> list[Part]:
        """Set the ends in motion from origins (2, 3) [m]; the line's parts in a stage as it sees it."""
        self.stage = stage
        set_motions(self.line, stage, self.vessels, origins)
        self.line.prescribe_spin(self.spins and not isinstance(stage, DynamicStage))
        return [*self.parts, *self.parts_of(stage)]

    @property
    def parts_of_stages(self) -> list[Part]:
        """The parts that any of the line's stages has beside the lasting ones."""
        return [part for stage in self.scene.stages for part in self.parts_of(stage)]

    def parts_of(self, stage: Stage) -> list[Part]:
        """The line's parts that a stage, as it sees it, has beside the lasting ones."""
        scene, line, elements, parts = self.scene, self.line, self.elements, list[Part]()
        if loads := loads_on_line(scene, stage):
            from riser_soil.assembly.loads import loads_of_line

            parts.append(loads_of_line(line, loads, stage))
        if (contents := scene.line.inner_flow) is not None:
            from riser_soil.assembly.contents import contents_of

            parts.append(contents_of(scene, contents, line, elements, stage))
        if isinstance(stage, DynamicStage):
            from riser_soil.assembly.dynamics import dynamic_parts

            parts += dynamic_parts(stage, line, elements, self.attachments)
        if self.sea is not None and (water := self.sea.in_stage(stage)).acts:
            from riser_soil.assembly.sea_loads import sea_loads

            parts += sea_loads(scene, water, line, elements, self.attachments)
        return parts

    def pressure_change(self, t: float) -> float:
        """How much higher the pressure inside [Pa] is at t of the present stage than the contents' own."""
        given = self.scene.line.contents
        if given is None or self.stage is None:
            return 0.0
        return pressure_in(self.scene.stages, self.stage, t, given.pressure) - given.pressure

    def moved(self, t0: float, t1: float) -> float:
        """How far the end that the present stage moves farthest [m] is at t1 from where it is at t0."""
        return max((float(np.linalg.norm(after - before)) for before, after in self._moves(t0, t1)), default=0.0)

    def pressed(self, t0: float, t1: float) -> float:
        """Change of the embedment of an end's underside between t0 and t1 of the present stage [m], in the
        level soil before it.
        """
        axis = self.scene.seabed_level + 0.5 * self.scales.diameter
        depths = ([max(0.0, axis - float(x[2])) for x in move] for move in self._moves(t0, t1))
        return max((abs(after - before) for before, after in depths), default=0.0)

    def _moves(self, t0: float, t1: float) -> list[tuple[Array, Array]]:
        """Where the ends that the present stage moves are at t0 and at t1 (3,) [m]."""
        motions = (end.motion for end in (self.line.start, self.line.end))
        return [(motion(t0)[0], motion(t1)[0]) for motion in motions if motion is not None]

    def first_guess(self) -> Array | None:
        """Increments (nn, ndof) to where the search for a laid line's equilibrium begins; None for where it is."""
        if self.seabed is None or self.catenary is None or self.soil is not None:
            return None
        from riser_soil.assembly.laid_guess import laid_guess

        return laid_guess(self.scene, self.seabed, self.elements, self.attachments, self.catenary)

    def state(self) -> Saved:
        """The state of the prescribed motions; fields and parts have states of their own."""
        return dict(self.start_places)

    def restore(self, saved: Saved) -> None:
        self.start_places = dict(saved)


def line_assembly(
    scene: Scene, sea: SeaAssembly | None, name: str, active: bool, spins: bool | None = None
) -> LineAssembly:
    """Build a scene's line without its ground. spins: as of `LineAssembly`, where joints decide, too."""
    elements, attachments = elements_of(scene), attachments_of(scene)
    line, catenary = line_of(scene, elements, attachments, active, name)
    parts = [Beam(line, elements), *springs_of(scene.line, line), *attached_weight(line, attachments)]
    pressures, vessels = pressures_of(scene, line, elements), vessels_of(scene, sea)
    turns = spins_freely(scene.line) if spins is None else spins
    return LineAssembly(scene, line, elements, parts, catenary, attachments, pressures, vessels, turns, sea)
