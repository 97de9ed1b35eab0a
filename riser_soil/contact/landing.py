"""Contact predictor: first guess of a step in which the riser touches down."""

from __future__ import annotations

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.core.part import State


def landing_predictor(guess: State, heights: IntArray, present: Array, guessed: Array, start: float) -> Array:
    """The guess's increments, raised where a node would sink below its present depth.

    The motion of the last step carries landing nodes deep into the ground, where the law is far stiffer than at the
    depth at which they come to rest. They start instead from half the law's rounded corner.

    heights (nn,): local numbers of the nodes' vertical dofs. present, guessed (nn,): their gaps less that at which the
    force begins, `start` [m].
    """
    increments = guess.u.copy()
    _lift_each(increments, heights, present, guessed, start)
    return increments


@njit
def _lift_each(increments: Array, heights: IntArray, present: Array, guessed: Array, start: float) -> None:
    for n in range(heights.size):
        increments[heights[n]] += lift(present[n], guessed[n], start)


@njit
def lift(present: float, guessed: float, start: float) -> float:
    """How far a node is raised; arguments as in `landing_predictor`."""
    return max(min(present, -0.5 * start) - guessed, 0.0)
