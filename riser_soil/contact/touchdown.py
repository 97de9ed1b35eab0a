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

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array

DEEP = 96.0  # rises of the force within a depth of 1: 43 l on stiff springs, of which f0 is read from the far half
LEAST = 60.0  # stations within a depth of 1 in a layer that the mesh doesn't resolve
FADING = 8  # power of the depth with which stations count in f0: 1e-8 at the peak


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
    turned = float(np.sum(share)) - arc[::-1], share[::-1], clearance[::-1]
    found, n = [], len(arc)
    for first, last in _runs(clearance, force):
        f = np.where((np.arange(n) >= first) & (np.arange(n) <= last), force, 0.0)
        start = float(np.sum(share)) - _leaving(*turned, f[::-1], n - 1 - first) if first > 0 else 0.0
        end = _leaving(arc, share, clearance, f, last) if last < n - 1 else float(np.sum(share))
        found.append(ContactInterval(start, end, first, last))
    return found


def _runs(clearance: Array, force: Array) -> list[tuple[int, int]]:
    """First and last points of what touches, small gaps within included; none that presses nowhere beside others."""
    touching = np.flatnonzero((clearance < 0.0) | (force != 0.0))
    if len(touching) == 0:
        return []
    small = -float(clearance.min())
    after = np.flatnonzero(np.diff(touching) > 1)
    parting = [i for i in after if clearance[touching[i] : touching[i + 1] + 1].max() > small]
    runs = [(int(part[0]), int(part[-1])) for part in np.split(touching, np.array(parting, dtype=int) + 1)]
    return [run for run in runs if force[run[0] : run[1] + 1].any()] or runs


def _leaving(arc: Array, share: Array, clearance: Array, force: Array, last: int) -> float:
    """Arc length [m] at which the stretch whose last point is given ends."""
    end = _edge(arc, clearance, last)
    pressing = share * np.maximum(force, 0.0)
    if not pressing.any():
        return end
    depth = _depth(share[::-1], force[::-1])[::-1]
    near = 1.0 - _rise(4.0 * depth - 3.0)
    f0 = _resting(share * near * np.minimum(depth, 1.0) ** FADING, force)
    middle = float(np.average(arc, weights=pressing))
    return float(np.clip(_equivalent(arc, share, near, force, f0), middle, end))


def _edge(arc: Array, clearance: Array, last: int) -> float:
    """Arc length at which the clearance vanishes beyond the last point in contact."""
    if last == len(arc) - 1 or clearance[last] >= 0.0 or not np.isfinite(clearance[last + 1]):
        return float(arc[last])
    here, there = clearance[last], clearance[last + 1]
    return float(arc[last] + (arc[last + 1] - arc[last]) * here / (here - there))


def _depth(share: Array, force: Array) -> Array:
    """Depth of points (n,) behind the touchdown layer, counted from the free side; see the module's text."""
    pressing = np.maximum(force, 0.0)
    largest = np.maximum.accumulate(pressing)
    m = np.where(largest > 0.0, largest, 1.0)
    B = np.cumsum(share * largest) / m
    A = 4.0 * np.maximum(B - np.cumsum(share * largest**2) / m**2, 0.0)
    counted = np.cumsum(largest) / (LEAST * m)
    layers = np.minimum(np.divide(B, DEEP * A, out=counted.copy(), where=A > 0.0), counted)
    outside = np.cumsum(share * pressing) - 0.5 * share * pressing
    return np.maximum.accumulate(np.maximum(layers, 1.5 * outside / float(share @ pressing)))


def _rise(x: Array) -> Array:
    """From 0 to 1 over 0 < x < 1, twice continuously differentiable."""
    x = np.clip(x, 0.0, 1.0)
    return x**3 * (10.0 - 15.0 * x + 6.0 * x**2)


def _resting(weight: Array, force: Array) -> float:
    """Mean of the middle half of forces, by weight: stations loaded by a clump or bridging a dip do not count."""
    order = np.argsort(force)
    total = float(weight.sum())
    upto = np.clip(np.cumsum(weight[order]), 0.25 * total, 0.75 * total)
    counted = np.diff(upto, prepend=0.25 * total)
    return float(counted @ force[order]) / (0.5 * total) if total > 0.0 else 0.0


def _equivalent(arc: Array, share: Array, near: Array, force: Array, f0: float) -> float:
    """d: see the module's text. The sums go to the line's end; tau = 2 E1/(R + E0) is the same, where that is safe."""
    excess, length = near * share * (force - f0), float(np.sum(share))
    E0, E1 = float(excess.sum()), float(excess @ (length - arc))
    R = np.sqrt(max(E0**2 + 2.0 * f0 * E1, 0.0))
    return length - (2.0 * E1 / (R + E0) if E0 > 0.0 else (R - E0) / f0)
