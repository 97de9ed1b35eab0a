"""The assembled model: the fields and parts of a scene that last through all its stages."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly.hang_off import hung_end
from riser_soil.assembly.motions import end_positions, set_motions, vessels_of
from riser_soil.assembly.riser import attached_weight, attachments_of, elements_of, line_of, pressures_of, springs_of
from riser_soil.assembly.scales import Scales, scales_of
from riser_soil.assembly.sea_loads import sea_loads
from riser_soil.assembly.shape import least_bend
from riser_soil.assembly.soil_block import condensed_of
from riser_soil.assembly.stage import contents_of, dynamic_parts, loads_of, prescribe_spin
from riser_soil.core.arrays import Array
from riser_soil.core.communicator import Communicator
from riser_soil.core.part import Field, Model, Part
from riser_soil.core.saved_state import Saved
from riser_soil.errors import SceneError
from riser_soil.riser.beam import Beam
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, MovedEnds, Stage, StaticStage, pressure_in

if TYPE_CHECKING:
    from riser_soil.assembly.vessels import Vessels
    from riser_soil.contact.contact import RiserContact
    from riser_soil.contact.friction import CoulombFriction
    from riser_soil.contact.mesh_renewal import MeshRenewal
    from riser_soil.contact.seabed_contact import Cushion, Floor, SeabedContact
    from riser_soil.contact.soil_contact import SoilContact
    from riser_soil.contact.soil_friction import SoilFriction
    from riser_soil.riser.attachments import PointAttachment
    from riser_soil.riser.catenary import Catenary
    from riser_soil.riser.wall_stress import Pressures, WallSections
    from riser_soil.soil.condensed import CondensedSoil
    from riser_soil.soil.soil import Soil

AUTO_TOLERANCE = 0.02  # of the diameter: local error of automatic steps
AUTO_SMALLEST, AUTO_SMALLEST_OF_STAGE = 1e-4, 1e-7  # of a given time step; of a stage with automatic ones
MOST_STRETCHED = 10.0  # lengths of the riser: an end farther beyond its place is there by stretch that no pipe bears


@dataclass(eq=False)
class Assembly:
    """A scene's fields and lasting parts; what the scene lacks is None.

    catenary: the first shape, None for other ones.
    attachments: point masses and buoyancy modules on the line; their weight less buoyancy is among `riser_parts`.
    pressures: inside and outside the pipe; None where the wall tension is not known.
    contact_stiffness [N/m2]: force per length and penetration, by ground (soil, seabed).
    vessels: those that carry ends, None where there are none.
    condensed: linear soil as it is solved for, in the place of `soil`, whose state is then that of `recovered_soil`.
    start_places: by the names of the stages begun so far, where the ends were then (2, 3) [m]: their motions follow
    from it. stage: the last one begun.
    """

    scene: Scene
    comm: Communicator
    line: Line
    elements: Elements
    riser_parts: list[Part]
    catenary: Catenary | None
    attachments: tuple[PointAttachment, ...] = ()
    pressures: Pressures | None = None
    soil: Soil | None = None
    condensed: CondensedSoil | None = None
    soil_contact: SoilContact | None = None
    seabed: SeabedContact | None = None
    friction: CoulombFriction | None = None
    soil_friction: SoilFriction | None = None
    mesh_renewal: MeshRenewal | None = None
    cushion: Cushion | None = None
    floor: Floor | None = None
    contact_stiffness: dict[str, float] = field(default_factory=dict)
    vessels: Vessels | None = None
    start_places: dict[str, Array] = field(default_factory=dict)
    stage: Stage | None = None

    @property
    def ground_fields(self) -> list[Field]:
        if self.soil is None:
            return []
        return [self.soil.field, self.soil.surface] if self.condensed is None else [self.condensed.top]

    @property
    def fields(self) -> list[Field]:
        return [self.line, *self.ground_fields]

    @property
    def contacts(self) -> list[RiserContact]:
        """Contact parts of the riser."""
        both: tuple[RiserContact | None, RiserContact | None] = (self.soil_contact, self.seabed)
        return [contact for contact in both if contact is not None]

    @property
    def frictions(self) -> list[CoulombFriction | SoilFriction]:
        """Friction parts of the riser."""
        return [friction for friction in (self.friction, self.soil_friction) if friction is not None]

    @property
    def soil_parts(self) -> list[Part]:
        """The soil as it is solved for: whole, condensed, or none."""
        parts: tuple[Part | None, Part | None] = (self.condensed, self.soil if self.condensed is None else None)
        return [part for part in parts if part is not None]

    @property
    def laid_on(self) -> list[SeabedContact]:
        """What bears the riser before the soil does."""
        return [part for part in (self.cushion, self.floor) if part is not None]

    @property
    def lasting_parts(self) -> list[Part]:
        """Those that act in all stages."""
        return [*self.riser_parts, *self.contacts, *self.frictions, *self.soil_parts]

    def recovered_soil(self) -> Soil | None:
        """The whole soil as of the last accepted step, for results."""
        return self.soil if self.condensed is None else self.condensed.recover()

    @property
    def on_soil(self) -> list[SoilContact | SoilFriction]:
        """Parts by which the riser loads the soil."""
        return [part for part in (self.soil_contact, self.soil_friction) if part is not None]

    @property
    def size(self) -> int:
        """Entries of a local array on this rank."""
        return sum(f.size for f in self.fields)

    @cached_property
    def scales(self) -> Scales:
        return scales_of(self.elements)

    @cached_property
    def wall_sections(self) -> WallSections | None:
        """Sections of the walls that bear stress; None where no line type has one."""
        if not self.elements.wall_outer_diameter.any():
            return None
        from riser_soil.riser.wall_stress import walls_of

        return walls_of(self.elements)

    def error_tolerance(self, stage: DynamicStage) -> float:
        """Largest local error of an automatic step [m]."""
        return AUTO_TOLERANCE * self.scales.diameter if stage.tolerance is None else stage.tolerance

    @property
    def contact_period(self) -> float:
        """Shortest period [s] of the riser on the stiffness of its contact, on soil in series with the soil's own; nan
        where it touches nothing.
        """
        found = dict(self.contact_stiffness)
        if "soil" in found and self.scene.soil is not None:
            E = self.scene.soil.top_law.surface_modulus(self.scales.diameter)
            found["soil"] *= E / (E + found["soil"])
        stiffest = max(found.values(), default=math.nan)
        return 2.0 * math.pi * math.sqrt(float(self.elements.mass.min()) / stiffest)

    def smallest_step(self, stage: DynamicStage) -> float:
        """Down to which time steps are cut [s]."""
        given = self.scene.solver.min_time_step
        if given != "auto":
            return float(given)
        return AUTO_SMALLEST_OF_STAGE * stage.duration if stage.time_step == "auto" else AUTO_SMALLEST * stage.time_step

    @property
    def slack(self) -> float:
        """Distance of the end of the initial shape from its prescribed position [m]."""
        return self.catenary.slack if self.catenary is not None else 0.0

    @property
    def too_slack(self) -> str:
        """Error message where a riser too slack for its elements finds no equilibrium."""
        bend = least_bend(self.elements)
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
    def laying(self) -> StaticStage | None:
        """The stage that lays a slack riser: it moves the end to its prescribed position before the scene's stages."""
        end = self.scene.riser.end
        if self.slack == 0.0 or not isinstance(end, Support) or self.scene.initial is not None:
            return None
        return StaticStage(name="laying", kind="static", move=MovedEnds(end=end.position))

    def begin_laying(self, stage: StaticStage) -> Model:
        """Set the end in motion and name the parts: without a current's drag."""
        model = self._enter(stage, end_positions(self.line))
        return replace(model, parts=[part for part in model.parts if not part.traits.follows])

    def begin(self, stage: Stage) -> Model:
        """Set the ends in motion and name the parts of a stage."""
        self.start_places[stage.name] = end_positions(self.line)
        return self._enter(stage, self.start_places[stage.name])

    def resume(self) -> tuple[Stage, Model]:
        """The last stage of those begun, its ends set in motion, and its parts: of an assembly that was restored."""
        *before, stage = (stage for stage in self.scene.stages if stage.name in self.start_places)
        for earlier in before:
            set_motions(self.line, earlier, self.vessels, self.start_places[earlier.name])
        return stage, self._enter(stage, self.start_places[stage.name])

    def state(self) -> Saved:
        """The state of the prescribed motions; fields and parts have states of their own."""
        return dict(self.start_places)

    def restore(self, saved: Saved) -> None:
        self.start_places = dict(saved)

    def _enter(self, stage: Stage, origins: Array) -> Model:
        self.stage = stage
        set_motions(self.line, stage, self.vessels, origins)
        prescribe_spin(self.scene, self.line, stage)
        parts = [*self.riser_parts, *loads_of(self.scene, self.line, stage)]
        parts += contents_of(self.scene, self.line, self.elements, stage)
        if isinstance(stage, DynamicStage):
            parts += dynamic_parts(stage, self.line, self.elements, self.attachments)
        parts += sea_loads(self.scene, self.line, self.elements, stage, self.attachments)
        on_ground = [*self.contacts, *self.frictions, *(self.laid_on if self.is_laid_in(stage) else [])]
        renewal = [] if self.mesh_renewal is None else [self.mesh_renewal]
        with_soil = [*self.soil_parts, *on_ground, *renewal]
        if self.condensed is not None:
            with_soil = [*on_ground, *self.soil_parts]
        return Model([self.line], [*parts, *with_soil], self.ground_fields)

    def pressure_change(self, t: float) -> float:
        """How much higher the pressure inside [Pa] is at t of the present stage than the contents' own."""
        given = self.scene.riser.contents
        if given is None or self.stage is None:
            return 0.0
        return pressure_in(self.scene.stages, self.stage, t, given.pressure) - given.pressure

    def moved(self, t0: float, t1: float) -> float:
        """How far the end that the present stage moves farthest [m] is at t1 from where it is at t0."""
        return max((float(np.linalg.norm(after - before)) for before, after in self._moves(t0, t1)), default=0.0)

    def pressed(self, t0: float, t1: float) -> float:
        """By how much the embedment of an end's underside changes between t0 and t1 of the present stage [m], in the
        level soil before it.
        """
        axis = self.scene.seabed_level + 0.5 * self.scales.diameter
        depths = ([max(0.0, axis - float(x[2])) for x in move] for move in self._moves(t0, t1))
        return max((abs(after - before) for before, after in depths), default=0.0)

    def _moves(self, t0: float, t1: float) -> list[tuple[Array, Array]]:
        """Where the ends that the present stage moves are at t0 and at t1 (3,) [m]."""
        motions = (end.motion for end in (self.line.start, self.line.end))
        return [(motion(t0)[0], motion(t1)[0]) for motion in motions if motion is not None]

    def first_guess(self, stage: Stage) -> Array | None:
        """Increments (size,) to where the first static step begins its search; None where it begins as it is placed."""
        if not self.is_laid_in(stage) or self.seabed is None or self.catenary is None or self.soil is not None:
            return None
        from riser_soil.assembly.laid_guess import laid_guess

        guess = laid_guess(self.scene, self.seabed, self.elements, self.attachments, self.catenary)
        if guess is None:
            return None
        increments = np.zeros(self.size)
        self.line.nodal(increments)[:] = guess
        return increments

    def is_laid_in(self, stage: Stage) -> bool:
        """Whether a static stage is the first, in which the riser is laid on the soil."""
        first = self.laying.name if self.laying is not None else self.scene.stages[0].name
        return stage.kind == "static" and stage.name == first and self.scene.initial is None


