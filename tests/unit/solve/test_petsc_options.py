"""Options of PETSc by the project's prefix: SNES, its line search and its linear solver do what they say."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI
from petsc4py import PETSc

from riser_soil.core.part import Model, State
from riser_soil.core.system import System, Timer
from riser_soil.errors import SceneError
from riser_soil.solve.balance import OutgrownError
from riser_soil.solve.linear_solver import raised
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.petsc_options import PREFIX, user_options
from riser_soil.solve.snes_loop import SnesLoop
from riser_soil.solve.step import NotConvergedError, Solution, Step
from riser_soil.solve.step_iteration import StepIteration
from riser_soil.solve.time_scheme import Static
from tests.support.driven_stage import built, take
from tests.support.on_ranks import mpirun
from tests.support.said import line_with
from tests.support.scenes import LAY, Mapping, touchdown
from tests.support.toy_chain import Chain, Springs

STIFFENING = {"k": 10.0, "cubic": 100.0, "weight": 2.0}  # N/m, N/m3, N: full steps go far beyond the equilibrium


def solved(tolerance: float = 1e-10, most: int = 20, **options: Any) -> Solution:
    """Three stiffening springs under weights, by SNES."""
    chain, z = Chain(np.arange(4.0), prescribed=True), np.zeros(4)
    system = System(MPI.COMM_SELF, Model([chain], [Springs(chain, 1.0, **STIFFENING)]), Timer.new())
    settings = NewtonSettings(tolerance, most, 1e-12, snes=True, petsc_options=tuple(options.items()))
    newton = Newton(system, settings)
    try:
        return newton.solve(Step(Static(), State(0.0, z, z.copy(), z.copy()), 1.0, 1.0, None, z.copy()))
    finally:
        newton.destroy()
        system.destroy()


@pytest.fixture(autouse=True)
def none_left() -> Iterator[None]:
    """Options of a system go with it."""
    yield
    assert user_options() == {}


def test_monitors_print_the_norms(capfd: pytest.CaptureFixture[str]) -> None:
    solution = solved(snes_monitor=True, snes_converged_reason=None)
    *printed, reason = capfd.readouterr().out.splitlines()
    assert [float(line.split()[-1]) for line in printed] == pytest.approx(solution.norms, rel=1e-9)
    line_with(reason, PREFIX, "CONVERGED_FNORM_RELATIVE", f"iterations {solution.iterations}")


@pytest.mark.parametrize(
    ("option", "limit"),
    [("snes_rtol", lambda norms: 1e-3 * norms[0]), ("snes_atol", lambda norms: 1e-3)],
    ids=["relative", "absolute"],
)
def test_a_tolerance_of_snes_ends_the_iteration_in_the_place_of_the_project_s(option: str, limit: Any) -> None:
    """Looser than the scene's, and tighter."""
    asked: dict[str, Any] = {option: 1e-3}
    for tolerance in (1e-12, 0.9):
        *before, last = solved(tolerance, **asked).norms
        assert last <= limit([*before, last]) < before[-1]


def test_a_short_step_ends_the_iteration_where_that_is_asked_for() -> None:
    assert solved(snes_stol=1e-2).iterations < solved(snes_stol=1e-12).iterations


def test_the_number_of_iterations_is_limited() -> None:
    with pytest.raises(NotConvergedError) as failure:
        solved(snes_max_it=3, snes_error_if_not_converged=True)
    line_with(str(failure.value), "diverged_max_it", "after 3 iterations", "sits at the mass")


def test_options_of_the_database_go_before_those_of_a_scene() -> None:
    PETSc.Options()[f"{PREFIX}snes_max_it"] = 2
    try:
        with pytest.raises(NotConvergedError, match="after 2 iterations"):
            solved(snes_max_it=9)
    finally:
        PETSc.Options().delValue(f"{PREFIX}snes_max_it")


