"""Analysis of one stage, from its assembled system to its end, with dynamic relaxation where statics need it.

A riser on soil first comes to rest on its cushion, before the soil is there to bear it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Protocol

import numpy as np

from riser_soil.assembly import Assembly
from riser_soil.assembly.assembly import LAID_IN, LETTING_GO
from riser_soil.assembly.motions import corners
from riser_soil.assembly.stage import scheme_of, times_to_hit
from riser_soil.core.arrays import Array
from riser_soil.core.communicator import destroyed_together
from riser_soil.core.part import Model, State
from riser_soil.core.roles import Adaptive, owners, with_role
from riser_soil.core.saved_state import Saved, Stateful, gathered, restore_all, within
from riser_soil.core.system import System, Timer, total
from riser_soil.errors import SolveError
from riser_soil.interruption import asked_to_end, end_together, uninterrupted
from riser_soil.scene.stages import DynamicStage, QuasiStaticStage, Stage, StaticStage
from riser_soil.solve.dynamic_relaxation import RelaxationResult, relax
from riser_soil.solve.local_error import first_step
from riser_soil.solve.newton import Newton, solver_of
from riser_soil.solve.settling import Pressed, SinkingError, settle
from riser_soil.solve.solver import NewtonSettings, NotConvergedError, Step
from riser_soil.solve.step_control import AutoSteps, PathSteps, StepControl, from_last_to_first
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper

MOVED_BY, PRESSED_BY = 0.25, 1 / 160  # diameters by which a load step on soil moves an end; presses it in, on clay
ROUND_OFF = 1e-9  # of a load step
AUTO_SMALLEST, AUTO_SMALLEST_OF_STAGE = 1e-4, 1e-7  # of a given time step; of a stage with automatic ones
MOST_STEPS = 64  # of a stage, but for those that the scene asks for
MOST_RELAXED = 1  # times in a static stage on clay
MOST_SUNK = 1 / 40  # diameters by which the riser may sink in a static step on soil that moves
MOST_CUTS = 4  # of a static step, before relaxation is tried at what is left of it


CheckpointWriter = Callable[[Callable[[], Saved], bool, bool], None]
"""Called between steps with a function that gives the saved state, from which the stage can be resumed; whether it is
the stage's last step; and whether the run ends here before its time.
"""


class StageObserver(Stateful, Protocol):
    """Observer of a stage: is notified of its beginning, of accepted steps and of dynamic relaxation."""

    def begin_stage(self, stage: Stage, stepper: TimeStepper) -> None: ...

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None: ...

    def relaxed(self, relaxed: RelaxationResult) -> None: ...


class StatelessObserver:
    """A counter that has nothing to go on with in a stage that is resumed."""

    def state(self) -> Saved:
        return {}

    def restore(self, saved: Saved) -> None:
        pass


@dataclass
class LayingCounter(StatelessObserver):
    """Counts the load steps and relaxations while a slack riser is laid, before the scene's stages."""

    steps: int = 0
    relaxations: int = 0

    def begin_stage(self, stage: Stage, stepper: TimeStepper) -> None:
        pass

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        self.steps += 1

    def relaxed(self, relaxed: RelaxationResult) -> None:
        self.relaxations += 1


def lay(assembly: Assembly, clock: Timer) -> tuple[State, LayingCounter | None]:
    """Before all stages: take up the end of another run; or move the end of a slack riser's initial shape to its
    prescribed position.
    """
    if assembly.scene.initial is not None:
        from riser_soil.results.end_of_run import take_up_end_of_run

        return take_up_end_of_run(assembly), None
    rest, stage = State.at_rest(0.0, assembly.size), assembly.laying
    if stage is None:
        return rest, None
    slackest = assembly.slackest
    if slackest.too_soft:
        raise SolveError(slackest.too_soft)
    counter = LayingCounter()
    try:
        _take(assembly, assembly.begin_laying(stage), stage, None, counter, clock)
    except SolveError as err:
        raise SolveError(f"{slackest.too_slack}: {err}" if slackest.slack else f"joints do not close: {err}") from err
    if assembly.lets_go:
        _let_go(assembly, counter, clock)
    return rest, counter


def _let_go(assembly: Assembly, counter: LayingCounter, clock: Timer) -> None:
    """Bodies that were held go to their own equilibrium, as what held them grows less."""
    assert assembly.hung is not None
    stage = StaticStage(name=LETTING_GO, kind="static")
    held = System(assembly.comm, assembly.begin_laying(stage), clock)
    with destroyed_together(assembly.comm, held.destroy):
        met = total(held.forces(State.at_rest(1.0, held.numbering.size)))
    reactions = {name: met[body.part] for name, body in assembly.hung.bodies.items()}
    _take(assembly, assembly.begin_letting_go(stage, reactions), stage, None, counter, clock)


