"""Balance of a line without bending stiffness in a vertical plane, hanging or resting on a level seabed.

The line is a chain of bars with the weight lumped at their joints. A bar of unstressed length l0 that carries the
horizontal tension H and the vertical force V, with T = sqrt(H^2 + V^2), spans

    dx = l0 H (1/T + 1/EA),    dz = l0 V (1/T + 1/EA)

(Irvine, Cable Structures, 1981, chapter 1). The seabed bears no horizontal force, so H is the same everywhere, and for
a given H > 0 the joints' heights minimise a convex function. Newton's method finds them with heights and bar forces as
unknowns side by side: a high EA then costs no iterations, unlike in a method that has the heights alone. The reach of
the line grows with H: a scalar equation follows.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import solveh_banded
from scipy.optimize import brentq

from riser_soil.arrays import Array
from riser_soil.errors import SceneError

BALANCED = 1e-11  # misfit of spans over the length plus that of forces over the weight
NEARLY_BALANCED = 1e-6
MOST_ITERATIONS = 200
STRIDE = 4.0  # factor between the values of H that are tried first
SHORT_STRIDE = 1.1  # and when the seabed has become a little harder
SOFTEST = 0.01  # of the length
HARDENING = 0.1
WIDEST = 1e15  # largest H over the weight


@dataclass(frozen=True, eq=False)
class Chain:
    """Unstressed length l0 [m] and EA [N] of the bars (nb,), weight W [N] of the joints (nb + 1,).

    z0 and z1 [m]: heights of the ends. softness [m]: of the seabed at z = 0, which pushes a joint up by
    (sqrt(z^2 + softness^2) - z)/(2 softness) of `bearing` [N]; None where there is no seabed.
    """

    l0: Array
    EA: Array
    W: Array
    z0: float
    z1: float
    bearing: float = 0.0
    softness: float | None = None

    @property
    def L(self) -> float:
        return float(self.l0.sum())

    @property
    def load(self) -> float:
        """Sum of weights and lifts [N]."""
        return float(np.abs(self.W).sum())

    def push(self, z: Array) -> tuple[Array, Array]:
        """Upward force [N] of the seabed on joints at z, and how fast it falls with z [N/m]."""
        if self.softness is None:
            return np.zeros_like(z), np.zeros_like(z)
        root = np.hypot(z, self.softness)
        K = 0.5 * self.bearing / self.softness
        force = K * np.where(z > 0.0, self.softness**2 / (root + np.abs(z)), root - z)
        return force, force / root


@dataclass(frozen=True, eq=False)
class Balance:
    """Horizontal tension H [N], heights z (nb + 1,) m of the joints, vertical forces V (nb,) N in the bars."""

    chain: Chain
    H: float
    z: Array
    V: Array

    @property
    def x(self) -> Array:
        """Horizontal distance of the joints from the start (nb + 1,) m."""
        chain = self.chain
        dx = chain.l0 * self.H * (1.0 / np.hypot(self.H, self.V) + 1.0 / chain.EA)
        return np.append(0.0, np.cumsum(dx))

    @property
    def reach(self) -> float:
        return float(self.x[-1])

    @property
    def V_at_joints(self) -> Array:
        """(nb + 1,) N: amid what jumps there."""
        W, V = self.chain.W, self.V
        return np.concatenate([[V[0] - W[0]], 0.5 * (V[1:] + V[:-1]), [V[-1] + W[-1]]])


def fit(chain: Chain, h: float, least_H: float) -> Balance:
    """The chain in balance with its ends h apart; farther apart where that takes an H below least_H [N].

    A seabed is hardened step by step to its final softness. Raises SceneError when no balance is found.
    """
    softest = chain if chain.softness is None else replace(chain, softness=max(SOFTEST * chain.L, chain.softness))
    found = _search(_straight(softest), h, least_H, STRIDE)
    while found.chain.softness != chain.softness:
        assert found.chain.softness is not None
        assert chain.softness is not None
        harder = replace(chain, softness=max(found.chain.softness * HARDENING, chain.softness))
        found = _search(replace(found, chain=harder), h, least_H, SHORT_STRIDE)
    return found


def _straight(chain: Chain) -> Balance:
    """A straight line under a high tension; not in balance."""
    slope = (chain.z1 - chain.z0) / chain.L
    arc = np.append(0.0, np.cumsum(chain.l0))
    return Balance(chain, chain.load, chain.z0 + slope * arc, np.full(chain.l0.size, slope * chain.load))


def _search(guess: Balance, h: float, least_H: float, stride: float) -> Balance:
    """The balance that reaches h, or that with least_H; H is changed by the stride until it is passed."""
    found = balance(guess, max(guess.H, least_H), NEARLY_BALANCED)
    if found.reach < h:
        while found.reach < h:
            if found.H > WIDEST * guess.chain.load:
                raise SceneError("riser.initial: catenary: found none between the ends; give initial points")
            low, found = found, balance(found, found.H * stride, NEARLY_BALANCED)
        return _between(h, low, found)
    while found.H > least_H:
        high, found = found, balance(found, max(found.H / stride, least_H), NEARLY_BALANCED)
        if found.reach <= h:
            return _between(h, found, high)
    return balance(found, least_H)


def _between(h: float, low: Balance, high: Balance) -> Balance:
    """The balance that reaches h, between two that reach less and more."""
    nearest = high

    def misfit(log_H: float) -> float:
        nonlocal nearest
        nearest = balance(nearest, float(np.exp(log_H)))
        return nearest.reach - h

    log_H = brentq(misfit, np.log(low.H) - 1e-4, np.log(high.H) + 1e-4, xtol=1e-13, rtol=1e-13)
    return balance(nearest, float(np.exp(log_H)))


def balance(guess: Balance, H: float, tolerance: float = BALANCED) -> Balance:
    """The guess's chain in balance at a given horizontal tension, by Newton's method with halved steps."""
    chain, trial = guess.chain, replace(guess, H=H)
    spans, forces = _misfits(trial)
    for _ in range(MOST_ITERATIONS):
        size = _size(chain, spans, forces)
        if size < tolerance:
            return trial
        dz, dV = _newton_step(trial, spans, forces)
        fraction = 1.0
        while True:
            further = replace(trial, z=trial.z + fraction * dz, V=trial.V + fraction * dV)
            spans, forces = _misfits(further)
            if _size(chain, spans, forces) < (1.0 - 0.1 * fraction) * size or fraction < 1e-3:
                break
            fraction *= 0.5
        trial = further
    if size < NEARLY_BALANCED:
        return trial
    raise SceneError("riser.initial: catenary: found none between the ends; give initial points")


def _misfits(trial: Balance) -> tuple[Array, Array]:
    """Spans beyond what the forces make of the bars (nb,) m; net upward force on the inner joints (nb - 1,) N."""
    chain, z, V = trial.chain, trial.z, trial.V
    spans = np.diff(z) - chain.l0 * V * (1.0 / np.hypot(trial.H, V) + 1.0 / chain.EA)
    forces = np.diff(V) - chain.W[1:-1] + chain.push(z[1:-1])[0]
    return spans, forces


def _size(chain: Chain, spans: Array, forces: Array) -> float:
    return float(np.abs(spans).sum() / chain.L + np.abs(forces).sum() / chain.load)


def _newton_step(trial: Balance, spans: Array, forces: Array) -> tuple[Array, Array]:
    """Changes of heights and bar forces; k is dV/d(dz) of a bar at fixed H."""
    chain, H = trial.chain, trial.H
    k = 1.0 / (chain.l0 * (H**2 / np.hypot(H, trial.V) ** 3 + 1.0 / chain.EA))
    banded = np.zeros((2, k.size - 1))
    banded[0, 1:] = -k[1:-1]
    banded[1] = k[:-1] + k[1:] + chain.push(trial.z[1:-1])[1]
    dz = np.zeros(k.size + 1)
    dz[1:-1] = solveh_banded(banded, forces + np.diff(k * spans))
    return dz, k * (spans + np.diff(dz))
