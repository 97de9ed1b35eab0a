"""The demo on a block: seconds by part, and a coupled Newton iteration against a bare factorisation of its matrix."""

from __future__ import annotations

from pathlib import Path

from petsc4py import PETSc

from benchmarks.stage import last_stage, typical_seconds
from riser_soil.core.system import Timer

SCENE = Path(__file__).parent.parent / "tests" / "scenes" / "touchdown_on_block.yaml"


def report() -> None:
    clock = Timer.new()
    stage = last_stage(SCENE, (), clock)
    stage.walk()
    seconds = stage.seconds
    print(f"demo, dynamic stage: {stage.iterations} Newton iterations, {seconds:.2f} s")
    for part, share in sorted(clock.seconds.items(), key=lambda item: -item[1]):
        print(f"  {part:14s} {share:8.3f} s")
    iteration, bare = seconds / stage.iterations, factorisation_seconds(stage.system.matrix.mat)
    print(f"coupled Newton iteration {iteration * 1e3:.1f} ms, bare MUMPS factorisation {bare * 1e3:.1f} ms")
    print(f"coupled Newton iteration / bare MUMPS factorisation: {iteration / bare:.2f}")
    stage.destroy()


def factorisation_seconds(matrix: PETSc.Mat, repeats: int = 15) -> float:
    """Median seconds of a numeric factorisation, the symbolic one reused."""
    pc = PETSc.PC().create(matrix.comm)
    pc.setOperators(matrix)
    pc.setType("lu")
    pc.setFactorSolverType("mumps")
    pc.setUp()

    def factor() -> None:
        matrix.assemble()
        pc.setUp()

    seconds = typical_seconds(factor, repeats)
    pc.destroy()
    return seconds
