"""A stage of a scene, set up for timing."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from statistics import median

from mpi4py import MPI

from riser_soil.assembly import Assembly, build
from riser_soil.assembly.stage import scheme_of
from riser_soil.core.part import State
from riser_soil.core.system import System, Timer
from riser_soil.results.observer import Observer
from riser_soil.scene.reader import read_scene
from riser_soil.scene.stages import Stage
from riser_soil.solve.newton import solver_of
from riser_soil.solve.time_stepper import TimeStepper
from riser_soil.stages import LayingCounter, lay, run_stage, settings_of, steps_of


class TimedStage:
    """One stage's system and time stepper; `iterations` and `seconds` of all its Newton solves."""

    def __init__(
        self, assembly: Assembly, stage: Stage, before: State, clock: Timer, linear_start: bool = False
    ) -> None:
        self.assembly, self.stage = assembly, stage
        self.system = System(assembly.comm, assembly.begin(stage), clock)
        settings = replace(settings_of(assembly), linear_start=linear_start)
        self.newton = solver_of(self.system, scheme_of(stage).dynamic, settings)
        self.stepper = TimeStepper(self.system, self.newton, scheme_of(stage), replace(before, t=0.0))
        self.control = steps_of(assembly, stage, self.stepper)
        self.iterations, self.seconds = 0, 0.0

    def walk(self, steps: int | None = None) -> State:
        """Take this many steps, or all."""
        while not self.control.finished and (steps is None or steps > 0):
            began = time.perf_counter()
            step = self.stepper.advance(self.control)
            self.seconds += time.perf_counter() - began
            self.iterations += step.solution.iterations
            self.stepper.commit(step, self.control)
            self._taken = step
            steps = None if steps is None else steps - 1
        return self.stepper.before

    def tell(self, observer: Observer) -> None:
        """Record the step just taken."""
        observer.record(self.stepper, self._taken, last=False)

    def destroy(self) -> None:
        self.newton.destroy()
        self.system.destroy()


def last_stage(scene_file: Path, overrides: tuple[str, ...], clock: Timer) -> TimedStage:
    """The last stage of a scene, all before it computed."""
    scene = read_scene(scene_file, overrides)
    assembly = build(scene, MPI.COMM_SELF)
    before, _ = lay(assembly, Timer.new())
    for stage in scene.stages[:-1]:
        before = run_stage(assembly, stage, before, LayingCounter(), Timer.new())
    return TimedStage(assembly, scene.stages[-1], before, clock)


def typical_seconds(action: Callable[[], object], repeats: int) -> float:
    """Median seconds of an action."""
    seconds = []
    for _ in range(repeats):
        began = time.perf_counter()
        action()
        seconds.append(time.perf_counter() - began)
    return median(seconds)
