"""A stage from its beginning to its end: its system, its steps, and dynamic relaxation where statics need it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

from riser_soil.assembly import Assembly
from riser_soil.assembly.stage import scheme_of, times_to_hit
from riser_soil.core.part import Model, State
from riser_soil.core.system import Clock, System
from riser_soil.errors import SolveError
from riser_soil.interruption import check, undivided
from riser_soil.scene.stages import Stage, StaticStage
from riser_soil.solve.automatic_steps import AutoSteps
from riser_soil.solve.dynamic_relaxation import Relaxed, relax
from riser_soil.solve.local_error import first_step
from riser_soil.solve.newton import Newton, NewtonSettings
from riser_soil.solve.step_control import Control, StepControl
from riser_soil.solve.time_stepper import Accepted, TimeStepper

MOST_CUTS = 4  # of a static step, before relaxation is tried at what is left of it


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


def lay(assembly: Assembly, clock: Clock) -> tuple[State, Laying | None]:
    """Before all stages: where a slack riser's first shape ends beyond its place, bring its end there."""
    rest, stage = State.at_rest(0.0, assembly.size), assembly.laying
    if stage is None:
        return rest, None
    follower = Laying()
    try:
        return _take(assembly, assembly.begin_laying(stage), stage, rest, follower, clock), follower
    except SolveError as err:
        raise SolveError(f"{assembly.too_slack}: {err}") from err


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
