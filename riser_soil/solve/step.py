"""A step for Newton's method, its solution, and how it fails."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State
from riser_soil.solve.time_scheme import Scheme, Static


class NotConvergedError(Exception):
    """A step that Newton could not solve; its text says why and where the residual sits."""


class UnstableError(NotConvergedError):
    """An unstable equilibrium, from which the riser would buckle or swing away: `solution`."""

    def __init__(self, text: str, solution: Solution) -> None:
        super().__init__(text)
        self.solution = solution


def failure_text(why: str, norms: list[float], place: str) -> str:
    """Why a step failed, the last of its residual's norms [N], and where the residual sits."""
    last = ", ".join(f"{norm:.3g}" for norm in norms[-3:])
    return f"{why} after {max(len(norms) - 1, 0)} iterations (last residual norms {last} N); {place}"


@dataclass(frozen=True, eq=False)
class Step:
    """One step to solve: from the accepted state `before` to time t."""

    scheme: Scheme
    before: State
    t: float
    dt: float
    start: Forces | None
    guess: Array

    @classmethod
    def static(cls, before: State, seconds: float = math.inf) -> Step:
        """A step to equilibrium from an accepted state; seconds: that pass in it, in which rates flow."""
        return cls(Static(seconds), before, before.t, 0.0, None, np.zeros(before.u.size))


@dataclass(frozen=True, eq=False)
class Solution:
    """A converged step: the state at its end, the forces in balance by group, the residual norms [N];
    iterations_before: of solutions of the step on other geometries of the soil.
    """

    state: State
    forces: Forces
    norms: list[float] = field(default_factory=list)
    iterations_before: int = 0

    @property
    def iterations(self) -> int:
        return self.iterations_before + len(self.norms) - 1
