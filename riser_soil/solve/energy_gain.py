"""Energy gain: what the steps of a dynamic stage make out of nothing, and the steps that are rejected for it.

A step that creates much energy at once is a root of the equations far from the motion that it continues, or too long.
Steps that follow a line through buckling or a snap may each create a little and never give it back: in the end the
line is torn by what the scheme has put in. So their sum counts, too, beside what has been turned over. Of a step there
counts what may have gone into motion, at most the kinetic energy: what a slow pipe seems to gain that is pressed into
soil in long steps is the error of its mean force, which moves nothing.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.part import Energy
from riser_soil.core.saved_state import Saved

LARGEST = 0.2  # of the energy in motion: what a step may make out of nothing
SUM, SMALL = 0.25, 0.025  # of that share: of what was turned over, for the sum of steps; for a step that adds to it


class EnergyGain:
    """The sum of what steps have made out of nothing since it was last balanced [J]; start: energy at the start.

    largest: share of the energy in motion that a step may make. turned: the most that was stored, or put in or
    dissipated in all [J].
    """

    def __init__(self, start: Energy, largest: float = LARGEST) -> None:
        self._largest = largest
        self._sum = self._work = self._dissipated = 0.0
        self._turned = max(start.kinetic, start.strain)

    def rejection(self, was: Energy, now: Energy, dissipated: float, work: float, negligible: float) -> str:
        """Why a step from one energy to another that makes as much as it does is not accepted; "" for a good one."""
        appeared = _appeared(was, now, dissipated, work)
        in_motion = was.kinetic + was.strain + max(0.0, was.potential - now.potential) + abs(work)
        if appeared > self._largest * in_motion + negligible:
            return f"the step's solution makes {appeared:.3g} J out of nothing, beside {in_motion:.3g} J in motion"
        adds, turned = SMALL * self._largest * in_motion, max(self._turned, in_motion)
        moving = _into_motion(was, now, appeared)
        made = self._sum + moving
        if moving > adds + negligible and made > SUM * self._largest * turned:
            return f"the steps' solutions make {made:.3g} J out of nothing, beside {turned:.3g} J exchanged"
        return ""

    def accept(self, was: Energy, now: Energy, dissipated: float, work: float) -> None:
        """Count an accepted step."""
        self._sum = max(0.0, self._sum + _into_motion(was, now, _appeared(was, now, dissipated, work)))
        self._work += work
        self._dissipated += dissipated
        self._turned = max(self._turned, now.kinetic, now.strain, abs(self._dissipated), abs(self._work))

    def state(self) -> Saved:
        return {"sums": np.array([self._sum, self._work, self._dissipated, self._turned])}

    def restore(self, saved: Saved) -> None:
        self._sum, self._work, self._dissipated, self._turned = map(float, saved["sums"])


def _appeared(was: Energy, now: Energy, dissipated: float, work: float) -> float:
    return now.total - was.total + dissipated - work


def _into_motion(was: Energy, now: Energy, appeared: float) -> float:
    return min(appeared, was.kinetic + now.kinetic)
