"""Natural frequencies and shapes of the riser at rest, taken there by its static stages: `modes_of`."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array

from riser_soil.assembly import Assembly, build, sized
from riser_soil.assembly.packages import communicator_of
from riser_soil.assembly.sea_loads import sea_loads
from riser_soil.assembly.stage import contents_at, dynamic_parts
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Model, Part, State, Weights
from riser_soil.core.system import System, Timer
from riser_soil.errors import SceneError, SolveError
from riser_soil.interruption import agreeing
from riser_soil.modes.eigenpairs import Eigenpairs, lowest
from riser_soil.riser.directors import Frames
from riser_soil.riser.line import UP
from riser_soil.riser.sections import larger_beside
from riser_soil.riser.spatial_directors import SpatialFrames
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage
from riser_soil.stages import LayingCounter, lay, run_stage

DIRECTIONS = ("in plane", "out of plane", "axial", "twist")
BETWEEN = "at no node"  # moves: the direction of a mode that elements are too long for
NEAR_ZERO = 1e-6  # of g over the riser's length: a mode whose square is not larger is one that nothing holds
MOST_ASYMMETRY = 0.01  # by which the part of the tangent that is not symmetric may change a frequency
GRAVITY = 9.81  # m/s2
UNSEEN = 1e-8  # of the nodes' turns times an element's length: displacements that are round-off
PLUMB = 1e-9  # of the distance of the ends: in plan, of ends above each other
STIFFNESS = Weights(inertia=0.0, force=1.0, shift_v=0.0, shift_a=0.0)
MASS = Weights(inertia=1.0, force=0.0, shift_v=0.0, shift_a=1.0)
MOVING = DynamicStage(name="small vibrations", kind="dynamic", duration=1.0, time_step=1.0)


class Modes(NamedTuple):
    """Modes of small vibrations about rest, the lowest first; n modes, nn nodes.

    frequency (n,) [Hz]. arc (nn,) [m], position (nn, 3) [m] at rest, global axes. shape (n, nn, 3): displacement of the
    axis, global axes, and twist (n, nn) [rad/m]: rotation about the pipe's axis, both for a largest displacement of 1
    of the axis or, where the pipe twists, of its surface. share (n, 4): of the squared displacement along the riser, by
    DIRECTIONS: across the pipe in the vertical plane from start to end, across it out of this plane, along it, and of
    the pipe's surface as it twists; nan, and no shape, where the nodes turn but stay in place, in half waves as short
    as elements. asymmetry: see `Eigenpairs`. stage: name of the static stage.
    """

    frequency: Array
    arc: Array
    position: Array
    shape: Array
    twist: Array
    share: Array
    asymmetry: float
    stage: str

    @property
    def period(self) -> Array:
        """(n,) [s]; infinite where nothing holds the riser."""
        return np.divide(1.0, self.frequency, out=np.full_like(self.frequency, np.inf), where=self.frequency > 0.0)

    @property
    def direction(self) -> list[str]:
        """Words for the largest share."""
        return [DIRECTIONS[share.argmax()] if np.isfinite(share).all() else BETWEEN for share in self.share]


def modes_of(scene: Scene, count: int = 10, stage: str | None = None) -> Modes:
    """The lowest modes of a scene's riser at the end of a static stage, by default the last before a dynamic one.

    Without damping. Stiffness is the tangent at rest: of the riser with its loads, of contact as it touches there, of
    the soil; friction sticks. Mass is that of the riser, what is in it and on it, and the added mass of still water;
    soil has none. Raises SceneError or what a run would; SolveError where the riser is unstable at rest, or its tangent
    far from symmetric.
    """
    rest = at_rest(scene, stage)
    least = NEAR_ZERO * GRAVITY / float(rest.assembly.line.arc[-1])
    found = lowest(rest.stiffness, rest.mass, count, -least)
    _require_sound(found, least)
    return _seen(rest, np.where(found.squares > least, found.squares, 0.0), found)


def _require_sound(found: Eigenpairs, least: float) -> None:
    if found.squares.min() < -least:
        raise SolveError(
            f"the riser at rest is unstable: the square of an angular frequency is {found.squares.min():.4g} rad2/s2; "
            "look at the static stage, refine the riser or hold its ends"
        )
    if found.asymmetry > MOST_ASYMMETRY:
        raise SolveError(
            f"the tangent at rest is not symmetric, as with drag in a current or moments in space: frequencies would "
            f"change by {found.asymmetry:.2g} of them, more than {MOST_ASYMMETRY:g}; leave out such loads"
        )


def _seen(rest: RiserAtRest, squares: Array, found: Eigenpairs) -> Modes:
    line = rest.assembly.line
    state = State.at_rest(rest.stage.end, rest.assembly.size)
    tangents = line.trial(state).turn.tangent @ line.basis.T
    nodal = np.array([line.nodal(rest.whole(mode)) for mode in found.modes])
    moved = nodal[..., : line.dimension] @ line.basis.T
    twist = _twist(line.frames, nodal[..., line.dimension :])
    radius = 0.5 * larger_beside(line.outer_diameter)
    turned = np.abs(nodal[..., line.dimension :]).max(axis=(1, 2)) * line.length.max()
    scale = _scale(moved, radius * twist, UNSEEN * turned)
    moved, twist = scale[:, None, None] * moved, scale[:, None] * twist
    position = line.positions3(state)
    share = _shares(moved, radius * twist, _axes(tangents, position), line.tributary_length)
    frequency = np.sqrt(squares) / (2.0 * np.pi)
    return Modes(frequency, line.arc, position, moved, twist, share, found.asymmetry, rest.stage.name)


def _twist(frames: Frames, rotation: Array) -> Array:
    """Rotations about the tangent (n, nn), from those in body axes (n, nn, 3); none in a plane."""
    if not isinstance(frames, SpatialFrames):
        return np.zeros(rotation.shape[:2])
    tangent = np.concatenate([frames.T0[:, 0, :, 0], frames.T0[-1:, 1, :, 0]])
    return np.asarray(np.einsum("mni,ni->mn", rotation, tangent))


def _scale(moved: Array, of_surface: Array, least: Array) -> Array:
    """Factors (n,) that make the largest displacement 1, and positive where it is of the axis; 0 where it is not more
    than `least` (n,).
    """
    values = np.concatenate([moved.reshape(len(moved), -1), of_surface], axis=1)
    sizes = np.maximum(np.linalg.norm(moved, axis=2), np.abs(of_surface)).max(axis=1)
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


def _shares(moved: Array, of_surface: Array, axes: Array, length: Array) -> Array:
    """Of the squared displacement along the riser (n, 4), by DIRECTIONS."""
    of_axis = np.einsum("n,mnk->mk", length, np.einsum("nki,mni->mnk", axes, moved) ** 2)
    parts = np.column_stack([of_axis, of_surface**2 @ length])
    total = parts.sum(axis=1)[:, None]
    return np.divide(parts, total, out=np.full_like(parts, np.nan), where=total > 0.0)


class RiserAtRest(NamedTuple):
    """Equilibrium at the end of a stage without inertia. stiffness, mass (free, free): by the increments of the free
    dofs, of all fields; rows (size,): row of each entry of a local array, -1 where prescribed.
    """

    assembly: Assembly
    stage: Stage
    stiffness: csr_array
    mass: csr_array
    rows: IntArray

    def whole(self, free: Array) -> Array:
        """A local array (size,) of the free dofs' values, zero where prescribed."""
        return np.where(self.rows < 0, 0.0, np.append(free, 0.0)[self.rows])


