"""Sums of waves as Taylor series about places of a fixed grid, so that a point costs no sum over the components.

The waves of one direction move the water in a plane: s along the direction, z up from the mean surface. With theta
being a component's phase at s = 0 in water of depth h, velocity and acceleration are of the form

    u + i w = V + conjugate of M,
    V = sum of G exp(k (z + i s) + i theta),     M = sum of G exp(k (-2 h - z + i s) + i theta),

M being V mirrored at the bottom. Both are exponentials of k x, with x = dz + i ds in V and -dz + i ds in M, about any
place. So there V is the series

    sum over n < ORDER of c_n x^n,     c_n = sum of (G exp(k (z + i s) + i theta) at the place) k^n/n!,

likewise M, and, in i ds, the surface. du/dz + i dw/dz follow from dV/dx, and d/ds = i d/dz without divergence and curl.
Of the factors at a place only exp(i theta), which all places share, changes in time.

The places are the middles of squares. At the surface their side is such that k |x| < RADIUS for the shortest wave: the
remainder is below RADIUS^ORDER/ORDER! = 5e-15 of each component. With depth their sides double, where NEAREST of the
larger ones fit in above: the remainder exp(k z) (k |x|)^ORDER/ORDER!, largest for k z = -ORDER, is then below 2e-15.
The surface is asked for above all points, however deep: its strips are wider, with SURFACE_RADIUS and SURFACE_ORDER, so
that there are few of them. Their remainder is below 1e-16, their round-off that of exp(SURFACE_RADIUS), 1e-14.

A series hangs on its place and the time alone. It is computed when a point lies there, and again at another time; so
nothing hangs on what was evaluated before, and there is nothing to save.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, ComplexArray, IntArray
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.rows import add_multiple, add_shares, two_polynomials
from riser_soil.sea.components import Components

ORDER = 20
RADIUS = 1.6
SURFACE_ORDER, SURFACE_RADIUS = 32, 4.0
NEAREST = 3
DEEPEST = 30.0  # k d beyond which a component is left out at depth d: it has decayed to 1e-13 of what it is above
LEVELS = 64
MOST, MEMORY = 8192, 1 << 25  # places kept at most, and bytes for the components' motion there
HALF = SURFACE_ORDER // 2
WHOLE, EVEN, FOUR = fixed(ORDER), fixed(HALF), fixed(4)
_SPREAD = 0x1E3779B97F4A7C15  # a large odd number, by which neighbouring keys are scattered over the table


class SeriesAt(NamedTuple):
    """Series of one or several sums at places. motion: (workspace, sums, m, 2) the components but for exp(i theta), as
    real and imaginary part; alive: (workspace, sums) how many of them count; c: times powers of `side`, see
    `WaveSeries`.
    """

    places: Places
    motion: Array
    alive: IntArray
    c: Array


class WaveSeries(NamedTuple):
    """Series of waves. side: of the squares at the surface [m]; powers: (m, ORDER) (k side)^n/n!. strip: width of the
    surface's strips [m]; split: (m, 2, HALF) even and odd (k strip)^n/n! times i^n, without the i of the odd ones.

    columns: of the surface, one for each strip of the sea, c (workspace, 2, HALF) even and odd. cells: of the flow; two
    sums, V and M, c (workspace, 2, ORDER, 4) real and imaginary part of velocity and of acceleration.
    """

    side: float
    powers: Array
    strip: float
    split: Array
    columns: SeriesAt
    cells: SeriesAt


class PlaneFlow(NamedTuple):
    """Velocity or acceleration u + i w at points (n,), u along the waves and w up, and its derivative by z."""

    value: ComplexArray
    by_z: ComplexArray


class Cell(NamedTuple):
    """A square of the grid: a number that is its own, its middle s and depth d, and half its side [m]."""

    key: int
    s: float
    d: float
    half: float


def wave_series(waves: WaveTrain) -> WaveSeries:
    """Series of a train's waves, none computed yet."""
    m, shortest = waves.k.size, float(waves.k.max())
    side, strip = sqrt(2.0) * RADIUS / shortest, 2.0 * SURFACE_RADIUS / shortest
    along = _powers(strip * waves.k, SURFACE_ORDER)
    split = np.stack([along[:, ::2], along[:, 1::2]], axis=1) * (-1.0) ** np.arange(HALF)
    columns, cells = _workspace(m, 1, (2, HALF)), _workspace(m, 2, (2, ORDER, 4))
    return WaveSeries(side, _powers(side * waves.k, ORDER), strip, split, columns, cells)


def _powers(x: Array, count: int) -> Array:
    """x^n/n! (m, count) of x (m,)."""
    return np.concatenate([np.ones((x.size, 1)), np.cumprod(x[:, None] / np.arange(1.0, count), axis=1)], axis=1)