@pytest.mark.parametrize("options", [{"snes_linesearch_type": "bt"}, {"snes_type": "newtontr"}], ids=str)
def test_searches_of_petsc_let_no_residual_grow(options: dict[str, Any]) -> None:
    full, searched = solved(), solved(**options)
    assert full.norms[1] > full.norms[0]
    assert (np.diff(searched.norms) < 0.0).all()
    np.testing.assert_allclose(searched.state.u, full.state.u, rtol=0.0, atol=1e-9)


def test_the_part_of_a_step_that_petsc_takes_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """A tenth is the least that "bt" takes of what it has tried, and all of a step near the end."""
    parts = list[float]()
    monkeypatch.setattr(StepIteration, "note_step_length", lambda iteration, part: parts.append(part))
    solved(snes_linesearch_type="bt")
    assert parts[0] == pytest.approx(0.1)
    assert parts[-1] == pytest.approx(1.0)


def test_the_tangent_is_assembled_as_snes_asks_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    usual, asked = StepIteration.tangent, list[int]()

    def tangent(iteration: StepIteration, x: Any) -> None:
        asked.append(1)
        usual(iteration, x)

    monkeypatch.setattr(StepIteration, "tangent", tangent)
    once = solved()
    assert len(asked) == once.iterations
    asked.clear()
    lagging = solved(most=60, snes_lag_jacobian=2)
    assert len(asked) == -(-lagging.iterations // 2) < lagging.iterations
    np.testing.assert_allclose(lagging.state.u, once.state.u, rtol=0.0, atol=1e-9)


def test_the_tangent_is_that_of_the_residual_by_petsc_s_own_test(capfd: pytest.CaptureFixture[str]) -> None:
    solved(snes_test_jacobian=True)
    errors = [line for line in capfd.readouterr().out.splitlines() if "||J - Jfd||_F/||J||_F =" in line]
    assert len(errors) > 3
    assert all(float(line.split("=")[1].split(",")[0]) < 1e-6 for line in errors)


def test_a_linear_solver_of_petsc_takes_the_place_of_the_project_s(capfd: pytest.CaptureFixture[str]) -> None:
    """PETSc's solver is as exact as Newton's method asks for."""
    solution = solved(ksp_type="gmres", pc_type="none", ksp_converged_reason=True)
    printed = capfd.readouterr().out.splitlines()
    assert len(printed) == solution.iterations == solved().iterations
    assert all("iterations 0" not in line for line in printed)
    np.testing.assert_allclose(solution.state.u, solved().state.u, rtol=0.0, atol=1e-9)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"snes_monitr": True}, ("-riser_soil_snes_monitr", "nothing reads it", "mean snes_monitor?", "ksp_rtol")),
        ({"ksp_gmres_restart": 9}, ("-riser_soil_ksp_gmres_restart", "nothing reads it", "KSP preonly")),
        ({"snes_linesearch_type": "bisect"}, ("-riser_soil_snes_linesearch_type bisect", "refuses")),
        ({"snes_max_it": "many"}, ("-riser_soil_snes_max_it many", "refuses", "no integer value")),
        ({"snes_convergence_test": "skip"}, ("-riser_soil_snes_convergence_test", "snes_rtol")),
    ],
    ids=lambda each: next(iter(each)) if isinstance(each, dict) else "",
)
def test_an_option_that_is_none_is_refused_in_one_line(options: dict[str, Any], says: tuple[str, ...]) -> None:
    with pytest.raises(SceneError) as failure:
        solved(**options)
    line_with(str(failure.value), "PETSC_OPTIONS or solver.petsc_options", *says)


def test_what_a_callback_raises_comes_out_of_petsc_s_own_error() -> None:
    err, cause = PETSc.Error(-1), OutgrownError()
    err.__cause__ = cause
    assert raised(err) is cause
    assert raised(cause) is cause