def sized(scene: Scene) -> Scene:
    """The scene with the sizes of its soil in numbers; SceneError where none can be chosen."""
    if scene.soil is None or "auto" not in (scene.soil.block, scene.soil.mesh):
        return scene
    from riser_soil.assembly.soil_sizes import with_sizes

    return with_sizes(scene, scene.soil)


def build(scene: Scene, comm: Communicator) -> Assembly:
    """Build the parts of a scene; collective. Raises SceneError or MeshError."""
    if scene.accuracy is not None:
        raise SceneError("accuracy: elements and steps are to be chosen first, by riser_soil.accuracy.target_run")
    if (asking := hung_end(scene)) is not None:
        raise SceneError(f"{asking.path}: is to be solved first, by riser_soil.hang_off")
    scene = sized(scene)
    elements = elements_of(scene)
    attachments = attachments_of(scene)
    line, catenary = line_of(scene, elements, attachments, active=comm.rank == 0)
    parts = [Beam(line, elements), *springs_of(scene.riser, line), *attached_weight(line, attachments)]
    pressures, vessels = pressures_of(scene, line, elements), vessels_of(scene)
    assembly = Assembly(scene, comm, line, elements, parts, catenary, attachments, pressures, vessels=vessels)
    if scene.contact is not None:
        _add_ground(assembly)
    return assembly


