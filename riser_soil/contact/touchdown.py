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

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray, as_list
from riser_soil.core.compiled import njit

DEEP = 96.0  # rises of the force within a depth of 1: 43 l on stiff springs, of which f0 is read from the far half
LEAST = 60.0  # stations within a depth of 1 in a layer that the mesh doesn't resolve
FADING = 8  # power of the depth with which stations count in f0: 1e-8 at the peak


class PointsAlong(NamedTuple):
    """Points along the riser from its start: their growing arc length, and share of its length by quadrature (n,) [m].
    """

    arc: Array
    share: Array


class ContactInterval(NamedTuple):
    """Contact from one touchdown point to the next: their arc lengths [m], that of the line's end where it touches, and
    the first and last of the points that touch.
    """

    start: float
    end: float
    first: int
    last: int


def touchdown(arc: Array, share: Array, clearance: Array, force: Array) -> float:
    """Arc length [m] of the touchdown point towards the riser's end; nan where nothing touches.

    Where the riser's end itself touches, but not all of the riser, it is the touchdown point next to the start.
    Arguments as in `contact_intervals`.
    """
    found = contact_intervals(arc, share, clearance, force)
    if not found:
        return float("nan")
    last, n = found[-1], len(arc)
    return last.start if last.last == n - 1 and last.first > 0 else last.end


def contact_intervals(arc: Array, share: Array, clearance: Array, force: Array) -> list[ContactInterval]:
    """Intervals of contact along the riser, from its start on.

    arc (n,): of points along the riser from its start, growing [m]. share (n,): of its length [m] by quadrature.
    clearance (n,): gap less that at which the force begins [m]. force (n,): per length [N/m], > 0 where it pushes.
    A gap that is no higher than the deepest penetration does not end a stretch: just behind the touchdown point a stiff
    bed lifts the riser off a little.
    """
    rising = force.argsort()
    return [
        ContactInterval(*_ends_of(first, last, arc, share, clearance, force, rising), first, last)
        for first, last in as_list(_runs(clearance, force))
    ]


def _ends_of(
    first: int, last: int, arc: Array, share: Array, clearance: Array, force: Array, rising: IntArray
) -> tuple[float, float]:
    """Where what touches begins and ends [m], from its first to its last point; rising (n,): all points by force.
    """
    n, whole = arc.size, float(share.sum())
    f, start, end = np.zeros(n), 0.0, whole
    f[first : last + 1] = force[first : last + 1]
    if first > 0:
        behind = tuple(np.ascontiguousarray(each[::-1]) for each in (whole - arc, share, clearance, f))
        start = whole - _leaving(*behind, n - 1 - rising, n - 1 - first)
    if last < n - 1:
        end = _leaving(arc, share, clearance, f, rising, last)
    return start, end


@njit
def _runs(clearance: Array, force: Array) -> IntArray:
    """First and last points (k, 2) of what touches, small gaps within included; none that presses nowhere beside
    others.
    """
    runs, k, pressing, pushed = np.empty((clearance.size, 2), dtype=np.int64), 0, 0, False
    small, highest = -math.inf, 0.0
    for gap in clearance:
        small = max(small, -gap)
    for i in range(clearance.size):
        if k > 0:
            highest = max(highest, clearance[i])
        if clearance[i] < 0.0 or force[i] != 0.0:
            if k == 0 or (i > runs[k - 1, 1] + 1 and highest > small):
                runs[k, 0], pushed = i, False
                k += 1
            runs[k - 1, 1], highest = i, clearance[i]
            if force[i] != 0.0 and not pushed:  # those that press come first, in their order
                runs[pressing, 0], pushed = runs[k - 1, 0], True
                pressing += 1
            if pushed:
                runs[pressing - 1, 1] = i
    return runs[: pressing if pressing > 0 else k]


@njit
def _leaving(arc: Array, share: Array, clearance: Array, force: Array, rising: IntArray, last: int) -> float:
    """Arc length [m] at which the stretch whose last point is given ends; rising: its points, among others, by their
    forces.
    """
    end = _edge(arc, clearance, last)
    near, weight, middle = _layer(arc, share, force)
    if math.isnan(middle):
        return end
    d = _equivalent(arc, share, near, force, _resting(weight, force, rising))
    return min(max(d, middle), end)


@njit
def _edge(arc: Array, clearance: Array, last: int) -> float:
    """Arc length at which the clearance vanishes beyond the last point in contact."""
    if last == len(arc) - 1 or clearance[last] >= 0.0 or not math.isfinite(clearance[last + 1]):
        return arc[last]
    here, there = clearance[last], clearance[last + 1]
    return arc[last] + (arc[last + 1] - arc[last]) * here / (here - there)


@njit
def _layer(arc: Array, share: Array, force: Array) -> tuple[Array, Array, float]:
    """How far points (n,) belong to the touchdown layer, their weight in f0, and the middle of the forces [m], which is
    nan where nothing presses. Depths are counted from the free side; see the module's text.
    """
    near, weight, total, moment = np.zeros(arc.size), np.zeros(arc.size), 0.0, 0.0
    for i in range(arc.size):
        total += share[i] * max(force[i], 0.0)
        moment += arc[i] * share[i] * max(force[i], 0.0)
    largest = count = first = second = outside = depth = 0.0
    for i in range(arc.size - 1, -1, -1):
        pressing = max(force[i], 0.0)
        largest = max(largest, pressing)
        m = largest if largest > 0.0 else 1.0
        count, first, second = count + largest, first + share[i] * largest, second + share[i] * largest**2
        B, counted = first / m, count / (LEAST * m)
        A = 4.0 * max(B - second / m**2, 0.0)
        outside += share[i] * pressing
        depth = max(depth, min(B / (DEEP * A), counted) if A > 0.0 else counted)
        if total > 0.0:
            depth = max(depth, 1.5 * (outside - 0.5 * share[i] * pressing) / total)
        near[i] = 1.0 - _rise(4.0 * depth - 3.0)
        weight[i] = share[i] * near[i] * min(depth, 1.0) ** FADING
    return near, weight, moment / total if total > 0.0 else math.nan


@njit
def _rise(x: float) -> float:
    """From 0 to 1 over 0 < x < 1, twice continuously differentiable."""
    x = min(max(x, 0.0), 1.0)
    return x**3 * (10.0 - 15.0 * x + 6.0 * x**2)


@njit
def _resting(weight: Array, force: Array, rising: IntArray) -> float:
    """Mean of the middle half of forces, by weight: stations loaded by a clump or bridging a dip do not count. rising:
    the stations by their forces.
    """
    total = 0.0
    for own in weight:
        total += own
    upto, reached, mean = 0.0, 0.25 * total, 0.0
    for i in rising:
        before, upto = reached, upto + weight[i]
        reached = min(max(upto, 0.25 * total), 0.75 * total)
        mean += (reached - before) * force[i]
    return mean / (0.5 * total) if total > 0.0 else 0.0


@njit
def _equivalent(arc: Array, share: Array, near: Array, force: Array, f0: float) -> float:
    """d: see the module's text. The sums go to the line's end; tau = 2 E1/(R + E0) is the same, where that is safe."""
    length = E0 = E1 = 0.0
    for own in share:
        length += own
    for i in range(arc.size):
        excess = near[i] * share[i] * (force[i] - f0)
        E0, E1 = E0 + excess, E1 + excess * (length - arc[i])
    R = math.sqrt(max(E0**2 + 2.0 * f0 * E1, 0.0))
    tau: float = 2.0 * E1 / (R + E0) if E0 > 0.0 else (R - E0) / f0
    return length - tau
