"""Analysis of one stage, from its assembled system to its end, with dynamic relaxation where statics need it.

A riser on soil first comes to rest on a cushion, without the soil.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Protocol

import numpy as np

from riser_soil.assembly import Assembly, LineAssembly
from riser_soil.assembly.assembly import LAID_IN, LETTING_GO
from riser_soil.assembly.motions import corners
from riser_soil.assembly.stage import scheme_of, times_to_hit
from riser_soil.checks.overload import overload
from riser_soil.core.arrays import Array
from riser_soil.core.communicator import destroyed_together
from riser_soil.core.part import Model, State
from riser_soil.core.roles import Adaptive, owners, with_role
from riser_soil.core.saved_state import Saved, Stateful, gathered, restore_all, within
from riser_soil.core.system import System, Timer, total
from riser_soil.errors import SolveError
from riser_soil.interruption import agreeing, asked_to_end, end_together, uninterrupted
from riser_soil.results.end_of_run import take_up_end_of_run
from riser_soil.scene.stages import DynamicStage, QuasiStaticStage, Stage, StaticStage
from riser_soil.solve.adaptive_steps import AutoSteps, from_last_to_first
from riser_soil.solve.dynamic_relaxation import RelaxationResult, relax
from riser_soil.solve.local_error import first_step
from riser_soil.solve.newton import Newton, solver_of
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.settling import Pressed, SinkingError, settle
from riser_soil.solve.step import NotConvergedError, Step
from riser_soil.solve.step_control import PathSteps, StepControl
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper

MOVED_BY, PRESSED_BY = 0.25, 1 / 160  # diameters by which a load step moves an end on soil; presses it into clay
ROUND_OFF = 1e-9  # of a load step
AUTO_SMALLEST, AUTO_SMALLEST_OF_STAGE = 1e-4, 1e-7  # of a given time step; of a stage's duration if they are automatic
MOST_STEPS = 64  # load steps of a stage, unless the scene asks for more
MOST_RELAXED = 1  # dynamic relaxations in a static stage on clay
MOST_SUNK = 1 / 40  # diameters by which the riser may sink in a static step on soil that moves
MOST_CUTS = 4  # of a static step, before dynamic relaxation is tried at its last size


CheckpointWriter = Callable[[Callable[[], Saved], bool, bool], None]
"""Called between steps with a function that gives the saved state, from which the stage can be resumed; whether it is
the stage's last step; and whether the run ends here before its time.
"""


class StageObserver(Stateful, Protocol):
    """Observer of a stage: its methods are called at its beginning, after accepted steps and after relaxation."""

    def begin_stage(self, stage: Stage, stepper: TimeStepper) -> None: ...

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None: ...

    def relaxed(self, relaxed: RelaxationResult) -> None: ...


class StatelessObserver:
    """An observer that has no state to resume from, and does nothing with what it doesn't define a method for."""

    def begin_stage(self, stage: Stage, stepper: TimeStepper) -> None:
        pass

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        pass

    def relaxed(self, relaxed: RelaxationResult) -> None:
        pass

    def state(self) -> Saved:
        return {}

    def restore(self, saved: Saved) -> None:
        pass


@dataclass
class LayingCounter(StatelessObserver):
    """Counts the load steps and relaxations while a slack riser is laid, before the scene's stages."""

    steps: int = 0
    relaxations: int = 0

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        self.steps += 1

    def relaxed(self, relaxed: RelaxationResult) -> None:
        self.relaxations += 1


def lay(assembly: Assembly, clock: Timer) -> tuple[State, LayingCounter | None]:
    """State before all stages: at rest, or the end of another run; a slack riser's end is moved to its position first.

    The counter is that of the steps of laying, None where nothing was laid.
    """
    if assembly.scene.initial is not None:
        return take_up_end_of_run(assembly), None
    rest, stage = State.at_rest(0.0, assembly.size), assembly.laying
    if stage is None:
        return rest, None
    slackest = assembly.slackest
    if slackest.too_soft:
        raise SolveError(slackest.too_soft)
    counter = LayingCounter()
    try:
        _solve_stage(assembly, assembly.begin_laying(stage), stage, None, counter, clock)
    except SolveError as err:
        raise SolveError(f"{slackest.too_slack}: {err}" if slackest.slack else f"joints do not close: {err}") from err
    if assembly.lets_go:
        _release_bodies(assembly, counter, clock)
    return rest, counter


