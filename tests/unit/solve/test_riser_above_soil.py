"""When the riser of a coupled system may be solved by itself, and what comes of it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from petsc4py import PETSc

from riser_soil.core.system import System
from riser_soil.solve.direct_solver import exact_solver
from riser_soil.solve.riser_above_soil import RiserAboveSoil
from tests.support.above_soil import hanging
from tests.support.driven_stage import FirstStep, built
from tests.support.scenes import LAY, Mapping, heave, touchdown


def at_start(scene: Mapping) -> System:
    """The system of a scene's last stage, its tangent that of its beginning."""
    step = FirstStep(built(scene))
    step.matrix(np.zeros(step.free))
    return step.system


@pytest.fixture(scope="module")
def above() -> Iterator[System]:
    scene = hanging()
    scene["stages"] = scene["stages"][:1]
    system = at_start(scene)
    yield system
    system.destroy()


def test_soil_that_is_touched_is_solved_with_the_riser() -> None:
    """Also where it is in balance as it is touched."""
    system = at_start(touchdown(LAY, heave(0.1)) | {"contact": {"method": "surface"}})
    assert system.couples
    assert not RiserAboveSoil(system).suits(system.numbering.zeros(), 1.0)
    system.destroy()


def test_soil_out_of_balance_is_solved_with_the_riser(above: System) -> None:
    """Soil is out of balance by more than what is negligible; the riser may be it."""
    solver, f = RiserAboveSoil(above), above.numbering.zeros()
    f[0] = 1e3
    assert solver.suits(f, 0.0)
    f[-2:] = 3.0, 4.0
    assert solver.suits(f, 5.1)
    assert not solver.suits(f, 4.9)
    f[-1] = np.nan
    assert not solver.suits(f, 1e9)


def test_the_riser_moves_as_with_the_soil_which_stays(above: System) -> None:
    f = above.numbering.zeros()
    f[: above.line_rows] = np.random.default_rng(3).normal(size=above.line_rows)
    solver, ksp = RiserAboveSoil(above), PETSc.KSP().create(PETSc.COMM_SELF)
    assert solver.suits(f, 0.0)
    solver.attach(ksp, above.matrix.mat.createVecLeft())
    ksp.setOperators(above.matrix.mat)
    x, b = above.matrix.mat.createVecs()
    b.array_w[:] = f
    ksp.solve(b, x)
    assert ksp.reason > 0
    with exact_solver(above) as solve:
        expected = solve(f)
    assert not x.array_r[above.line_rows :].any()
    assert np.abs(x.array_r - expected).max() < 1e-9 * np.abs(expected).max()
    ksp.reset()
    ksp.destroy()
    assert solver not in RiserAboveSoil.in_use


def test_a_riser_without_an_answer_of_its_own_is_left_to_the_solver_of_the_whole(above: System) -> None:
    """Which tells what fails."""
    solver = RiserAboveSoil(above)
    above.matrix.clear()
    above.matrix.assemble()
    assert not solver.suits(above.numbering.zeros(), 0.0)
