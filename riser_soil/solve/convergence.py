"""How Newton's method ends: the tests of an iteration, by the norms of the residual so far."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

ITERATING, CONVERGED = "iterating", "converged"
# Failures by PETSc's names; OUTGROWN where the matrix lacks places for the tangent.
NOT_FINITE, NOT_SOLVED, DIVERGED, TOO_MANY, OUTGROWN = (
    "diverged_fnorm_nan",
    "diverged_linear_solve",
    "diverged_dtol",
    "diverged_max_it",
    "outgrown",
)
DIVERGES, DIVERGES_AFTER = 1e6, 4  # times the first norm, after so many iterations at least
STALLED = 0.5  # the norm of a residual that falls by less in each of two iterations stays as it is


class StopLimits(NamedTuple):
    """When to stop, see `NewtonSettings`.

    reuse: an iteration that reduces the residual to less than this share leaves its tangent to the next, but contact's
    part, which is made anew, as contact has corners. most, least: iterations; floor_at_start: whether a residual below
    the floor counts as small before the first one, too.
    """

    tolerance: float
    floor: float
    reuse: float
    most: int
    least: int
    floor_at_start: bool


class Convergence:
    """Convergence of a step: the norms [N] of its residuals so far, and what they say by the limits.

    untouched: the last norm of the residual's share at nodes that nothing touches [N]; most: iterations, which may be
    raised; first: the iteration from which the method is Newton's own.
    """

    def __init__(self, limits: StopLimits) -> None:
        self.limits, self.most, self.first = limits, limits.most, 0
        self.norms: list[float] = []
        self.untouched = math.nan

    def add(self, norm: float, untouched: float | None = None) -> None:
        """Add the norm [N] of a residual, and of its share at nodes that nothing touches: all of it by default."""
        self.norms.append(norm)
        self.untouched = norm if untouched is None else untouched

    @property
    def iterations(self) -> int:
        """Iterations of the step so far; a residual that is not finite at its start is none."""
        return max(len(self.norms) - 1, 0)

    def ending(self, in_play: float, at_round_off: Callable[[], bool], small: bool | None = None) -> str:
        """How the method ends with the last residual, else ITERATING.

        in_play: norm [N] of the forces in play; at_round_off: whether all of the residual may be its
        round-off; small: whether the residual is small by a user's own tolerances, None where the limits decide.
        """
        norm, count, limits = self.norms[-1], len(self.norms) - 1, self.limits
        if not math.isfinite(norm):
            return NOT_FINITE
        if count >= limits.least:
            if small is None:
                below_floor = norm <= limits.floor and (count > 0 or limits.floor_at_start)
                small = below_floor or norm <= limits.tolerance * in_play
            if small or (stalled(self.norms) and at_round_off()):
                return CONVERGED
            if count >= DIVERGES_AFTER and norm > DIVERGES * self.norms[self.first]:
                return DIVERGED
        return ITERATING if count < self.most else TOO_MANY

    @property
    def keeps_tangent(self) -> bool:
        """Whether the next iteration reuses the tangent, but contact's share: the last one has reduced the residual's
        norm to a small share, or that norm where nothing touches.
        """
        if len(self.norms) < 2:
            return False
        before, norm = self.norms[-2:]
        reuse = self.limits.reuse
        return norm < STALLED * before and (norm < reuse * before or self.untouched < reuse * norm)


def stalled(norms: list[float]) -> bool:
    """Whether the last two iterations have hardly reduced the residual's norm. norms: all so far."""
    if len(norms) < 3:
        return False
    earlier, before, norm = norms[-3:]
    return norm > STALLED * before and before > STALLED * earlier
