"""The base of seabed laws: what a law does at one point is compiled, and chosen by the type of its kernel data.

A law has kernels of `answer` and `may_act`, and all else goes through them. For data without kernels numba says that
there is no implementation for their type.
"""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.bound import Bound, Packed
from riser_soil.core.by_type import by_type
from riser_soil.core.compiled import njit
from riser_soil.seabed.law import SeabedResponse


@by_type
def answer(law: Any, penetration: float, history: Array, after: Array) -> Any:
    """Force [N/m], slope [N/m2] and energy stored [N] at the end of a step, as in `SeabedResponse`.

    penetration [m]: at its end. history (nh,): at its beginning; that at its end is written to `after` (nh,).
    """


@by_type
def may_act(law: Any, penetration: float, history: Array) -> Any:
    """Whether there may be a force, or stored energy, at the end of such a step."""


class LawPoints(NamedTuple):
    """Points (n,) at which a law is evaluated: penetration [m] at the end of a step, history (n, nh) at its beginning.
    The answer: whether the law may act; force, slope and energy stored as in `SeabedResponse`, 0 where it may not; the
    history (n, nh) at the end of the step.
    """

    penetration: Array
    history: Array
    acts: BoolArray
    force: Array
    slope: Array
    stored: Array
    after: Array


def law_points(penetration: Array, history: Array) -> LawPoints:
    """Points with workspace for the answer."""
    force, slope, stored = np.zeros((3, penetration.size))
    acts = np.zeros(penetration.size, dtype=np.bool_)
    return LawPoints(penetration, history, acts, force, slope, stored, np.zeros(history.shape))


@njit
def answer_acting(law: Any, points: LawPoints) -> None:
    """Write a law's answer, by its kernel data, at the points where it may act."""
    z, history = points.penetration, points.history
    for p in range(z.size):
        points.force[p], points.slope[p], points.stored[p] = 0.0, 0.0, 0.0
        points.acts[p] = may_act(law, z[p], history[p])
        if points.acts[p]:
            points.force[p], points.slope[p], points.stored[p] = answer(law, z[p], history[p], points.after[p])


@njit
def keep_history(law: Any, points: LawPoints) -> None:
    """Write the history at the end of the step, of points where the law does not act, too, in the place of that at its
    beginning.
    """
    for p in range(points.penetration.size):
        if not points.acts[p]:
            answer(law, points.penetration[p], points.history[p], points.after[p])
        for k in range(points.history.shape[1]):
            points.history[p, k] = points.after[p, k]


class CompiledLaw:
    """Base of all `NormalLaw`s: what a law does is in the kernels for its kernel data."""

    kernel_data: Any
    gradual: ClassVar[bool] = False

    def update(self, penetration: Array, history: Array) -> SeabedResponse:
        points = self.answers(penetration, history)
        force, slope, stored = (each.reshape(penetration.shape) for each in (points.force, points.slope, points.stored))
        return SeabedResponse(force, slope, points.after.reshape(history.shape), stored)

    def answers(self, penetration: Array, history: Array) -> LawPoints:
        """The law's answer at points of any shape, in a row (n,)."""
        z = np.array(penetration, dtype=float).reshape(-1)
        points = law_points(z, np.array(history, dtype=float, order="C").reshape(z.size, history.shape[-1]))
        law, packed = Packed(self.kernel_data), Packed(points)
        Bound(answer_acting, law, packed)()
        if history.shape[-1] > 0:
            Bound(keep_history, law, packed)()
        return points
