"""Newton's method at the round-off of its residual."""

from __future__ import annotations

import numpy as np
import pytest
from mpi4py import MPI

from benchmarks.error_bars.scenes import CLAY, pressed
from riser_soil.core.arrays import Array
from riser_soil.core.part import Model, State, Weights
from riser_soil.core.system import System, Timer
from riser_soil.solve.convergence import stalled
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.step import NotConvergedError, Solution, Step
from riser_soil.solve.time_scheme import Static
from riser_soil.solve.time_stepper import AcceptedStep
from tests.support.driven_stage import built, take
from tests.support.scenes import turned_bar
from tests.support.toy_chain import Chain, Springs


@pytest.mark.parametrize(
    ("norms", "expected"),
    [
        ([1.0, 1e-8, 1.1e-8, 0.9e-8], True),
        ([1.0, 1e-2, 1e-3, 1e-6], False),  # it falls
        ([1.0, 1e-8, 1.1e-8], False),  # it stays once: it may have been at its last iteration before
        ([0.0, 1.0, 1.0], True),
    ],
)
def test_norms_that_stay_in_two_iterations(norms: list[float], expected: bool) -> None:
    assert stalled(norms) == expected


K, HIGH = 1e6, 1e6  # N/m, m: an eps of the height is 1e-4 N in a spring, where 4e-8 N are allowed


class WrongSprings(Springs):
    """Springs whose tangent is thirty times as stiff as their forces: Newton's method creeps by a thirtieth an
    iteration.
    """

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        super().tangent(state, weights, values)
        values["chain"] *= 30.0


def hung(springs: type[Springs]) -> Solution:
    """A chain of masses of 1 N that hangs from its first one, far above zero."""
    chain = Chain(HIGH + np.arange(4.0), prescribed=True)
    system = System(MPI.COMM_SELF, Model([chain], [springs(chain, 1.0, K, weight=1.0)]), Timer.new())
    newton, z = Newton(system, NewtonSettings(1e-8, 25, 1e-12)), np.zeros(chain.size)
    try:
        return newton.solve(Step(Static(), State(0.0, z, z.copy(), z.copy()), 1.0, 1.0, None, z.copy()))
    finally:
        newton.destroy()
        system.destroy()


def test_a_step_ends_where_heights_are_known_no_better() -> None:
    solution = hung(Springs)
    assert solution.iterations <= 4
    assert 1e-6 < solution.norms[-1] < 1e-3
    assert solution.state.u == pytest.approx(-np.array([0.0, 3.0, 5.0, 6.0]) / K, abs=1e-9)


def test_a_residual_that_stays_for_a_wrong_tangent_is_no_round_off() -> None:
    with pytest.raises(NotConvergedError, match="diverged_max_it"):
        hung(WrongSprings)


def test_a_bar_that_has_turned_many_times_comes_to_rest_without_a_cut_step() -> None:
    """The bar's angle of 126 rad is known to 1.4e-14 rad, and 6 EI/h^2 of that is 1e-8 N at either end of each element:
    more than counts as none when nothing moves any more.
    """
    assembly, watched = built(turned_bar(20)), list[AcceptedStep]()
    turn, rest = assembly.scene.stages
    take(assembly, rest, take(assembly, turn), watch=lambda _, step: watched.append(step))
    assert len(watched) == 100
    assert assembly.riser.line.x[-1] == pytest.approx([1.0, 0.0], abs=1e-9)
    assert watched[-1].solution.norms[-1] > assembly.scales.force_floor


def test_a_stiff_pipe_on_clay_ends_at_its_round_off_without_a_cut_step() -> None:
    """Where line searches shorten steps. 12 EI/h^3 of elements of 3 mm is 4e15 N/m: the round-off of places of 0.1 m
    leaves more than the 1e-4 N that 1e-14 EA allows.
    """
    scene = pressed(CLAY, 4, 0.01)
    scene["riser"]["segments"][0]["elements"] = 96
    assembly, watched = built(scene), list[AcceptedStep]()
    take(assembly, assembly.scene.stages[0], watch=lambda _, step: watched.append(step))
    assert not any(step.cuts for step in watched)
    assert max(step.solution.norms[-1] for step in watched) > 1e-3
