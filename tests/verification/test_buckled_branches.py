"""Beyond a bifurcation statics find the buckled branch, on any mesh; elastica and rod equations beside it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI
from petsc4py import PETSc
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from riser_soil.assembly import Assembly, build
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import System, Timer
from riser_soil.results import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.solve.buckling_mode import _largest
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.time_scheme import Static
from riser_soil.whole_run import run
from tests.support.on_ranks import mpirun
from tests.support.rod_reference import Rod, first_buckling
from tests.support.scenes import ALONG, SLANTING, Mapping, blade, column, frame


def tip(scene: Mapping, folder: Path) -> tuple[Array, int]:
    """Where the free end comes to, and how many unstable equilibria were left on the way."""
    run(scene_from_mapping(scene), folder, force=True)
    stage = Run(folder).summary["stages"][0]
    return np.array(stage["final"]["end"]["position"]), stage["branch_switches"]


def elastica(ratio: float) -> tuple[float, float]:
    """Tip of the buckled cantilever, along its first axis and aside (Timoshenko & Gere 1961, section 2.7)."""
    k = 0.5 * np.pi * np.sqrt(ratio)
    m = brentq(lambda m: ellipk(m) - k, 1e-9, 1.0 - 1e-9, xtol=1e-15)
    return 2.0 * ellipe(m) / k - 1.0, 2.0 * np.sqrt(m) / k


@pytest.mark.parametrize(("elements", "EA"), [(20, 1e7), (200, 1e9), pytest.param(1000, 1e7, marks=pytest.mark.verify)])
def test_columns_of_any_mesh_buckle(elements: int, EA: float, tmp_path: Path) -> None:
    deflection, switches = tip(column(elements, 2.0, EA), tmp_path)
    assert (deflection[0], deflection[2]) == pytest.approx(elastica(2.0), abs=2e-4)
    assert switches == 1


@pytest.mark.verify
@pytest.mark.parametrize("axis", [ALONG, SLANTING])
@pytest.mark.parametrize(("dimension", "elements"), [(2, 2000), (3, 800)])
@pytest.mark.parametrize("EA", [1e7, 1e9])
def test_columns_of_many_elements_buckle(EA: float, dimension: int, elements: int, axis: Any, tmp_path: Path) -> None:
    """Round-off is 0.3 of the load for EA = 1e9 and 2,000 elements: the drag must exceed what it may hide."""
    deflection, switches = tip(column(elements, 2.0, EA, dimension, axis), tmp_path)
    along = float(deflection @ axis)
    assert (along, np.linalg.norm(deflection - along * np.array(axis))) == pytest.approx(elastica(2.0), abs=2e-4)
    assert switches == 1


def unstable_modes(scene: Mapping) -> int:
    """At the equilibrium that Newton's method finds in one step from the first shape."""
    assembly: Assembly = build(scene_from_mapping(scene), MPI.COMM_WORLD)
    system = System(assembly.comm, assembly.begin(assembly.scene.stages[0]), Timer.new())
    newton = Newton(system, NewtonSettings(assembly.scene.solver.tolerance, 25, assembly.scales.force_floor))
    weights, still = Static().weights(1.0), State.at_rest(1.0, assembly.size)
    system.assemble(still, weights)
    forces, (increment, right) = system.forces(still), system.matrix.mat.createVecs()
    right.array_w[:] = system.numbering.add_to_global(-forces.force)
    solver = PETSc.KSP().create(assembly.comm)
    solver.setType("preonly")
    solver.getPC().setType("lu")
    solver.getPC().setFactorSolverType("mumps")
    solver.setOperators(system.matrix.mat)
    solver.solve(right, increment)
    u = np.zeros(assembly.size)
    system.numbering.to_local(increment.array_r, u)
    modes = newton.unstable_modes(State(1.0, u, 0.0 * u, 0.0 * u))
    for thing in (solver, right, increment, newton, system):
        thing.destroy()
    return modes


@pytest.mark.parametrize("axis", [ALONG, SLANTING])
@pytest.mark.parametrize(("dimension", "modes"), [(2, 1), (3, 2)])
@pytest.mark.parametrize("elements", [20, 1000])
def test_the_count_knows_the_load_to_a_hundredth(elements: int, dimension: int, modes: int, axis: Any) -> None:
    """Bound of round-off: 11 eps n^4 = 0.0025 of a cantilever's load for n = 1000, and 0.003 for EA/P = 4e6."""
    assert unstable_modes(column(elements, 0.98, 1e7, dimension, axis)) == 0
    assert unstable_modes(column(elements, 1.02, 1e7, dimension, axis)) == modes


