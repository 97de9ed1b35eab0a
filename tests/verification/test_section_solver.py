"""Soil in sections by a solver of its own: steps are those of the general one, on any number of ranks."""

from __future__ import annotations

import gc
from itertools import count
from pathlib import Path
from typing import Any
from weakref import ReferenceType, ref

import numpy as np
import pytest
from petsc4py import PETSc
from scipy.sparse import csr_matrix

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.system import System
from riser_soil.results import Run
from riser_soil.solve import newton
from riser_soil.solve.section_factors import Csr, SectionFactors
from riser_soil.solve.section_solver import SectionSolver
from riser_soil.solve.time_stepper import AcceptedStep
from tests.support.driven_stage import built, take
from tests.support.run_on_ranks import COMPARED, ran
from tests.support.scenes import LAY, Mapping, cells, heave, touchdown

SECTIONS = 14
FRICTION: Mapping = {"axial": 0.3, "lateral": 0.3}


def on_sections(linear: str, tolerance: float = 1e-11, **contact: Any) -> Mapping:
    """Clay that yields, in so many sections."""
    scene = touchdown(LAY, heave(0.3), su=1000.0, tolerance=tolerance)
    scene["soil"] |= {"model": "sections", "mesh": {"kind": "hex", "size_at_riser": 0.1, "size_far": 0.5}}
    scene["soil"]["mesh"]["size_at_riser"] = {"along": 0.5, "across": 0.06, "strip": 0.15}
    scene["solver"] |= {"linear": linear}
    return scene | ({"contact": contact} if contact else {})


def steps(scene: Mapping) -> list[Array]:
    """Increments of all steps."""
    assembly, states, state = built(scene), list[Array](), None

    def watch(system: System, step: AcceptedStep) -> None:
        states.append(step.solution.state.u)

    for stage in assembly.scene.stages:
        state = take(assembly, stage, state, watch)
    return states


def backward_error(system: System, x: Array, load: Array) -> float:
    """Least relative change of matrix and load with which x solves the system exactly, on one rank.

    Source: Oettli & Prager, Numerische Mathematik 6 (1964), 405-409.
    """
    indptr, indices, values = system.matrix.stored.csr()
    matrix = csr_matrix((values, indices, indptr))
    terms = abs(matrix) @ np.abs(x) + np.abs(load)
    return float(np.max(np.abs(matrix @ x - load) / np.maximum(terms, np.finfo(float).tiny)))


@pytest.mark.parametrize(
    "contact",
    [pytest.param({}, id="smooth"), pytest.param({"friction": FRICTION}, id="rough", marks=pytest.mark.verify)],
)
def test_each_newton_step_solves_its_linear_system(contact: Mapping, monkeypatch: pytest.MonkeyPatch) -> None:
    """Sections that yield, and others that don't and keep their factors, from one pattern to the next.

    Its backward error is that of a direct solver: clay that yields all through has tangents so nearly singular that
    two exact solvers find steps that differ by 1e-4.
    """
    errors, made, usual, factorise = list[float](), list[int](), SectionSolver.apply, SectionFactors.factorise

    def judge(solver: SectionSolver, pc: PETSc.PC, load: PETSc.Vec, solution: PETSc.Vec) -> None:
        usual(solver, pc, load, solution)
        errors.append(backward_error(solver._system, solution.array_r, load.array_r))

    def accepted(factors: SectionFactors, csr: Csr, coupled: BoolArray) -> bool:
        regular = factorise(factors, csr, coupled)
        made.append(int(factors.bands.renewed.sum()))
        return regular

    monkeypatch.setattr(SectionSolver, "apply", judge)
    monkeypatch.setattr(SectionFactors, "factorise", accepted)
    scene = on_sections("auto", tolerance=1e-7, **contact)
    scene["soil"]["mesh"] = cells({"along": 0.5, "across": 0.1, "strip": 0.15}, 1.0)
    steps(scene)
    assert max(errors) < 1e-11
    assert len(errors) > 20
    assert sum(made) < 0.8 * SECTIONS * len(errors)


@pytest.mark.verify
def test_an_interior_without_an_inverse_is_left_to_the_general_solver(monkeypatch: pytest.MonkeyPatch) -> None:
    """A step of 0.1 um has the round-off of those of 9 mm before it."""
    expected, usual, calls = steps(on_sections("direct")), SectionFactors.factorise, count()
    monkeypatch.setattr(SectionFactors, "factorise", lambda *given: usual(*given) and next(calls) % 7 != 6)
    largest = max(np.abs(step).max() for step in expected)
    for mine, other in zip(steps(on_sections("auto")), expected, strict=True):
        np.testing.assert_allclose(mine, other, rtol=0.0, atol=1e-7 * largest)
    assert next(calls) > 14


@pytest.mark.verify
def test_what_balances_a_new_mesh_leaves_no_matrix_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    """However seldom Python looks for circles of references: each would hold the matrix of all of the soil."""
    made, usual = list[ReferenceType[System]](), newton.System

    def remembered(*given: Any) -> System:
        system = usual(*given)
        made.append(ref(system))
        return system

    monkeypatch.setattr(newton, "System", remembered)
    gc.disable()
    try:
        scene = on_sections("auto", tolerance=1e-7)
        scene["stages"][-1]["motion"]["end"]["harmonic"]["amplitude"] = [0.0, 0.0, 1.5]
        scene["stages"][-1]["duration"] = 1.2
        steps(scene)
        assert len(made) > 1
        assert not [system for system in made if system() is not None]
    finally:
        gc.enable()


@pytest.mark.verify
def test_a_rank_without_sections_takes_part(tmp_path: Path) -> None:
    scene = on_sections("auto")
    scene["soil"]["block"]["x"] = [4.0, 4.5]
    one, two = (ran(scene, tmp_path / str(ranks), ranks) for ranks in (1, 2))
    np.testing.assert_allclose(two["position"], one["position"], rtol=0.0, atol=1e-8)


@pytest.fixture(scope="module")
def direct(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """By the general solver."""
    return ran(on_sections("direct"), tmp_path_factory.mktemp("direct") / "run")


@pytest.mark.verify
@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_runs_are_the_same_on_any_number_of_ranks(ranks: int, direct: Run, tmp_path: Path) -> None:
    sections = ran(on_sections("auto"), tmp_path / "sections", ranks)
    for name in COMPARED:
        scale = np.nanmax(np.abs(direct[name]))
        np.testing.assert_allclose(sections[name], direct[name], rtol=0.0, atol=1e-8 * scale, err_msg=name)
    for name, values in direct.soil_frame().fields.items():  # ranks write their sections in turn
        computed, expected = (np.sort(each, axis=0) for each in (sections.soil_frame().fields[name], values))
        np.testing.assert_allclose(computed, expected, rtol=0.0, atol=1e-7 * np.abs(values).max(), err_msg=name)
    assert direct["contact_force"].max() > 0.0
    assert direct.soil_frame().fields["equivalent_plastic_strain"].max() > 0.0
