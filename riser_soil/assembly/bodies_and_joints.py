"""Assembly of bodies, and of the joints between them and the lines."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import assert_never

import numpy as np

from riser_soil.assembly.bodies_on_seabed import on_seabed
from riser_soil.assembly.line_assembly import LineAssembly
from riser_soil.assembly.sea import SeaAssembly, StageWater
from riser_soil.bodies.body import BodyProperties, MovingBody
from riser_soil.bodies.drag import BodyDrag
from riser_soil.bodies.inertia import BodyInertia, MidpointBodyInertia
from riser_soil.bodies.joints import STIFF, JointOf, Joints, Side
from riser_soil.bodies.loads import BodyWeight, Release
from riser_soil.bodies.seabed_contact import BodyContact
from riser_soil.bodies.seabed_friction import BodyFriction
from riser_soil.core.arrays import Array
from riser_soil.core.part import Part
from riser_soil.core.sphere import radius_of
from riser_soil.scene.bodies import Body as BodyScene
from riser_soil.scene.bodies import PointBody, SolidBody
from riser_soil.scene.joints import Joint, JointPoint
from riser_soil.scene.lines import arc_of, axis_across
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, MidpointScheme, Stage, loads_on_body
from riser_soil.sea.flows import Sea

TURNED = 1e-9  # rad: what needs no stage to turn
CLOSED = 1e-6  # of a line's length: a first gap of a joint that needs no stage to close


@dataclass(eq=False)
class BodiesAndJoints:
    """Bodies by name, and all joints; None without any.

    given, weights: what each body is, and its weight and buoyancy. contacts, frictions: of those that may touch the
    seabed.
    """

    bodies: dict[str, MovingBody]
    joints: Joints | None
    given: dict[str, BodyProperties]
    weights: dict[str, BodyWeight]
    joints_are_open: bool
    contacts: dict[str, BodyContact]
    frictions: dict[str, BodyFriction]

    @property
    def lasting(self) -> list[Part]:
        """Parts in all stages."""
        joints = [] if self.joints is None else [self.joints]
        return [*self.weights.values(), *self.contacts.values(), *self.frictions.values(), *joints]

    def _hold(self, fixed: bool) -> None:
        for body in self.bodies.values():
            body.fix(fixed)
        if self.joints is not None:
            self.joints.open = float(fixed)

    def close(self) -> list[Part]:
        """Hold the bodies in place while joints close, and return the parts of that stage."""
        self._hold(True)
        return self.lasting

    def let_go(self, reactions: Mapping[str, Array]) -> list[Part]:
        """Release the bodies, and return the parts of that stage. reactions: on each body's temporary support, by the
        body's name.
        """
        self._hold(False)
        return [*self.lasting, *(Release(self.bodies[name], reaction) for name, reaction in reactions.items())]

    @property
    def loads(self) -> dict[MovingBody, float]:
        """Typical force on each body that may move [N]: the larger of its weight and its buoyancy."""
        free = (name for name, body in self.bodies.items() if not body.prescribed.all())
        return {self.bodies[name]: self.weights[name].load for name in free}

    def parts_in(self, scene: Scene, sea: SeaAssembly | None, stage: Stage) -> list[Part]:
        """Release the bodies, and return the parts of a stage of the scene."""
        self._hold(False)
        return [*self.lasting, *self.parts_of(scene, sea, stage)]

    def parts_of(self, scene: Scene, sea: SeaAssembly | None, stage: Stage) -> list[Part]:
        """Parts that a stage has beside the lasting ones: loads, and in dynamic stages inertia and drag."""
        parts = list[Part]()
        for name, body in self.bodies.items():
            if isinstance(stage, DynamicStage):
                inertia = MidpointBodyInertia if isinstance(stage.scheme, MidpointScheme) else BodyInertia
                parts.append(inertia(body, self.given[name].mass_matrix()))
            if sea is not None and (drag := _drag(sea.in_stage(stage), body, self.given[name])):
                parts.append(drag)
            if loads := loads_on_body(scene.stages, stage, name):
                from riser_soil.assembly.loads import loads_of_body

                parts.append(loads_of_body(body, loads, stage))
        return parts


def _drag(water: StageWater, body: MovingBody, given: BodyProperties) -> BodyDrag | None:
    """Drag and added mass of a body in a stage; None where the water does nothing beyond carrying it."""
    if not water.is_dynamic and not water.moves:
        return None
    drags = bool(given.drag.any() or given.spin_drag.any())
    pushed = bool(given.volume or given.added_mass.any()) and water.accelerates
    if not drags and not pushed:
        return None
    density, level = water.given.density, water.given.surface_level
    buoyancy = water.sea.scene.gravity * density * given.volume if water.has_waves else 0.0
    flow = water.flow or Sea(None)
    return BodyDrag(body, given, flow, density, buoyancy, np.inf if level is None else level, not water.moves)


def bodies_and_joints_of(scene: Scene, lines: Mapping[str, LineAssembly], active: bool) -> BodiesAndJoints:
    """The scene's bodies and joints. active: whether this rank evaluates them, as it does the lines."""
    given = {name: _properties(scene, body) for name, body in scene.bodies.items()}
    bodies = {name: _body(scene, name, given[name], active) for name in scene.bodies}
    joints = None
    if scene.joints:
        made = [_joint(name, joint, lines, bodies) for name, joint in scene.joints.items()]
        joints = Joints(made, [joint.keep_distance for joint in scene.joints.values()])
    closed = CLOSED * min(float(own.line.arc[-1]) for own in lines.values())
    is_open = joints is not None and bool((joints.first_gap > closed).any() or (joints.first_turn > TURNED).any())
    weights = {name: _weight(scene, body, given[name]) for name, body in bodies.items()}
    touching = on_seabed(scene, lines, bodies, given, weights)
    return BodiesAndJoints(bodies, joints, given, weights, is_open, *touching)


