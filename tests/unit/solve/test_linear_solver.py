"""Newton's method where the linear solver fails: told as a step that did not converge, and usable afterwards."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI
from petsc4py import PETSc

from riser_soil.core.part import Model, State
from riser_soil.core.system import System, Timer
from riser_soil.solve.linear_solver import complaint
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.step import NotConvergedError, Step
from riser_soil.solve.time_scheme import Static
from tests.support.on_ranks import mpirun
from tests.support.said import line_with
from tests.support.toy_chain import Chain, Springs

SCRIPT = '''
import numpy as np
from mpi4py import MPI
from petsc4py import PETSc
from riser_soil.core.part import Model, State
from riser_soil.core.system import System, Timer
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.step import NotConvergedError, Step
from riser_soil.solve.time_scheme import Static
from tests.support.toy_chain import Chain, Springs

comm, options = MPI.COMM_WORLD, PETSc.Options()
options["riser_soil_pc_factor_mat_solver_type"] = "mumps"
for raising in (False, True):
    if raising:
        options["riser_soil_ksp_error_if_not_converged"] = True
    # All ranks hold the chain and share its springs.
    chain = Chain(np.arange(4.0), prescribed=True, owner=comm.rank == 0)
    springs = Springs(chain, 1.0, 1.0, weight=2.0 / comm.size)
    system = System(comm, Model([chain], [springs]), Timer.new())
    newton, z = Newton(system, NewtonSettings(1e-10, 20, 1e-12, snes=True)), np.zeros(4)
    told = []
    for k in (20.0, 0.0, 20.0, 0.0, 0.0, 10.0):
        springs.k = k / comm.size
        try:
            solution = newton.solve(Step(Static(), State(0.0, z, z.copy(), z.copy()), 1.0, 1.0, None, z.copy()))
            told.append(f"{solution.state.u[-1]:.9f}")
        except NotConvergedError as failure:
            told.append(str(failure).split(" after")[0])
    told = comm.gather(told)
    if comm.rank == 0:
        assert all(each == told[0] for each in told), told
        print(*told[0], sep="; ")
'''


@pytest.mark.parametrize("ranks", [1, 2])
def test_springs_without_stiffness_fail_and_others_after_them_do_not(tmp_path: Path, ranks: int) -> None:
    """Three springs under 2, 2 and 2 N give (6 + 4 + 2) N/k, whatever failed before; a failure is told, or raised."""
    script = tmp_path / "chain.py"
    script.write_text(SCRIPT)
    done = mpirun(ranks, str(script))
    assert done.returncode == 0, done.stderr
    failures = "diverged_linear_solve", "the linear solver failed (MUMPS"
    for said, failure in zip(done.stdout.strip().splitlines(), failures, strict=True):
        messages = said.split("; ")  # more or less of what MUMPS says, by PETSc's version
        expected = ["-0.600000000", failure, "-0.600000000", failure, failure, "-1.200000000"]
        assert [text[: len(start)] for text, start in zip(messages, expected, strict=True)] == expected


HELD = '''
import signal
import sys
import numpy as np
from mpi4py import MPI
from riser_soil.core.part import Model, State
from riser_soil.core.system import System, Timer
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.step import Step
from riser_soil.solve.time_scheme import Static
from tests.support.toy_chain import Chain, Springs

signal.alarm(60)  # s: ranks that wait for each other are ended
comm = MPI.COMM_WORLD
held = []

class Holding(Springs):
    def tangent(self, *given):
        if comm.rank == 1:
            held.append(sys._getframe())  # and with it the frames that have called it
        super().tangent(*given)

for stage in range(2):
    chain = Chain(np.arange(4.0), prescribed=True, owner=comm.rank == 0)
    system = System(comm, Model([chain], [Holding(chain, 10.0, 1.0, weight=2.0 / comm.size)]), Timer.new())
    newton, z = Newton(system, NewtonSettings(1e-10, 20, 1e-12, snes=True, linear=sys.argv[1])), np.zeros(4)
    newton.solve(Step(Static(), State(0.0, z, z.copy(), z.copy()), 1.0, 1.0, None, z.copy()))
    newton.destroy()
    comm.sendrecv(None, 1 - comm.rank)
    system.destroy()
'''


@pytest.mark.parametrize("linear", ["direct", pytest.param("kept", marks=pytest.mark.verify)])
def test_stages_end_on_all_ranks_though_one_holds_on_to_frames(tmp_path: Path, linear: str) -> None:
    """A rank holds on to frames where it alone has compiled a kernel: factors go, and PETSc's copy of the communicator
    stays.
    """
    script = tmp_path / "held.py"
    script.write_text(HELD)
    done = mpirun(2, str(script), linear)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("code", [55, 63])
def test_other_errors_are_no_complaint_of_the_linear_solver(code: int) -> None:
    """Memory, or an index out of range."""
    assert complaint(PETSc.Error(code)) == ""


def test_a_complaint_without_words_is_one() -> None:
    line_with(complaint(PETSc.Error(76)), "linear solver failed", "MUMPS")


def test_a_dense_border_without_stiffness_fails_and_is_reported() -> None:
    """A chain held by springs, and a place that nothing holds; a second time, too."""
    chain, loose, z = Chain(np.arange(4.0), prescribed=True), Chain(np.zeros(1)), np.zeros(5)
    loose.name = loose.space = "loose"
    system = System(MPI.COMM_SELF, Model([chain], [Springs(chain, 1.0, 20.0, weight=2.0)], [loose]), Timer.new())
    newton = Newton(system, NewtonSettings(1e-10, 20, 1e-12))
    for _ in range(2):
        with pytest.raises(NotConvergedError, match="matrix is singular"):
            newton.solve(Step(Static(), State(0.0, z, z.copy(), z.copy()), 1.0, 1.0, None, z.copy()))
    newton.destroy()
    system.destroy()