@pytest.mark.verify
def test_two_ranks_count_as_one() -> None:
    """Two ranks count by MUMPS, where one rank has PETSc's own factorisation."""
    script = (
        "from tests.verification.test_buckled_branches import unstable_modes\n"
        "from tests.support.scenes import column\n"
        "from mpi4py import MPI\n"
        "found = [unstable_modes(column(1000, r, 1e7, 3, (0.6, 0.0, 0.8))) for r in (0.98, 1.02)]\n"
        "print(found if MPI.COMM_WORLD.rank == 0 else '')\n"
    )
    done = mpirun(2, "-c", script)
    assert done.stdout.strip() == "[0, 2]", done.stderr


@pytest.mark.parametrize("elements", [20, pytest.param(40, marks=pytest.mark.verify)])
def test_just_beyond_lateral_torsional_buckling(elements: int, tmp_path: Path) -> None:
    """The deflection is the square root of the excess over the load at which the rod's equations have a second
    solution; far beyond it towards positive y, as the mode's largest displacement goes there. The mirrored branch is as
    good, and a load step from a state next to the critical load may find that one.
    """
    rod = Rod(1.0, 1e5, np.array([0.5, 1.0, 1e3]), np.zeros(3), np.eye(3))
    critical = first_buckling([(rod, np.eye(3))], np.array([0.0, 1.0, 0.0]), 2.0, 3.5)
    near, far = (tip(blade(elements, ratio * critical), tmp_path) for ratio in (1.0025, 1.01))
    assert (near[1], far[1]) == (1, 1)
    assert far[0][1] > 0.0
    assert far[0][1] / abs(near[0][1]) == pytest.approx(2.0, rel=0.01)


@pytest.mark.parametrize(("ratio", "elements"), [(1.06, 40), pytest.param(2.0, 80, marks=pytest.mark.verify)])
def test_frame_beyond_its_buckling_load(ratio: float, elements: int, tmp_path: Path) -> None:
    """Both meshes go out of the plane to the same side, as far as the smaller share of the bent joint lets them."""
    coarse, fine = (tip(frame(n, ratio * 1.0878), tmp_path) for n in (elements, 2 * elements))
    assert (coarse[1], fine[1]) == (1, 1)
    assert fine[0][1] > 0.05 * 240.0
    assert coarse[0] == pytest.approx(fine[0], abs=0.02 * 240.0)


@pytest.mark.verify
def test_frame_of_640_elements(tmp_path: Path) -> None:
    deflection, switches = tip(frame(640, 2.0 * 1.0878), tmp_path)
    assert switches == 1
    assert deflection[1] > 0.2 * 240.0


@pytest.mark.parametrize("elements", [20, 40, pytest.param(640, marks=pytest.mark.verify)])
def test_pushed_frame_far_beyond_buckling(elements: int, tmp_path: Path) -> None:
    """Pushed by twice the load at which it buckles, 0.68 N (Simo & Vu-Quoc 1986), with 1e-4 N across: the strip's
    stiffnesses are as 2,500 to 1, and an element of 24 mm turns by 0.2 rad about the soft axis. Beside 640 elements.
    """
    deflection, _ = tip(frame(elements, -1.36, across=1e-4), tmp_path)
    assert deflection == pytest.approx([-15.41, 234.71, -132.45], abs=0.01 * 240.0)


def test_the_sign_of_a_mode_hangs_on_no_round_off() -> None:
    """The first of displacements that are equally large along the line decides."""
    wave = np.sin(2.0 * np.pi * np.linspace(0.0, 1.0, 9))[:, None] * np.array([0.0, 1.0])
    for scatter in (1e-14, -1e-14):
        noisy = wave.copy()
        noisy[6] += scatter
        assert _largest(noisy) == 1.0
        assert _largest(-noisy) == -1.0


@pytest.mark.verify
def test_two_ranks_take_the_same_branch(tmp_path: Path) -> None:
    deflections = []
    for ranks in (1, 2):
        folder = tmp_path / str(ranks)
        script = (
            "from pathlib import Path\n"
            "from riser_soil.whole_run import run\n"
            "from riser_soil.scene.reader import scene_from_mapping\n"
            "from tests.support.scenes import blade\n"
            f"run(scene_from_mapping(blade(20, 3.0)), Path({str(folder)!r}))\n"
        )
        done = mpirun(ranks, "-c", script)
        assert done.returncode == 0, done.stderr
        deflections.append(Run(folder).summary["stages"][0])
    assert [stage["branch_switches"] for stage in deflections] == [1, 1]
    one, two = (stage["final"]["end"]["position"] for stage in deflections)
    assert abs(one[1]) > 0.1, "either side is as good"
    assert two == pytest.approx(one, abs=1e-6)
