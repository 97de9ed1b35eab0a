"""Clay with nonlinear kinematic hardening: elastic trial, return mapping and energy, point by point.

Its formulae stand in `kinematic_hardening`, the components of strain and stress in `mandel`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.soil.kernels import modulus, stretched
from riser_soil.soil.law import StressUpdate
from riser_soil.soil.mandel import DEVIATOR, VOLUME
from riser_soil.soil.rate import Gain

MOST_ITERATIONS, CONVERGED = 50, 1e-14  # of Δp; change over the largest that Δp may be
ROUND_OFF = 4e-15  # of |η| in the equation for Δp: a change that makes no more is none
ROOT = math.sqrt(2.0 / 3.0)


class Clay(NamedTuple):
    """Elastic moduli, largest equivalent stress and that at first yield, hardening modulus C, each (n,), and initial
    stress (n, 6) [Pa].
    """

    bulk: Array
    shear: Array
    limit: Array
    first: Array
    hardening: Array
    initial: Array


class _Point(NamedTuple):
    """A point that yields: q0, C and 2G [Pa], γ [-], and the step's gain by its rate."""

    first: float
    hardening: float
    twice: float
    recall: float
    gain: Gain


class _Trial(NamedTuple):
    """At Δp: what the left side of the equation for it has more than the right one, by how much that falls with Δp, and
    |η| [Pa]; θ, -dθ/dΔp.
    """

    slip: float
    excess: float
    falls: float
    size: float
    theta: float
    recalls: float


@njit
def bring_within(bound: Array, s: Array) -> None:
    """Shorten deviators (n, 6) whose equivalent stress is beyond a bound (n,) [Pa]."""
    for i in range(len(s)):
        _shorten(bound[i], s[i])


@njit
def _shorten(bound: float, s: Array) -> None:
    q = math.sqrt(1.5 * _product(s, s))
    if q > bound:
        for k in range(6):
            s[k] *= bound / q


@njit
def write_locked_in(hardening: Array, backstress: Array, out: Array) -> None:
    """Write the energy (n,) [J/m3] of backstresses (n, 6)."""
    for i in range(len(out)):
        out[i] = _locked_in(hardening[i], backstress[i])


@njit
def _locked_in(hardening: float, alpha: Array) -> float:
    return 0.75 / hardening * _product(alpha, alpha)


@njit
def update(clay: Clay, gain: Gain, strain: Array, history: Array, out: StressUpdate) -> None:
    """Write the answer to strain increments (n, 6) from a history (n, 13), see `CyclicClay`; what the backstress has
    stored is all of it. Views of rows are costly, so that each point has workspace.
    """
    stress, alpha, s, n = np.empty(6), np.empty(6), np.empty(6), np.empty(6)
    for i in range(len(strain)):
        bulk, shear = clay.bulk[i], clay.shear[i]
        first, hardening, bound = clay.first[i], clay.hardening[i], clay.limit[i] - clay.first[i]
        trial = stretched(3.0 * bulk, 2.0 * shear, _components(strain, i))
        for k in range(6):
            stress[k], alpha[k] = history[i, k] + trial[k], history[i, 7 + k]
            for m in range(6):
                out.tangent[i, k, m] = modulus(bulk, shear, VOLUME[k, m], DEVIATOR[k, m])
        if gain.slow == math.inf:  # the strength, and with it the bound, may have fallen
            _shorten(bound, alpha)
        slip = 0.0
        _write_direction(stress, alpha, s, n)
        if gain.slow > 0.0 and math.sqrt(1.5 * _product(n, n)) > first:
            point = _Point(first, hardening, 2.0 * shear, hardening / bound, gain)
            slip = _bring_back(point, stress, alpha, out.tangent[i], s, n)
        out.history[i, 6] = history[i, 6] + slip
        for k in range(6):
            out.stress[i, k] = out.history[i, k] = stress[k]
            out.elastic[i, k], out.history[i, 7 + k] = stress[k] - clay.initial[i, k], alpha[k]
        elastic = stretched(1.0 / (3.0 * bulk), 1.0 / (2.0 * shear), _components(out.elastic, i))
        out.stored[i] = _locked_in(hardening, alpha)
        for k in range(6):
            out.stored[i] += 0.5 * out.elastic[i, k] * elastic[k]
            out.elastic[i, k] = elastic[k]


@njit
def _components(a: Array, i: int) -> tuple[float, float, float, float, float, float]:
    return a[i, 0], a[i, 1], a[i, 2], a[i, 3], a[i, 4], a[i, 5]