def test_a_matrix_that_lacks_places_ends_the_iteration_and_leaves_snes_usable(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Once, in its second tangent: what follows takes up where that was."""
    expected, usual, asked, rests = solved(), StepIteration.tangent, list[int](), list[int]()

    def tangent(iteration: StepIteration, x: Any) -> None:
        asked.append(1)
        if len(asked) == 2:
            raise OutgrownError
        usual(iteration, x)

    def renew(iteration: StepIteration, state: State) -> None:
        rests.append(1)
        assert isinstance(iteration.loop, SnesLoop)
        iteration.loop.release()
        iteration.loop.renew()

    monkeypatch.setattr(StepIteration, "tangent", tangent)
    monkeypatch.setattr(StepIteration, "_renew", renew)
    solution = solved()
    assert rests == [1]
    assert solution.norms == pytest.approx(expected.norms, rel=1e-9)


ON_RANKS = '''
import sys
import numpy as np
from mpi4py import MPI
from riser_soil.core.part import Model, State
from riser_soil.core.system import System, Timer
from riser_soil.errors import SceneError
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.step import Step
from riser_soil.solve.time_scheme import Static
from tests.support.toy_chain import Chain, Springs

comm = MPI.COMM_WORLD
for options in ((), (("snes_linesearch_type", "bt"), ("pc_type", "lu")), (("snes_monitr", True),)):
    # All ranks hold the chain and share its springs.
    chain, z = Chain(np.arange(4.0), prescribed=True, owner=comm.rank == 0), np.zeros(4)
    springs = Springs(chain, 1.0, 10.0 / comm.size, 100.0 / comm.size, 2.0 / comm.size)
    system = System(comm, Model([chain], [springs]), Timer.new())
    newton = Newton(system, NewtonSettings(1e-10, 20, 1e-12, snes=True, petsc_options=options))
    try:
        state = newton.solve(Step(Static(), State(0.0, z, z.copy(), z.copy()), 1.0, 1.0, None, z.copy())).state
        told = f"{state.u[-1]:.9f}"
    except SceneError as failure:
        told = str(failure)
    newton.destroy()
    system.destroy()
    told = comm.gather(told)
    if comm.rank == 0:
        assert told == [told[0]] * comm.size, told
        print(told[0], flush=True)
'''


def test_options_of_the_environment_count_on_two_ranks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    script = tmp_path / "chain.py"
    script.write_text(ON_RANKS)
    monkeypatch.setenv("PETSC_OPTIONS", f"-{PREFIX}snes_monitor")
    done = mpirun(2, str(script))
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert sum(line.startswith("  0 SNES Function norm") for line in lines) == 3  # by the first rank alone
    by_basic, by_bt, refused = (line for line in lines if "SNES Function norm" not in line)
    assert by_basic == by_bt == f"{solved().state.u[-1]:.9f}"
    line_with(refused, "-riser_soil_snes_monitr", "did you mean snes_monitor?")


def test_options_of_the_soil_s_solver_are_looked_for_where_there_is_soil(capfd: pytest.CaptureFixture[str]) -> None:
    """The riser is laid before, by a solver that has none of them; multigrid reads its own when it is set up."""
    scene = touchdown(LAY)
    scene["solver"] |= {"linear": "iterative"}
    asked = {"ksp_gmres_restart": 60, "soil_pc_gamg_threshold": 0.01, "soil_mg_levels_ksp_max_it": 2, "ksp_view": True}
    scene["solver"]["petsc_options"] = asked
    laid(scene)
    assert "restart=60" in capfd.readouterr().out
    scene["solver"]["petsc_options"] = asked | {"soil_pc_gamg_treshold": 0.01}
    with pytest.raises(SceneError) as failure:
        laid(scene)
    line_with(str(failure.value), "-riser_soil_soil_pc_gamg_treshold", "nothing reads it", "KSP gmres")


def laid(scene: Mapping) -> None:
    assembly = built(scene)
    take(assembly, assembly.scene.stages[0])
