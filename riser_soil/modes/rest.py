"""The riser at rest: static stages taken to their end, and stiffness and mass of small vibrations about it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array

from riser_soil.assembly import Assembly, build, sized
from riser_soil.assembly.packages import communicator_of
from riser_soil.assembly.sea_loads import sea_loads
from riser_soil.assembly.stage import dynamic_parts
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Model, Part, State, Weights
from riser_soil.core.system import System, Timer
from riser_soil.errors import SceneError
from riser_soil.interruption import agreeing
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage
from riser_soil.stages import LayingCounter, lay, run_stage

STIFFNESS = Weights(inertia=0.0, force=1.0, shift_v=0.0, shift_a=0.0)
MASS = Weights(inertia=1.0, force=0.0, shift_v=0.0, shift_a=1.0)
MOVING = DynamicStage(name="small vibrations", kind="dynamic", duration=1.0, time_step=1.0)


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
    return [part for part in parts if "I" in part.traits.groups]


def _assembled(system: System, state: State, weights: Weights, parts: list[Part]) -> csr_array:
    system.assemble(state, weights, parts)
    indptr, indices, values = (each.copy() for each in system.matrix.mat.getValuesCSR())
    found = csr_array((values, indices, indptr), shape=(system.numbering.free,) * 2)
    found.eliminate_zeros()
    return found
