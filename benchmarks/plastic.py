"""Plastic soil: a Newton iteration with kept factors, one with factors of its own, and one factorisation alone."""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass

import numpy as np
from petsc4py import PETSc

from benchmarks.coupled import SCENE
from benchmarks.stage import TimedStage, last_stage
from riser_soil.core.factor_memory import Workspace
from riser_soil.core.system import Timer
from riser_soil.soil.law import PLASTIC_STRAIN
from riser_soil.soil.soil import Soil
from riser_soil.solve.kept_factors import KeptFactors
from riser_soil.solve.linear_solver import use_mumps
from riser_soil.solve.newton import Newton
from riser_soil.solve.snes import SnesLoop

CLAY = "su: 2.0e3, su_gradient: 1.5e3, E_over_su: 300.0"
LAWS = {
    "perfectly plastic clay": f"soil.law={{kind: von-mises, {CLAY}}}",
    "cyclic clay": f"soil.law={{kind: kinematic-hardening, {CLAY}}}",
}
QUICK = ((1.0, 0.075, 0.75), (0.7, 0.065, 0.65))  # cells along and across the riser, and far from it [m]
LARGE = ((0.4, 0.042, 0.41), (0.35, 0.036, 0.36))
STEPS = 16


@dataclass(frozen=True)
class Walk:
    """Some steps of a stage: Newton iterations, processor time of one [s].

    yielded: share of the soil's points with plastic strain. factorisations, krylov: how many there were, the latter
    iterations with kept factors. alone: processor time of one factorisation [s].
    """

    unknowns: int
    yielded: float
    iterations: int
    seconds: float
    factorisations: int
    krylov: int
    alone: float


def report(meshes: tuple[tuple[float, float, float], ...] = QUICK) -> None:
    print("processor time; yielded: share of the points; LDL^T: one factorisation alone")
    for law, overrides in LAWS.items():
        for mesh in meshes:
            kept, direct = (_walked((overrides, _meshed(mesh), f"solver.linear={how}")) for how in ("kept", "direct"))
            made = f"{kept.factorisations} factorisations, {kept.krylov / kept.iterations:.1f} Krylov iterations each"
            print(
                f"{law}, {kept.unknowns} unknowns, {100.0 * kept.yielded:.0f} % yielded: "
                f"an iteration {1e3 * kept.seconds:.0f} ms kept (of {kept.iterations}; {made}), "
                f"{1e3 * direct.seconds:.0f} ms direct (of {direct.iterations}), LDL^T {1e3 * direct.alone:.0f} ms; "
                f"kept/direct {kept.seconds / direct.seconds:.2f}, kept/LDL^T {kept.seconds / direct.alone:.2f}",
                flush=True,
            )


def _meshed(mesh: tuple[float, float, float]) -> str:
    along, across, far = mesh
    at_riser = f"{{along: {along}, across: {across}, strip: 0.15}}"
    return f"soil.mesh={{kind: hex, size_at_riser: {at_riser}, size_far: {far}}}"


def _walked(overrides: tuple[str, ...]) -> Walk:
    """The first steps of the demo's dynamic stage."""
    stage = last_stage(SCENE, overrides, Timer.new())
    assert isinstance(stage.newton, Newton)
    assert isinstance(stage.newton.by_parts.loop, SnesLoop)
    kept, began = stage.newton.by_parts.loop.linear, time.process_time()
    stage.walk(STEPS)
    seconds = (time.process_time() - began) / stage.iterations
    made = (kept.factorisations, kept.iterations) if isinstance(kept, KeptFactors) else (stage.iterations, 0)
    unknowns, alone = stage.system.numbering.free, _factorisation_seconds(stage.system.matrix.mat)
    walk = Walk(unknowns, _yielded(stage), stage.iterations, seconds, *made, alone)
    stage.destroy()
    return walk


def _yielded(stage: TimedStage) -> float:
    soil = next(part for part in stage.system.model.parts if isinstance(part, Soil))
    return float(np.mean(soil.state()["history"][:, soil.law.columns.index(PLASTIC_STRAIN)] > 0.0))


def _factorisation_seconds(matrix: PETSc.Mat, repeats: int = 3) -> float:
    """Least processor time [s] of a numeric factorisation as LDL^T, the symbolic one reused."""
    pc, taken = PETSc.PC().create(matrix.comm), list[float]()
    pc.setOperators(matrix)
    use_mumps(pc, "cholesky", Workspace().controls)
    for _ in range(1 + repeats):
        matrix.assemble()
        began = time.process_time()
        pc.setUp()
        taken.append(time.process_time() - began)
    pc.destroy()
    return min(taken[1:])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m benchmarks.plastic", description=__doc__)
    parser.add_argument("--large", action="store_true", help="meshes of some 37,000 and 60,000 unknowns, half an hour")
    report(LARGE if parser.parse_args().large else QUICK)
