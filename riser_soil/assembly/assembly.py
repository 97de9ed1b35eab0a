"""The assembled model: the fields and parts of a scene that last through all its stages."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly.condensation import condensed_of
from riser_soil.assembly.hang_off import hung_ends
from riser_soil.assembly.line_assembly import LineAssembly, add_seabed, line_assembly
from riser_soil.assembly.scales import Scales, of_several
from riser_soil.core.arrays import Array
from riser_soil.core.communicator import Communicator
from riser_soil.core.part import Field, LineField, Model, Part, State
from riser_soil.core.saved_state import Saved, gathered, restore_all
from riser_soil.errors import SceneError
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.scene.lines import by_line, on_soil, placing, spinning
from riser_soil.scene.scene import Scene
from riser_soil.scene.soil import SoilScene
from riser_soil.scene.stages import DynamicStage, Stage, StaticStage

if TYPE_CHECKING:
    from riser_soil.assembly.bodies_and_joints import Hung
    from riser_soil.assembly.vessels import Vessels
    from riser_soil.code_checks.line_checks import LineChecks
    from riser_soil.contact.contact import RiserContact
    from riser_soil.contact.friction import CoulombFriction
    from riser_soil.contact.mesh_renewal import MeshRenewal
    from riser_soil.contact.seabed_contact import Cushion, SeabedContact
    from riser_soil.contact.soil_contact import SoilContact
    from riser_soil.contact.soil_friction import SoilFriction
    from riser_soil.riser.attachments import PointAttachment
    from riser_soil.riser.catenary import Catenary
    from riser_soil.riser.wall_stress import Pressures, WallSections
    from riser_soil.soil.condensed import CondensedSoil
    from riser_soil.soil.soil import Soil

LAID_IN = 8  # load steps in which a line is laid on soil, at least
AUTO_TOLERANCE = 0.02  # of the diameter: local error of automatic steps
LAYING, LETTING_GO = "laying", "letting go"  # stages before those of the scene


@dataclass(eq=False)
class Assembly:
    """A scene's fields and lasting parts; what the scene lacks is None.

    lines: what belongs to each, by name, "riser" where there is one. hung: bodies, and joints between them and lines.
    condensed: linear soil as it is solved for, in the place of `soil`, whose state is then that of `recovered_soil`.
    stage: the last one begun.
    """

    scene: Scene
    comm: Communicator
    lines: dict[str, LineAssembly]
    hung: Hung | None = None
    soil: Soil | None = None
    condensed: CondensedSoil | None = None
    mesh_renewal: MeshRenewal | None = None
    cushion: Cushion | None = None
    soil_in_motion: list[Part] = field(default_factory=list)
    own_forms: list[Part] = field(default_factory=list)
    stage: Stage | None = None

    @property
    def only(self) -> LineAssembly:
        """The one line there is; SceneError where there are several."""
        assert self.scene.line is not None  # asked for, it refuses scenes with several
        (own,) = self.lines.values()
        return own

    @cached_property
    def by_line(self) -> dict[str, Assembly]:
        """Each line as an assembly of its own, which shares all that is the line's, by name; "" of the only one."""
        if not self.scene.lines:
            return {"": self}
        return {name: self._seen_by(name, own) for name, own in self.lines.items()}

    def _seen_by(self, name: str, own: LineAssembly) -> Assembly:
        if own.soil_contact is None:
            return Assembly(own.scene, self.comm, {name: own})
        soil = self.soil, self.condensed, self.mesh_renewal, self.cushion
        return Assembly(own.scene, self.comm, {name: own}, None, *soil)

    @property
    def name_on_soil(self) -> str:
        """Name of the line that lies on the soil in a scene of several lines, else ""."""
        return "" if self.scene.soil is None else self.scene.soil.line or ""

    @property
    def line_on_soil(self) -> Assembly | None:
        """The line that lies on the soil, as of `by_line`; None without soil."""
        return None if self.soil is None else self.by_line[self.name_on_soil]

    @property
    def line(self) -> Line:
        return self.only.line

    @property
    def elements(self) -> Elements:
        return self.only.elements

    @property
    def catenary(self) -> Catenary | None:
        return self.only.catenary

    @property
    def attachments(self) -> tuple[PointAttachment, ...]:
        return self.only.attachments

    @property
    def pressures(self) -> Pressures | None:
        return self.only.pressures

    @property
    def vessels(self) -> Vessels | None:
        return self.only.vessels

    @property
    def contact_stiffness(self) -> dict[str, float]:
        return self.only.contact_stiffness

    @property
    def soil_contact(self) -> SoilContact | None:
        return self.only.soil_contact

    @property
    def seabed(self) -> SeabedContact | None:
        return self.only.seabed

    @property
    def friction(self) -> CoulombFriction | None:
        return self.only.friction

    @property
    def wall_sections(self) -> WallSections | None:
        return self.only.wall_sections

    def code_checks(self) -> LineChecks | None:
        return self.only.code_checks()

    @property
    def ground_fields(self) -> list[Field]:
        if self.soil is None:
            return []
        return [self.soil.field, self.soil.surface] if self.condensed is None else [self.condensed.top]

    @property
    def moving(self) -> list[LineField]:
        """Lines and bodies."""
        bodies = [] if self.hung is None else self.hung.bodies.values()
        return [*(own.line for own in self.lines.values()), *bodies]

    @property
    def fields(self) -> list[Field]:
        return [*self.moving, *self.ground_fields]

    @property
    def contacts(self) -> list[RiserContact]:
        """Contact parts of all lines."""
        return [contact for own in self.lines.values() for contact in own.contacts]

    def ground_force(self, state: State) -> float:
        """Vertical force of all ground on the lines [N], upwards; on the rank that holds them."""
        return sum(float(contact.force_on_riser(state)[2]) for contact in self.contacts)

    @property
    def frictions(self) -> list[CoulombFriction | SoilFriction]:
        """Friction parts of all lines."""
        return [friction for own in self.lines.values() for friction in own.frictions]

    @property
    def soil_parts(self) -> list[Part]:
        """The soil as it is solved for: whole, condensed, or none."""
        parts: tuple[Part | None, Part | None] = (self.condensed, self.soil if self.condensed is None else None)
        return [*(part for part in parts if part is not None), *self.own_forms]

    @property
    def lasting_parts(self) -> list[Part]:
        """Those that act in all stages."""
        parts = [part for own in self.lines.values() for part in own.parts]
        hung = [] if self.hung is None else self.hung.lasting
        return [*parts, *self.contacts, *self.frictions, *self.soil_parts, *hung]

    def recovered_soil(self) -> Soil | None:
        """The whole soil as of the last accepted step, for results."""
        return self.soil if self.condensed is None else self.condensed.recover()

    @property
    def on_soil(self) -> list[SoilContact | SoilFriction]:
        """Parts by which the lines load the soil."""
        return [part for own in self.lines.values() for part in own.on_soil]

    @property
    def size(self) -> int:
        """Entries of a local array on this rank."""
        return sum(f.size for f in self.fields)

    @property
    def scales(self) -> Scales:
        """Typical sizes of all lines together, which tolerances are relative to."""
        return of_several(own.scales for own in self.lines.values())

    def error_tolerance(self, stage: DynamicStage) -> float:
        """Largest local error of an automatic step [m]."""
        return AUTO_TOLERANCE * self.scales.diameter if stage.tolerance is None else stage.tolerance

    @property
    def contact_period(self) -> float:
        """The shortest of the lines' [s]; nan where none touches anything."""
        periods = (own.contact_period for own in self.lines.values())
        return min((period for period in periods if not math.isnan(period)), default=math.nan)

    @property
    def slack(self) -> float:
        """The largest distance of the end of a line's initial shape from its prescribed position [m]."""
        return max(own.slack for own in self.lines.values())

    @property
    def slackest(self) -> LineAssembly:
        """The line of that distance."""
        return max(self.lines.values(), key=lambda own: own.slack)

    @property
    def laying(self) -> StaticStage | None:
        """The stage before the scene's in which slack lines are laid, ends moved to their prescribed positions, and
        joints close, while bodies are held.
        """
        moved = any(own.laying is not None for own in self.lines.values())
        if moved or (self.hung is not None and (self.hung.joints_are_open or self.lets_go)):
            return StaticStage(name=LAYING, kind="static")
        return None

    @property
    def lets_go(self) -> bool:
        """Whether bodies come to rest before the scene's stages."""
        return self.hung is not None and bool(self.hung.bodies) and self.scene.stages[0].kind != "dynamic"

    def begin_laying(self, stage: StaticStage) -> Model:
        """Set ends and joints in motion and name the parts, without a current's drag; bodies are held."""
        self.stage = stage
        parts = {name: own.lay(stage) for name, own in self.lines.items()}
        return self._model(parts, [] if self.hung is None else self.hung.close())

    def begin_letting_go(self, stage: StaticStage, reactions: Mapping[str, Array]) -> Model:
        """Let bodies go that were held; reactions: on their dofs, by name [N, N.m]."""
        assert self.hung is not None
        self.stage = stage
        parts = {name: own.lay(stage) for name, own in self.lines.items()}
        return self._model(parts, self.hung.let_go(reactions))

    def begin(self, stage: Stage) -> Model:
        """Set the ends in motion and name the parts of a stage."""
        self.stage = stage
        return self._model({name: own.begin(stage) for name, own in self.lines.items()}, self._hung_in(stage))

    def resume(self) -> tuple[Stage, Model]:
        """The last stage of those begun, its ends set in motion, and its parts: of an assembly that was restored."""
        begun = next(iter(self.lines.values())).start_places
        *before, stage = (stage for stage in self.scene.stages if stage.name in begun)
        self.stage = stage
        parts = {name: own.resume(before, stage) for name, own in self.lines.items()}
        return stage, self._model(parts, self._hung_in(stage))

    def seen_by_lines(self, stage: Stage) -> list[tuple[LineAssembly, Stage]]:
        """Each line, and a stage of the scene as it sees it."""
        return [(own, own.seen(stage)) for own in self.lines.values()]

    def _hung_in(self, stage: Stage) -> list[Part]:
        return [] if self.hung is None else self.hung.parts_in(self.scene, stage)

    def state(self) -> Saved:
        """The state of the prescribed motions; fields and parts have states of their own."""
        return self.only.state() if not self.scene.lines else gathered(self.lines)

    def restore(self, saved: Saved) -> None:
        if self.scene.lines:
            restore_all(self.lines, saved)
        else:
            self.only.restore(saved)

    def _model(self, of_lines: Mapping[str, list[Part]], hung: list[Part]) -> Model:
        stage = self.stage
        assert stage is not None
        cushion = []
        if self.cushion is not None and (self.is_laid_in(stage) or not self.soil_bears):
            self.cushion.stays, cushion = not self.soil_bears, [self.cushion]
        on_ground = [*self.contacts, *self.frictions, *cushion]
        in_motion = self.soil_in_motion if isinstance(stage, DynamicStage) else []
        if self.soil is not None:
            self.soil.hold(by_boundary=not any(part.name == "soil boundary" for part in in_motion))
        renewal = [] if self.mesh_renewal is None else [self.mesh_renewal]
        with_soil = [*self.soil_parts, *in_motion, *on_ground, *renewal]
        if self.condensed is not None:
            with_soil = [*on_ground, *self.soil_parts]
        parts = [part for each in of_lines.values() for part in each]
        if not self.soil_bears:
            absent = [*self.soil_parts, *self.on_soil, *renewal]
            return Model(self.moving, [*parts, *hung, *(part for part in on_ground if part not in absent)])
        return Model(self.moving, [*parts, *hung, *with_soil], self.ground_fields)

    @property
    def soil_bears(self) -> bool:
        """Whether there is soil in the present stage: while several lines are laid, it is their cushion that bears."""
        assert self.stage is not None
        before = self.stage.name in (LAYING, LETTING_GO)
        return self.soil is not None and not (before and self._laid_on_cushion)

    @property
    def _laid_on_cushion(self) -> bool:
        return bool(self.scene.lines) and self.cushion is not None

    def pressure_change(self, t: float) -> float:
        """How much higher the pressure inside [Pa] is at t of the present stage than the contents' own."""
        return self.only.pressure_change(t)

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
        return [move for own in self.lines.values() for move in own.moves(t0, t1)]

    def first_guess(self, stage: Stage) -> Array | None:
        """Increments (size,) to where the first static step begins its search; None where it begins as it is placed."""
        if not self.is_first(stage) or (self.cushion is not None and self.is_laid_in(stage)):
            return None
        increments, guessed = np.zeros(self.size), False
        for own in self.lines.values():
            if (guess := own.first_guess()) is not None:
                own.line.nodal(increments)[:] = guess
                guessed = True
        return increments if guessed else None

    def is_laid_in(self, stage: Stage) -> bool:
        """Whether a line is laid on the ground in a static stage: the first, of several lines on soil the scene's."""
        return self._begins_with(stage, self.scene.stages[0].name) if self._laid_on_cushion else self.is_first(stage)

    def is_first(self, stage: Stage) -> bool:
        """Whether a static stage is the first of all."""
        return self._begins_with(stage, LAYING if self.laying is not None else self.scene.stages[0].name)

    def _begins_with(self, stage: Stage, name: str) -> bool:
        return stage.kind == "static" and stage.name == name and self.scene.initial is None


