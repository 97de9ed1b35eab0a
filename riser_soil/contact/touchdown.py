"""Touchdown points from the contact forces along the riser.

Where the contact force ends depends on how soft the ground is: on a bed of stiffness k the force near the touchdown
point is spread over some layer length l = (4 EI/k)^(1/4), and ends about l beyond the place where the riser would leave
a rigid floor. There, the force per length is f0, that of the riser at rest, up to the touchdown point, plus a
concentrated force R at that point (a straight pipe has no moment, so the shear force jumps). The touchdown point is
defined as the end d of that rigid contact which has the resultant and the moment of the computed forces: with tau = S -
d, S the line's end,

    E0 = int (f - f0) ds = R - f0 tau,    E1 = int (f - f0)(S - s) ds = R tau - f0 tau²/2,
    R² = E0² + 2 f0 E1,                   tau = (R - E0)/f0.

By statics neither d nor R depends on how the force is spread. On a bed of springs under the tension H and small slopes,
d lies sqrt(EI/H - H/k) before the place where the catenary of the hanging part touches down, sqrt(EI/H) on a rigid
floor: an error of the order of 1/k, whereas the contact's end moves with the power -1/4 of k. On beds softer than H²/EI
there is no such R, and d is that place itself. With quadrature along the line the sums are as exact as the balance of
forces.

The extent of the layer follows from the forces too, counted from the free side: with m(x) the largest force up to x,
and x from the end of the contact,

    B(x) = int m/m(x) dx,   A(x) = 4 int m/m(x) (1 - m/m(x)) dx,   depth = B/(DEEP A).

A is the length in which the force rises to its peak, 0.45 l on stiff springs, B the length since the force began. Up to
a depth of 3/4 the force counts fully in E0 and E1, beyond 1 not at all; f0 is a mean over the deep part. The depth is
at least 3/4 where half of the stretch's force acts on the free side: of two touchdown points, each has its half of the
contact. All weights and means are continuous in the forces, and so is d: a station begins to touch with zero force.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray, as_list

DEEP = 96.0  # rises of the force within a depth of 1: 43 l on stiff springs, of which f0 is read from the far half
LEAST = 60.0  # stations within a depth of 1 in a layer that the mesh doesn't resolve
AT_ONCE = 1 << 13  # forces whose arrays stay in a processor's cache
FADING = 3  # times that the depth is squared for the weight of stations in f0: 1e-8 at the peak


class PointsAlong(NamedTuple):
    """Points along the riser from its start: their growing arc length, and share of its length by quadrature (n,) [m].
    """

    arc: Array
    share: Array


class ContactInterval(NamedTuple):
    """Contact from one touchdown point to the next: their arc lengths [m]. from_start, to_end: whether it begins with
    the line's start, or ends with its end, where the line does not come down but lies.
    """

    start: float
    end: float
    from_start: bool
    to_end: bool


class Stretches(NamedTuple):
    """Stretches that touch, each (k,): the state, counted along many, and the first and last points."""

    row: IntArray
    first: IntArray
    last: IntArray


def touchdown_arc(intervals: Sequence[ContactInterval]) -> float:
    """Arc length [m] of the touchdown point towards the riser's end, by its contact from the start on; nan without any.

    Where the riser's end itself touches, but not all of the riser, the last interval begins with the touchdown point.
    """
    if not intervals:
        return float("nan")
    last = intervals[-1]
    return last.start if last.to_end and not last.from_start else last.end


def touchdown_points(intervals: Sequence[ContactInterval]) -> int:
    """Number of places where the riser comes down or leaves the ground; its ends do not count."""
    return sum((not each.from_start) + (not each.to_end) for each in intervals)


def merged(intervals: Sequence[ContactInterval], near: float) -> list[ContactInterval]:
    """Contact with several grounds by the arc length, as one where a ground ends and another begins within `near` [m].
    """
    joined: list[ContactInterval] = []
    for this in sorted(intervals):
        if joined and this.start - joined[-1].end <= near:
            last = joined[-1]
            joined[-1] = last._replace(end=max(last.end, this.end), to_end=last.to_end or this.to_end)
        else:
            joined.append(this)
    return joined


def contact_intervals(arc: Array, share: Array, clearance: Array, force: Array) -> list[list[ContactInterval]]:
    """Intervals of contact along the riser, from its start on, at each of nt states.

    arc (n,): of points along the riser from its start, growing [m]. share (n,): of its length [m] by quadrature.
    clearance (nt, n): gap less that at which the force begins [m]. force (nt, n): per length [N/m], > 0 where it
    pushes. A gap that is no higher than the deepest penetration does not end a stretch: just behind the touchdown point
    a stiff bed lifts the riser off a little.
    """
    stretches, whole = touching(clearance, force), float(np.cumsum(share)[-1])
    row, first, last = stretches
    from_start, to_end = first == 0, last == arc.size - 1
    start, end = np.zeros(row.size), np.full(row.size, whole)
    if (at := np.flatnonzero(~to_end)).size:
        own = Stretches(row[at], first[at], last[at])
        end[at] = _leaving(arc, share, clearance, force, own)
    if (at := np.flatnonzero(~from_start)).size:
        own = Stretches(row[at], arc.size - 1 - last[at], arc.size - 1 - first[at])
        backwards = (whole - arc[::-1], share[::-1], clearance[:, ::-1], force[:, ::-1])
        start[at] = whole - _leaving(*backwards, own)
    intervals: list[list[ContactInterval]] = [[] for _ in clearance]
    for state, *ends in zip(*map(as_list, (row, start, end, from_start, to_end)), strict=True):
        intervals[state].append(ContactInterval(*ends))
    return intervals


def touching(clearance: Array, force: Array) -> Stretches:
    """What touches, small gaps within included; none that presses nowhere beside others. Each (nt, n)."""
    rows, points = np.nonzero((clearance < 0.0) | (force != 0.0))
    if not rows.size:
        return Stretches(rows, rows, rows)
    begins = np.concatenate([[True], rows[1:] != rows[:-1]])
    gaps = np.flatnonzero(~begins & (points != np.roll(points, 1) + 1))
    begins[gaps] = _highest(clearance, rows[gaps], points[gaps - 1], points[gaps]) > -clearance[rows[gaps]].min(axis=1)
    first = np.flatnonzero(begins)
    stretches = Stretches(rows[first], points[first], points[np.append(first[1:], rows.size) - 1])
    presses = np.logical_or.reduceat(force[rows, points] != 0.0, first)
    somewhere = np.zeros(len(clearance), dtype=bool)
    somewhere[stretches.row[presses]] = True
    return Stretches(*(each[presses | ~somewhere[stretches.row]] for each in stretches))


def _highest(clearance: Array, rows: IntArray, before: IntArray, behind: IntArray) -> Array:
    """Largest clearances (k,) between the points before gaps and behind them, these included."""
    first = rows * clearance.shape[1]
    bounds = np.stack([first + before, first + behind + 1], axis=1).ravel()
    return np.maximum.reduceat(np.append(clearance, 0.0), bounds)[::2] if rows.size else np.empty(0)


def _leaving(arc: Array, share: Array, clearance: Array, force: Array, stretches: Stretches) -> Array:
    """Arc lengths (k,) [m] at which stretches end, by the forces in them."""
    points = int(stretches.last.max()) + 1  # beyond them nothing is pushed
    some = max(1, AT_ONCE // points)
    parts = [Stretches(*(each[k : k + some] for each in stretches)) for k in range(0, stretches.row.size, some)]
    d, middle = np.concatenate([_rigid_end(arc, share, force[:, :points], part) for part in parts], axis=1)
    end = _edge(arc, clearance, stretches)
    return np.where(np.isnan(middle), end, np.minimum(np.fmax(d, middle), end))


def _rigid_end(arc: Array, share: Array, force: Array, stretches: Stretches) -> Array:
    """End d of the rigid contact, and the middle of the forces (2, k) [m], which is nan where nothing presses.

    force (nt, m): at the first m points, among them all of the stretches.
    """
    m = force.shape[1]
    number, own, last = np.arange(m), force[stretches.row], stretches.last[:, None]
    pushing = np.where((number >= stretches.first[:, None]) & (number <= last), own, 0.0)
    near, weight, middle = _layer(arc[:m], share[:m], pushing)
    near *= number <= last
    f0 = _resting(weight, pushing, own.argsort(axis=1, kind="stable"))
    return np.stack([_equivalent(arc, share, near, pushing, f0, stretches.last), middle])


def _edge(arc: Array, clearance: Array, stretches: Stretches) -> Array:
    """Arc lengths (k,) at which the clearance vanishes beyond the last point in contact."""
    row, last = stretches.row, stretches.last
    behind = np.minimum(last + 1, arc.size - 1)
    here, there = clearance[row, last], clearance[row, behind]
    leaves = (here < 0.0) & np.isfinite(there) & (behind > last)
    change = np.subtract(here, there, out=np.ones(here.shape), where=leaves)
    share = np.divide(here, change, out=np.zeros(here.shape), where=leaves)
    return np.asarray(arc[last] + (arc[behind] - arc[last]) * share)


def _layer(arc: Array, share: Array, force: Array) -> tuple[Array, Array, Array]:
    """How far points (k, n) belong to the touchdown layer, their weight in f0, and the middle of the forces (k,) [m],
    which is nan where nothing presses. Depths are counted from the free side; see the module's text.
    """
    pressing = np.maximum(force, 0.0)
    own = share * pressing
    total, moment = _sum(own), _sum(arc * own)
    own, step = own[:, ::-1], share[::-1]
    largest = np.maximum.accumulate(pressing[:, ::-1], axis=1)
    m = np.where(largest > 0.0, largest, 1.0)
    B, counted = (step * largest).cumsum(axis=1) / m, largest.cumsum(axis=1) / (LEAST * m)
    A = 4.0 * np.maximum(B - (step * largest**2).cumsum(axis=1) / m**2, 0.0)
    depth = np.minimum(np.divide(B, DEEP * A, out=np.full(A.shape, np.inf), where=A > 0.0), counted)
    presses = total > 0.0
    outside = (own.cumsum(axis=1) - 0.5 * own) / np.where(presses, total, 1.0)[:, None]
    depth = np.maximum.accumulate(np.maximum(depth, 1.5 * outside), axis=1)[:, ::-1]
    near = 1.0 - _rise(4.0 * depth - 3.0)
    weight = np.minimum(depth, 1.0)
    for _ in range(FADING):
        weight *= weight
    weight *= share * near
    return near, weight, np.divide(moment, total, out=np.full(total.shape, np.nan), where=presses)


def _rise(x: Array) -> Array:
    """Smooth step from 0 to 1 over 0 < x < 1, twice continuously differentiable."""
    x = np.clip(x, 0.0, 1.0)
    return np.asarray(x * x * x * (10.0 - x * (15.0 - 6.0 * x)))


def _resting(weight: Array, force: Array, rising: IntArray) -> Array:
    """Mean (k,) of the middle half of forces, by weight (k, n): stations loaded by a clump or bridging a dip do not
    count. rising: the stations by their forces.
    """
    total = _sum(weight)[:, None]
    upto = np.take_along_axis(weight, rising, axis=1).cumsum(axis=1)
    reached = np.minimum(np.maximum(upto, 0.25 * total), 0.75 * total)
    counted = np.diff(reached, axis=1, prepend=0.25 * total)
    summed = _sum(counted * np.take_along_axis(force, rising, axis=1))
    return np.divide(summed, 0.5 * total[:, 0], out=np.zeros(summed.shape), where=total[:, 0] > 0.0)


def _equivalent(arc: Array, share: Array, near: Array, force: Array, f0: Array, last: IntArray) -> Array:
    """End d (k,) [m] of the rigid contact that is equivalent, by the equations of the module's text. The sums go to the
    line's end, beyond the last points with no force; tau = 2 E1/(R + E0) is the same, where that is safe.
    """
    length, m = float(np.cumsum(share)[-1]), near.shape[1]
    lever = length - arc
    beyond, moment_beyond = (np.append(np.cumsum(each[::-1])[-2::-1], 0.0)[last] for each in (share, share * lever))
    excess = near * share[:m] * np.subtract(force, f0[:, None])
    E0, E1 = _sum(excess) - f0 * beyond, _sum(excess * lever[:m]) - f0 * moment_beyond
    R = np.sqrt(np.maximum(E0**2 + 2.0 * f0 * E1, 0.0))
    pushes = E0 > 0.0
    with np.errstate(divide="ignore", invalid="ignore"):  # nothing rests: it is the middle of the forces
        return np.asarray(length - np.where(pushes, 2.0 * E1, R - E0) / np.where(pushes, R + E0, f0))


def _sum(values: Array) -> Array:
    """Sums (k,) of rows (k, n), one term after the other: the same for a row whatever others there are."""
    return np.asarray(values.cumsum(axis=1)[:, -1])
