"""Static equilibrium of an elastic cable in a vertical plane, hanging or resting on a level seabed.

The line is a chain of bars with the weight lumped at their joints. A bar of unstressed length l0 that carries the
horizontal tension H and the vertical force V, with T = sqrt(H^2 + V^2), spans

    dx = l0 H (1/T + 1/EA),    dz = l0 V (1/T + 1/EA)

(Irvine, Cable Structures, 1981, chapter 1). The seabed bears no horizontal force, so H is the same everywhere. It
pushes a joint at the height z > 0 by q with q z = mu, and mu goes to zero: the interior-point method for the convex
problem that the chain poses (Wright, Primal-Dual Interior-Point Methods, 1997). Newton's method takes heights, bar
forces and pushes as unknowns side by side, so that a high EA costs no iterations, as it would with heights alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.banded import solve_symmetric
from riser_soil.errors import SceneError

BALANCED = 1e-11  # misfit, see `_misfit`
ROUND_OFF = 1e-9  # the misfit under which it may stall
ROUNDED = 1e-4  # of the tension: what counts beside the load
MOST_ITERATIONS = 50
NEAR = 0.01  # between logarithms of H or mu: where Newton's method must converge without steps between
SHORTEST_STEP = 1e-3  # of Newton's
STRIDE = 4.0  # factor between the values of H that are tried
CLOSE = 1.05  # the same where H is then let free
SLACK = 0.01  # of the least H: below it the search for H ends
WIDEST = 1e15  # largest H over the load
FARTHEST = 0.01  # over the length and the load: mu at first
HARDER = 0.2  # factor on mu
TO_THE_EDGE = 0.9  # of the way to where a height, a push or H would vanish, in one step


@dataclass(frozen=True, eq=False)
class BarChain:
    """Unstressed length l0 [m] and EA [N] of the bars (nb,), weight W [N] of the joints (nb + 1,).

    z0 and z1 [m]: heights of the ends. hover [m]: at about this height above a seabed at z = 0 the line rests; None
    where there is no seabed.
    """

    l0: Array
    EA: Array
    W: Array
    z0: float
    z1: float
    hover: float | None = None

    @cached_property
    def L(self) -> float:
        return float(self.l0.sum())

    @cached_property
    def load(self) -> float:
        """Sum of weights and lifts [N]."""
        return float(np.abs(self.W).sum())

    @property
    def hardest(self) -> float:
        """mu [N m] that lets the line rest where it should."""
        return 0.0 if self.hover is None else self.hover * float(np.abs(self.W).max())


@dataclass(frozen=True, eq=False)
class CableBalance:
    """Horizontal tension H [N], heights z (nb + 1,) m of the joints, vertical forces V (nb,) N in the bars, pushes
    q (nb - 1,) N of the seabed on the inner joints, which times the heights make mu [N m].

    Also the change of these in a Newton step.
    """

    chain: BarChain
    H: float
    z: Array
    V: Array
    q: Array
    mu: float

    @cached_property
    def T(self) -> Array:
        """Tension of the bars (nb,) N."""
        return np.hypot(self.H, self.V)

    @cached_property
    def lengths_per_force(self) -> Array:
        """What the bars span per newton of the force along the same axis (nb,) m/N."""
        return self.chain.l0 * (1.0 / self.T + 1.0 / self.chain.EA)

    @property
    def x(self) -> Array:
        """Horizontal distance of the joints from the start (nb + 1,) m."""
        return np.append(0.0, np.cumsum(self.H * self.lengths_per_force))

    @property
    def reach(self) -> float:
        return float(self.H * self.lengths_per_force.sum())

    @cached_property
    def misfits(self) -> tuple[Array, Array]:
        """Spans beyond what the forces make of the bars (nb,) m; net upward force on the inner joints (nb - 1,) N."""
        V = self.V
        spans = np.diff(self.z) - V * self.lengths_per_force
        return spans, np.diff(V) - self.chain.W[1:-1] + self.q

    @property
    def V_at_joints(self) -> Array:
        """(nb + 1,) N: amid what jumps there."""
        W, V = self.chain.W, self.V
        return np.concatenate([[V[0] - W[0]], 0.5 * (V[1:] + V[:-1]), [V[-1] + W[-1]]])


@dataclass(frozen=True)
class SpanCondition:
    """Ends h [m] apart, unless the horizontal tension would fall below least_H [N]."""

    h: float
    least_H: float


def fit(chain: BarChain, h: float, least_H: float, near: CableBalance | None = None) -> CableBalance:
    """The chain in balance with its ends h apart; with least_H [N] and its ends farther apart where it would need less.

    near: a balance of the same bars with ends nearby, from which it is sought first. Raises SceneError when no balance
    is found.
    """
    goal, straight = SpanCondition(h, least_H), _straight(chain)
    if near is not None and (balance := _newton(_with_ends_of(chain, near), goal)) is not None and least_H < balance.H:
        return balance
    taut = _solved(straight, straight)
    far = _nearly(taut, goal)
    if far.reach <= h:
        balance = _hardened(_solved(far, far, goal), goal)
        if least_H < balance.H:
            return balance
    slack = _hardened(_nearly(taut, SpanCondition(-np.inf, least_H)))
    if slack.reach >= h:
        return slack
    near = _nearly(slack, goal)
    return _solved(near, near, goal)


def _with_ends_of(chain: BarChain, near: CableBalance) -> CableBalance:
    """A balance with the ends of another chain of the same bars."""
    z = near.z.copy()
    z[0], z[-1] = chain.z0, chain.z1
    return replace(near, chain=chain, z=z)


def _nearly(start: CableBalance, goal: SpanCondition) -> CableBalance:
    """Balance with nearly the H that reaches the goal, or with its least H where that reaches it too; mu is left as it
    is.
    """
    low, high, h, least_H, chain = start, start, goal.h, goal.least_H, start.chain
    while high.reach < h:
        if high.H / chain.load > WIDEST:
            raise SceneError("riser: nothing holds its ends as far apart as they are; lengthen the segments")
        low, high = high, _solved(high, replace(high, H=high.H * STRIDE))
    while low.reach > h and least_H < low.H:
        low, high = _solved(low, replace(low, H=max(low.H / STRIDE, least_H))), low
    while low.reach <= h and high.H > CLOSE * low.H:
        middle = _solved(low, replace(low, H=float(np.sqrt(low.H * high.H))))
        low, high = (middle, high) if middle.reach <= h else (low, middle)
    return low


def _straight(chain: BarChain) -> CableBalance:
    """A straight line over the seabed under a high tension; not in balance."""
    slope = (chain.z1 - chain.z0) / chain.L
    arc = np.append(0.0, np.cumsum(chain.l0))
    z, V = chain.z0 + slope * arc, np.full(chain.l0.size, slope * chain.load)
    if chain.hover is None:
        return CableBalance(chain, chain.load, z, V, np.zeros(z.size - 2), 0.0)
    mu = max(FARTHEST * chain.L * chain.load / z.size, chain.hardest)
    z[1:-1] += FARTHEST * chain.L
    return CableBalance(chain, chain.load, z, V, mu / z[1:-1], mu)


def _hardened(balance: CableBalance, goal: SpanCondition | None = None) -> CableBalance:
    """The balance at the final mu; unchanged where H falls far below the least H of the span condition."""
    while balance.mu > balance.chain.hardest and not _is_slack(balance, goal):
        balance = _solved(balance, replace(balance, mu=max(HARDER * balance.mu, balance.chain.hardest)), goal)
    return balance


def _is_slack(balance: CableBalance, goal: SpanCondition | None) -> bool:
    return goal is not None and goal.least_H > balance.H


def _solved(known: CableBalance, trial: CableBalance, goal: SpanCondition | None = None) -> CableBalance:
    """Equilibrium of the trial's chain at its mu, at its H or at the H that meets the span condition.

    Found by way of values of H and mu nearer to those of a known balance where theirs are far from it. Gives up where
    H falls far below the goal's least.
    """
    balance = _newton(trial, goal)
    if balance is not None:
        return balance
    H, mu = float(np.sqrt(known.H * trial.H)), float(np.sqrt(known.mu * trial.mu))
    if abs(np.log(H / trial.H)) < NEAR and (mu == 0.0 or abs(np.log(mu / trial.mu)) < NEAR):
        raise SceneError("riser.initial: catenary: found none between the ends; give initial points")
    halfway = _solved(known, replace(known, H=H, mu=mu), goal)
    return _solved(halfway, replace(halfway, H=trial.H, mu=trial.mu), goal)


def _newton(trial: CableBalance, goal: SpanCondition | None) -> CableBalance | None:
    """Newton's method; None where it does not converge."""
    size = _misfit(trial, goal)
    for _ in range(MOST_ITERATIONS):
        before, (trial, size) = size, _improved(trial, size, goal)
        if size < BALANCED or 0.8 * before < size < ROUND_OFF or _is_slack(trial, goal):
            return trial
    return None


