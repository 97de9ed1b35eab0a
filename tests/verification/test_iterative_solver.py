"""The iterative linear solver: the same states as the direct one, on any number of ranks; it says where it fails."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI
from petsc4py import PETSc
from typer.testing import CliRunner

from riser_soil.__main__ import app
from riser_soil.assembly import build
from riser_soil.core.part import State
from riser_soil.core.system import System, Timer
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.solve import iterative_solver, stability
from riser_soil.solve.iterative_solver import IterativeSolver
from riser_soil.stages import LayingCounter, run_stage
from tests.support.run_on_ranks import COMPARED, ran
from tests.support.said import line_with
from tests.support.scenes import LAY, Mapping, heave, touchdown


def on_clay(linear: str) -> Mapping:
    """In a plane: in space the riser may get out of the way to either side."""
    scene = touchdown(LAY, heave(0.2), su=400.0, tolerance=1e-9)
    scene["solver"] |= {"linear": linear}
    return scene


@pytest.mark.verify
@pytest.mark.parametrize("ranks", [1, 2])
def test_states_are_those_of_the_direct_solver(ranks: int, tmp_path: Path) -> None:
    """Clay that yields, touched by the riser, at rest and in motion."""
    direct = ran(on_clay("direct"), tmp_path / "direct")
    iterative = ran(on_clay("iterative"), tmp_path / "iterative", ranks)
    for name in COMPARED:
        scale = np.nanmax(np.abs(direct[name]))
        np.testing.assert_allclose(iterative[name], direct[name], rtol=0.0, atol=1e-6 * scale, err_msg=name)
    assert direct["contact_force"].max() > 0.0
    assert direct.soil_frame().fields["equivalent_plastic_strain"].max() > 0.0


def test_iterations_that_do_not_converge_are_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(iterative_solver, "MOST_ITERATIONS", 2)
    scene = on_clay("iterative")
    scene["solver"] |= {"min_load_step": 1.0}
    (tmp_path / "scene.yaml").write_text(json.dumps(scene), encoding="utf-8")
    done = CliRunner().invoke(app, ["run", str(tmp_path / "scene.yaml"), "-o", str(tmp_path / "out")])
    assert done.exit_code == 3
    line_with(done.stderr, "iterative linear solver", "not converged", "2 iterations:")


@pytest.mark.parametrize(("linear", "judged"), [("direct", True), ("iterative", False)])
def test_nothing_is_factorised_to_judge_stability(
    linear: str, judged: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    counted: list[System] = []

    def none(system: System) -> int:
        counted.append(system)
        return 0

    monkeypatch.setattr(stability, "negative_pivots", none)
    assembly = build(scene_from_mapping(on_clay(linear)), MPI.COMM_SELF)
    start = State.at_rest(0.0, assembly.size)
    run_stage(assembly, assembly.scene.stages[0], start, LayingCounter(), Timer.new())
    assert any(len(system.model.fields) > 1 for system in counted) == judged


def test_a_tangent_of_clay_takes_few_iterations(monkeypatch: pytest.MonkeyPatch) -> None:
    """13 on average; 18 with two steps of the smoother, or where a correction misses what the one before has left."""
    cycles: list[PETSc.PC] = []
    tangents: list[PETSc.PC] = []
    apply, set_up = IterativeSolver.apply, IterativeSolver.setUp

    def applied(solver: IterativeSolver, pc: PETSc.PC, x: PETSc.Vec, y: PETSc.Vec) -> None:
        cycles.append(pc)
        apply(solver, pc, x, y)

    def set_anew(solver: IterativeSolver, pc: PETSc.PC) -> None:
        tangents.append(pc)
        set_up(solver, pc)

    monkeypatch.setattr(IterativeSolver, "apply", applied)
    monkeypatch.setattr(IterativeSolver, "setUp", set_anew)
    assembly = build(scene_from_mapping(on_clay("iterative")), MPI.COMM_SELF)
    start = State.at_rest(0.0, assembly.size)
    run_stage(assembly, assembly.scene.stages[0], start, LayingCounter(), Timer.new())
    assert 5 * len(tangents) < len(cycles) < 15 * len(tangents)
