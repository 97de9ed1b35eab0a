"""Newton's method in a static step: its linear start, and a matrix that grows with what comes to touch."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Forces, MatrixBlock, Model, State, Traits, Weights
from riser_soil.core.roles import Adaptive
from riser_soil.core.system import System, Timer
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.residual_norm import ResidualNorm
from riser_soil.solve.step import Solution, Step
from riser_soil.solve.time_scheme import Static
from tests.support.toy_chain import Chain, Floor, Springs

MOVED = 0.3  # m


class MovedChain(Chain):
    """A chain whose first mass is moved."""

    def prescribe(self, t: float, u: Array, v: Array, a: Array) -> None:
        super().prescribe(t, u, v, a)
        u[0] = MOVED * t


class GrowingFloor(Floor):
    """Contact whose pattern has places for those that were found to touch, and for no others."""

    traits = Traits("E", symmetric=True, roles=(Adaptive,))
    outgrown = False

    def __init__(self, chain: Chain, stiffness: float) -> None:
        super().__init__(chain, stiffness)
        self.held: IntArray = np.empty(0, dtype=np.int64)
        self._missed: IntArray = self.held
        self.grown: list[int] = []

    def blocks(self) -> dict[str, MatrixBlock]:
        rows = (self.chain.offset + self.held)[:, None]
        return {"floor": MatrixBlock(rows, rows)}

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        touching = np.flatnonzero(self.chain.heights(state) < 0.0)
        self._missed = np.setdiff1d(touching, self.held).astype(np.int64)
        self.outgrown = bool(len(self._missed))
        values["floor"][np.isin(self.held, touching)] += self.stiffness

    def rebuild(self, state: State) -> None:
        self.held, self.outgrown = np.union1d(self.held, self._missed).astype(np.int64), False
        self.grown.append(len(self.held))


def solved(chain: Chain, parts: list[Springs | Floor], guess: Array | None = None, **settings: Any) -> Solution:
    system = System(MPI.COMM_SELF, Model([chain], parts), Timer.new())
    newton, z = Newton(system, NewtonSettings(1e-8, 25, 1e-12, **settings)), np.zeros(chain.size)
    guess = z.copy() if guess is None else guess
    guess[0] = MOVED * chain.prescribed[0]
    try:
        return newton.solve(Step(Static(), State(0.0, z, z.copy(), z.copy()), 1.0, 1.0, None, guess))
    finally:
        newton.destroy()
        system.destroy()


def test_linear_response_is_the_whole_answer_of_a_linear_system() -> None:
    """A chain of springs of 1 m and 100 N/m follows its first mass, and hangs by its weight of 1 N a mass below it."""
    chain = MovedChain(np.arange(4.0), prescribed=True)
    solution = solved(chain, [Springs(chain, 1.0, 100.0, weight=1.0)], linear_start=True)
    assert solution.iterations == 1
    assert solution.norms[1] < 1e-8 * solution.norms[0]
    assert solution.state.u == pytest.approx(MOVED - np.array([0.0, 0.03, 0.05, 0.06]), abs=1e-9)


def test_a_moved_end_does_not_spoil_the_first_iteration() -> None:
    """Springs that stiffen: moved alone, the first mass stretches one of them by all of its way."""
    states = {}
    for start in (True, False):
        chain = MovedChain(np.arange(12.0), prescribed=True)
        states[start] = solved(chain, [Springs(chain, 1.0, 100.0, cubic=1e6, weight=1e-3)], linear_start=start)
    assert states[True].state.u == pytest.approx(states[False].state.u, rel=1e-9)
    assert states[True].iterations < states[False].iterations - 3


def test_a_guess_that_flows_on_is_taken_and_one_far_off_is_not() -> None:
    """Springs that stiffen: from beside its end a step takes fewer iterations, and from far off none more."""

    def solution_from(guess: Array | None) -> Solution:
        chain = MovedChain(np.arange(12.0), prescribed=True)
        return solved(chain, [Springs(chain, 1.0, 100.0, cubic=1e4, weight=1.0)], guess, linear_start=True)

    linear = solution_from(None)
    near, far = (solution_from(linear.state.u + by * np.arange(12.0)) for by in (1e-6, 1.0))
    assert near.iterations < linear.iterations
    assert far.iterations == linear.iterations
    for solution in (near, far):
        assert solution.state.u == pytest.approx(linear.state.u, rel=1e-7)


def test_what_comes_to_touch_within_a_step_gets_its_place_at_once() -> None:
    """Masses of 1 N hang by springs and come down on a floor, as with places for all."""

    def on(kind: type[Floor]) -> tuple[Floor, Solution]:
        chain = Chain(np.array([0.001, 0.011, 0.021, 0.061]), prescribed=True)
        floor = kind(chain, 1e4)
        return floor, solved(chain, [Springs(chain, 0.01, 100.0, cubic=1e3, weight=1.0), floor])

    (growing, landed), (_, whole) = on(GrowingFloor), on(Floor)
    assert isinstance(growing, GrowingFloor)
    assert growing.grown == [3]
    assert landed.state.u == pytest.approx(whole.state.u, rel=1e-9)
    assert landed.iterations == whole.iterations
    assert landed.norms == pytest.approx(whole.norms, rel=1e-6, abs=1e-9)


def test_forces_in_play_are_the_largest_of_reactions_inertia_and_contact() -> None:
    """The first of four masses is held; what acts on the others is no reaction."""
    chain = Chain(np.arange(4.0), prescribed=True)
    system = System(MPI.COMM_SELF, Model([chain], [Springs(chain, 1.0, 100.0)]), Timer.new())
    try:
        norm = ResidualNorm(system)
        reaction, inertia, contact = (np.array(each) for each in ([3.0, 0, 0, 9.0], [0, 0, 0, 4.0], [0, 5.0, 0, 12.0]))
        none = np.zeros(4)
        assert norm.in_play(Forces(none, reaction, none)) == pytest.approx(3.0)
        assert norm.in_play(Forces(inertia, reaction, none)) == pytest.approx(4.0)
        assert norm.in_play(Forces(inertia, reaction, contact)) == pytest.approx(13.0)
    finally:
        system.destroy()