def _add_ground(assembly: Assembly) -> None:
    from riser_soil.assembly import friction, ground

    scene, settings = assembly.scene, assembly.scene.contact
    assert settings is not None
    stiffness = ground.stiffnesses(scene, settings, assembly.scales)
    line, elements, assembly.contact_stiffness = assembly.line, assembly.elements, stiffness
    if scene.soil is not None:
        assembly.soil = soil = ground.soil_of(scene, scene.soil, line, assembly.scales.diameter, assembly.comm)
        assembly.condensed = condensed_of(scene, soil, line, assembly.scales.diameter)
        surface = soil.surface if assembly.condensed is None else assembly.condensed.top
        contact = ground.soil_contact_of(scene, settings, line, elements, surface, stiffness["soil"])
        assembly.soil_contact = contact
        assembly.soil_friction = friction.soil_friction_of(scene, settings, contact, elements, soil.surface.volume)
        assembly.mesh_renewal = ground.mesh_renewal_of(soil, contact, assembly.soil_friction, line)
        if assembly.laying is not None or scene.stages[0].kind == "static":
            top = soil.surface.points
            assembly.cushion = ground.cushion_of(scene, contact, elements, top, assembly.comm)
            if assembly.cushion is not None:
                assembly.floor = ground.floor_of(scene, contact, elements, stiffness["soil"])
    if scene.seabed is not None:
        law = ground.seabed_law(scene.seabed, settings, elements, stiffness)
        assembly.seabed = ground.seabed_contact_of(scene, settings, line, elements, law, assembly.soil_contact)
        assembly.friction = friction.friction_of(scene, settings, assembly.seabed, elements)
