"""Plastic soil: a Newton iteration with kept factors, one with factors of its own, and one factorisation alone."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from petsc4py import PETSc

from benchmarks.coupled import SCENE
from benchmarks.speed_page import parser_of, tell
from benchmarks.stage import TimedStage, last_stage
from riser_soil.core.factor_memory import Workspace
from riser_soil.core.system import Timer
from riser_soil.soil.law import PLASTIC_STRAIN
from riser_soil.soil.soil import Soil
from riser_soil.solve.direct_solver import use_mumps
from riser_soil.solve.kept_factors import KeptFactors
from riser_soil.solve.newton import Newton
from riser_soil.solve.snes_loop import SnesLoop

CLAY = "su: 2.0e3, su_gradient: 1.5e3, E_over_su: 300.0"
LAWS = {
    "perfectly plastic": f"soil.law={{kind: von-mises, {CLAY}}}",
    "cyclic": f"soil.law={{kind: kinematic-hardening, {CLAY}}}",
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


HEAD = (
    *("clay", "unknowns", "points that have yielded", "an iteration, kept [ms]", "direct [ms]", "LDLᵀ alone [ms]"),
    *("kept over direct", "kept over LDLᵀ", "Newton iterations, kept and direct", "factorisations, kept"),
    "Krylov iterations each",
)


def report(page: bool = False, meshes: tuple[tuple[float, float, float], ...] = QUICK) -> None:
    tell("plastic", HEAD, (row(law, mesh) for law in LAWS for mesh in meshes), page)


def row(law: str, mesh: tuple[float, float, float]) -> list[str]:
    kept, direct = (_walked((LAWS[law], _meshed(mesh), f"solver.linear={how}")) for how in ("kept", "direct"))
    return [
        law, f"{kept.unknowns:,}", f"{100.0 * kept.yielded:.0f} %",
        f"{1e3 * kept.seconds:.0f}", f"{1e3 * direct.seconds:.0f}", f"{1e3 * direct.alone:.0f}",
        f"{kept.seconds / direct.seconds:.2f}", f"{kept.seconds / direct.alone:.2f}",
        f"{kept.iterations}, {direct.iterations}", f"{kept.factorisations}", f"{kept.krylov / kept.iterations:.1f}",
    ]  # fmt: skip


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
    return float(np.mean(soil.state()["law/history"][:, soil.law.columns.index(PLASTIC_STRAIN)] > 0.0))


def _factorisation_seconds(matrix: PETSc.Mat, repeats: int = 3) -> float:
    """Least processor time [s] of a numeric factorisation as LDL^T, the symbolic one reused."""
    pc, seconds = PETSc.PC().create(matrix.comm), list[float]()
    pc.setOperators(matrix)
    use_mumps(pc, "cholesky", Workspace().controls)
    for _ in range(1 + repeats):
        matrix.assemble()
        began = time.process_time()
        pc.setUp()
        seconds.append(time.process_time() - began)
    pc.destroy()
    return min(seconds[1:])


if __name__ == "__main__":
    parser = parser_of("plastic", __doc__)
    parser.add_argument("--large", action="store_true", help="also larger meshes")
    given = parser.parse_args()
    report(given.page, QUICK + LARGE if given.large else QUICK)
