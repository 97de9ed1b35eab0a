"""Elastic catenary between two points in space, as the initial configuration; `cable` finds its equilibrium."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.errors import SceneError
from riser_soil.riser.cable import BarChain, CableBalance, fit
from riser_soil.riser.shapes import UP, Curve, X, from_nodes
from riser_soil.riser.slack import heap

BARS = 2000  # error of H some 5e-8 of it
HOVER = 1e-8  # of the length: where a line at rest is over the seabed
KINK = 2.0  # weights of a bar: the least H, so that the sharpest bend spans some bars
LIES = 1e-6  # of the length: below it a joint lies on the seabed
LEVEL = 1e-9  # of the length: what an end may lie below the level at which the line rests


@dataclass(frozen=True, eq=False)
class Catenary:
    """Curve of the line, tensions at its nodes (nn,) N, the balance that it follows from, horizontal tension H (N).

    slack [m]: how far the end lies beyond its place, horizontally away from the start, where the line is too long to
    hang there with the least H allowed; else 0. heaped: whether it is too long to pull at what lies of it
    (`slack`). folded: whether it is so slack that it hangs in two legs, here leaning to where its ends are.
    """

    curve: Curve
    tension: Array
    slack: float
    balance: CableBalance
    heaped: bool = False
    folded: bool = False

    @property
    def H(self) -> float:
        return self.balance.H

    @property
    def bends(self) -> Array:
        """Arc lengths (n,) [m] where it bends most: where it comes down, and lowest or highest points."""
        chain, z, V = self.balance.chain, self.balance.z, self.balance.V
        joints = np.append(0.0, np.cumsum(chain.l0))
        if self.heaped:
            rests = np.concatenate([[False], V == 0.0, [False]])
            return joints[np.flatnonzero(rests[1:] != rests[:-1])]
        lies = (z < LIES * chain.L) & (chain.hover is not None)
        down = np.flatnonzero(lies[1:] != lies[:-1])
        turns = 1 + np.flatnonzero(V[1:] * V[:-1] < 0.0)
        hanging = turns[~lies[turns]]
        if self.folded and not (down.size or hanging.size):  # all of it hangs from one end, and is slack at the other
            return joints[[0 if np.abs(V[0]) < np.abs(V[-1]) else -1]]
        return np.concatenate([np.where(lies[down], joints[down], joints[down + 1]), joints[hanging]])

    def turns(self, arcs: Array) -> Array:
        """Angles (n,) [rad] by which it turns at arc lengths (n,) [m] within it: kinks where point weights hang."""
        chain = self.balance.chain
        joints = np.append(0.0, np.cumsum(chain.l0))
        at = np.clip(np.abs(joints - arcs[:, None]).argmin(axis=1), 1, chain.l0.size - 1)
        slope = np.arctan2(self.balance.V, self.H)
        return np.abs(slope[at] - slope[at - 1])


def catenary(
    arc: Array,
    start: Array,
    end: Array,
    weight: Array | float,
    EA: Array | float,
    level: float = -np.inf,
    *,
    points: Array | None = None,
    least_H: float = 0.0,
    heaps: bool = False,
    surface: float = np.inf,
    bars: int = BARS,
    near: Catenary | None = None,
) -> Catenary:
    """Shape and tension of a line of length arc[-1] between two points, which carries its own weight.

    arc: (nn,) unstressed arc length of the nodes. weight: N/m, negative where the line floats, and EA: N; each for the
    whole line or by element (ne,). level: height [m] at which the line rests on the seabed; by default there is none.
    points: (np, 2) arc lengths [m] of point weights [N]. bars: about how many the line is cut into; the error is of
    second order in their length. near: one of the same line between points nearby, found in a tenth of the time.
    least_H [N]: a line so slack that its H would be less is laid with this one and ends beyond its place; at H = 0 a
    cable has kinks, and any shape on the seabed. heaps: what lies on the seabed may take up the slack, or,
    of a line that floats, on the water's surface [m]. Raises SceneError where there is no such line.
    """
    across = (end - start) * [1.0, 1.0, 0.0]
    h = float(np.linalg.norm(across))
    length = np.diff(arc)
    pieces = np.maximum(1, np.ceil(length * (bars / arc[-1]) - 1e-9)).astype(np.int64)
    w, stiffness = (np.repeat(np.broadcast_to(value, length.shape), pieces) for value in (weight, EA))
    l0 = np.repeat(length / pieces, pieces)
    W = _at_joints(l0, w, np.empty((0, 2)) if points is None else points)
    chain = _chain(l0, stiffness, W, (start[2], end[2]), level)
    if not chain.load > 0.0:
        raise SceneError("riser.initial: catenary: needs a submerged weight; give initial points, or straight")
    nodes, direction = np.append(0, np.cumsum(pieces)), across / h if h > 0.0 else X
    if heaps and (heaped := heap(chain, h, surface - start[2])) is not None:
        return replace(_in_space(*heaped, nodes, start, end, direction, 0.0), heaped=True)
    least = max(least_H, KINK * float(np.abs(w * l0).max()))
    balance = fit(chain, h, least, None if near is None else near.balance)
    slack = max(0.0, balance.reach - h) if least >= balance.H else 0.0
    if heaps and slack > 0.0:
        leaning = balance.x - slack * np.append(0.0, np.cumsum(chain.l0)) / chain.L
        return replace(_in_space(leaning, balance, nodes, start, end, direction, 0.0), folded=True)
    return _in_space(balance.x, balance, nodes, start, end + slack * direction, direction, slack)


def _chain(l0: Array, EA: Array, W: Array, ends: tuple[float, float], level: float) -> BarChain:
    """The bars, heights counted from the seabed, or from the start where there is none."""
    L, low = float(l0.sum()), min(ends)
    if low < level - LEVEL * L:
        raise SceneError(
            f"riser: an end at z = {low:.6g} m lies below the level {level:.6g} m at which the riser rests"
        )
    if np.isinf(level):
        return BarChain(l0, EA, W, 0.0, ends[1] - ends[0])
    return BarChain(l0, EA, W, ends[0] - level, ends[1] - level, hover=HOVER * L)


def _at_joints(l0: Array, w: Array, points: Array) -> Array:
    """Weights (nb + 1,) [N] of the joints: half of each bar beside it, and shares of the point weights there; those at
    a prescribed end are carried by its support.
    """
    along = np.append(0.0, np.cumsum(l0))
    bar = np.clip(np.searchsorted(along, points[:, 0], side="right") - 1, 0, l0.size - 1)
    share = (points[:, 0] - along[bar]) / l0[bar]
    hung = np.zeros_like(along)
    np.add.at(hung, bar, (1.0 - share) * points[:, 1])
    np.add.at(hung, bar + 1, share * points[:, 1])
    hung[[0, -1]] = 0.0
    return 0.5 * (np.append(w * l0, 0.0) + np.append(0.0, w * l0)) + hung


def _in_space(
    along: Array, balance: CableBalance, nodes: IntArray, start: Array, end: Array, direction: Array, slack: float
) -> Catenary:
    """The shape at the nodes, its joints at distances along (nb + 1,) [m] from the start; it ends where it is to end,
    beyond the round-off of its balance.
    """
    x, z, V = (values[nodes, None] for values in (along, balance.z - balance.chain.z0, balance.V_at_joints))
    force = balance.H * direction + V * UP
    tension = np.linalg.norm(force, axis=1)
    position = start + x * direction + z * UP
    position[-1] = end
    curve = from_nodes(position, force / tension[:, None])
    return Catenary(curve, tension, slack, balance)


def curvature(w: Array, H: float, T: Array) -> Array:
    """Curvature k = w H/T^2 [1/m] of a cable of a weight w >= 0 [N/m] where its tension is T [N]."""
    return np.asarray(w * H / T**2)


def bend_of_curvature(w: Array, H: float, T: Array) -> Array:
    """Size of its second derivative along the cable [1/m3]: with T^2 = H^2 + V^2 and dV/ds = w,
    k'' = 2 w^3 H (3 V^2 - H^2)/T^6.
    """
    return np.asarray(2.0 * w**3 * H * np.abs(3.0 * T**2 - 4.0 * H**2) / T**6)
