"""Regular waves of finite height, which run without changing shape: coefficients of potential and surface, by raschii.

In water of depth h a wave of height H and wave number k runs with the speed c. With theta = k (s - c t),

    surface   sum of E_j cos j theta
    velocity  sum of D_j (exp(j k z) + exp(-j k (z + 2 h))) cos j theta along s,
              sum of D_j (exp(j k z) - exp(-j k (z + 2 h))) sin j theta upwards,

z being the height above the mean surface: an exact solution of Laplace's equation over the bed, whatever the D_j, which
each theory finds from the conditions at the surface. The mean velocity at a fixed place below all troughs is zero
(Stokes's first definition of c). Sources: Fenton, Journal of Waterway, Port, Coastal and Ocean Engineering 111,
1985, 216-234, for the fifth order of Stokes's theory; Rienecker and Fenton, Journal of Fluid Mechanics 104, 1981,
119-137, for stream functions; both by the library raschii of T. Landet, which is asked in units of g T^2/2 pi.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.sea.components import wave_number

AIRY, STOKES, STREAM = "airy", "stokes", "stream-function"
FIFTH = 5
ORDERS = (20, 40)  # of stream functions, the first of them whose last term is small
LAST_TERM, ROUGH = 1e-6, 1e-3  # of the velocity in the crest, over all of it: small enough, and bearable near breaking
DEEP = 2.0  # lengths of the wave: deeper water is as deep, to 3e-11
SECOND = 0.01  # second harmonic over the first, below which `choose` takes linear theory
STEEP_STOKES, LONG_STOKES = 0.6, 10.0  # of the highest wave; Ursell's number: up to which it takes the fifth order
LONGEST_STOKES = 40.0  # Ursell's number beyond which Stokes's series is of no use
LONGER = (1.0, 1.05, 1.1, 1.2, 1.3)  # first lengths that are tried, over that of linear theory
ITERATIONS, CLOSE = 30, 1e-9  # to the period, and how near


class SteadyWave(NamedTuple):
    """theory: name; k [rad/m]; w [rad/s]; speed D (m,) [m/s]; rise E (m,) [m]; depth h [m], which may be inf."""

    theory: str
    k: float
    w: float
    speed: Array
    rise: Array
    depth: float

    @property
    def length(self) -> float:
        """Length from crest to crest [m]."""
        return 2.0 * math.pi / self.k

    @property
    def crest(self) -> float:
        """Height of the crest above the mean surface [m]."""
        return float(self.rise.sum())

    @property
    def trough(self) -> float:
        """Depth of the trough below the mean surface [m]."""
        return float(-np.sum(self.rise * (-1.0) ** np.arange(1, self.rise.size + 1)))


@cache
def steady_wave(theory: str, H: float, T: float, g: float, h: float) -> SteadyWave:
    """The wave of height H [m] and period T [s] in water of depth h [m], which may be inf.

    theory: stokes, stream-function, or auto, see `choose`. SceneError, by the key that is wrong, where there is none.
    """
    unit = g * T * T / (2.0 * math.pi)
    chosen = choose(H / unit, h / unit) if theory == "auto" else theory
    if chosen == STOKES:
        _refuse_long(H / unit, h / unit)
    try:
        k, speed, rise = _THEORIES[chosen](H / unit, h / unit)
    except _NoWaveError as err:
        most = unit * highest(linear_length(h / unit) * LONGER[-2], h / unit)
        which = f"waves of {T:g} s" + (f" in {h:g} m of water" if math.isfinite(h) else "")
        raise SceneError(
            f"height: {H:g} m is too high: {which} break at some {most:.3g} m; lower it, or lengthen it"
        ) from err
    return SteadyWave(chosen, k / unit, 2.0 * math.pi / T, speed * unit / T, rise * unit, h)


def choose(H: float, h: float) -> str:
    """The theory for a wave of height H in depth h, both over g T^2/2 pi.

    Linear where the second harmonic of Stokes's surface is below SECOND: in deep water H/g T^2 = 0.001, where
    Le Mehaute (1976) draws the line. The fifth order of Stokes where Ursell's number is at most LONG_STOKES and the
    height at most STEEP_STOKES of the highest wave's: there its velocity under the crest is within 0.3 % of the stream
    function's. It is useless above 40 (Hedges, Proceedings of the ICE: Water, Maritime and Energy 112, 1995, 111-114).
    Else the stream function, which knows no other bound than breaking.
    """
    L = linear_length(h)
    coth = 1.0 / math.tanh(2.0 * math.pi * h / L)
    if math.pi * H / L / 4.0 * coth * (3.0 * coth * coth - 1.0) <= SECOND:
        return AIRY
    low = STEEP_STOKES * highest(L, h)
    return STOKES if low >= H and ursell(H, L, h) <= LONG_STOKES else STREAM


def linear_length(h: float) -> float:
    """Length of small waves in depth h, both over g T^2/2 pi."""
    return 2.0 * math.pi / float(wave_number(np.array([2.0 * math.pi]), 2.0 * math.pi, h)[0])


def ursell(H: float, L: float, h: float) -> float:
    """Ursell's number H L^2/h^3."""
    return H * L * L / h**3