def at_rest(scene: Scene, stage: str | None = None) -> RiserAtRest:
    """The riser at the end of a static stage, by default the last before the first dynamic one.

    SceneError where there is no such stage; else raises what a run would.
    """
    stages = stages_up_to(scene, stage)
    assembly, clock = build(sized(scene), communicator_of(scene)), Timer.new()
    with agreeing(assembly.comm):
        before, _ = lay(assembly, clock)
        for each in stages:
            before = run_stage(assembly, each, before, LayingCounter(), clock)
    for friction in assembly.frictions:
        friction.stick()
    if assembly.soil is not None:
        assembly.soil.unload()
    return _linearised(assembly, stages[-1], clock)


def stages_up_to(scene: Scene, name: str | None) -> list[Stage]:
    """The scene's first stages up to a named one, none of them dynamic."""
    names = [stage.name for stage in scene.stages]
    if name is not None and name not in names:
        raise SceneError(f'--stage "{name}": the scene has no such stage; it has {", ".join(names)}')
    found: list[Stage] = []
    for stage in scene.stages:
        if isinstance(stage, DynamicStage):
            break
        found.append(stage)
        if stage.name == name:
            return found
    if name is not None:
        raise SceneError(f'--stage "{name}": a riser at rest is that after static stages alone; name one of the first')
    if not found:
        raise SceneError("stages: modes are those of a riser at rest; begin with a static stage")
    return found


def _linearised(assembly: Assembly, stage: Stage, clock: Timer) -> RiserAtRest:
    model, state = assembly.begin(stage), State.at_rest(stage.end, assembly.size)
    at_rest = [part for part in model.parts if part is not assembly.cushion]
    massive = _with_mass(assembly)
    system = System(assembly.comm, Model(model.lines, [*at_rest, *massive], model.others), clock)
    try:
        stiffness = _assembled(system, state, STIFFNESS, at_rest)
        mass = _assembled(system, state, MASS, massive)
        return RiserAtRest(assembly, stage, stiffness, mass, system.numbering.index)
    finally:
        system.destroy()


def _with_mass(assembly: Assembly) -> list[Part]:
    """Mass of the riser and added mass of its water, which stands still and has a level surface."""
    scene, line, elements, attached = assembly.scene, assembly.line, assembly.elements, assembly.attachments
    if scene.water is not None:
        scene = scene.model_copy(update={"water": scene.water.model_copy(update={"waves": None, "current": None})})
    parts = dynamic_parts(MOVING, line, elements, attached) + sea_loads(scene, line, elements, MOVING, attached)
    parts += contents_at(scene, line, elements, clock=0.0)
    return [part for part in parts if "I" in part.traits.groups]


def _assembled(system: System, state: State, weights: Weights, parts: list[Part]) -> csr_array:
    system.assemble(state, weights, parts)
    indptr, indices, values = (each.copy() for each in system.matrix.mat.getValuesCSR())
    found = csr_array((values, indices, indptr), shape=(system.numbering.free,) * 2)
    found.eliminate_zeros()
    return found