def _release_bodies(assembly: Assembly, counter: LayingCounter, clock: Timer) -> None:
    """Solve for the equilibrium of bodies that were supported during laying, as their supports' forces fade out."""
    assert assembly.bodies_and_joints is not None
    stage = StaticStage(name=LETTING_GO, kind="static")
    supported = System(assembly.comm, assembly.begin_laying(stage), clock)
    with destroyed_together(assembly.comm, supported.destroy):
        residual = total(supported.forces(State.at_rest(1.0, supported.numbering.size)))
    reactions = {name: residual[body.part] for name, body in assembly.bodies_and_joints.bodies.items()}
    _solve_stage(assembly, assembly.begin_letting_go(stage, reactions), stage, None, counter, clock)


def solve_stages(assembly: Assembly, observer: StageObserver, stages: Sequence[Stage] | None = None) -> State:
    """Solve a scene's first stages, by default all, without a results folder; the state at their end; collective.

    Raises the errors of a run.
    """
    clock = Timer.new()
    with agreeing(assembly.comm):
        state, _ = lay(assembly, clock)
        for stage in assembly.scene.stages if stages is None else stages:
            state = run_stage(assembly, stage, state, observer, clock)
    return state


def run_stage(
    assembly: Assembly,
    stage: Stage,
    before: State,
    observer: StageObserver,
    clock: Timer,
    checkpoint: CheckpointWriter | None = None,
) -> State:
    """Solve one stage from an accepted state; the state at its end, increments zero."""
    return _solve_stage(assembly, assembly.begin(stage), stage, before, observer, clock, checkpoint)


def resume_stage(
    assembly: Assembly, saved: Saved, observer: StageObserver, clock: Timer, checkpoint: CheckpointWriter | None = None
) -> tuple[Stage, State]:
    """Solve the rest of a stage that was saved on its way; the stage, and the state at its end.

    assembly, observer: built anew from the scene. The stages before were solved in the run that was saved.
    """
    assembly.restore(within(saved, "assembly"))
    stage, model = assembly.resume()
    return stage, _solve_stage(assembly, model, stage, saved, observer, clock, checkpoint)


def _solve_stage(
    assembly: Assembly,
    model: Model,
    stage: Stage,
    begin: State | Saved | None,
    observer: StageObserver,
    clock: Timer,
    checkpoint: CheckpointWriter | None = None,
) -> State:
    """Solve one stage. begin: initial state, saved state to resume from, or None for rest."""
    if isinstance(begin, State | None) and assembly.is_cushioned_in(stage):
        seat(assembly, model, settings_of(assembly), clock)
    system = System(assembly.comm, model, clock)
    if begin is None:
        begin = State.at_rest(0.0, system.numbering.size)
    if not isinstance(begin, State):
        _restore(system, begin)
    newton = solver_of(system, scheme_of(stage).dynamic, _settings_in(assembly, stage))
    with destroyed_together(assembly.comm, newton.destroy, system.destroy):
        try:
            run = _begin_run(assembly, stage, system, newton, begin, observer)
            return _step_to_end(run, checkpoint)
        except SolveError as err:
            raise SolveError(f"{err}{_overload(assembly)}") from err


def _restore(system: System, saved: Saved) -> None:
    restore_all(owners(system.model), saved)
    if with_role(system.model.parts, Adaptive):
        system.renew_pattern()


