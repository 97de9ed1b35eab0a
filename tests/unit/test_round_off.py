"""Newton's method at the round-off of its residual."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.error_bars.scenes import CLAY, pressed
from riser_soil.solve.round_off import RoundOff
from riser_soil.solve.time_stepper import AcceptedStep
from tests.support.driven_stage import built, take

X = np.array([1e-3, 2e-3])  # m


def reached(moves: list[float], norms: list[float], size: float = 1.0) -> list[bool]:
    """Before and after each iteration, whose step of the first unknown is so long [m], of a line of this size [m]."""
    followed = RoundOff(list, size)
    told = [followed.reached(X, norms[:1])]
    for n, move in enumerate(moves, start=2):
        followed.follow(np.array([move, 0.0]))
        told.append(followed.reached(X, norms[:n]))
    return told


def test_a_residual_that_stays_while_nothing_moves_is_round_off() -> None:
    assert reached([1e-4, 1e-15, 1e-15], [1.0, 1e-8, 1.1e-8, 0.9e-8]) == [False, False, False, True]


@pytest.mark.parametrize(
    ("moves", "norms"),
    [
        ([1e-4, 1e-12, 1e-12], [1.0, 1e-8, 1.1e-8, 0.9e-8]),  # it still moves by 1e-9 of the step's increments
        ([1e-4, -1e-4, 1e-4], [1.0, 0.9, 1.0, 0.9]),  # to and fro between two places
        ([1e-4, 1e-15, 1e-15], [1.0, 1e-2, 1e-3, 1e-6]),  # the residual falls
        ([1e-4, 1e-15], [1.0, 1e-8, 1.1e-8]),  # it stays once: it may have been at its last iteration before
    ],
)
def test_what_is_not_at_its_round_off_goes_on(moves: list[float], norms: list[float]) -> None:
    assert not any(reached(moves, norms))


def test_a_line_at_rest_moves_by_the_round_off_of_its_places() -> None:
    """Beside increments of 1e-3 m in a step; in one of none at all that is all there is."""
    still, norms = [1e-12, 1e-12, 1e-12], [1e-3, 1e-3, 1e-3, 1e-3]
    assert not any(reached(still, norms, size=10.0))
    assert reached(still, norms, size=1e4) == [False, False, True, True]


def test_a_residual_that_begins_at_nothing_goes_on() -> None:
    """As that of a linear start where all is prescribed and nothing touches yet."""
    assert not any(reached([1e-4, 1e-4], [0.0, 1.0, 1.0]))


def test_a_new_step_begins_anew() -> None:
    followed, still = RoundOff(list, 1.0), [1.0, 1.0, 1.0]
    followed.follow(np.zeros(2))
    assert followed.reached(X, still)
    followed.begin()
    assert not followed.reached(X, still)


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
