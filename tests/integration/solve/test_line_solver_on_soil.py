"""Time steps of a riser on condensed soil in the line solver, beside those of Newton's method over its parts."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from riser_soil.contact.closest_point import Axis
from riser_soil.contact.near_points import PairsByFacet, boxes
from riser_soil.contact.surface_kernels import Watched, leaves
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import System, Timer
from riser_soil.solve.convergence import StopLimits
from riser_soil.solve.line_solver import LineSolver, line_solver
from riser_soil.solve.line_system import LineSystem
from riser_soil.solve.newton import solver_of
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.soil_border import SoilBorder
from riser_soil.solve.step import Step
from riser_soil.solve.step_trial import StepTrial
from riser_soil.solve.time_scheme import GeneralizedAlpha
from riser_soil.solve.time_stepper import AcceptedStep
from riser_soil.stages import run_stage
from tests.support.driven_stage import Watcher, before_commit, built, soil_under
from tests.support.scenes import LAY, Mapping, heave, touchdown

SAME = 1e-8
CASES: dict[str, tuple[int, Mapping]] = {
    "in a plane": (2, {}),
    "in space": (3, {"friction": None}),
    "with friction": (2, {"friction": {"axial": 0.4, "lateral": 0.7}}),
    "with friction in space": (3, {"friction": {"axial": 0.4, "lateral": 0.7}}),
    "with suction": (2, {"suction": {"cap": 300.0, "reach": 0.02}}),
    "at nodes": (2, {"method": "node"}),
    "at nodes in space": (3, {"method": "node"}),
    "with both": (2, {"friction": {"axial": 0.4, "lateral": 0.7}, "suction": {"cap": 300.0, "reach": 0.02}}),
}
QUICK = "in a plane", "at nodes", "with both"  # others have to be compiled for themselves
MARKED = [pytest.param(name, marks=[pytest.mark.verify] * (name not in QUICK)) for name in CASES]
SCHEME, SETTINGS = GeneralizedAlpha.newmark(), NewtonSettings(1e-9, 25, 1e-6, line_search=True)


def scene(case: str, newton: str) -> Mapping:
    dimension, contact = CASES[case]
    mapping = touchdown(LAY, heave(0.8), dimension=dimension, tolerance=1e-11)
    mapping["water"]["current"] = {"profile": [[0.0, 0.2, 0.0], [15.0, 0.6, 0.3 if dimension == 3 else 0.0]]}
    mapping["soil"]["law"] = {"kind": "linear-elastic", "E": 4.0e5, "nu": 0.45}
    mapping["contact"] = {"method": "surface", "smoothing": 1e-3} | contact
    mapping["solver"] |= {"soil": "condensed", "newton": newton}
    return mapping


def states_of(case: str, newton: str) -> list[dict[str, Array]]:
    """Results of each accepted step of the dynamic stage."""
    assembly, states = built(scene(case, newton)), list[dict[str, Array]]()
    contact, line, condensed = soil_under(assembly).contact, assembly.riser.line, soil_under(assembly).condensed
    assert contact is not None
    assert condensed is not None

    def tell(system: System, step: AcceptedStep) -> None:
        state = step.solution.state
        works = [vars(work)[name] for work in step.turned.values() for name in ("dissipated", "external", "by_scheme")]
        states.append(
            {
                "positions": line.positions3(state),
                "rates": np.concatenate([state.v, state.a * step.dt]),
                "force on the riser": contact.force_on_riser(state),
                "settlement": condensed.top.displacement(state),
                "contact": step.solution.forces.end[: line.size],
                "energy": np.array([*vars(step.energy).values(), step.braking, *works]),
            }
        )

    before = State.at_rest(0.0, assembly.size)
    lay, move = assembly.scene.stages
    before = run_stage(assembly, lay, before, Watcher(), Timer.new())
    with before_commit(tell):
        run_stage(assembly, move, before, Watcher(), Timer.new())
    return states


@cache
def by_snes(case: str) -> list[dict[str, Array]]:
    return states_of(case, "snes")


def assert_same(states: list[dict[str, Array]], wanted: list[dict[str, Array]]) -> None:
    assert len(states) == len(wanted) == 8
    for name in wanted[0]:
        size = max(float(np.abs(each[name]).max()) for each in wanted)
        assert size > 0.0
        for got, expected in zip(states, wanted, strict=True):
            assert np.abs(got[name] - expected[name]).max() < SAME * size, name


def forbid(patch: pytest.MonkeyPatch) -> None:
    def refuse(loop: LineSolver) -> bool:
        raise AssertionError("a step was left to Newton's method over the parts")

    patch.setattr(LineSolver, "leave_to_parts", refuse)


@pytest.mark.parametrize("case", MARKED)
def test_the_loop_finds_what_newton_finds(case: str, monkeypatch: pytest.MonkeyPatch) -> None:
    forbid(monkeypatch)
    assert_same(states_of(case, "compiled"), by_snes(case))


def test_steps_that_it_cannot_solve_are_left_to_newton(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each second one, so that both go on from what the other has left."""
    usual, asked = LineSolver._iterate, []

    def iterate(loop: LineSolver, trial: StepTrial, limits: StopLimits) -> tuple[str, list[float]]:
        asked.append(trial.step.t)
        return usual(loop, trial, limits) if len(asked) % 2 else ("left to Newton", [])

    monkeypatch.setattr(LineSolver, "_iterate", iterate)
    assert_same(states_of("in a plane", "compiled"), by_snes("in a plane"))
    assert len(asked) == 8


