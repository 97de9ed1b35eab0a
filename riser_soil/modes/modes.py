"""Natural frequencies and shapes of the riser at rest, taken there by its static stages: `modes_of`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.sparse import csr_array

from riser_soil.assembly import Assembly, LineAssembly, build, sized
from riser_soil.assembly.contents import contents_at
from riser_soil.assembly.dynamics import dynamic_parts
from riser_soil.assembly.packages import communicator_of
from riser_soil.assembly.sea import sea_of
from riser_soil.assembly.sea_loads import sea_loads
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Part, State, Weights
from riser_soil.core.system import System, Timer
from riser_soil.errors import SceneError, SolveError
from riser_soil.modes.eigenpairs import Eigenpairs, lowest
from riser_soil.riser.directors import Frames
from riser_soil.riser.line import UP, Line
from riser_soil.riser.sections import larger_beside
from riser_soil.riser.spatial_directors import SpatialFrames
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage
from riser_soil.stages import StatelessObserver, solve_stages

if TYPE_CHECKING:
    from riser_soil.bodies.body import MovingBody

DIRECTIONS = ("in plane", "out of plane", "axial", "twist")
BETWEEN = "at no node"  # moves: the direction of a mode that elements are too long for
OF_BODY = "of a body"  # moves: the direction of a mode in which no line does
NEAR_ZERO = 1e-6  # of g over the riser's length: a mode whose square is not larger is one that nothing holds
MOST_ASYMMETRY = 0.01  # by which the part of the tangent that is not symmetric may change a frequency
GRAVITY = 9.81  # m/s2
UNSEEN = 1e-8  # of the nodes' turns times an element's length: displacements that are round-off
PLUMB = 1e-9  # of the distance of the ends: in plan, of ends above each other
STIFFNESS = Weights(inertia=0.0, force=1.0, shift_v=0.0, shift_a=0.0)
MASS = Weights(inertia=1.0, force=0.0, shift_v=0.0, shift_a=1.0)
MOVING = DynamicStage(name="small vibrations", kind="dynamic", duration=1.0, time_step=1.0)


class LineShapes(NamedTuple):
    """Shapes of n modes of a line with nn nodes, global axes.

    arc (nn,) [m]; position (nn, 3) [m] at rest. shape (n, nn, 3): displacement of the axis; twist (n, nn) [rad/m]:
    rotation about the pipe's axis.
    """

    arc: Array
    position: Array
    shape: Array
    twist: Array

    def scaled(self, factors: Array) -> LineShapes:
        """The shapes scaled by each mode's factor (n,)."""
        return self._replace(shape=factors[:, None, None] * self.shape, twist=factors[:, None] * self.twist)


class BodyShapes(NamedTuple):
    """Shapes of n modes of a body: displacement of the origin of its axes (n, 3), and rotation (n, 3) [rad/m], global
    axes.
    """

    shape: Array
    rotation: Array

    def scaled(self, factors: Array) -> BodyShapes:
        """The shapes scaled by each mode's factor (n,)."""
        return BodyShapes(factors[:, None] * self.shape, factors[:, None] * self.rotation)


