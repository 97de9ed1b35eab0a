"""Where the riser comes down.

Where the contact force ends depends on how soft the ground is: on a bed of stiffness k the force near the touchdown
point is spread over some layer length l = (4 EI/k)^(1/4), and ends about l beyond the place where the riser would leave
a rigid floor. There, the force per length would be f0, with which the riser rests, up to the touchdown point, and a
concentrated force R at that point (a straight pipe bears no moment, so the shear force jumps). The touchdown point is
taken as the end d of that rigid contact which has the resultant and the moment of the forces found: with tau = S - d,
S the line's end,

    E0 = int (f - f0) ds = R - f0 tau,    E1 = int (f - f0)(S - s) ds = R tau - f0 tau²/2,
    R² = E0² + 2 f0 E1,                   tau = (R - E0)/f0.

By statics neither d nor R knows how the force is spread. On a bed of springs under the tension H and small slopes, d
lies sqrt(EI/H - H/k) before the place where the catenary of the hanging part touches down, sqrt(EI/H) on a rigid floor:
an error of the order of 1/k, whereas the contact's end moves with the power -1/4 of k. On beds softer than H²/EI there
is no such R, and d is that place itself. Quadrature along the line makes the sums as exact as the balance of forces.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.arrays import Array, IntArray

# In distances from the place where the force ends to its first peak, pi/4 l on a bed of springs: where the force has
# settled to e^-12 of its peak, how far f0 is looked for, and more than the touchdown point can be away (4/pi).
LAYER, RESTING, FARTHEST = 16.0, 48.0, 4.0
LEAST = 20  # stations in a layer that the mesh doesn't resolve


class Stretch(NamedTuple):
    """Contact from one touchdown point to the next: their arc lengths [m], that of the line's end where it touches, and
    the first and last of the points that touch.
    """

    start: float
    end: float
    first: int
    last: int


def touchdown(arc: Array, share: Array, clearance: Array, force: Array) -> float:
    """Arc length [m] of the touchdown point towards the riser's end; nan where nothing touches.

    Where the riser's end itself touches, but not all of the riser, it is where it comes down from the start. Arguments
    as in `stretches`.
    """
    found = stretches(arc, share, clearance, force)
    if not found:
        return float("nan")
    last, n = found[-1], len(arc)
    return last.start if last.last == n - 1 and last.first > 0 else last.end


def stretches(arc: Array, share: Array, clearance: Array, force: Array) -> list[Stretch]:
    """Where the riser lies, from its start on.

    arc (n,): of points along the riser from its start, growing [m]. share (n,): of its length [m] by quadrature.
    clearance (n,): gap less that at which the force begins [m]. force (n,): per length [N/m], > 0 where it pushes.
    Gaps no higher than the deepest point is deep part nothing: a stiff bed throws the riser off a little behind the
    touchdown point.
    """
    length, found = float(np.sum(share)), []
    for first, last in _runs(clearance):
        f = np.where((np.arange(len(arc)) >= first) & (np.arange(len(arc)) <= last), force, 0.0)
        end = _leaving(arc, share, clearance, f, last)
        start = length - _leaving(length - arc[::-1], share[::-1], clearance[::-1], f[::-1], len(arc) - 1 - first)
        found.append(Stretch(start if first > 0 else 0.0, end if last < len(arc) - 1 else length, first, last))
    return found


def _runs(clearance: Array) -> list[tuple[int, int]]:
    """First and last points of what touches, small gaps within included."""
    touching = np.flatnonzero(clearance < 0.0)
    if len(touching) == 0:
        return []
    small = -float(clearance.min())
    after = np.flatnonzero(np.diff(touching) > 1)
    parting = [i for i in after if clearance[touching[i] : touching[i + 1] + 1].max() > small]
    return [(int(part[0]), int(part[-1])) for part in np.split(touching, np.array(parting, dtype=int) + 1)]


def _leaving(arc: Array, share: Array, clearance: Array, force: Array, last: int) -> float:
    """Arc length [m] at which the stretch whose last point is given ends."""
    end = _edge(arc, clearance, last)
    lying = np.flatnonzero(force[: last + 1] > 0.0)
    if len(lying) < 2:
        return end
    scale = end - arc[_peak(force, last)]
    middle = 0.5 * (arc[lying[0]] + end)
    layer = max(middle, min(end - LAYER * scale, arc[max(last - LEAST, 0)]))
    resting = max(middle, min(end - RESTING * scale, arc[max(last - 3 * LEAST, 0)]))
    f0 = _median(force, share, np.flatnonzero((arc >= resting) & (arc <= 0.5 * (resting + end))))
    found = _equivalent(arc, share, force, f0, arc >= layer) if f0 > 0.0 else end
    return float(np.clip(found, max(end - FARTHEST * scale, middle), end))


def _edge(arc: Array, clearance: Array, last: int) -> float:
    """Where the clearance vanishes beyond the last point that touches."""
    if last == len(arc) - 1 or not np.isfinite(clearance[last + 1]):
        return float(arc[last])
    here, there = clearance[last], clearance[last + 1]
    return float(arc[last] + (arc[last + 1] - arc[last]) * here / (here - there))


def _peak(force: Array, last: int) -> int:
    """The first local maximum on the way back from the last point."""
    i = last
    while i > 0 and force[i - 1] >= force[i]:
        i -= 1
    return i


def _median(force: Array, share: Array, at: IntArray) -> float:
    """Force per length that no more than half of the length at some points has less or more than."""
    order = at[np.argsort(force[at])]
    half = int(np.searchsorted(np.cumsum(share[order]), 0.5 * float(share[at].sum())))
    return float(force[order[min(half, len(order) - 1)]]) if len(order) else 0.0


def _equivalent(arc: Array, share: Array, force: Array, f0: float, part: Array) -> float:
    """d: see the module's text; the sums go from where the riser rests to the line's end."""
    excess = (share * (force - f0))[part]
    length = float(np.sum(share))
    E0, E1 = float(excess.sum()), float(excess @ (length - arc)[part])
    R = np.sqrt(max(E0**2 + 2.0 * f0 * E1, 0.0))
    return length - (R - E0) / f0