def _improved(trial: CableBalance, size: float, goal: SpanCondition | None) -> tuple[CableBalance, float]:
    """After a Newton step, shortened to stay inside and until the misfit falls; and its misfit."""
    step = _newton_step(trial, goal)
    fraction = min(1.0, *_ways_inside(trial, step))
    while True:
        further = replace(
            trial,
            H=trial.H + fraction * step.H,
            z=trial.z + fraction * step.z,
            V=trial.V + fraction * step.V,
            q=trial.q + fraction * step.q,
        )
        misfit = _misfit(further, goal)
        if misfit < (1.0 - 0.1 * fraction) * size or fraction < SHORTEST_STEP:
            return further, misfit
        fraction *= 0.5


def _ways_inside(trial: CableBalance, step: CableBalance) -> Iterator[float]:
    """Fractions of the step that leave H positive, and heights and pushes too where there is a seabed."""
    pairs = [(np.array([trial.H]), np.array([step.H]))]
    if trial.chain.hover is not None:
        pairs += [(trial.z[1:-1], step.z[1:-1]), (trial.q, step.q)]
    for value, change in pairs:
        yield TO_THE_EDGE / max(1e-300, float(np.max(-change / value)))


def _misfit(trial: CableBalance, goal: SpanCondition | None) -> float:
    """Misfits of spans, reach and heights over the length, plus that of forces over the load.

    Where tensions exceed the load by far, their round-off counts less.
    """
    chain, (spans, forces) = trial.chain, trial.misfits
    beyond = 0.0 if goal is None else abs(trial.reach - goal.h)
    resting = np.abs(trial.q * trial.z[1:-1] - trial.mu).sum() if trial.mu > 0.0 else 0.0
    scale = chain.load + ROUNDED * (trial.H + float(np.abs(trial.V).max()))
    return float((np.abs(spans).sum() + beyond + resting / scale) / chain.L + np.abs(forces).sum() / scale)


