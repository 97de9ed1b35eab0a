"""The course of figures from step to step, compiled: peaks, and how sharply they turn."""

from __future__ import annotations

import math
from typing import NamedTuple

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.compiled import njit

# Of the largest second difference around an extreme, from the calibration in `tests/verification/test_indicators.py`.
SHARE = 0.3
AFTER = 2  # steps after a peak that still belong to it


class Course(NamedTuple):
    """What is known of n figures' course. Arrays (2, n) are of the least values, negative, and of the largest.

    values, slope, past (n,): of the last step: the figures, their rates and |D|. times (2,): its end and its size [s].
    extreme, error, steps (2, n): the extremes yet, their own errors, and the longest step [s] around them.
    peak, leads, around, longest, since (2, n): the latest peak, or the value while it rises; whether it is the extreme;
    the largest |D| and the longest step [s] around it; updates since.
    rival, rival_error, rival_steps (2, n): of the peaks yet, the one that goes farthest with its error, and the longest
    step [s] around it.
    """

    values: Array
    slope: Array
    past: Array
    times: Array
    extreme: Array
    error: Array
    steps: Array
    peak: Array
    leads: BoolArray
    around: Array
    longest: Array
    since: Array
    rival: Array
    rival_error: Array
    rival_steps: Array


@njit
def follow(course: Course, times: Array, rows: Array) -> None:
    """Take in what steps end with, in turn: times (nt,) [s] and figures (nt, n)."""
    for row in range(times.size):
        _follow(course, times[row], rows[row])


@njit
def _follow(course: Course, t: float, after: Array) -> None:
    """Take in the figures (n,) after one step."""
    n = course.values.size
    before, last_dt = course.times[0], course.times[1]
    dt = t - before
    longer = last_dt if last_dt > dt else dt
    for i in range(n):
        slope = (after[i] - course.values[i]) / dt
        bend = 2.0 * longer**2 / (dt + last_dt) * abs(slope - course.slope[i])
        if not bend >= 0.0:
            bend = 0.0
        for row in range(2):
            sign = 2.0 * row - 1.0
            _follow_peak(course, row, i, sign * after[i], sign * course.values[i], bend, longer)
        course.values[i], course.slope[i], course.past[i] = after[i], slope, bend
    course.times[0], course.times[1] = t, dt


@njit
def _follow_peak(at: Course, row: int, i: int, value: float, last: float, bend: float, step: float) -> None:
    """A figure's largest value, or its least one with the other sign, after a step; bend: |D|."""
    k = row, i
    if at.since[k] < AFTER:  # a step that still belongs to the peak
        at.around[k] = max(at.around[k], bend)
        if not step <= at.longest[k] and not math.isnan(step):
            at.longest[k] = step
    _keep(at, row, i)
    falls, error = value <= last, SHARE * at.around[k]
    if (falls or at.since[k] > 0.0) and at.peak[k] + error > at.rival[k] + at.rival_error[k]:
        at.rival[k], at.rival_error[k], at.rival_steps[k] = at.peak[k], error, at.longest[k]
    at.since[k] += 1.0
    if not falls and not math.isnan(value):
        at.leads[k] = value > at.extreme[k]
        at.peak[k], at.around[k], at.longest[k], at.since[k] = value, max(at.past[i], bend), step, 0.0
    if value > at.extreme[k]:
        at.extreme[k] = value
    _keep(at, row, i)


@njit
def _keep(at: Course, row: int, i: int) -> None:
    """Store the error and the steps of the extreme, where it is the leading one."""
    k = row, i
    if at.leads[k]:
        at.error[k], at.steps[k] = SHARE * at.around[k], at.longest[k]
