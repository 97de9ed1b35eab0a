"""A riser alone in full surge, 0.1 s a step: its Newton iterations against the bare work in them, and whole steps.

Everything is measured in turn, step by step, so that a machine whose speed drifts changes all figures alike.
"""

from __future__ import annotations

import functools
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from statistics import mean, median

from petsc4py import PETSc

from benchmarks.stage import TimedStage, last_stage, random_right_hand_side
from riser_soil.core.part import Forces, State
from riser_soil.core.system import Timer
from riser_soil.results.observer import Observer
from riser_soil.solve.linear_solver import factorise_directly
from riser_soil.solve.newton import Newton
from riser_soil.solve.solution import Step

SCENE = Path(__file__).parent.parent / "tests" / "scenes" / "catenary.yaml"
SIZES = ((2, 35), (2, 100), (3, 100), (3, 400))
RAMP, STEPS = 150, 140  # steps until the surge has grown; steps of one period


def report() -> None:
    found = {size: measure(*size) for size in SIZES}
    for (dimension, elements), us in found.items():
        print(
            f"{dimension}D, {elements} elements: Newton iteration {us['iteration']:.0f} us, "
            f"bare force + tangent + LU {us['bare']:.0f} us, ratio {us['iteration'] / us['bare']:.2f}; "
            f"SNES / plain loop {us['snes'] / us['plain']:.2f}"
        )
        print(
            f"  a step: {us['step']:.0f} us, {1e5 / us['step']:.0f} times faster than real time; recorded "
            f"{us['recorded']:.0f} us, {1e5 / us['recorded']:.0f} times; {us['iterations']:.2f} iterations"
        )
    print(f"3D / 2D, 100 elements: {found[3, 100]['step'] / found[2, 100]['step']:.2f}")


def measure(dimension: int, elements: int) -> dict[str, float]:
    """Medians in us: iteration, bare, snes, plain; step: solved, accounted for and committed; recorded: told to the
    results too. Mean number of iterations.
    """
    stage = surging(dimension, elements)
    bench = Bench(stage)
    taken = defaultdict[str, list[float]](list)
    opened = functools.partial(Observer.open, stage.assembly, Timer.new(), force=True)
    with tempfile.TemporaryDirectory() as folder, opened(Path(folder)) as seen:
        seen.begin_stage(stage.stage, stage.stepper)
        for _ in range(STEPS):
            for name, action in bench.actions().items():
                taken[name].append(1e6 * timed(action))
            taken["iteration"].append(taken["full"][-1] / bench.full_iterations)
            stage.iterations = 0
            taken["step"].append(1e6 * timed(lambda: stage.walk(1)))
            taken["iterations"].append(stage.iterations)
            taken["recorded"].append(taken["step"][-1] + 1e6 * timed(lambda: stage.tell(seen)))
    bench.destroy()
    stage.destroy()
    return {name: median(values) for name, values in taken.items()} | {"iterations": mean(taken["iterations"])}


def surging(dimension: int, elements: int) -> TimedStage:
    """The surge of the published catenary, grown to its full amplitude."""
    segment = f"riser.segments.0.elements={elements}"
    stage = last_stage(SCENE, (f"dimension={dimension}", segment, "line_types.flexible.GJ=2.0e4"), Timer.new())
    stage.walk(RAMP)
    return stage


def timed(action: Callable[[], object]) -> float:
    """Seconds of an action."""
    began = time.perf_counter()
    action()
    return time.perf_counter() - began


class Bench:
    """The next step of a stage, solved in several ways without being taken."""

    def __init__(self, stage: TimedStage) -> None:
        self.stage, self.system = stage, stage.system
        self._full = Newton(self.system, replace(stage.newton.settings, reuse=0.0))
        self._pc = PETSc.PC().create(PETSc.COMM_SELF)
        factorise_directly(self._pc, self.system)
        self._x, self._f, self._dx = (self.system.numbering.vector.duplicate() for _ in range(3))
        self._tiny = 1e-9 * random_right_hand_side(self.system.numbering.size)
        self.full_iterations = 1

    def actions(self) -> dict[str, Callable[[], object]]:
        """bare: force, tangent, and factorisation with one solve. full: Newton's method with a new tangent in each
        iteration. snes: as a run solves it. plain: the same in a plain loop.
        """
        step = self.stage.stepper.next_step(self.stage.control)
        return {
            "bare": self._bare,
            "full": lambda: self._solve_fully(step),
            "snes": lambda: self.stage.newton.solve(step),
            "plain": lambda: self._plain(step),
        }

    def _bare(self) -> None:
        system, stepper = self.system, self.stage.stepper
        state, weights = State(0.0, self._tiny.copy(), stepper.before.v, stepper.before.a), stepper.scheme.weights(0.1)
        forces = Forces.zeros(len(self._tiny))
        for part in system.model.parts:
            part.residual(state, forces)
        system.matrix.clear()
        for part in system.model.parts:
            part.tangent(state, weights, system.matrix.values)
        system.matrix.assemble()
        self._pc.setUp()
        self._pc.apply(self._f, self._dx)

    def _solve_fully(self, step: Step) -> None:
        self.full_iterations = self._full.solve(step).iterations

    def _plain(self, step: Step) -> None:
        """What `Newton.solve` does, by Newton's own functions, with this loop in the place of SNES."""
        newton, x, f, dx = self.stage.newton, self._x, self._f, self._dx
        newton._begin(step)
        newton._x.copy(x)
        newton._function(None, x, f)
        iteration = 0
        while not newton._test(None, iteration, (0.0, 0.0, f.norm())):
            newton._jacobian(None, x, None, None)
            self._pc.setUp()
            self._pc.apply(f, dx)
            x.axpy(-1.0, dx)
            newton._function(None, x, f)
            iteration += 1
        newton.require_admissible(newton._trial(x))

    def destroy(self) -> None:
        for thing in (self._full, self._pc, self._x, self._f, self._dx):
            thing.destroy()
