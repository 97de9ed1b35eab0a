"""Steps of a given size against automatic ones on the hose in a tank: error and cost over its first 30 s."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from mpi4py import MPI

from riser_soil.assembly import Assembly, build
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.results.instants import InstantReader
from riser_soil.scene.reader import read_scene
from riser_soil.scene.stages import Stage
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import StatelessObserver, run_stage

SCENE = Path(__file__).parent.parent / "tests" / "scenes" / "tank.yaml"
DURATION = 30.0  # s
FINE = 0.0025  # s: the reference
STEPS = (0.2, 0.1, 0.05, 0.025)  # s
TOLERANCES = (3e-2, 1e-2, 3e-3, 1e-3)  # m


@dataclass
class StepHistory(StatelessObserver):
    """Tension and touchdown of the riser at the accepted steps of a stage."""

    assembly: Assembly
    t: list[float] = field(default_factory=list)
    dt: list[float] = field(default_factory=list)
    tension: list[float] = field(default_factory=list)
    touchdown: list[float] = field(default_factory=list)
    cuts: int = 0
    iterations: int = 0

    def begin_stage(self, stage: Stage, stepper: TimeStepper) -> None:
        self._instants = InstantReader(self.assembly.riser)

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        self.t.append(step.t)
        self.dt.append(step.dt)
        record = self._instants.record_of([self._instants.copy(stepper)]).at(0)
        self.tension.append(float(record.effective_tension[-1]))
        self.touchdown.append(float(record.touchdown_arc))
        self.cuts += step.cuts
        self.iterations = stepper.newton.iterations


def step_history(*overrides: str, scene_file: Path = SCENE) -> StepHistory:
    """The last stage of a scene, without output times."""
    scene = read_scene(scene_file, ["output={}", *overrides])
    assembly = build(scene, MPI.COMM_SELF)
    before = State.at_rest(0.0, assembly.size)
    for stage in scene.stages:
        history = StepHistory(assembly)
        before = run_stage(assembly, stage, before, history, Timer.new())
    return history


def swing(time_step: float | str, *overrides: str) -> StepHistory:
    """The hose's swing by steps of one size, or `auto`."""
    return step_history(f"stages.1.duration={DURATION}", f"stages.1.time_step={time_step}", *overrides)


def automatic(tolerance: float, *overrides: str) -> StepHistory:
    """The hose's swing by automatic steps."""
    return swing("auto", f"stages.1.tolerance={tolerance}", *overrides)


def errors(history: StepHistory, reference: StepHistory) -> tuple[float, float]:
    """Root mean square in time of the errors in top tension [N] and touchdown arc [m]."""
    return _rms(history, reference, "tension"), _rms(history, reference, "touchdown")


def _rms(history: StepHistory, reference: StepHistory, name: str) -> float:
    exact: Array = np.interp(history.t, reference.t, getattr(reference, name))
    return float(np.sqrt(np.average((np.array(getattr(history, name)) - exact) ** 2, weights=history.dt)))


def report() -> None:
    reference = swing(FINE)
    print(f"Hose in a tank, {DURATION:g} s, errors against steps of {FINE:g} s: top tension, touchdown arc; cost")
    for time_step in STEPS:
        _print(f"time_step {time_step:g} s", swing(time_step), reference)
    for tolerance in TOLERANCES:
        _print(f"auto, tolerance {tolerance:g} m", automatic(tolerance), reference)


def _print(name: str, history: StepHistory, reference: StepHistory) -> None:
    tension, touchdown = errors(history, reference)
    steps = f"{len(history.t)} steps of {min(history.dt):.3g} to {max(history.dt):.3g} s, {history.cuts} tried again"
    print(f"  {name:24s} {tension:6.3f} N {1e3 * touchdown:6.2f} mm {history.iterations:6d} Newton iterations; {steps}")
