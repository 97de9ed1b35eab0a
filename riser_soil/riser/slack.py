"""Lines without bending stiffness where they are slack: constants of their elements' law, and heaps on a seabed."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.riser.cable import BarChain, CableBalance
from riser_soil.riser.tension_only import Law, Linear, TensionOnly

PULL = 1e-4  # of the line's weight: tension in a slack element as long as its chord
LEAST_SHARE, MOST_SHARE = 1e-11, 1e-4  # r: above round-off, and where EA is small beside the weight
SOFT = 0.1  # of an element's weight, over EA
MOST_SOFT = 0.1  # of the strain
FOLD = 500.0  # of an element's weight: an element under this alone sags to angles of 0.5 rad


def law_of(bends: BoolArray, weight: Array, length: Array, EA: Array) -> Law:
    """Law of elements with and without bending stiffness; weight N/m, length m, EA N (ne,)."""
    if bends.all():
        return Linear()
    heavy = np.abs(weight) * length
    share = np.clip(PULL * heavy.sum() / EA, LEAST_SHARE, MOST_SHARE)
    soft = np.clip(SOFT * heavy / EA, share, MOST_SOFT)
    return TensionOnly(np.where(bends, 1.0, share), np.where(bends, 1.0, soft), np.where(bends, 0.0, FOLD * heavy))


def heap(chain: BarChain, h: float, surface: float = np.inf) -> tuple[Array, CableBalance] | None:
    """A chain too long to pull at what lies of it: horizontal distances of the joints (nb + 1,) m from the start, and
    their balance. It hangs straight down from its ends, h [m] apart, and its other bars lie between, evenly closer
    together. One that floats stands up from its ends, and lies on the water's surface, at a height [m] over the start.
    None where it is shorter, or floats in part.
    """
    if (chain.W <= 0.0).all() and np.isfinite(surface):
        up = surface, surface - (chain.z1 - chain.z0)
        mirrored = None if min(up) < 0.0 else _heap(replace(chain, W=-chain.W, z0=up[0], z1=up[1]), h)
        if mirrored is None:
            return None
        x, balance = mirrored
        return x, replace(balance, chain=chain, z=chain.z0 + surface - balance.z, V=-balance.V)
    return _heap(chain, h) if chain.hover is not None and (chain.W >= 0.0).all() else None


def _heap(chain: BarChain, h: float) -> tuple[Array, CableBalance] | None:
    """The balance of a line that hangs straight down to a heap at z = 0; None where it would not reach it."""
    first = _suspended(chain.l0, chain.W, chain.EA, chain.z0)
    last = _suspended(chain.l0[::-1], chain.W[::-1], chain.EA[::-1], chain.z1)
    lying = chain.l0.size - first.V.size - last.V.size
    if lying < 1:
        return None
    lies = slice(first.V.size, first.V.size + lying)
    room = chain.l0[lies].copy()
    room[0] -= first.z[-1]
    room[-1] -= last.z[-1]
    if room.min() < 0.0 or h > room.sum():
        return None
    dx, V = np.zeros(chain.l0.size), np.zeros(chain.l0.size)
    dx[lies] = room * h / room.sum()
    V[: first.V.size], V[V.size - last.V.size :] = -first.V, last.V[::-1]
    z = np.concatenate([first.z, np.zeros(lying - 1), last.z[::-1]])
    pull = PULL * chain.load * max(h / room.sum(), LEAST_SHARE)  # no more than a direction where h is 0
    return np.append(0.0, np.cumsum(dx)), CableBalance(chain, pull, z, V, np.zeros(z.size - 2), 0.0)


@dataclass(frozen=True, eq=False)
class SuspendedBars:
    """Bars that hang straight down from an end to the seabed: heights of their joints z (n + 1,) m, from the end on,
    and forces V (n,) N in them.
    """

    z: Array
    V: Array


def _suspended(l0: Array, W: Array, EA: Array, height: float) -> SuspendedBars:
    """The bars of a chain, counted from an end at a height [m], that hang all over their length."""
    down = np.cumsum(l0)
    n = int(np.searchsorted(down, height, side="right"))
    below = np.append(W[1 : n + 1][::-1].cumsum()[::-1], 0.0)  # weights of the joints below each bar
    rest = height - (down[n - 1] if n else 0.0)
    V = below[:n] - (0.5 * W[n] - W[n] * rest / l0[n] if 0 < n < l0.size else 0.0)
    z = height - np.append(0.0, np.cumsum(l0[:n] * (1.0 + V / EA[:n])))
    return SuspendedBars(np.maximum(z, 0.0), V)
