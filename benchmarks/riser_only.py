"""A riser alone: its Newton iteration against bare force, tangent and LU; simulated seconds per second."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from petsc4py import PETSc

from benchmarks.stage import TimedStage, last_stage, random_right_hand_side, typical_seconds
from riser_soil.part import Forces, State
from riser_soil.system import Clock

SCENE = Path(__file__).parent.parent / "tests" / "scenes" / "catenary.yaml"
SIZES = ((2, 35), (2, 100), (3, 100), (3, 400))


def report() -> None:
    for dimension, elements in SIZES:
        overrides = (
            f"dimension={dimension}",
            f"riser.segments.0.elements={elements}",
            "line_types.flexible.GJ=2.0e4",
            "stages.1.duration=28.0",
        )
        stage = last_stage(SCENE, overrides, Clock.new())
        stage.walk(20)
        stage.iterations, stage.seconds = 0, 0.0
        steps = 100
        stage.walk(steps)
        iteration, bare = stage.seconds / stage.iterations, bare_seconds(stage)
        simulated = steps * 0.1 / stage.seconds
        print(
            f"{dimension}D, {elements} elements: Newton iteration {iteration * 1e6:.0f} us, bare force + tangent + LU "
            f"{bare * 1e6:.0f} us, ratio {iteration / bare:.2f}; {stage.iterations / steps:.2f} iterations a step, "
            f"{simulated:.0f} times faster than real time"
        )
        stage.destroy()


def bare_seconds(stage: TimedStage, repeats: int = 200) -> float:
    """Force, tangent, and factorisation with one solve, without Newton, SNES or time scheme around them."""
    system, march = stage.system, stage.march
    weights = march.scheme.weights(0.1)
    base = march.before
    tiny = 1e-9 * random_right_hand_side(len(base.u))
    matrix = system.matrix
    pc = PETSc.PC().create(PETSc.COMM_SELF)
    pc.setOperators(matrix.mat)
    pc.setType("lu")
    pc.setFactorOrdering("natural")
    b = matrix.mat.createVecLeft()
    b.array_w[:] = random_right_hand_side(b.size)
    x = b.duplicate()

    def once() -> None:
        state = State(0.0, tiny.copy(), base.v, base.a)
        forces = Forces.zeros(len(tiny))
        for part in system.model.parts:
            part.residual(state, forces)
        matrix.clear()
        for part in system.model.parts:
            part.tangent(state, weights, matrix.values)
        matrix.assemble()
        pc.setUp()
        pc.apply(b, x)

    seconds = typical_seconds(once, repeats)
    assert np.isfinite(x.norm())
    for thing in (pc, b, x):
        thing.destroy()
    return seconds
