"""The story of a run: scene, parts, system, time loop, recorder."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

from mpi4py import MPI

from riser_soil.assembly import World, build
from riser_soil.assembly.stage import scheme_of, times_to_hit
from riser_soil.checks.limits import size_that_fits, tell, too_long
from riser_soil.checks.plausibility import physical_warnings
from riser_soil.core.part import Model, State
from riser_soil.core.system import Clock, System
from riser_soil.errors import Interruption, SceneError, SolveError, WriteError
from riser_soil.interruption import agreeing, check, listening, undivided
from riser_soil.results.observer import Observer
from riser_soil.results.ownership import refuse
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Stage, StaticStage
from riser_soil.solve.automatic_steps import AutoSteps
from riser_soil.solve.dynamic_relaxation import Relaxed, relax
from riser_soil.solve.local_error import first_step
from riser_soil.solve.newton import Newton, NewtonSettings
from riser_soil.solve.step_control import Control, StepControl
from riser_soil.solve.time_stepper import Accepted, March

MOST_CUTS = 4  # of a static step, before relaxation is tried at what is left of it


def run(scene: Scene, folder: Path | str, force: bool = False) -> None:
    """Run a scene and leave its results in a folder; collective over all ranks.

    force: overwrite a finished run. Raises SceneError or MeshError before anything is computed. After SolveError, and
    Interruption at Ctrl-C or SIGTERM, the folder keeps everything up to the last accepted step, after WriteError what
    went in; it is marked unfinished.
    """
    folder = Path(folder)
    with listening():
        _refuse(folder, force)
        comm, clock, since = MPI.COMM_WORLD, Clock.new(), time.perf_counter()
        size = size_that_fits(scene, folder, comm)
        tell(size, comm)
        world = build(scene, comm)
        clock.add("build", since)
        for doubt in (*physical_warnings(world), *too_long(size)):
            if comm.rank == 0:
                print(f"warning: {doubt}")
        with agreeing(comm), Observer.open(world, clock, folder, force) as observer:
            _take_all(world, observer, clock)


def _refuse(folder: Path, force: bool) -> None:
    """On all ranks by what the first one sees."""
    comm, failure = MPI.COMM_WORLD, None
    if comm.rank == 0:
        try:
            refuse(folder, force)
        except (SceneError, WriteError) as err:
            failure = err
    if failure := comm.bcast(failure):
        raise failure


def _take_all(world: World, observer: Observer, clock: Clock) -> None:
    try:
        before = lay(world, observer, clock)
        for stage in world.scene.stages:
            before = run_stage(world, stage, before, observer, clock)
        with undivided():
            observer.finish()
    except (SolveError, Interruption) as end:
        observer.record_last(end)
        raise


def lay(world: World, observer: Observer, clock: Clock) -> State:
    """Before all stages: where a slack riser's first shape ends beyond its place, bring its end there."""
    rest, stage = State.at_rest(0.0, world.size), world.laying
    if stage is None:
        return rest
    follower = Laying()
    try:
        laid = _take(world, world.begin_laying(stage), stage, rest, follower, clock)
    except SolveError as err:
        raise SolveError(f"{world.too_slack}: {err}") from err
    observer.laid(world.slack, follower.steps, follower.relaxations)
    return laid


class Follower(Protocol):
    """Who is told how a stage goes on."""

    def begin_stage(self, stage: Stage, march: March) -> None: ...

    def record(self, march: March, step: Accepted, last: bool) -> None: ...

    def relaxed(self, relaxed: Relaxed) -> None: ...


@dataclass
class Laying:
    """Counts the load steps and relaxations of a stage that the scene does not have."""

    steps: int = 0
    relaxations: int = 0

    def begin_stage(self, stage: Stage, march: March) -> None:
        pass

    def record(self, march: March, step: Accepted, last: bool) -> None:
        self.steps += 1

    def relaxed(self, relaxed: Relaxed) -> None:
        self.relaxations += 1


def run_stage(world: World, stage: Stage, before: State, observer: Follower, clock: Clock) -> State:
    """Take one stage to its end; the state that it leaves, increments zero."""
    return _take(world, world.begin(stage), stage, before, observer, clock)


def _take(world: World, model: Model, stage: Stage, before: State, observer: Follower, clock: Clock) -> State:
    system = System(world.comm, model, clock)
    newton = Newton(system, _settings(world))
    try:
        march = March(system, newton, scheme_of(stage), replace(before, t=0.0))
        with undivided():
            observer.begin_stage(stage, march)
        return _walk(world, stage, march, observer)
    except SolveError as err:
        raise SolveError(f"{err}{_overload(world)}") from err
    finally:
        newton.destroy()
        system.destroy()


def _overload(world: World) -> str:
    """What the ground has to do with a failure."""
    if not world.contacts:
        return ""
    from riser_soil.checks.overload import overload

    return overload(world)


def _walk(world: World, stage: Stage, march: March, observer: Follower) -> State:
    control = steps_of(world, stage, march)
    while not control.finished:
        static = isinstance(stage, StaticStage)
        step = _static_step(world, march, control, observer) if static else march.advance(control)
        with undivided():
            march.commit(step, control)
            observer.record(march, step, last=control.finished)
        check(world.comm)
    return march.before


def _static_step(world: World, march: March, control: Control, observer: Follower) -> Accepted:
    """By Newton's method, in load steps that are halved a few times, else by dynamic relaxation.

    Where relaxation does not get to the load factor that was missed, it all begins again with half the step.
    """
    while True:
        try:
            return march.advance(control, MOST_CUTS if march.depends_on(control) else 0)
        except SolveError:
            if _relaxed(world, march, control, observer):
                return march.advance(control, 0)


def _relaxed(world: World, march: March, control: Control, observer: Follower) -> bool:
    """Whether an equilibrium was found at the load factor that Newton's method missed; else the step is halved."""
    system, settings, weight = march.system, _settings(world), world.scales.weight
    try:
        relaxed = relax(world.comm, system.model, world.line, weight, settings, system.clock, control.target)
    except SolveError:
        if not march.depends_on(control) or not control.cut():
            raise
        return False
    observer.relaxed(relaxed)
    march.restart()
    return True


def _settings(world: World) -> NewtonSettings:
    solver = world.scene.solver
    return NewtonSettings(solver.tolerance, solver.max_iterations, world.scales.force_floor)


def steps_of(world: World, stage: Stage, march: March) -> Control:
    """The steps of a stage, from its beginning to its end."""
    solver = world.scene.solver
    if isinstance(stage, StaticStage):
        return StepControl(1.0, 1.0 / solver.load_steps, solver.min_load_step)
    smallest = world.smallest_step(stage)
    if stage.time_step == "auto":
        tolerance = world.error_tolerance(stage)
        first = first_step(march.system, march.now, tolerance)
        return AutoSteps(stage.duration, tolerance, smallest, first, times_to_hit(world.scene, stage))
    return StepControl(stage.duration, stage.time_step, smallest)