def test_what_is_watched_follows_the_riser(monkeypatch: pytest.MonkeyPatch) -> None:
    """A narrow range is watched around the pipe and room for few points steps are begun anew several times."""
    begun = list[SoilBorder]()
    usual = SoilBorder._prescribe_anew

    def count(border: SoilBorder) -> None:
        begun.append(border)
        usual(border)

    forbid(monkeypatch)
    monkeypatch.setattr(SoilBorder, "_prescribe_anew", count)
    monkeypatch.setattr("riser_soil.contact.surface_contact.FEW", 4)
    monkeypatch.setattr("riser_soil.contact.near_points.FEW", 2)
    monkeypatch.setattr("riser_soil.contact.surface_contact.AROUND", 0.05)
    states = states_of("in a plane", "compiled")
    assert len(begun) > 12
    assert_same(states, by_snes("in a plane"))


def test_soil_that_moves_beyond_what_is_watched_is_left_to_newton(monkeypatch: pytest.MonkeyPatch) -> None:
    departures, usual = list[LineSolver](), LineSolver.leave_to_parts

    def count(loop: LineSolver) -> bool:
        departures.append(loop)
        return usual(loop)

    monkeypatch.setattr(LineSolver, "leave_to_parts", count)
    monkeypatch.setattr("riser_soil.contact.condensed_contact.SHARE", 1e-4)
    states = states_of("in a plane", "compiled")
    assert len(departures) > 0
    assert_same(states, by_snes("in a plane"))


def at_first_step(case: str) -> tuple[LineSystem, System]:
    """The loop where the dynamic stage begins, in balance under the present soil."""
    assembly = built(scene(case, "compiled"))
    lay, move = assembly.scene.stages
    before = run_stage(assembly, lay, State.at_rest(0.0, assembly.size), Watcher(), Timer.new())
    system = System(assembly.comm, assembly.begin(move), Timer.new())
    solver = solver_of(system, SCHEME.dynamic, SETTINGS)
    assert solver.lines is not None
    guess = np.zeros(assembly.size)
    solver.solve(Step(SCHEME, before, 0.01, 0.01, None, guess))
    return solver.lines.packed, system


@pytest.mark.parametrize("case", MARKED)
def test_the_tangent_is_the_slope_of_the_residual(case: str) -> None:
    """The tangent of riser and border; it is another one without contact's share."""
    riser, system = at_first_step(case)
    (line,), (beside,) = riser.lines, riser.couplings
    assert isinstance(beside, SoilBorder)
    border = beside._border.value
    step, dofs, n = line.step, line.dofs, line.line.size
    x0 = np.concatenate([step.u.ravel(), border.u])

    def residual(x: Array) -> Array:
        step.u.ravel()[:], border.u[:] = x[:n], x[n:]
        riser.evaluate()
        return np.concatenate([dofs.residual.ravel(), border.residual])

    free = np.append(~dofs.fixed.ravel(), np.ones(len(border.u), dtype=bool))
    residual(x0)
    riser.write_tangent()
    workspace, matrix = line.workspace, np.zeros((len(x0), len(x0)))
    for i in range(n):
        for j in range(max(0, i - len(workspace.band)), min(n, i + len(workspace.band) + 1)):
            matrix[i, j] = workspace.ab[i, j - i + len(workspace.band)]
    matrix[:n, n:], matrix[n:, :n], matrix[n:, n:] = border.right, border.below.T, border.corner
    assert np.abs(border.right[free[:n]]).max() > 0.0
    assert np.abs(border.corner - beside._data.value.stiffness).max() > 0.0
    random = np.random.default_rng(2)
    for _ in range(3):
        direction = random.normal(size=len(x0)) * free
        h = 1e-7 / np.abs(direction).max()
        wanted = (residual(x0 + h * direction) - residual(x0 - h * direction)) / (2.0 * h)
        got = matrix @ direction
        for rows in (np.flatnonzero(free[:n]), np.arange(n, len(x0))):
            assert np.linalg.norm((got - wanted)[rows]) < 1e-6 * np.linalg.norm(wanted[rows])
    system.destroy()


def test_elastic_soil_adheres_without_a_limit() -> None:
    """Soil lies beside a seabed of clay, whose strength adhesion is a share of: friction on the soil has kernels."""
    mapping = scene("with friction", "compiled")
    mapping["contact"]["friction"]["adhesion"] = 0.5
    mapping["seabed"] = {"kind": "hysteretic", "law": {"kind": "randolph-quiggin", "su": 2.0e3}}
    assembly = built(mapping)
    system = System(assembly.comm, assembly.begin(assembly.scene.stages[1]), Timer.new())
    assert line_solver(system) is not None
    system.destroy()


@pytest.mark.parametrize(
    ("moved", "outside"),
    [((0.0, 0.0, 0.0), False), ((0.2, 0.0, 0.0), True), ((0.0, -0.2, 0.0), True), ((0.0, 0.0, -0.2), True)],
)
@pytest.mark.parametrize("above", [False, True])
def test_an_element_that_leaves_its_box_is_noticed_unless_it_is_above_the_soil(
    moved: tuple[float, float, float], outside: bool, above: bool
) -> None:
    q = np.array([[[0.0, 0.0, 0.1], [1.0, 0.0, 0.0], [1.0, 0.0, 0.1], [1.0, 0.0, 0.0]]])
    low, high = boxes(Axis(q, np.ones(1), np.full(1, 0.1)), 0.1, 0.1)
    q[:, ::2] += np.array(moved)
    none = np.empty(0, dtype=np.int64)
    watched = Watched(PairsByFacet(none, none, none), low, high, -1.0 if above else 1.0)
    assert leaves(Axis(q, np.ones(1), np.full(1, 0.1)), watched, 0.0) == (outside and not above)