@dataclass(eq=False)
class StageRun:
    """A stage in progress. relaxed: how often dynamic relaxation has been tried."""

    assembly: Assembly
    stage: Stage
    stepper: TimeStepper
    control: StepControl | PathSteps | AutoSteps
    observer: StageObserver
    relaxed: int = 0

    def state(self) -> Saved:
        """All that a stage is resumed from, as arrays by name."""
        own: dict[str, Stateful] = {"assembly": self.assembly, "stepper": self.stepper}
        kept = gathered(owners(self.stepper.system.model) | own | self.listeners)
        return kept | {"relaxed": np.array(self.relaxed)}

    @property
    def listeners(self) -> dict[str, Stateful]:
        """Owners of state that follow each step."""
        return {"control": self.control, "observer": self.observer, "clock": self.stepper.system.clock}


def _begin_run(
    assembly: Assembly, stage: Stage, system: System, newton: Newton, begin: State | Saved, observer: StageObserver
) -> StageRun:
    """The stage at its beginning, or as it was saved; collective."""
    if isinstance(begin, State):
        guess = assembly.first_guess(stage)
        stepper = TimeStepper(system, newton, scheme_of(stage), replace(begin, t=0.0), first_guess=guess)
        with uninterrupted():
            observer.begin_stage(stage, stepper)
        return StageRun(assembly, stage, stepper, steps_of(assembly, stage, stepper), observer)
    stepper = TimeStepper(system, newton, scheme_of(stage), within(begin, "stepper"))
    run = StageRun(assembly, stage, stepper, steps_of(assembly, stage, stepper), observer, int(begin["relaxed"]))
    restore_all(run.listeners, begin)
    return run


def _overload(assembly: Assembly) -> str:
    """Words on bearing capacity where a solve failed; empty where the ground bears the riser."""
    if not assembly.contacts:
        return ""
    return overload(assembly)


def _step_to_end(run: StageRun, checkpoint: CheckpointWriter | None) -> State:
    """Advance step by step to the end of the stage; a checkpoint after each step, and the run's end where asked for."""
    stepper, control = run.stepper, run.control
    while not control.finished:
        dynamic = isinstance(run.stage, DynamicStage)
        step = stepper.advance(control) if dynamic else _static_step(run)
        with uninterrupted():
            stepper.commit(step, control)
            run.observer.record(stepper, step, last=control.finished)
        leaving = asked_to_end(run.assembly.comm)
        if checkpoint is not None:
            checkpoint(run.state, control.finished, leaving)
        if leaving:
            end_together()
    return stepper.before


def _static_step(run: StageRun) -> AcceptedStep:
    """Solve a static step by Newton's method, with its fallbacks.

    The fallbacks in turn: settling, on soil that moves; load steps that are halved a few times; dynamic relaxation.
    Where relaxation fails at the load factor wanted, all begins again with half the step. On clay, soil or a hysteretic
    seabed, it is tried MOST_RELAXED times: at the end of its strength clay creeps on in ever shorter steps.
    """
    assembly, stepper, control = run.assembly, run.stepper, run.control
    seabed = assembly.scene.seabed
    on_clay = assembly.soil_bears or (seabed is not None and seabed.kind == "hysteretic")
    while True:
        if assembly.soil_bears and assembly.scene.soil_moves and (step := _followed_by_soil(run)):
            return step
        try:
            return stepper.advance(control, MOST_CUTS if stepper.depends_on(control) else 0)
        except SolveError:
            run.relaxed += 1
            if on_clay and run.relaxed > MOST_RELAXED:
                raise
        try:
            _bring_to_rest(run, _by_relaxation)
        except SolveError:
            if not stepper.depends_on(control) or not control.cut():
                raise
            continue
        return stepper.advance(control, 0)


def _followed_by_soil(run: StageRun) -> AcceptedStep | None:
    """A static step in which the riser sinks by MOST_SUNK diameters at most; None where none converges.

    The step is cut where supports press the riser in. Where it sinks farther or none converges, settling is tried.
    """
    stepper, longest = run.stepper, MOST_SUNK * _on_soil(run.assembly).scales.diameter
    try:
        step = stepper.advance(run.control, MOST_CUTS if stepper.moves_supports(run.control) else 0)
        if _sunk(run.assembly, stepper.before, step.solution.state) <= longest:
            return step
    except SolveError:
        pass
    try:
        _bring_to_rest(run, _by_settling)
        return stepper.advance(run.control, 0)
    except SinkingError:
        raise
    except SolveError:
        return None