def run_stage(
    assembly: Assembly,
    stage: Stage,
    before: State,
    observer: StageObserver,
    clock: Timer,
    checkpoint: CheckpointWriter | None = None,
) -> State:
    """Take one stage to its end; the state that it leaves, increments zero."""
    return _take(assembly, assembly.begin(stage), stage, before, observer, clock, checkpoint)


def resume_stage(
    assembly: Assembly, saved: Saved, observer: StageObserver, clock: Timer, checkpoint: CheckpointWriter | None = None
) -> tuple[Stage, State]:
    """Take the stage that was saved on its way to its end; the stage, and the state that it leaves.

    assembly, observer: built anew from the scene. The stages before were taken in the run that was saved.
    """
    assembly.restore(within(saved, "assembly"))
    stage, model = assembly.resume()
    return stage, _take(assembly, model, stage, saved, observer, clock, checkpoint)


def _take(
    assembly: Assembly,
    model: Model,
    stage: Stage,
    begin: State | Saved | None,
    observer: StageObserver,
    clock: Timer,
    checkpoint: CheckpointWriter | None = None,
) -> State:
    """From the state that the stage begins with, None where all is at rest, or from where it was saved."""
    if isinstance(begin, State | None) and assembly.cushion is not None and assembly.is_laid_in(stage):
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
            return _walk(run, checkpoint)
        except SolveError as err:
            raise SolveError(f"{err}{_overload(assembly)}") from err


def _restore(system: System, saved: Saved) -> None:
    restore_all(owners(system.model), saved)
    if with_role(system.model.parts, Adaptive):
        system.renew_pattern()


@dataclass(eq=False)
class StageRun:
    """A stage in progress: its time stepper, step control and observer; how often relaxation has been tried."""

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
    """The bearing capacity check of a failed solve."""
    if not assembly.contacts:
        return ""
    from riser_soil.checks.overload import overload

    return overload(assembly)


