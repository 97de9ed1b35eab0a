"""Line search at the critical point of the energy: closed forms, and how often it looks."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, Model, State, Weights
from riser_soil.core.system import System, Timer
from riser_soil.solve.line_search import step_length
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.step import NotConvergedError, Step
from riser_soil.solve.time_scheme import Static
from tests.support.toy_chain import Chain, Springs


def counted(slope: Callable[[float], float]) -> tuple[Callable[[float], float], list[float]]:
    looked: list[float] = []

    def look(part: float) -> float:
        looked.append(part)
        return slope(part)

    return look, looked


def linear(end: float, part: float) -> float:
    return -1.0 + part * (1.0 + end)


def test_a_full_step_stays_where_it_ends_near_the_least_energy() -> None:
    for end in (-0.9, 0.0, 0.49):
        slope, looked = counted(partial(linear, end))
        assert step_length(-1.0, slope) == 1.0
        assert looked == [1.0]


@pytest.mark.parametrize("stiffer", [4.0, 1e3, 1e9])
def test_a_step_into_something_stiff_ends_where_the_slope_is_nearly_zero(stiffer: float) -> None:
    """Free up to 0.1 of the step, then on a spring: zero at 0.1 + 0.9/stiffer."""
    slope, looked = counted(lambda a: -1.0 + stiffer * max(0.0, a - 0.1))
    part = step_length(-1.0, slope)
    assert len(looked) <= 11
    assert part < 1.0
    if stiffer < 1e4:
        assert abs(slope(part)) <= 0.25
    else:
        assert part < 0.2


def test_a_slope_half_as_steep_as_at_the_start_is_too_far() -> None:
    assert step_length(-1.0, partial(linear, 0.51)) == pytest.approx(1.0 / 1.51)


@pytest.mark.parametrize(("ratio", "looks"), [(0.24, 2), (-0.24, 2), (0.26, 3), (-0.26, 3)])
def test_a_quarter_of_the_slope_at_the_start_is_near_enough(ratio: float, looks: int) -> None:
    """The first place looked at is the middle, as far from zero at both ends; a straight line leads on from there."""
    slope, looked = counted(lambda a: float(np.interp(a, (0.0, 0.5, 1.0), (-1.0, ratio, 1.0))))
    step_length(-1.0, slope)
    assert len(looked) == looks


def test_it_looks_ten_times_within_a_step_at_most() -> None:
    slope, looked = counted(lambda a: -1.0 if a < 0.3 else 1.0)
    assert step_length(-1.0, slope) == pytest.approx(0.3, abs=0.1)
    assert len(looked) == 11


def test_a_step_that_leads_to_nowhere_is_shortened() -> None:
    slope, _ = counted(lambda a: math.inf if a > 0.3 else -1.0 + 5.0 * a)
    part = step_length(-1.0, slope)
    assert 0.0 < part <= 0.3


def test_a_step_that_climbs_is_taken_backwards() -> None:
    """The step goes back to the least energy there, or all of it where that lies further away."""
    assert step_length(1.0, lambda a: 1.0 + 10.0 * a) == pytest.approx(-0.1, abs=0.025)
    assert step_length(1.0, lambda a: 1.0 + 0.2 * a) == -1.0


LIMIT, YIELDS_AT = 10.0, 0.1  # N, m


class YieldingSprings(Springs):
    """Forces LIMIT tanh(e/YIELDS_AT) in the stretches e, and weight: far from rest they hardly stiffen."""

    def residual(self, state: State, forces: Forces) -> None:
        f = LIMIT * np.tanh(self._stretch(state) / YIELDS_AT)
        forces.force[:-1] -= f
        forces.force[1:] += f
        forces.force += self.weight

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        far = np.clip(self._stretch(state) / YIELDS_AT, -300.0, 300.0)
        k = LIMIT / YIELDS_AT / np.cosh(far) ** 2
        values["chain"] += weights.force * k[:, None, None] * np.array([[1.0, -1.0], [-1.0, 1.0]])


@pytest.mark.parametrize("line_search", [True, False])
def test_newton_comes_back_from_beyond_the_limit_with_it_alone(line_search: bool) -> None:
    """Springs squeezed to 2.5 times what they yield at come to bear what stands on them: 3, 2 and 1 N."""
    chain = Chain(np.arange(4.0), prescribed=True)
    springs = YieldingSprings(chain, 1.0 + 2.5 * YIELDS_AT, 0.0, weight=1.0)
    system = System(MPI.COMM_SELF, Model([chain], [springs]), Timer.new())
    newton, z = Newton(system, NewtonSettings(1e-10, 25, 1e-12, line_search=line_search)), np.zeros(4)
    step = Step(Static(), State(0.0, z, z.copy(), z.copy()), 1.0, 1.0, None, z.copy())
    if not line_search:
        with pytest.raises(NotConvergedError):
            newton.solve(step)
        return
    stretch = np.diff(chain.heights(newton.solve(step).state)) - springs.rest
    assert LIMIT * np.tanh(stretch / YIELDS_AT) == pytest.approx([-3.0, -2.0, -1.0], rel=1e-8)


def test_forces_of_a_full_step_are_evaluated_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """The line search evaluates them, which tries it, and not again by Newton's method: a linear chain takes one step
    and two.
    """
    chain = Chain(np.arange(4.0), prescribed=True)
    system, z = System(MPI.COMM_SELF, Model([chain], [Springs(chain, 1.0, 20.0, weight=2.0)]), Timer.new()), np.zeros(4)
    evaluated, forces = list[State](), system.forces

    def counted(state: State) -> Forces:
        evaluated.append(state)
        return forces(state)

    monkeypatch.setattr(system, "forces", counted)
    newton = Newton(system, NewtonSettings(1e-10, 20, 1e-12, line_search=True))
    solution = newton.solve(Step(Static(), State(0.0, z, z.copy(), z.copy()), 1.0, 1.0, None, z.copy()))
    assert solution.iterations == 1
    assert len(evaluated) == 2
    newton.destroy()
    system.destroy()