class Modes(NamedTuple):
    """Modes of small vibrations about rest, the lowest first; n of them.

    frequency (n,) [Hz]. lines: their shapes by name, "" of the only one, and of bodies; all for a largest displacement
    of 1 of an axis, of a pipe's surface as it twists, or of a body. share (n, 4): of the squared displacement along the
    lines, by DIRECTIONS: across the pipe in the vertical plane from start to end, across it out of this plane, along
    it, and of the pipe's surface as it twists; nan where lines stay in place as bodies move; nan, and no shape, where
    the nodes turn but stay in place, in half waves as short as elements. asymmetry: see `Eigenpairs`. stage: name of
    the static stage.
    """

    frequency: Array
    share: Array
    asymmetry: float
    stage: str
    lines: Mapping[str, LineShapes]
    bodies: Mapping[str, BodyShapes]

    @property
    def period(self) -> Array:
        """(n,) [s]; infinite where nothing holds the riser."""
        return np.divide(1.0, self.frequency, out=np.full_like(self.frequency, np.inf), where=self.frequency > 0.0)

    @property
    def direction(self) -> list[str]:
        """Words for the largest share."""
        bodies = self.bodies.values()
        moves = [any(own.shape[n].any() or own.rotation[n].any() for own in bodies) for n in range(len(self.share))]
        each = zip(self.share, moves, strict=True)
        still = {True: OF_BODY, False: BETWEEN}
        return [DIRECTIONS[share.argmax()] if np.isfinite(share).all() else still[body] for share, body in each]

    @property
    def line(self) -> LineShapes:
        """The only line."""
        (only,) = self.lines.values()
        return only

    @property
    def moving_most(self) -> list[str]:
        """Name of the line or body that has the largest displacement of its axis; of the body that turns most where
        none has any.
        """
        each = {name: own.shape for name, own in self.lines.items()}
        each |= {name: own.shape[:, None] for name, own in self.bodies.items()}
        largest = np.array([np.linalg.norm(shape, axis=2).max(axis=1) for shape in each.values()])
        names, turned = [[*each][n] for n in largest.argmax(axis=0)], self._turned
        turning = turned.any(axis=0) & (largest.max(axis=0) < UNSEEN)
        return [[*self.bodies][turned[:, n].argmax()] if turning[n] else name for n, name in enumerate(names)]

    @property
    def _turned(self) -> Array:
        """Sizes of what bodies turn (nb, n) [rad/m]."""
        turns = [np.linalg.norm(own.rotation, axis=1) for own in self.bodies.values()]
        return np.array(turns).reshape(-1, len(self.frequency))


def modes_of(scene: Scene, count: int = 10, stage: str | None = None) -> Modes:
    """The lowest modes of a scene's lines and bodies at the end of a static stage: by default the last before a dynamic
    one.

    Without damping. Stiffness is the tangent at rest: of the riser with its loads, of contact as it touches there, of
    the soil; friction sticks. Mass is that of the lines, what is in them and on them, of bodies, and the added mass of
    still water; soil has none. Raises SceneError or what a run would; SolveError where the riser is unstable at rest,
    or its tangent far from symmetric.
    """
    rest = at_rest(scene, stage)
    least = NEAR_ZERO * GRAVITY / max(float(own.line.arc[-1]) for own in rest.assembly.lines.values())
    pairs = lowest(rest.stiffness, rest.mass, count, -least)
    _require_sound(pairs, least)
    return _shapes_of(rest, np.where(pairs.squares > least, pairs.squares, 0.0), pairs)


def _require_sound(pairs: Eigenpairs, least: float) -> None:
    if pairs.squares.min() < -least:
        raise SolveError(
            f"the riser at rest is unstable: the square of an angular frequency is {pairs.squares.min():.4g} rad2/s2; "
            "check the static load step, refine the riser or hold its ends"
        )
    if pairs.asymmetry > MOST_ASYMMETRY:
        raise SolveError(
            f"the tangent at rest is not symmetric, as with drag in a current or moments in space: frequencies would "
            f"change by {pairs.asymmetry:.2g} of them, more than {MOST_ASYMMETRY:g}; leave out such loads"
        )


def _shapes_of(rest: RiserAtRest, squares: Array, pairs: Eigenpairs) -> Modes:
    state, moved = State.at_rest(rest.stage.end, rest.assembly.size), [rest.whole(mode) for mode in pairs.modes]
    each = {name: own.line for name, own in rest.assembly.lines.items()}
    of_lines = {name: _line_shapes(line, state, moved) for name, line in each.items()}
    of_bodies = {body.name: _body_shapes(body, moved) for body in rest.bodies}
    fields: list[Line | MovingBody] = [*each.values(), *rest.bodies]
    least = np.max([_turned(field, moved) for field in fields], axis=0)
    surfaces = [_radius(line) * of_lines[name].twist for name, line in each.items()]
    arms = [body.lever * of_bodies[body.name].rotation for body in rest.bodies]
    axes = [*(own.shape for own in of_lines.values()), *(own.shape[:, None] for own in of_bodies.values())]
    scale = _scale(np.hstack([*axes, *(arm[:, None] for arm in arms)]), np.hstack(surfaces), UNSEEN * least)
    lines = {name: own.scaled(scale) for name, own in of_lines.items()}
    bodies = {name: own.scaled(scale) for name, own in of_bodies.items()}
    visible = UNSEEN**2 * sum(line.arc[-1] for line in each.values())
    share = _shares(np.sum([_squared(line, state, lines[name]) for name, line in each.items()], axis=0), visible)
    return Modes(np.sqrt(squares) / (2.0 * np.pi), share, pairs.asymmetry, rest.stage.name, lines, bodies)