def sized(scene: Scene) -> Scene:
    """The scene with the sizes of its soil in numbers, slack chain cut where it bends sharply; SceneError where no size
    can be chosen.
    """
    if any(not max(each.bending_stiffness) for each in scene.line_types.values()):
        from riser_soil.assembly.sharp_bends import cut_at_sharp_bends

        scene = cut_at_sharp_bends(scene)
    if scene.soil is None or "auto" not in (scene.soil.block, scene.soil.mesh):
        return scene
    from riser_soil.assembly.soil_sizes import with_sizes

    own = on_soil(scene)
    assert own is not None  # the scene's checks have seen to it
    return scene.model_copy(update={"soil": with_sizes(own, scene.soil)})


def build(scene: Scene, comm: Communicator) -> Assembly:
    """Build the parts of a scene; collective. Raises SceneError or MeshError."""
    if scene.accuracy is not None:
        raise SceneError("accuracy: elements and steps are to be chosen first, by riser_soil.accuracy.target_run")
    for asking in hung_ends(scene):
        raise SceneError(f"{asking.path}: is to be solved first, by riser_soil.hang_off")
    if scene.vessel is not None:
        raise SceneError("vessel.offset: is to be put into the stages first, by riser_soil.scene.variants.at_offset")
    scene = sized(scene)
    spins = spinning(scene)
    assembly = Assembly(scene, comm, {})
    for name, view in by_line(scene).items():
        turns = name in spins if scene.lines else None
        with placing(name):
            assembly.lines[name] = line_assembly(view, name or "riser", comm.rank == 0, turns)
    if scene.bodies or scene.joints:
        from riser_soil.assembly.bodies_and_joints import hung_of

        assembly.hung = hung_of(scene, assembly.lines, comm.rank == 0)
    if scene.contact is not None:
        _add_ground(assembly)
    return assembly