def _sunk(assembly: Assembly, before: State, after: State) -> float:
    """How far [m] a line on soil has sunk where it presses; collective."""
    line, presses = _on_soil(assembly).line, _pressing(assembly, after) > 0.0
    down = line.positions3(before)[:, 2] - line.positions3(after)[:, 2]
    return float(down[presses].max(initial=0.0))


def _on_soil(assembly: Assembly) -> LineAssembly:
    """The line that lies on the soil, in a scene with soil."""
    line = assembly.line_on_soil
    assert line is not None
    return line


def _pressing(assembly: Assembly, state: State) -> Array:
    """Force per length (nn,) [N/m] on the soil, the same on all ranks; collective."""
    soil = assembly.soil
    assert soil is not None
    return assembly.comm.allreduce(soil.contact.force_per_length(state))


def _bring_to_rest(run: StageRun, seek: Callable[[StageRun], RelaxationResult]) -> None:
    """Find an equilibrium at the load factor where Newton's method failed, and commit it.

    SolveError where there is none; then all is as after the last step.
    """
    stepper = run.stepper
    before = gathered(owners(stepper.system.model))
    try:
        settled = seek(run)
    except SolveError:
        restore_all(owners(stepper.system.model), before)
        stepper.newton.renew()
        raise
    stepper.newton.renew()  # the search has chosen patterns of its own
    run.observer.relaxed(settled)
    stepper.restart()
    stepper.newton.at_equilibrium = True


def _by_relaxation(run: StageRun) -> RelaxationResult:
    """Equilibrium at the load factor of the step, by dynamic relaxation."""
    assembly, system = run.assembly, run.stepper.system
    settings, weight = settings_of(assembly), assembly.scales.weight
    loads = {} if assembly.bodies_and_joints is None else assembly.bodies_and_joints.loads
    return relax(assembly.comm, system.model, weight, settings, system.clock, run.control.target, loads)


def _by_settling(run: StageRun) -> RelaxationResult:
    """Equilibrium at the load factor of the step, by letting the riser settle into the soil."""
    assembly, system, lying = run.assembly, run.stepper.system, _on_soil(run.assembly)
    pressed = Pressed(lying.line, lambda state: _pressing(assembly, state), lying.scales.weight, lying.scales.diameter)
    return settle(assembly.comm, system.model, pressed, settings_of(assembly), system.clock, run.control.target)


def settings_of(assembly: Assembly) -> NewtonSettings:
    """Newton's settings in a scene's stages."""
    solver = assembly.scene.solver
    on_soil = assembly.soil_bears
    floor = assembly.scales.force_floor
    return NewtonSettings(
        solver.tolerance,
        solver.max_iterations,
        floor,
        line_search=on_soil,
        linear=solver.linear,
        snes=solver.by_snes,
        petsc_options=tuple(solver.petsc_options.items()),
        has_soil=assembly.scene.soil is not None,
    )


def _settings_in(assembly: Assembly, stage: Stage) -> NewtonSettings:
    """Newton's settings in a stage: line search in statics on a ground, where contact opens and closes.

    Steps start linearly in statics on a ground once something lies there, and in motion of a riser that was laid on
    soil. A riser that falls onto soil starts from its motion.
    """
    settings, lies = settings_of(assembly), bool(assembly.contacts) and isinstance(stage, StaticStage)
    at_rest = not assembly.is_first(stage) or assembly.is_cushioned_in(stage)
    moves = assembly.cushioned and isinstance(stage, DynamicStage)
    return replace(settings, line_search=settings.line_search or lies, linear_start=(lies and at_rest) or moves)


