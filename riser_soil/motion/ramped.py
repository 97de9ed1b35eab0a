"""Smooth ramp on a prescribed motion."""

from __future__ import annotations

from typing import TypeVar

from riser_soil.core.arrays import Array
from riser_soil.core.smooth_step import smooth_step

Value = TypeVar("Value", float, Array)


def ramped(t: float, ramp: float, x: Value, v: Value, a: Value) -> tuple[Value, Value, Value]:
    """The product of x and a smooth step of t/ramp, with its first two derivatives in t; v, a: those of x."""
    if t >= ramp:
        return x, v, a
    r, r1, r2 = smooth_step(t, ramp)
    return r * x, r1 * x + r * v, r2 * x + 2.0 * r1 * v + r * a
