"""The base of seabed laws: what a law does at one point is compiled, and chosen by the type of its kernel data.

A law has kernels of `answer` and `may_act`, and all else goes through them. Of data without kernels numba says that
there is no implementation for their type.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
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


class CompiledLaw:
    """Base of all `NormalLaw`s: what a law does is in the kernels for its kernel data."""

    kernel_data: Any
    gradual: ClassVar[bool] = False

    def active(self, penetration: Array, history: Array) -> BoolArray:
        z, before = _points(penetration, history)
        out = np.empty(z.size, dtype=np.bool_)
        _whether_each(self.kernel_data, z, before, out)
        return out.reshape(penetration.shape)

    def update(self, penetration: Array, history: Array) -> SeabedResponse:
        z, before = _points(penetration, history)
        found, after = np.empty((3, z.size)), np.empty(before.shape)
        _answer_each(self.kernel_data, z, before, found, after)
        force, slope, stored = found.reshape(3, *penetration.shape)
        return SeabedResponse(force, slope, after.reshape(history.shape), stored)


def _points(penetration: Array, history: Array) -> tuple[Array, Array]:
    """Penetrations (n,) and histories (n, nh) of one kind of array, for which loops are compiled once."""
    z = np.ascontiguousarray(penetration, dtype=float).reshape(-1)
    return z, np.ascontiguousarray(history, dtype=float).reshape(z.size, history.shape[-1])


@njit
def _answer_each(law: Any, penetration: Array, history: Array, out: Array, after: Array) -> None:
    """Writes force, slope and energy stored to out (3, n)."""
    for i in range(penetration.size):
        out[0, i], out[1, i], out[2, i] = answer(law, penetration[i], history[i], after[i])


@njit
def _whether_each(law: Any, penetration: Array, history: Array, out: BoolArray) -> None:
    for i in range(penetration.size):
        out[i] = may_act(law, penetration[i], history[i])