def _load_steps(assembly: Assembly, stage: Stage, t0: float, t1: float) -> int:
    """Number of load steps from t0 to t1 of a stage without inertia: the scene's, or more where soil must follow the
    riser that is laid on it or moved.
    """
    asked, lying = assembly.scene.solver.load_steps, assembly.line_on_soil
    if lying is None or not assembly.soil_bears:
        return asked
    moved = lying.moved(t0, t1) / (MOVED_BY * lying.scales.diameter)
    if assembly.scene.has_path_dependent_soil:
        moved = max(moved, lying.pressed(t0, t1) / (PRESSED_BY * lying.scales.diameter) - ROUND_OFF)
    laid = LAID_IN if assembly.is_cushioned_in(stage) else 1
    return max(asked, laid, min(math.ceil(moved), MOST_STEPS))


def _path_steps(assembly: Assembly, stage: QuasiStaticStage) -> PathSteps:
    """Steps from corner to corner of a quasi-static stage: at most as long as asked for, or as many as load steps."""
    by_line = [(own, each) for own, each in assembly.stages_by_line(stage) if isinstance(each, QuasiStaticStage)]
    ends = (t for own, each in by_line for t in corners(own.scene, each))
    times, longest = [0.0, *from_last_to_first(stage.duration, ends)[::-1]], stage.time_step
    if longest == "auto":
        counts = [_load_steps(assembly, stage, a, b) for a, b in pairwise(times)]
    else:
        counts = [math.ceil((b - a) / longest - ROUND_OFF) for a, b in pairwise(times)]
    return PathSteps(times, counts, assembly.scene.solver.min_load_step)


def steps_of(assembly: Assembly, stage: Stage, stepper: TimeStepper) -> StepControl | PathSteps | AutoSteps:
    """The steps of a stage, from its beginning to its end."""
    solver = assembly.scene.solver
    if isinstance(stage, StaticStage):
        return StepControl(1.0, 1.0 / _load_steps(assembly, stage, 0.0, 1.0), solver.min_load_step)
    if isinstance(stage, QuasiStaticStage):
        return _path_steps(assembly, stage)
    smallest = _smallest_step(assembly, stage)
    if stage.time_step == "auto":
        tolerance = assembly.error_tolerance(stage)
        first = first_step(stepper.system, stepper.now, tolerance)
        by_line = [(own, each) for own, each in assembly.stages_by_line(stage) if isinstance(each, DynamicStage)]
        hit = [t for own, each in by_line for t in times_to_hit(own.scene, each)]
        return AutoSteps(stage.duration, tolerance, smallest, first, hit)
    return StepControl(stage.duration, stage.time_step, smallest)


def _smallest_step(assembly: Assembly, stage: DynamicStage) -> float:
    """Least time step [s], down to which steps are cut."""
    given = assembly.scene.solver.min_time_step
    if given != "auto":
        return float(given)
    return AUTO_SMALLEST_OF_STAGE * stage.duration if stage.time_step == "auto" else AUTO_SMALLEST * stage.time_step


def seat(assembly: Assembly, model: Model, settings: NewtonSettings, clock: Timer) -> None:
    """Find the riser's equilibrium on the cushion at the load factor 0 and commit it; collective.

    By Newton's method, else by dynamic relaxation: SolveError where that finds none either.
    """
    soil = assembly.soil
    absent = [] if soil is None else [*soil.parts, *soil.pressed_by]
    present = [part for part in model.parts if not any(part is each for each in absent)]
    alone = replace(model, parts=present, others=())
    system = System(assembly.comm, alone, clock)
    newton = Newton(system, replace(settings, line_search=False))
    with destroyed_together(assembly.comm, newton.destroy, system.destroy):
        try:
            solution = newton.solve(Step.static(State.at_rest(0.0, system.numbering.size)))
            newton.require_stable(solution)
            system.commit(solution.state)
        except NotConvergedError:
            relax(assembly.comm, alone, assembly.scales.weight, settings, clock, 0.0)
