"""The story of a run: scene, parts, system, time loop, recorder."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

from mpi4py import MPI

from riser_soil.build import World, build
from riser_soil.build.stage import scheme_of
from riser_soil.doubts import physical_warnings
from riser_soil.errors import SolveError
from riser_soil.folder import refuse_finished
from riser_soil.march import March
from riser_soil.newton import Newton, NewtonSettings
from riser_soil.observe import Observer
from riser_soil.part import State
from riser_soil.relax import relax
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Stage, StaticStage
from riser_soil.stepping import StepControl
from riser_soil.system import Clock, System


def run(scene: Scene, folder: Path, force: bool = False) -> None:
    """Run a scene and leave its results in a folder; collective over all ranks.

    force: overwrite a finished run. Raises SceneError, MeshError or SolveError; after the last the folder keeps
    everything up to the last accepted step, marked unfinished.
    """
    refuse_finished(folder, force)
    comm, clock, since = MPI.COMM_WORLD, Clock.new(), time.perf_counter()
    world = build(scene, comm)
    clock.add("build", since)
    for doubt in physical_warnings(world):
        if comm.rank == 0:
            print(f"warning: {doubt}")
    with Observer.open(world, clock, folder, force) as observer:
        before = State.at_rest(0.0, world.size)
        for stage in scene.stages:
            before = run_stage(world, stage, before, observer, clock)
        observer.finish()


def run_stage(world: World, stage: Stage, before: State, observer: Observer, clock: Clock) -> State:
    """Take one stage to its end; the state that it leaves, increments zero."""
    model = world.begin(stage)
    system = System(world.comm, model, clock)
    newton = Newton(system, _settings(world))
    try:
        march = March(system, newton, scheme_of(stage), replace(before, t=0.0))
        observer.begin_stage(stage, march.energy)
        return _walk(world, stage, march, observer)
    finally:
        newton.destroy()
        system.destroy()


def _walk(world: World, stage: Stage, march: March, observer: Observer) -> State:
    control, relaxed = _control(world, stage), False
    while not control.finished:
        try:
            step = march.advance(control)
        except SolveError:
            if relaxed or not isinstance(stage, StaticStage):
                raise
            _relax(world, march, control.target, observer)
            relaxed = True
            control.widen()
            continue
        march.commit(step, control)
        observer.record(march, step, last=control.finished)
        relaxed = False
    return march.before


def _relax(world: World, march: March, t: float, observer: Observer) -> None:
    """Where Newton's method can't go on in a static stage: to an equilibrium at the load factor t that it missed."""
    system = march.system
    iterations = relax(world.comm, system.model, world.line, world.weight, _settings(world), system.clock, t)
    observer.relaxed(iterations)
    march.restart()


def _settings(world: World) -> NewtonSettings:
    solver = world.scene.solver
    return NewtonSettings(solver.tolerance, solver.max_iterations, world.force_floor)


def _control(world: World, stage: Stage) -> StepControl:
    solver = world.scene.solver
    if isinstance(stage, StaticStage):
        return StepControl(1.0, 1.0 / solver.load_steps, solver.min_load_step)
    return StepControl(stage.duration, stage.time_step, solver.min_time_step)
