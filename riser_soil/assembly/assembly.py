"""The assembled model: the fields and parts of a scene that last through all its stages."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly.hang_off import hang_off_ends
from riser_soil.assembly.line_assembly import LineAssembly, line_assembly
from riser_soil.assembly.scales import Scales, of_several
from riser_soil.assembly.sea import SeaAssembly, sea_of
from riser_soil.core.arrays import Array
from riser_soil.core.communicator import Communicator
from riser_soil.core.part import Field, LineField, Model, Part, State
from riser_soil.core.saved_state import Saved, gathered, restore_all
from riser_soil.errors import SceneError
from riser_soil.riser.line_part import joined
from riser_soil.scene.lines import by_line, on_soil, placing, spinning
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage, StaticStage

if TYPE_CHECKING:
    from riser_soil.assembly.bodies_and_joints import BodiesAndJoints
    from riser_soil.assembly.soil_assembly import SoilAssembly
    from riser_soil.contact.contact import RiserContact
    from riser_soil.contact.friction import CoulombFriction
    from riser_soil.contact.soil_friction import SoilFriction

LAID_IN = 8  # load steps in which a line is laid on soil, at least
AUTO_TOLERANCE = 0.02  # of the diameter: local error of automatic steps
LAYING, LETTING_GO = "laying", "letting go"  # stages before those of the scene


@dataclass(eq=False)
class Assembly:
    """A scene's fields and lasting parts; what the scene lacks is None.

    lines: what belongs to each, by name, "" of a scene's only one. sea: the water that all share. bodies_and_joints:
    bodies, and joints between them and lines. stage: the last one begun.
    """

    scene: Scene
    comm: Communicator
    lines: dict[str, LineAssembly]
    sea: SeaAssembly | None = None
    bodies_and_joints: BodiesAndJoints | None = None
    stage: Stage | None = None

    @property
    def riser(self) -> LineAssembly:
        """The only line; ValueError where there are several."""
        (own,) = self.lines.values()
        return own

    @property
    def name_on_soil(self) -> str:
        """Name of the line that lies on soil, "" where it is the only one or there is no soil."""
        return next((name for name, own in self.lines.items() if own.soil is not None), "")

    @property
    def soil(self) -> SoilAssembly | None:
        """The soil under the line that lies on it."""
        return None if self.line_on_soil is None else self.line_on_soil.soil

    @property
    def line_on_soil(self) -> LineAssembly | None:
        """The line that lies on soil."""
        return next((own for own in self.lines.values() if own.soil is not None), None)

    @property
    def moving(self) -> list[LineField]:
        """Lines and bodies."""
        bodies = [] if self.bodies_and_joints is None else self.bodies_and_joints.bodies.values()
        return [*(own.line for own in self.lines.values()), *bodies]

    @property
    def fields(self) -> list[Field]:
        return [*self.moving, *([] if self.soil is None else self.soil.fields)]

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
    def lasting_parts(self) -> list[Part]:
        """Parts that act in all stages."""
        parts = [part for own in self.lines.values() for part in own.parts]
        parts += [*self.contacts, *self.frictions, *([] if self.soil is None else self.soil.parts)]
        return [*parts, *([] if self.bodies_and_joints is None else self.bodies_and_joints.lasting)]

    @cached_property
    def part_names(self) -> frozenset[str]:
        """Names of all parts that stages of the scene are solved with."""
        parts = [*self.lasting_parts, *(part for own in self.lines.values() for part in own.parts_of_stages)]
        if (bodies_and_joints := self.bodies_and_joints) is not None:
            for stage in self.scene.stages:
                parts += bodies_and_joints.parts_of(self.scene, self.sea, stage)
        if self.soil is not None:
            parts += [*self.soil.renewal, *(self.soil.in_motion if self.scene.has_dynamic_stage else [])]
            parts += [] if self.soil.cushion is None else [self.soil.cushion]
        return frozenset(part.name for part in parts)

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
    def slackest(self) -> LineAssembly:
        """The line whose initial shape ends farthest from the prescribed position of its end."""
        return max(self.lines.values(), key=lambda own: own.slack)

    @property
    def laying(self) -> StaticStage | None:
        """The stage before the scene's in which slack lines are laid, ends moved to their prescribed positions, and
        joints close, while bodies are held.
        """
        moved = any(own.laying is not None for own in self.lines.values())
        open_joints = self.bodies_and_joints is not None and self.bodies_and_joints.joints_are_open
        if moved or open_joints or self.lets_go:
            return StaticStage(name=LAYING, kind="static")
        return None

    @property
    def lets_go(self) -> bool:
        """Whether bodies come to rest before the scene's stages."""
        has_bodies = self.bodies_and_joints is not None and bool(self.bodies_and_joints.bodies)
        return has_bodies and self.scene.stages[0].kind != "dynamic"

    def begin_laying(self, stage: StaticStage) -> Model:
        """Set ends and joints in motion and name the parts, without a current's drag; bodies are held."""
        self.stage = stage
        parts = {name: own.lay(stage) for name, own in self.lines.items()}
        return self._model(parts, [] if self.bodies_and_joints is None else self.bodies_and_joints.close())

    def begin_letting_go(self, stage: StaticStage, reactions: Mapping[str, Array]) -> Model:
        """Let bodies go that were held; reactions: on their dofs, by name [N, N.m]."""
        assert self.bodies_and_joints is not None
        self.stage = stage
        parts = {name: own.lay(stage) for name, own in self.lines.items()}
        return self._model(parts, self.bodies_and_joints.let_go(reactions))

    def begin(self, stage: Stage) -> Model:
        """Set the ends in motion and name the parts of a stage."""
        self.stage = stage
        parts = {name: own.begin(stage) for name, own in self.lines.items()}
        return self._model(parts, self._of_bodies_and_joints(stage))

    def resume(self) -> tuple[Stage, Model]:
        """The last stage of those begun, its ends set in motion, and its parts: of an assembly that was restored."""
        begun = next(iter(self.lines.values())).start_places
        *before, stage = (stage for stage in self.scene.stages if stage.name in begun)
        self.stage = stage
        parts = {name: own.resume(before, stage) for name, own in self.lines.items()}
        return stage, self._model(parts, self._of_bodies_and_joints(stage))

    def stages_by_line(self, stage: Stage) -> list[tuple[LineAssembly, Stage]]:
        """Each line, and a stage of the scene as it sees it."""
        return [(own, own.own_stage(stage)) for own in self.lines.values()]

    def _of_bodies_and_joints(self, stage: Stage) -> list[Part]:
        present = self.bodies_and_joints
        return [] if present is None else present.parts_in(self.scene, self.sea, stage)

    def state(self) -> Saved:
        """The state of the prescribed motions; fields and parts have states of their own."""
        return self.riser.state() if not self.scene.lines else gathered(self.lines)

    def restore(self, saved: Saved) -> None:
        if self.scene.lines:
            restore_all(self.lines, saved)
        else:
            self.riser.restore(saved)

    def _model(self, of_lines: Mapping[str, list[Part]], of_bodies_and_joints: list[Part]) -> Model:
        stage, soil = self.stage, self.soil
        assert stage is not None
        parts = [*(part for each in of_lines.values() for part in each), *of_bodies_and_joints]
        on_ground, model = [*self.contacts, *self.frictions], partial(Model, self.moving, joined=joined)
        if soil is None:
            return model([*parts, *on_ground])
        in_motion = soil.in_motion if isinstance(stage, DynamicStage) else []
        soil.whole.fix_boundary(not any(part.name == "soil boundary" for part in in_motion))
        cushion = []
        if soil.cushion is not None and (self.is_laid_in(stage) or not self.soil_bears):
            soil.cushion.stays, cushion = not self.soil_bears, [soil.cushion]
        if not self.soil_bears:
            others = [part for part in on_ground if part not in soil.pressed_by]
            return model([*parts, *others, *cushion])
        on_ground += cushion
        if soil.condensed is not None:
            return model([*parts, *on_ground, *soil.parts], soil.fields)
        return model([*parts, *soil.parts, *in_motion, *on_ground, *soil.renewal], soil.fields)

    @property
    def soil_bears(self) -> bool:
        """Whether there is soil in the present stage: while several lines are laid, it is their cushion that bears."""
        assert self.stage is not None
        before = self.stage.name in (LAYING, LETTING_GO)
        return self.soil is not None and not (before and self._laid_on_cushion)

    @property
    def cushioned(self) -> bool:
        """Whether a line is laid on a cushion before soil bears it."""
        return self.soil is not None and self.soil.cushion is not None

    @property
    def _laid_on_cushion(self) -> bool:
        return bool(self.scene.lines) and self.cushioned

    def first_guess(self, stage: Stage) -> Array | None:
        """Increments (size,) to where the first static step begins its search; None where it begins as it is placed."""
        if not self.is_first(stage) or self.is_cushioned_in(stage):
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

    def is_cushioned_in(self, stage: Stage) -> bool:
        """Whether a line is laid on the ground in a static stage, and on a cushion before the soil bears it."""
        return self.cushioned and self.is_laid_in(stage)

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
    for asking in hang_off_ends(scene):
        raise SceneError(f"{asking.path}: is to be solved first, by riser_soil.hang_off")
    if scene.vessel is not None:
        raise SceneError("vessel.offset: is to be put into the stages first, by riser_soil.scene.variants.at_offset")
    scene = sized(scene)
    spins = spinning(scene)
    assembly = Assembly(scene, comm, {}, sea_of(scene))
    for name, view in by_line(scene).items():
        turns = name in spins if scene.lines else None
        with placing(name):
            assembly.lines[name] = line_assembly(view, assembly.sea, name or "riser", comm.rank == 0, turns)
    if scene.bodies or scene.joints:
        from riser_soil.assembly.bodies_and_joints import bodies_and_joints_of

        assembly.bodies_and_joints = bodies_and_joints_of(scene, assembly.lines, comm.rank == 0)
    if scene.contact is not None:
        from riser_soil.assembly.ground import add_ground

        laid = assembly.laying is not None or scene.stages[0].kind == "static"
        add_ground(assembly.lines.values(), laid, comm)
    return assembly
