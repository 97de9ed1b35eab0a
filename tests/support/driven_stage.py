"""Stages of a scene taken as riser_soil.whole_run takes them, but without files, every step open to a test's eyes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI
from scipy.sparse import csr_matrix

from riser_soil.assembly import Assembly, build
from riser_soil.assembly.soil_assembly import SoilAssembly
from riser_soil.assembly.stage import scheme_of
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import State
from riser_soil.core.system import System, Timer
from riser_soil.results.observer import Observer
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage
from riser_soil.solve.dynamic_relaxation import RelaxationResult
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.step import Step
from riser_soil.solve.step_control import Control
from riser_soil.solve.step_trial import StepTrial
from riser_soil.solve.time_scheme import Static
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from tests.support.scenes import Mapping

Watch = Callable[[System, AcceptedStep], None]


def built(mapping: Mapping) -> Assembly:
    """The parts of a scene, on this process alone."""
    return built_of(scene_from_mapping(mapping))


def built_of(scene: Scene) -> Assembly:
    return build(scene, MPI.COMM_SELF)


def soil_under(assembly: Assembly) -> SoilAssembly:
    """The soil of a scene that has some."""
    assert assembly.soil is not None
    return assembly.soil


@contextmanager
def before_commit(watch: Watch | None) -> Iterator[None]:
    """Show every accepted step to a function before it is committed."""
    usual = TimeStepper.commit

    def commit(stepper: TimeStepper, step: AcceptedStep, control: Control) -> None:
        if watch is not None:
            watch(stepper.system, step)
        usual(stepper, step, control)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(TimeStepper, "commit", commit)
        yield


class Watcher(Observer):
    """Shows every committed step to a function; writes nothing."""

    def __init__(self, after: Callable[[TimeStepper, AcceptedStep], None] | None = None) -> None:
        self._after = after
        self.relaxations = self.settlings = 0

    def begin_stage(self, stage: Stage, stepper: TimeStepper) -> None:
        self.energy_at_start = stepper.energy

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        if self._after is not None:
            self._after(stepper, step)

    def relaxed(self, relaxed: RelaxationResult) -> None:
        if relaxed.sunk:
            self.settlings += 1
        else:
            self.relaxations += 1


def take(assembly: Assembly, stage: Stage, before: State | None = None, watch: Watch | None = None) -> State:
    """Take a stage to its end; the state that it leaves, increments zero."""
    rest = State.at_rest(0.0, assembly.size) if before is None else before
    with before_commit(watch):
        return run_stage(assembly, stage, rest, Watcher(), Timer.new())


class FirstStep:
    """The first step of a scene's last stage, all stages before it taken: residual and matrix as functions of
    the system's unknowns x (free,).
    """

    def __init__(self, assembly: Assembly) -> None:
        self.assembly = assembly
        *first, stage = assembly.scene.stages
        before = State.at_rest(0.0, assembly.size)
        for earlier in first:
            before = take(assembly, earlier, before)
        self.system = System(assembly.comm, assembly.begin(stage), Timer.new())
        self.scheme = scheme_of(stage)
        solver = assembly.scene.solver
        settings = NewtonSettings(solver.tolerance, solver.max_iterations, assembly.scales.force_floor)
        newton = Newton(self.system, settings)
        self._before = TimeStepper(self.system, newton, self.scheme, replace(before, t=0.0)).before
        newton.destroy()
        self._dt = float(stage.time_step) if isinstance(stage, DynamicStage) else 1.0
        self._start = None if isinstance(self.scheme, Static) else self.system.forces(self._before)

    @property
    def free(self) -> int:
        return self.system.numbering.free

    def state(self, x: Array) -> State:
        """The trial state of x, prescribed motion included."""
        u = np.zeros(self.assembly.size)
        self.system.numbering.to_local(x, u)
        state = self.scheme.trial(self._before, self._dt, self._dt, u)
        self.system.prescribe(state)
        return state

    def residual(self, x: Array) -> Array:
        guess = np.zeros(self.assembly.size)
        trial = StepTrial(self.system, Step(self.scheme, self._before, self._dt, self._dt, self._start, guess))
        return self.system.numbering.add_to_global(trial.balance(self.system.forces(self.state(x))))

    def slope(self, x: Array, direction: Array, h: float) -> Array:
        """Derivative of the residual at x along a direction, by differences of fourth order in the step h."""
        at = {k: self.residual(x + k * h * direction) for k in (-2, -1, 1, 2)}
        return np.asarray((8.0 * (at[1] - at[-1]) - (at[2] - at[-2])) / (12.0 * h))

    def matrix(self, x: Array) -> csr_matrix:
        self.system.assemble(self.state(x), self.scheme.weights(self._dt))
        indptr, indices, values = self.system.matrix.mat.getValuesCSR()
        return csr_matrix((values, indices, indptr), shape=(self.free, self.free))

    def rows(self, local: IntArray) -> IntArray:
        """System rows of local dof numbers; prescribed ones have none."""
        rows: IntArray = self.system.numbering.index[local]
        return np.unique(rows[rows >= 0])