def _properties(scene: Scene, given: BodyScene) -> BodyProperties:
    displaced, none = scene.water.density * given.volume if scene.water is not None else 0.0, np.zeros(3)
    match given:
        case PointBody():
            drag, added = np.full(3, given.drag_area), np.full(3, given.added_mass * displaced)
            return BodyProperties(given.mass, none, none, given.volume, none, drag, none, added, none)
        case SolidBody():
            vectors = given.inertia, given.centre_of_gravity, given.centre_of_buoyancy, given.drag_area
            J, low, high, by_axes = map(np.array, vectors)
            spin_drag, added_J, share = map(np.array, (given.rotational_drag, given.added_inertia, given.added_mass))
            return BodyProperties(
                given.mass, J, low, given.volume, high, by_axes, spin_drag, share * displaced, added_J
            )
    assert_never(given)


def _body(scene: Scene, name: str, given: BodyProperties, active: bool) -> MovingBody:
    """Moments are weighed by the farthest arm of a joint, or the body's size."""
    points = (point for joint in scene.joints.values() for point in joint.between if point.body == name)
    arms = [float(np.linalg.norm(point.offset)) for point in points]
    gyration = float(np.sqrt(given.inertia.max() / given.mass))
    lever = max([*arms, gyration, radius_of(given.volume)]) or 1.0
    body = MovingBody(name, np.array(scene.bodies[name].position), scene.bodies[name].turns, lever, active)
    if (across := axis_across(scene)) is not None:
        body.keep_in_plane(across)
    return body


def _weight(scene: Scene, body: MovingBody, given: BodyProperties) -> BodyWeight:
    water = scene.water
    buoyancy = scene.gravity * water.density * given.volume if water is not None else 0.0
    level = water.surface_level if water is not None and water.surface_level is not None else np.inf
    return BodyWeight(body, given, scene.gravity * given.mass, buoyancy, level)


def _joint(name: str, joint: Joint, lines: Mapping[str, LineAssembly], bodies: Mapping[str, MovingBody]) -> JointOf:
    first, second = (_side(point, lines, bodies) for point in joint.between)
    k, kr = _rigid([(side, point) for side, point in zip((first, second), joint.between, strict=True)], lines)
    kr = kr if joint.kind == "clamped" else 0.0
    if joint.stiffness is not None:
        k = joint.stiffness.translation or k
        kr = joint.stiffness.rotation or 0.0
    return JointOf(name, (first, second), k, kr)


def _side(point: JointPoint, lines: Mapping[str, LineAssembly], bodies: Mapping[str, MovingBody]) -> Side:
    if point.body is not None:
        return Side(bodies[point.body], 0, np.array(point.offset))
    own = lines[str(point.line)]
    node = int(np.abs(own.line.arc - arc_of(own.scene.line, point)).argmin())
    return Side(own.line, node, np.zeros(3))


def _rigid(sides: list[tuple[Side, JointPoint]], lines: Mapping[str, LineAssembly]) -> tuple[float, float]:
    """Stiffness [N/m] and [N.m/rad] of a rigid joint, by the elements beside it; between bodies by all of them."""
    beside = [(lines[str(point.line)], side.node) for side, point in sides if point.line is not None]
    stiffest = [_beside(own, slice(max(node - 1, 0), node + 1)) for own, node in beside]
    stiffest = stiffest or [_beside(own, slice(None)) for own in lines.values()]
    return STIFF * max(EA for EA, _ in stiffest), STIFF * max(EI for _, EI in stiffest)


def _beside(own: LineAssembly, at: slice) -> tuple[float, float]:
    """EA/l and 4 EI/l of the stiffest of some elements."""
    e, length = own.elements, own.line.length[at]
    EI = np.maximum(e.EI_y, e.EI_z)[at]
    return float((e.EA[at] / length).max()), float((4.0 * EI / length).max())