def _newton_step(trial: CableBalance, goal: SpanCondition | None) -> CableBalance:
    """Changes of H, heights, bar forces and pushes. Of a bar, k is dV/d(dz) at constant H, and c is d(dz)/dH = d(dx)/dV
    at constant V.
    """
    chain, H, V, (spans, forces) = trial.chain, trial.H, trial.V, trial.misfits
    bend = chain.l0 / (trial.T * trial.T * trial.T)
    stretch = chain.l0 / chain.EA
    k = 1.0 / (H * H * bend + stretch)
    c = -H * V * bend
    resting = trial.q / trial.z[1:-1] if trial.mu > 0.0 else 0.0
    wanted = trial.mu / trial.z[1:-1] - trial.q if trial.mu > 0.0 else np.zeros_like(trial.q)
    banded = np.zeros((2, k.size - 1))
    banded[0, 1:] = -k[1:-1]
    banded[1] = k[:-1] + k[1:] + resting
    z = np.zeros((2, k.size + 1))  # at constant H, and for a unit of H
    z[:, 1:-1] = solve_symmetric(banded, np.stack([forces + wanted + np.diff(k * spans), -np.diff(k * c)]).T).T
    dV = k * (np.stack([spans, -c]) + np.diff(z))
    dH = 0.0
    if goal is not None:
        dH = (goal.h - trial.reach - c @ dV[0]) / (c @ dV[1] + np.sum(V * V * bend + stretch))
    dz = z[0] + dH * z[1]
    return replace(trial, H=float(dH), z=dz, V=dV[0] + dH * dV[1], q=wanted - resting * dz[1:-1])