def _walk(run: StageRun, checkpoint: CheckpointWriter | None) -> State:
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
    """By Newton's method, on soil that moves else by settling, else in load steps that are halved a few times, else by
    dynamic relaxation.

    Where relaxation does not get to the load factor that was missed, it all begins again with half the step. On clay,
    soil or a hysteretic seabed, it is tried MOST_RELAXED times: at the end of its strength it creeps on in ever shorter
    steps.
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
            _bring_to_rest(run, _relaxed)
        except SolveError:
            if not stepper.depends_on(control) or not control.cut():
                raise
            continue
        return stepper.advance(control, 0)


def _followed_by_soil(run: StageRun) -> AcceptedStep | None:
    """A step in which the riser sinks no farther than soil follows, cut where supports press it in, and by settling
    where there is no other; None where that finds no step that converges.
    """
    stepper, on_soil = run.stepper, _on_soil(run.assembly)
    longest = MOST_SUNK * on_soil.scales.diameter
    try:
        step = stepper.advance(run.control, MOST_CUTS if stepper.moves_supports(run.control) else 0)
        if _sunk(on_soil, stepper.before, step.solution.state) <= longest:
            return step
    except SolveError:
        pass
    try:
        _bring_to_rest(run, _settled)
        return stepper.advance(run.control, 0)
    except SinkingError:
        raise
    except SolveError:
        return None


def _sunk(assembly: Assembly, before: State, after: State) -> float:
    """How far [m] a line on soil has sunk where it presses; collective."""
    line, presses = assembly.line, _pressing(assembly, after) > 0.0
    down = line.positions3(before)[:, 2] - line.positions3(after)[:, 2]
    return float(down[presses].max(initial=0.0))


def _on_soil(assembly: Assembly) -> Assembly:
    """The line that lies on the soil, of a scene that has some."""
    found = assembly.line_on_soil
    assert found is not None
    return found


def _pressing(assembly: Assembly, state: State) -> Array:
    """Force per length (nn,) [N/m] on the soil, the same on all ranks; collective."""
    contact = assembly.soil_contact
    assert contact is not None
    return assembly.comm.allreduce(contact.force_per_length(state))


def _bring_to_rest(run: StageRun, seek: Callable[[StageRun], RelaxationResult]) -> None:
    """Find an equilibrium at the load factor that Newton's method missed; SolveError with all as the last step left it
    where there is none.
    """
    stepper = run.stepper
    left = gathered(owners(stepper.system.model))
    try:
        found = seek(run)
    except SolveError:
        restore_all(owners(stepper.system.model), left)
        stepper.newton.renew()
        raise
    stepper.newton.renew()  # the search has chosen patterns of its own
    run.observer.relaxed(found)
    stepper.restart()
    stepper.newton.at_equilibrium = True


def _relaxed(run: StageRun) -> RelaxationResult:
    assembly, system = run.assembly, run.stepper.system
    settings, weight = settings_of(assembly), assembly.scales.weight
    loads = {} if assembly.hung is None else assembly.hung.loads
    return relax(assembly.comm, system.model, weight, settings, system.clock, run.control.target, loads)


def _settled(run: StageRun) -> RelaxationResult:
    assembly, system, lying = run.assembly, run.stepper.system, _on_soil(run.assembly)
    pressed = Pressed(lying.line, lambda state: _pressing(lying, state), lying.scales.weight, lying.scales.diameter)
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
    """Newton's settings in a stage: in statics on a ground, steps are cut short where contact opens and closes; there,
    and in motion of a riser that was laid on soil, they start linearly. What falls onto soil continues its motion.
    """
    settings, lies = settings_of(assembly), bool(assembly.contacts) and isinstance(stage, StaticStage)
    at_rest = not assembly.is_first(stage) or (assembly.cushion is not None and assembly.is_laid_in(stage))
    moves = assembly.cushion is not None and isinstance(stage, DynamicStage)
    return replace(settings, line_search=settings.line_search or lies, linear_start=(lies and at_rest) or moves)


def _load_steps(assembly: Assembly, stage: Stage, t0: float, t1: float) -> int:
    """Load steps from t0 to t1 of a stage without inertia: as many as the scene asks for; more where soil is to follow
    a riser that is laid on it or moved.
    """
    asked, lying = assembly.scene.solver.load_steps, assembly.line_on_soil
    if lying is None or not assembly.soil_bears:
        return asked
    moved = lying.moved(t0, t1) / (MOVED_BY * lying.scales.diameter)
    if assembly.scene.has_path_dependent_soil:
        moved = max(moved, lying.pressed(t0, t1) / (PRESSED_BY * lying.scales.diameter) - ROUND_OFF)
    laid = LAID_IN if assembly.cushion is not None and assembly.is_laid_in(stage) else 1
    return max(asked, laid, min(math.ceil(moved), MOST_STEPS))


def _path_steps(assembly: Assembly, stage: QuasiStaticStage) -> PathSteps:
    """From corner to corner of a quasi-static stage, as long as asked at most, or as load steps would be."""
    seen = [(own, each) for own, each in assembly.seen_by_lines(stage) if isinstance(each, QuasiStaticStage)]
    ends = (t for own, each in seen for t in corners(own.scene, each))
    met, longest = [0.0, *from_last_to_first(stage.duration, ends)[::-1]], stage.time_step
    if longest == "auto":
        counts = [_load_steps(assembly, stage, a, b) for a, b in pairwise(met)]
    else:
        counts = [math.ceil((b - a) / longest - ROUND_OFF) for a, b in pairwise(met)]
    return PathSteps(met, counts, assembly.scene.solver.min_load_step)


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
        seen = [(own, each) for own, each in assembly.seen_by_lines(stage) if isinstance(each, DynamicStage)]
        hit = [t for own, each in seen for t in times_to_hit(own.scene, each)]
        return AutoSteps(stage.duration, tolerance, smallest, first, hit)
    return StepControl(stage.duration, stage.time_step, smallest)


def _smallest_step(assembly: Assembly, stage: DynamicStage) -> float:
    """Down to which time steps are cut [s]."""
    given = assembly.scene.solver.min_time_step
    if given != "auto":
        return float(given)
    return AUTO_SMALLEST_OF_STAGE * stage.duration if stage.time_step == "auto" else AUTO_SMALLEST * stage.time_step


def seat(assembly: Assembly, model: Model, settings: NewtonSettings, clock: Timer) -> None:
    """Find the riser's equilibrium on the cushion at the load factor 0 and commit it; collective.

    By Newton's method, else by dynamic relaxation: SolveError where that finds none either.
    """
    absent = [*assembly.soil_parts, *assembly.on_soil]
    alone = Model(model.lines, [part for part in model.parts if not any(part is each for each in absent)])
    system = System(assembly.comm, alone, clock)
    newton = Newton(system, replace(settings, line_search=False))
    with destroyed_together(assembly.comm, newton.destroy, system.destroy):
        try:
            solution = newton.solve(Step.static(State.at_rest(0.0, system.numbering.size)))
            newton.require_stable(solution)
            system.commit(solution.state)
        except NotConvergedError:
            relax(assembly.comm, alone, assembly.scales.weight, settings, clock, 0.0)