def _line_shapes(line: Line, state: State, moved: Sequence[Array]) -> LineShapes:
    """moved: local arrays of each mode."""
    nodal = np.array([line.nodal(each) for each in moved])
    shape = nodal[..., : line.dimension] @ line.basis.T
    return LineShapes(line.arc, line.positions3(state), shape, _twist(line.frames, nodal[..., line.dimension :]))


def _body_shapes(body: MovingBody, moved: Sequence[Array]) -> BodyShapes:
    nodal = np.array([body.nodal(each)[0] for each in moved])
    turned = nodal[:, 3:] @ body.frames.R[0].T if body.turns else np.zeros((len(nodal), 3))
    return BodyShapes(nodal[:, :3], turned)


def _turned(field: Line | MovingBody, moved: Sequence[Array]) -> Array:
    """What turns move beside them (n,) at most: by an element's length, or a body's arm."""
    arm = field.length.max() if isinstance(field, Line) else field.lever
    return np.array([arm * np.abs(field.nodal(each)[:, field.dimension :]).max(initial=0.0) for each in moved])


def _radius(line: Line) -> Array:
    return 0.5 * larger_beside(line.outer_diameter)


def _twist(frames: Frames, rotation: Array) -> Array:
    """Rotations about the tangent (n, nn), from those in body axes (n, nn, 3); none in a plane."""
    if not isinstance(frames, SpatialFrames):
        return np.zeros(rotation.shape[:2])
    tangent = np.concatenate([frames.T0[:, 0, :, 0], frames.T0[-1:, 1, :, 0]])
    return np.asarray(np.einsum("mni,ni->mn", rotation, tangent))


def _scale(moved: Array, of_surface: Array, least: Array) -> Array:
    """Factors (n,) that make the largest displacement 1, and positive where it is of an axis; 0 where it is not more
    than `least` (n,). moved: (n, k, 3), of_surface: (n, m).
    """
    values = np.concatenate([moved.reshape(len(moved), -1), of_surface], axis=1)
    sizes = np.maximum(np.linalg.norm(moved, axis=2).max(axis=1), np.abs(of_surface).max(axis=1))
    largest = np.take_along_axis(values, np.abs(values).argmax(axis=1)[:, None], axis=1)[:, 0]
    return np.divide(np.sign(largest), sizes, out=np.zeros_like(sizes), where=sizes > least)


def _axes(tangents: Array, position: Array) -> Array:
    """Unit vectors (nn, 3, 3) at the nodes by rows: across in plane, across out of plane, along."""
    t = np.concatenate([tangents[:1, 0], tangents[:-1, 1] + tangents[1:, 0], tangents[-1:, 1]])
    t /= np.linalg.norm(t, axis=1)[:, None]
    out = np.cross(_horizontal(position), UP)
    across = out - (t @ out)[:, None] * t
    across /= np.linalg.norm(across, axis=1)[:, None]
    return np.stack([np.cross(t, across), across, t], axis=1)


def _horizontal(position: Array) -> Array:
    """Unit vector (3,) from start to end in plan; x where they lie above each other."""
    chord = position[-1] - position[0]
    plan = chord * [1.0, 1.0, 0.0]
    size = float(np.linalg.norm(plan))
    return plan / size if size > PLUMB * float(np.linalg.norm(chord)) else np.array([1.0, 0.0, 0.0])


def _squared(line: Line, state: State, own: LineShapes) -> Array:
    """Squared displacement along a line (n, 4), by DIRECTIONS."""
    tangents, length = line.trial(state).turn.tangent @ line.basis.T, line.tributary_length
    along = np.einsum("nki,mni->mnk", _axes(tangents, own.position), own.shape)
    of_axis = np.einsum("n,mnk->mk", length, along**2)
    return np.column_stack([of_axis, (_radius(line) * own.twist) ** 2 @ length])


def _shares(parts: Array, least: float) -> Array:
    """Shares (n, 4) of parts in their sum; nan where the sum is not more than the least."""
    total = parts.sum(axis=1)[:, None]
    return np.divide(parts, total, out=np.full_like(parts, np.nan), where=total > least)


