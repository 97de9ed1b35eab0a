"""The story of a run: scene, parts, system, time loop, recorder."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

from mpi4py import MPI

from riser_soil.assembly import Assembly, build
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
from riser_soil.solve.time_stepper import Accepted, TimeStepper

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
        assembly = build(scene, comm)
        clock.add("build", since)
        for doubt in (*physical_warnings(assembly), *too_long(size)):
            if comm.rank == 0:
                print(f"warning: {doubt}")
        with agreeing(comm), Observer.open(assembly, clock, folder, force) as observer:
            _take_all(assembly, observer, clock)


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


def _take_all(assembly: Assembly, observer: Observer, clock: Clock) -> None:
    try:
        before = lay(assembly, observer, clock)
        for stage in assembly.scene.stages:
            before = run_stage(assembly, stage, before, observer, clock)
        with undivided():
            observer.finish()
    except (SolveError, Interruption) as end:
        observer.record_last(end)
        raise


def lay(assembly: Assembly, observer: Observer, clock: Clock) -> State:
    """Before all stages: where a slack riser's first shape ends beyond its place, bring its end there."""
    rest, stage = State.at_rest(0.0, assembly.size), assembly.laying
    if stage is None:
        return rest
    follower = Laying()
    try:
        laid = _take(assembly, assembly.begin_laying(stage), stage, rest, follower, clock)
    except SolveError as err:
        raise SolveError(f"{assembly.too_slack}: {err}") from err
    observer.laid(assembly.slack, follower.steps, follower.relaxations)
    return laid


class Follower(Protocol):
    """Who is told how a stage goes on."""

    def begin_stage(self, stage: Stage, stepper: TimeStepper) -> None: ...

    def record(self, stepper: TimeStepper, step: Accepted, last: bool) -> None: ...

    def relaxed(self, relaxed: Relaxed) -> None: ...


@dataclass
class Laying:
    """Counts the load steps and relaxations of a stage that the scene does not have."""

    steps: int = 0
    relaxations: int = 0

    def begin_stage(self, stage: Stage, stepper: TimeStepper) -> None:
        pass

    def record(self, stepper: TimeStepper, step: Accepted, last: bool) -> None:
        self.steps += 1

    def relaxed(self, relaxed: Relaxed) -> None:
        self.relaxations += 1


def run_stage(assembly: Assembly, stage: Stage, before: State, observer: Follower, clock: Clock) -> State:
    """Take one stage to its end; the state that it leaves, increments zero."""
    return _take(assembly, assembly.begin(stage), stage, before, observer, clock)


def _take(assembly: Assembly, model: Model, stage: Stage, before: State, observer: Follower, clock: Clock) -> State:
    system = System(assembly.comm, model, clock)
    newton = Newton(system, _settings(assembly))
    try:
        stepper = TimeStepper(system, newton, scheme_of(stage), replace(before, t=0.0))
        with undivided():
            observer.begin_stage(stage, stepper)
        return _walk(assembly, stage, stepper, observer)
    except SolveError as err:
        raise SolveError(f"{err}{_overload(assembly)}") from err
    finally:
        newton.destroy()
        system.destroy()


def _overload(assembly: Assembly) -> str:
    """What the ground has to do with a failure."""
    if not assembly.contacts:
        return ""
    from riser_soil.checks.overload import overload

    return overload(assembly)


def _walk(assembly: Assembly, stage: Stage, stepper: TimeStepper, observer: Follower) -> State:
    control = steps_of(assembly, stage, stepper)
    while not control.finished:
        static = isinstance(stage, StaticStage)
        step = _static_step(assembly, stepper, control, observer) if static else stepper.advance(control)
        with undivided():
            stepper.commit(step, control)
            observer.record(stepper, step, last=control.finished)
        check(assembly.comm)
    return stepper.before


def _static_step(assembly: Assembly, stepper: TimeStepper, control: Control, observer: Follower) -> Accepted:
    """By Newton's method, in load steps that are halved a few times, else by dynamic relaxation.

    Where relaxation does not get to the load factor that was missed, it all begins again with half the step.
    """
    while True:
        try:
            return stepper.advance(control, MOST_CUTS if stepper.depends_on(control) else 0)
        except SolveError:
            if _relaxed(assembly, stepper, control, observer):
                return stepper.advance(control, 0)


def _relaxed(assembly: Assembly, stepper: TimeStepper, control: Control, observer: Follower) -> bool:
    """Whether an equilibrium was found at the load factor that Newton's method missed; else the step is halved."""
    system, settings, weight = stepper.system, _settings(assembly), assembly.scales.weight
    try:
        relaxed = relax(assembly.comm, system.model, assembly.line, weight, settings, system.clock, control.target)
    except SolveError:
        if not stepper.depends_on(control) or not control.cut():
            raise
        return False
    observer.relaxed(relaxed)
    stepper.restart()
    return True


def _settings(assembly: Assembly) -> NewtonSettings:
    solver = assembly.scene.solver
    return NewtonSettings(solver.tolerance, solver.max_iterations, assembly.scales.force_floor)


def steps_of(assembly: Assembly, stage: Stage, stepper: TimeStepper) -> Control:
    """The steps of a stage, from its beginning to its end."""
    solver = assembly.scene.solver
    if isinstance(stage, StaticStage):
        return StepControl(1.0, 1.0 / solver.load_steps, solver.min_load_step)
    smallest = assembly.smallest_step(stage)
    if stage.time_step == "auto":
        tolerance = assembly.error_tolerance(stage)
        first = first_step(stepper.system, stepper.now, tolerance)
        return AutoSteps(stage.duration, tolerance, smallest, first, times_to_hit(assembly.scene, stage))
    return StepControl(stage.duration, stage.time_step, smallest)
