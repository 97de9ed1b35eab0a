"""A riser in a plane against the same one in space: the classes of which there are two, and Newton iterations.

Both lines move alike, and everything is measured in turn, so that a machine whose speed drifts changes all figures
alike. `python -m benchmarks.twins` prints the table alone.
"""

from __future__ import annotations

import argparse
import functools
from collections.abc import Callable, Sequence
from dataclasses import replace
from statistics import median

import numpy as np

from benchmarks.riser_only import CATENARY, ELEMENTS, surging, timed
from benchmarks.stage import TimedStage
from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, Part, State, Weights
from riser_soil.riser.beam import Beam
from riser_soil.riser.inertia import RotaryInertia
from riser_soil.riser.line import Line
from riser_soil.riser.structural_damping import StructuralDamping

COUNT, REPEATS = 100, 300
STEPS = 100  # whole steps, and their Newton iterations
WEIGHTS = Weights(inertia=1.0, force=1.0, shift_v=20.0, shift_a=400.0)

Action = Callable[[], object]


def report() -> None:
    print(f"in a plane and in space, {COUNT} elements:")
    for name, (plane, space) in measure().items():
        print(f"  {name}: {plane:.0f} us and {space:.0f} us, space / plane {space / plane:.1f}")


def measure() -> dict[str, tuple[float, float]]:
    """Medians in us, of the plane and of space."""
    stages = [in_surge(dimension) for dimension in (2, 3)]
    kernels = [actions(stage) for stage in stages]
    seconds = {name: in_turn([each[name] for each in kernels], REPEATS) for name in kernels[0]}
    seconds["Newton iteration"] = medians([[timed_iteration(stage) for stage in stages] for _ in range(STEPS)])
    seconds["step"] = in_turn([functools.partial(stage.walk, 1) for stage in stages], STEPS)
    for stage in stages:
        stage.destroy()
    return seconds


def in_surge(dimension: int) -> TimedStage:
    sizes = f"dimension={dimension}", ELEMENTS.format(COUNT)
    return surging(CATENARY, *sizes, "line_types.flexible.GJ=2.0e4")


def in_turn(pair: Sequence[Action], repeats: int) -> tuple[float, float]:
    for action in pair:
        action()
    return medians([[timed(action) for action in pair] for _ in range(repeats)])


def medians(seconds: list[list[float]]) -> tuple[float, float]:
    plane, space = (1e6 * median(column) for column in zip(*seconds, strict=True))
    return plane, space


def timed_iteration(stage: TimedStage) -> float:
    """Seconds of an iteration of the next step."""
    step, before = stage.stepper.next_step(stage.control), stage.newton.iterations
    seconds = timed(lambda: stage.newton.solve(step))
    return seconds / (stage.newton.iterations - before)


def actions(stage: TimedStage) -> dict[str, Action]:
    """What a Newton iteration asks of each of the classes."""
    line, elements = stage.assembly.riser.line, stage.assembly.riser.elements
    state, damped = stirred(line, stage.stepper.before), replace(elements, damping=np.full(line.length.size, 0.1))
    return {
        "frames (trial and rates)": lambda: turn(line, state),
        "elastic elements (forces and tangent)": both(Beam(line, elements), line, state),
        "structural damping (forces and tangent)": both(StructuralDamping(line, damped), line, state),
        "rotary inertia (moments and tangent)": both(RotaryInertia(line, np.ones(line.length.size)), line, state),
    }


def stirred(line: Line, before: State) -> State:
    """An accepted state with small increments of the translations and of the turns in the plane."""
    u = before.u.copy()
    along = np.linspace(0.0, 1.0, line.nodes)
    moved = line.nodal(u)
    moved[:, 0] += 1e-3 * along
    moved[:, line.dimension - 1] += 1e-3 * along**2
    moved[:, -1] += 1e-3 * along
    return replace(before, u=u)


def turn(line: Line, state: State) -> None:
    trial = line._make_trial(state)
    force = np.ones_like(trial.q)
    assert trial.q_rate.shape == force.shape
    trial.add_turning(matrices(line), 1.0, force)


def matrices(line: Line) -> Array:
    return np.zeros((line.length.size, 2 * line.ndof, 2 * line.ndof))


def both(part: Part, line: Line, state: State) -> Action:
    """Forces and tangent of a part at the same trial."""
    forces, values = Forces.zeros(state.u.size), {line.name: matrices(line)}

    def act() -> None:
        part.residual(state, forces)
        part.tangent(state, WEIGHTS, values)

    return act


if __name__ == "__main__":
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    report()