class RiserAtRest(NamedTuple):
    """Equilibrium at the end of a stage without inertia. stiffness, mass (free, free): by the increments of the free
    dofs, of all fields; rows (size,): row of each entry of a local array, -1 where prescribed.
    """

    assembly: Assembly
    stage: Stage
    stiffness: csr_array
    mass: csr_array
    rows: IntArray

    @property
    def bodies(self) -> list[MovingBody]:
        bodies_and_joints = self.assembly.bodies_and_joints
        return [] if bodies_and_joints is None else [*bodies_and_joints.bodies.values()]

    def whole(self, free: Array) -> Array:
        """A local array (size,) of the free dofs' values, zero where prescribed."""
        return np.where(self.rows < 0, 0.0, np.append(free, 0.0)[self.rows])


def at_rest(scene: Scene, stage: str | None = None) -> RiserAtRest:
    """The riser at the end of a static stage, by default the last before the first dynamic one.

    SceneError where there is no such stage; else raises what a run would.
    """
    stages = stages_up_to(scene, stage)
    assembly = build(sized(scene), communicator_of(scene))
    solve_stages(assembly, StatelessObserver(), stages)
    of_bodies = [] if assembly.bodies_and_joints is None else assembly.bodies_and_joints.frictions.values()
    for friction in (*assembly.frictions, *of_bodies):
        friction.stick()
    if assembly.soil is not None:
        assembly.soil.whole.mix_elastic(1.0)
    return _linearised(assembly, stages[-1])


def stages_up_to(scene: Scene, name: str | None) -> list[Stage]:
    """The scene's first stages up to a named one, none of them dynamic."""
    names = [stage.name for stage in scene.stages]
    if name is not None and name not in names:
        raise SceneError(f'--stage "{name}": the scene has no such stage; it has {", ".join(names)}')
    stages: list[Stage] = []
    for stage in scene.stages:
        if isinstance(stage, DynamicStage):
            break
        stages.append(stage)
        if stage.name == name:
            return stages
    if name is not None:
        raise SceneError(f'--stage "{name}": a riser at rest is that after static stages alone; name one of the first')
    if not stages:
        raise SceneError("stages: modes are those of a riser at rest; begin with a static stage")
    return stages


def _linearised(assembly: Assembly, stage: Stage) -> RiserAtRest:
    model, state = assembly.begin(stage), State.at_rest(stage.end, assembly.size)
    cushion = None if assembly.soil is None else assembly.soil.cushion
    at_rest = [part for part in model.parts if part is not cushion]
    massive = _with_mass(assembly)
    system = System(assembly.comm, replace(model, parts=[*at_rest, *massive]), Timer.new())
    try:
        stiffness = _assembled(system, state, STIFFNESS, at_rest)
        mass = _assembled(system, state, MASS, massive)
        return RiserAtRest(assembly, stage, stiffness, mass, system.numbering.index)
    finally:
        system.destroy()


def _with_mass(assembly: Assembly) -> list[Part]:
    """Mass of lines and bodies and added mass of their water, which stands still and has a level surface."""
    parts = [part for own in assembly.lines.values() for part in _of_line(own)]
    if (bodies_and_joints := assembly.bodies_and_joints) is not None and bodies_and_joints.bodies:
        from riser_soil.bodies.inertia import BodyInertia

        given = bodies_and_joints.given
        parts += [BodyInertia(body, given[name].mass_matrix()) for name, body in bodies_and_joints.bodies.items()]
    return parts


def _of_line(own: LineAssembly) -> list[Part]:
    scene, line, elements, attached = own.scene, own.line, own.elements, own.attachments
    if scene.water is not None:
        scene = scene.model_copy(update={"water": scene.water.model_copy(update={"waves": None, "current": None})})
    parts = dynamic_parts(MOVING, line, elements, attached)
    if (still := sea_of(scene)) is not None:
        parts += sea_loads(scene, still.in_stage(MOVING), line, elements, attached)
    if (contents := scene.line.inner_flow) is not None:
        parts.append(contents_at(scene, contents, line, elements, clock=0.0))
    return [part for part in parts if "I" in part.traits.groups]


def _assembled(system: System, state: State, weights: Weights, parts: list[Part]) -> csr_array:
    system.assemble(state, weights, parts)
    indptr, indices, values = (each.copy() for each in system.matrix.mat.getValuesCSR())
    matrix = csr_array((values, indices, indptr), shape=(system.numbering.free,) * 2)
    matrix.eliminate_zeros()
    return matrix