@njit
def _write_direction(stress: Array, alpha: Array, s: Array, n: Array) -> None:
    """Write a stress' deviator, and that beyond the backstress."""
    mean = (stress[0] + stress[1] + stress[2]) / 3.0
    for k in range(6):
        s[k] = stress[k] - (mean if k < 3 else 0.0)
        n[k] = s[k] - alpha[k]


@njit
def _bring_back(point: _Point, stress: Array, alpha: Array, tangent: Array, s: Array, n: Array) -> float:
    """Bring an elastic trial of the stress beyond the yield surface back to it, with its backstress and its elastic
    moduli, which become the consistent ones: Δp. s, n: see `_write_direction`.
    """
    root = _slip(point, s, alpha, n)
    _subtract_flow(point, root, alpha, n, tangent)
    for k in range(6):
        stress[k] -= math.sqrt(1.5) * point.twice * root.slip * n[k]
        alpha[k] = root.theta * (alpha[k] + ROOT * point.hardening * root.slip * n[k])
    return root.slip


@njit
def _slip(point: _Point, s: Array, alpha: Array, n: Array) -> _Trial:
    """Δp by Newton's method, kept where the root is known to lie, for a trial s and backstress α; n: its direction."""
    stiff = math.sqrt(1.5) * point.twice
    low, trial = 0.0, _at(0.0, point, s, alpha, n)
    high = trial.excess / stiff
    if point.gain.slow < math.inf:  # α may be beyond its bound
        high += math.sqrt(_product(alpha, alpha)) / stiff
        trial = _at(min(_guess(point, trial), high), point, s, alpha, n)
    least = max(CONVERGED * high, ROUND_OFF / stiff * trial.size)
    for _ in range(MOST_ITERATIONS):
        better = trial.slip + trial.excess / trial.falls
        if better < low or better > high:
            better = 0.5 * (low + high)
        done = abs(better - trial.slip) <= least
        trial = _at(better, point, s, alpha, n)
        if trial.excess > 0.0:
            low = better
        elif trial.excess < 0.0:
            high = better
        if done:
            break
    return trial


@njit
def _at(slip: float, point: _Point, s: Array, alpha: Array, n: Array) -> _Trial:
    factor, slope = _strength(point.gain, slip)
    y = slip / factor
    theta = 1.0 / (1.0 + point.recall * y)
    for k in range(6):
        n[k] = s[k] - theta * alpha[k]
    size = math.sqrt(_product(n, n))
    for k in range(6):
        n[k] /= size
    stiff = math.sqrt(1.5) * point.twice
    recalls = point.recall * theta**2 * (1.0 - y * slope) / factor
    hardens = point.hardening * theta**2 * (1.0 + point.recall * y**2 * slope) + point.first * slope
    falls = stiff + ROOT * hardens - recalls * _product(n, alpha)
    excess = size - ROOT * (factor * point.first + point.hardening * theta * slip) - stiff * slip
    return _Trial(slip, excess, falls, size, theta, recalls)


@njit
def _strength(gain: Gain, slip: float) -> tuple[float, float]:
    """Strength over that of slow shear at a Δp, and its derivative."""
    if slip > gain.slow:
        return 1.0 + gain.by_e * math.log(slip / gain.slow), gain.by_e / slip
    return 1.0, 0.0


@njit
def _guess(point: _Point, at_none: _Trial) -> float:
    """Δp of a fast step as if nothing but the rate hardened, roughly; at_none: where Δp is 0."""
    gain, slip = point.gain, max(at_none.excess, 0.0) / at_none.falls
    if slip <= gain.slow:
        return slip
    scale = gain.by_e * point.first * ROOT / at_none.falls
    x = slip / scale + math.log(gain.slow / scale)
    if x < 1.0:
        return scale * (math.exp(x) if x < -2.0 else math.exp(2.0 / 3.0 * (x - 1.0)))
    return scale * (x - math.log(x))


@njit
def _subtract_flow(point: _Point, root: _Trial, alpha: Array, n: Array, tangent: Array) -> None:
    """From elastic moduli, to the consistent ones: dΔp = 2G n:dε/h; the direction turns with the strain and with what
    the backstress recalls, by b = 2G P dε + recall α dΔp across n, over |η|.
    """
    along, stiff = _product(n, alpha), math.sqrt(1.5) * point.twice
    share = stiff * root.slip / root.size
    for i in range(6):
        turns = n[i] + root.slip / root.size * root.recalls * (alpha[i] - along * n[i])
        flow = point.twice * (stiff / root.falls * turns - share * n[i])
        for j in range(6):
            tangent[i, j] -= share * point.twice * DEVIATOR[i, j] + flow * n[j]


@njit
def _product(a: Array, b: Array) -> float:
    total = 0.0
    for k in range(6):
        total += a[k] * b[k]
    return total