def _add_ground(assembly: Assembly) -> None:
    from riser_soil.assembly import ground

    for own in assembly.lines.values():
        if own.scene.contact is not None:
            own.contact_stiffness |= ground.stiffnesses(own.scene, own.scene.contact, own.scales)
        if own.scene.soil is not None:
            _add_soil(assembly, own, own.scene.soil)
    if assembly.scene.seabed is not None:
        for own in assembly.lines.values():
            add_seabed(own)


def _add_soil(assembly: Assembly, own: LineAssembly, given: SoilScene) -> None:
    """own: the line that lies on it."""
    from riser_soil.assembly import friction, ground

    scene, settings, comm = own.scene, own.scene.contact, assembly.comm
    assert settings is not None
    line, elements, diameter = own.line, own.elements, own.scales.diameter
    assembly.soil = soil = ground.soil_of(scene, given, line, diameter, comm)
    assembly.soil_in_motion = ground.soil_in_motion(scene, given, soil)
    assembly.own_forms = ground.own_forms_of(given, soil)
    assembly.condensed = condensed_of(scene, soil, line, diameter)
    surface = soil.surface if assembly.condensed is None else assembly.condensed.top
    contact = ground.soil_contact_of(scene, settings, line, elements, surface, own.contact_stiffness["soil"])
    own.soil_contact = contact
    own.soil_friction = friction.soil_friction_of(scene, settings, contact, elements, soil.surface.volume)
    assembly.mesh_renewal = ground.mesh_renewal_of(soil, contact, own.soil_friction, line)
    if assembly.laying is not None or scene.stages[0].kind == "static":
        assembly.cushion = ground.cushion_of(scene, contact, elements, soil.surface.points, comm)