def highest(L: float, h: float) -> float:
    """Height of the highest wave of length L in depth h: Fenton's fit (1990) to Williams's (1981) computed waves."""
    x = L / min(h, 100.0 * L)
    over = 0.141063 * x + 0.0095721 * x**2 + 0.0077829 * x**3
    return L / x * over / (1.0 + 0.0788340 * x + 0.0317567 * x**2 + 0.0093407 * x**3)


class _NoWaveError(Exception):
    """There is no such wave."""


def _refuse_long(H: float, h: float) -> None:
    if (number := ursell(H, linear_length(h), h)) > LONGEST_STOKES:
        problem = (
            f"Ursell's number H L^2/h^3 = {number:.3g} is above {LONGEST_STOKES:g}: the water is too shallow for it"
        )
        raise SceneError(f"theory: stokes: {problem}; take stream-function or auto")


def _airy(H: float, h: float) -> tuple[float, Array, Array]:
    k = 2.0 * math.pi / linear_length(h)
    a = 0.5 * H
    return k, np.array([a * 2.0 * math.pi / -math.expm1(-2.0 * k * h)]), np.array([a])


def _stokes(H: float, h: float) -> tuple[float, Array, Array]:
    from raschii import StokesWave

    h = _at_most_deep(h)
    wave = _of_period(partial(StokesWave, H, h, N=FIFTH, g=2.0 * math.pi), H, h)
    k, of, e, j = wave.k, wave.data, 0.5 * wave.k * H, np.arange(1, FIFTH + 1)
    potential = np.array([sum(e**i * of.get(f"A{i}{n}", 0.0) for i in j) for n in j])
    speed = 0.5 * of["C0"] * math.sqrt(2.0 * math.pi / k) * j * potential * np.exp(j * k * h)
    first = e + e**3 * of["B31"] - e**5 * (of["B53"] + of["B55"])
    second, third = e**2 * of["B22"] + e**4 * of["B42"], e**5 * of["B53"] - e**3 * of["B31"]
    return k, speed, np.array([first, second, third, e**4 * of["B44"], e**5 * of["B55"]]) / k


def _stream(H: float, h: float) -> tuple[float, Array, Array]:
    from raschii import FentonWave

    h, series = _at_most_deep(h), None
    for N in ORDERS:
        try:
            wave = _of_period(partial(FentonWave, H, h, N=N, g=2.0 * math.pi, relax=1.0), H, h)
        except _NoWaveError:
            break
        series = _of_stream(wave, h)
        if _last_term(*series) <= LAST_TERM:
            return series
    if series is None or _last_term(*series) > ROUGH:
        raise _NoWaveError
    return series


def _of_stream(wave: Any, h: float) -> tuple[float, Array, Array]:
    B, k = wave.data["B"][1:], wave.k
    j = np.arange(1, B.size + 1)
    return k, j * k * B / (1.0 + np.exp(-2.0 * j * k * h)), _cosines(wave.eta)


def _last_term(k: float, speed: Array, rise: Array) -> float:
    """Share of the series' last term in the velocity at the crest."""
    terms = speed * np.exp(np.arange(1, speed.size + 1) * k * rise.sum())
    return float(abs(terms[-1] / terms.sum()))


def _cosines(eta: Array) -> Array:
    """Harmonics (m,), without the mean, of a surface (m + 1,) at even steps from crest to trough."""
    m = eta.size - 1
    ends = np.where((np.arange(m + 1) % m) == 0, 0.5, 1.0)
    turns = np.cos(np.outer(np.arange(m + 1), np.arange(m + 1)) * math.pi / m)
    return np.asarray((2.0 / m * ends * (turns @ (ends * eta)))[1:])


def _at_most_deep(h: float) -> float:
    return min(h, DEEP * linear_length(h))


def _of_period(make: Callable[[float], Any], H: float, h: float) -> Any:
    """The wave whose period is 1, by secants on its length; `_NoWaveError` where there is none."""
    first, linear = None, linear_length(h)
    for length in LONGER:
        first = first or _possible(make, H, h, length * linear)
    a, b = first, first and _possible(make, H, h, first.length * (1.1 - 0.1 * _period(first)))
    for _ in range(ITERATIONS):
        if a is None or b is None:
            break
        if abs(_period(b) - 1.0) <= CLOSE:
            return b
        rate = (_period(b) - _period(a)) / (b.length - a.length)
        if not rate > 0.0:
            break
        a, b = b, _possible(make, H, h, b.length + (1.0 - _period(b)) / rate)
    raise _NoWaveError


def _possible(make: Callable[[float], Any], H: float, h: float, length: float) -> Any:
    """The wave of this length, or None where it would break or the iteration does not converge."""
    from raschii import NonConvergenceError

    if highest(length, h) < H:
        return None
    try:
        return make(length)
    except (NonConvergenceError, np.linalg.LinAlgError, OverflowError):
        return None


def _period(wave: Any) -> float:
    return float(wave.length / wave.c)


_THEORIES = {AIRY: _airy, STOKES: _stokes, STREAM: _stream}
