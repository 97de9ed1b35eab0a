"""Slip lines below a rigid strip on weightless undrained clay whose strength grows with depth: its exact collapse load.

V/B = F ((2 + π) su0 + k B/4), c(z) = su0 + k z, B the strip's width, F a function of k B/su0 and of the strip's
roughness (Davis & Booker, The effect of increasing strength with depth on the bearing capacity of clays, Géotechnique
23, 1973). The equations, derived here anew: with p the mean of the stresses in the plane (compression positive) and
ψ the angle from x (outwards) towards z (downwards) of the greater one,

    σx = p + c cos 2ψ,  σz = p − c cos 2ψ,  τ = c sin 2ψ,

the two equations of equilibrium, added along the directions ψ ∓ π/4, become

    dp − 2c dψ + k dx = 0  along the first family (a),      dp + 2c dψ − k dx = 0  along the second (b).

Both are integrated by the trapezoidal rule and lines are chords at the mean of their ends' directions: second order.

The field grows from the strip's edge, the origin, over the free surface, x > 0 (p = su0, ψ = 0), and below the strip,
x < 0. Below a smooth strip ψ = π/2. A rough one lies on a wedge that moves with it, bounded by a line of family b from
the strip to the plane of symmetry, which it meets at ψ = π/2; that line starts at the edge or, beyond k B/su0 = 1.2,
within the strip, and outside of it the soil slides along the strip, τ = su0, ψ = 3π/4. One field holds the fields of
all narrower strips, so it is made once and the width read from it. Lengths in su0/k, stresses in su0.
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt, tan
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline, lagrange

from riser_soil.core.arrays import Array

SMOOTH, ROUGH = 0.5 * pi, 0.75 * pi  # ψ at a strip that the soil slides along
WIDEST = 25.0  # k B/su0 up to which the field is known to reach


class Point(NamedTuple):
    """A crossing of two slip lines, and the stress there."""

    x: float
    z: float
    p: float
    psi: float


Line = list[Point]  # of family a, from the free surface to the strip


def bearing_factor(ratio: float, rough: bool, lines: int) -> float:
    """F at ratio = k B/su0, from `lines` slip lines of either family; its error goes with 1/lines²."""
    if not 0.0 < ratio <= WIDEST:
        raise ValueError(f"k B/su0 = {ratio:g}: between 0 and {WIDEST:g}")
    reach = 0.9 * sqrt(ratio)
    half_widths, loads = rough_strips(lines, reach) if rough else smooth_strips(lines, reach)
    load = float(CubicSpline(half_widths, loads)(0.5 * ratio))
    return load / (0.5 * ratio) / (2.0 + pi + 0.25 * ratio)


def smooth_strips(lines: int, reach: float) -> tuple[Array, Array]:
    """Half widths (n,), from 0 on, of smooth strips and the load of either half; reach: of free surface that yields."""
    strip = np.array([line[-1] for line in field(lines, reach, SMOOTH)])
    return -strip[:, 0], _cumulated(strip)


def rough_strips(lines: int, reach: float) -> tuple[Array, Array]:
    """Bearing of rough strips: each line of family b that comes to ψ = π/2 bounds the wedge of one."""
    points = field(lines, reach, ROUGH)
    beside = _cumulated(np.array([line[-1] for line in points]))  # what the strip bears where the soil slides along it
    strips = [(0.0, 0.0)]
    for ray in range(1, lines + 1):
        strips += _wedge(np.array([line[number + ray] for number, line in enumerate(points)]), 0.0)
    for first in range(1, lines):
        below = [line[lines + first + number] for number, line in enumerate(points) if number >= first]
        strips += _wedge(np.array(below), beside[first])
    half_widths, loads = np.array(strips).T
    return half_widths, loads


def field(lines: int, reach: float, at_strip: float, k: float = 1.0) -> list[Line]:
    """Lines of family a, the first of them the fan's rays at the edge; point j of one lies on the line of family b
    through point j − 1 of the line before it.
    """
    fan = [Point(0.0, 0.0, 1.0 + 2.0 * psi, psi) for psi in np.linspace(0.0, at_strip, lines + 1)]
    rows = [fan]
    for x in np.linspace(0.0, reach, lines + 1)[1:]:
        line = [Point(float(x), 0.0, 1.0, 0.0)]
        for inner in rows[-1]:
            line.append(_crossing(line[-1], inner, k))
        line.append(_at_strip(line[-1], at_strip, k))
        rows.append(line)
    return rows


def _crossing(a: Point, b: Point, k: float) -> Point:
    """Where the line of family a through one point meets that of family b through the other."""
    x, z, psi = 0.5 * (a.x + b.x), 0.5 * (a.z + b.z), 0.5 * (a.psi + b.psi)
    for _ in range(50):
        along_a, along_b = 2.0 + k * (a.z + z), 2.0 + k * (b.z + z)  # 2c, the mean of both ends
        turns = b.p - a.p + along_a * a.psi + along_b * b.psi + k * (2.0 * x - a.x - b.x)
        before, psi = (x, z, psi), turns / (along_a + along_b)
        x, z = _meet(a, 0.5 * (a.psi + psi) - 0.25 * pi, b, 0.5 * (b.psi + psi) + 0.25 * pi)
        if abs(x - before[0]) + abs(z - before[1]) + abs(psi - before[2]) < 1e-13 * (1.0 + abs(x) + z):
            break
    return Point(x, z, a.p + (2.0 + k * (a.z + z)) * (psi - a.psi) - k * (x - a.x), psi)


def _meet(a: Point, direction_a: float, b: Point, direction_b: float) -> tuple[float, float]:
    """Where two straight lines meet."""
    along = (b.x - a.x) * sin(direction_b) - (b.z - a.z) * cos(direction_b)
    along /= sin(direction_b - direction_a)
    return a.x + along * cos(direction_a), a.z + along * sin(direction_a)


def _at_strip(a: Point, psi: float, k: float) -> Point:
    """Where the line of family a through a point ends at the strip."""
    x = a.x - a.z / tan(0.5 * (a.psi + psi) - 0.25 * pi)
    return Point(x, 0.0, a.p + (2.0 + k * a.z) * (psi - a.psi) - k * (x - a.x), psi)


def _cumulated(points: Array, k: float = 1.0) -> Array:
    """Downward force (n,) through the chords between points (n, 4) of a line, summed up from the first on."""
    return np.concatenate(([0.0], np.cumsum(forces(points, k)[:, 1])))


def forces(points: Array, k: float = 1.0) -> Array:
    """Force (n − 1, 2) outwards and downwards through each chord of a line (n, 4), on the soil to its left."""
    x, z, p, psi = points.T
    c = 1.0 + k * z
    stress = np.array([p + c * np.cos(2.0 * psi), c * np.sin(2.0 * psi), p - c * np.cos(2.0 * psi)])
    along, shear, upright = 0.5 * (stress[:, 1:] + stress[:, :-1])
    dx, dz = np.diff(x), np.diff(z)
    return np.stack([along * dz - shear * dx, shear * dz - upright * dx], axis=1)


def _wedge(line: Array, outside: float) -> list[tuple[float, float]]:
    """Half width and load of the strip whose wedge a line (n, 4) of family b bounds; none if it ends before ψ = π/2.

    outside: load of the strip between its edge and the line's start.
    """
    psi = line[:, 3]
    if not psi[0] > SMOOTH > psi[-1]:
        return []
    load = outside + _cumulated(line)
    first = max(0, min(int(np.argmax(psi <= SMOOTH)) - 2, len(psi) - 4))
    near = slice(first, first + 4)
    x, load_there = (float(lagrange(psi[near] - SMOOTH, values[near])(0.0)) for values in (line[:, 0], load))
    return [(-x, load_there)]