def _workspace(m: int, sums: int, series: tuple[int, ...]) -> SeriesAt:
    capacity = min(MOST, MEMORY // (16 * m * sums) + 1)
    alive = np.empty((capacity, sums), np.int64)
    return SeriesAt(places(capacity), np.empty((capacity, sums, m, 2)), alive, np.empty((capacity, *series)))


@njit
def surface(of: WaveSeries, waves: WaveTrain, t: float, g: int, s: Array) -> tuple[Array, Array]:
    """Rise of the surface by the waves of direction g at s (n,) [m], and its slope along s; the train's time is t."""
    rise, slope, last, place = np.empty(s.size), np.empty(s.size), 0, -1
    for p in range(s.size):
        column = int(np.floor(s[p] / of.strip))
        s0 = (column + 0.5) * of.strip
        if place < 0 or column != last:
            last, place = column, number(of.columns.places, column * len(waves.toward) + g)
            if of.columns.places.time[place] != t:
                _sum_surface(of, waves, g, place, s0)
                of.columns.places.time[place] = t
        value, by_x = _at_surface(of.columns.c, place, (s[p] - s0) / of.strip)
        rise[p], slope[p] = value, by_x / of.strip
    return rise, slope


@njit
def flow(of: WaveSeries, waves: WaveTrain, t: float, g: int, s: Array, z: Array) -> tuple[PlaneFlow, PlaneFlow]:
    """Velocity and acceleration by the waves of direction g at s (n,) and z <= 0 (n,) [m]; the train's time is t."""
    velocity, acceleration, last, place = _at_rest(s.size), _at_rest(s.size), 0, -1
    for p in range(s.size):
        if waves.k[waves.first[g]] * -z[p] > DEEPEST:
            continue
        cell = _cell(of.side, s[p], -z[p])
        if place < 0 or cell.key != last:
            last, place = cell.key, number(of.cells.places, cell.key * len(waves.toward) + g)
            if of.cells.places.time[place] != t:
                _sum_flow(of, waves, g, place, cell)
                of.cells.places.time[place] = t
        v, a, v_x, a_x = _in_cell(of.cells, place, (z[p] + cell.d) / of.side, (s[p] - cell.s) / of.side)
        velocity.value[p], velocity.by_z[p] = v, v_x / of.side
        acceleration.value[p], acceleration.by_z[p] = a, a_x / of.side
    return velocity, acceleration


@njit
def _at_rest(n: int) -> PlaneFlow:
    return PlaneFlow(np.zeros(n, np.complex128), np.zeros(n, np.complex128))


@njit
def _cell(side: float, s: float, d: float) -> Cell:
    """The square around s and depth d; side: of those at the surface [m]."""
    level, rows = 0, 2 * NEAREST
    while d >= rows * side and level < LEVELS - 1:
        side, level = 2.0 * side, level + 1
    column, row = int(np.floor(s / side)), min(int(d / side), rows - 1)
    return Cell((column * LEVELS + level) * rows + row, (column + 0.5) * side, (row + 0.5) * side, 0.5 * side)


@njit
def _at_surface(c: Array, place: int, x: float) -> tuple[float, float]:
    """The surface and its derivative at x, by Horner's rule for even and odd powers."""
    even, by_even, odd, by_odd, square = 0.0, 0.0, 0.0, 0.0, x * x
    for n in range(HALF - 1, -1, -1):
        by_even, even = by_even * square + even, even * square + c[place, 0, n]
        by_odd, odd = by_odd * square + odd, odd * square + c[place, 1, n]
    return even + x * odd, odd + 2.0 * x * (by_even + x * by_odd)


@njit
def _in_cell(of: SeriesAt, place: int, x: float, y: float) -> tuple[complex, complex, complex, complex]:
    """Velocity and acceleration at x + i y, and their derivatives; the mirror's where it counts."""
    at = 2 * place * 4 * ORDER
    u, w, p, q, u_x, w_x, p_x, q_x = two_polynomials(of.c, at, x, y, WHOLE)
    if of.alive[place, 1] == 0:
        return complex(u, w), complex(p, q), complex(u_x, w_x), complex(p_x, q_x)
    mu, mw, mp, mq, mu_x, mw_x, mp_x, mq_x = two_polynomials(of.c, at + 4 * ORDER, -x, y, WHOLE)
    values = complex(u + mu, w - mw), complex(p + mp, q - mq)
    return (*values, complex(u_x - mu_x, w_x + mw_x), complex(p_x - mp_x, q_x + mq_x))


@njit
def _sum_surface(of: WaveSeries, waves: WaveTrain, g: int, place: int, s: float) -> None:
    at, c = of.columns, of.columns.c
    if np.isnan(at.places.time[place]):
        _settle(at, waves, g, place, 0, waves.amplitude, Cell(0, s, 0.0, 0.0))
    c[place] = 0.0
    for j in range(waves.first[g], waves.first[g + 1]):
        value, to, given = _now(at.motion, place, 0, j, waves.turned), 2 * HALF * place, 2 * HALF * j
        add_multiple(c, to, value.real, of.split, given, EVEN)
        add_multiple(c, to + HALF, -value.imag, of.split, given + HALF, EVEN)


@njit
def _sum_flow(of: WaveSeries, waves: WaveTrain, g: int, place: int, cell: Cell) -> None:
    at, c = of.cells, of.cells.c
    mirrored = Cell(cell.key, cell.s, 2.0 * waves.depth - cell.d, cell.half)
    if np.isnan(at.places.time[place]):
        _settle(at, waves, g, place, 0, waves.speed, cell)
        _settle(at, waves, g, place, 1, waves.speed, mirrored)
    c[place] = 0.0
    for k in range(2):
        for j in range(waves.first[g], waves.first[g] + at.alive[place, k]):
            v = _now(at.motion, place, k, j, waves.turned)
            a = complex(waves.w[j] * v.imag, -waves.w[j] * v.real)
            both, to = (v.real, v.imag, a.real, a.imag), (2 * place + k) * 4 * ORDER
            for n in range(0, ORDER, 4):
                add_shares(c, to + 4 * n, of.powers, j * ORDER + n, both, FOUR)


@njit
def _settle(at: SeriesAt, waves: WaveTrain, g: int, place: int, k: int, size: Array, cell: Cell) -> None:
    """The components of sum k at a place, but for exp(i theta), as long as they count within its square."""
    at.alive[place, k] = 0
    for j in range(waves.first[g], waves.first[g + 1]):
        if waves.k[j] * (cell.d - cell.half) > DEEPEST:
            break
        here, angle = size[j] * np.exp(-waves.k[j] * cell.d), waves.k[j] * cell.s
        at.motion[place, k, j, 0], at.motion[place, k, j, 1] = here * np.cos(angle), here * np.sin(angle)
        at.alive[place, k] += 1


@njit
def _now(motion: Array, place: int, k: int, j: int, turned: Array) -> complex:
    """A component of sum k at a place and the train's time."""
    return complex(motion[place, k, j, 0], motion[place, k, j, 1]) * complex(turned[j, 0], turned[j, 1])


class Places(NamedTuple):
    """Workspace for n places. key: (n,). time: (n,) a time for which something is known there [s]; nan where the place
    is new. used: (1,) how many are in use. table: (a power of two, at least 2 n) their numbers where their keys lead
    to, or -1.
    """

    key: IntArray
    time: Array
    used: IntArray
    table: IntArray


def places(n: int) -> Places:
    """Workspace for n places, none in use."""
    size = 1 << (2 * n - 1).bit_length()
    return Places(np.empty(n, np.int64), np.empty(n), np.zeros(1, np.int64), np.full(size, -1))


@njit
def number(at: Places, key: int) -> int:
    """Number of the place of this key. Where there is no room for a new one, all others are forgotten."""
    mask = at.table.size - 1
    slot = ((key * _SPREAD) >> 24) & mask
    while at.table[slot] >= 0:
        if at.key[at.table[slot]] == key:
            return at.table[slot]
        slot = (slot + 1) & mask
    if at.used[0] == at.key.size:
        at.used[0] = 0
        at.table[:] = -1
    new = at.used[0]
    at.used[0], at.table[slot], at.key[new], at.time[new] = new + 1, new, key, np.nan
    return new


class WaveTrain(NamedTuple):
    """Components (m,) by direction, and by increasing wave number k [rad/m] within each of the g directions.

    first: (g + 1,) the first component of each direction, and m. toward: (g, 2) unit vectors. amplitude [m], w [rad/s],
    phase [rad]. speed: a w/(1 - exp(-2 k h)) [m/s]. turned: (m, 2) cosine and sine of phase - w t at the time that the
    train has been brought to. depth: h [m], which may be inf.
    """

    first: IntArray
    toward: Array
    amplitude: Array
    w: Array
    k: Array
    phase: Array
    speed: Array
    turned: Array
    depth: float


def train(waves: Components, h: float) -> WaveTrain:
    """The components prepared for water of depth h [m]."""
    a, w, k, d, phase = (part[np.lexsort((waves.wave_number, waves.direction))] for part in waves)
    directions, first = np.unique(d, return_index=True)
    toward = np.stack([np.cos(directions), np.sin(directions)], axis=-1)
    speed = a * w / -np.expm1(-2.0 * k * h)
    return WaveTrain(np.append(first, k.size), toward, a, w, k, phase, speed, np.full((k.size, 2), np.nan), h)


@njit
def turn(waves: WaveTrain, t: float) -> None:
    """Bring the train to a time of its clock [s]."""
    for j in range(waves.k.size):
        angle = waves.phase[j] - np.remainder(waves.w[j] * t, 2.0 * np.pi)
        waves.turned[j, 0], waves.turned[j, 1] = np.cos(angle), np.sin(angle)
