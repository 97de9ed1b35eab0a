"""Slip lines below a strip against Prandtl, equilibrium, a published fit; the soil's collapse load against them."""

from __future__ import annotations

from math import cos, pi, sin, sqrt, tan
from typing import NamedTuple

import numpy as np
import pytest
from scipy.interpolate import CubicSpline, lagrange

from riser_soil.core.arrays import Array
from tests.support.pages import Tell, signed_percent
from tests.support.strip import CLAY, SU, press_graded_strip

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


PRANDTL = 2.0 + np.pi


def test_slip_lines_of_constant_strength_are_prandtls() -> None:
    below = np.array([line[-1] for line in field(10, 1.0, SMOOTH, k=0.0)])
    np.testing.assert_allclose(below[:, 2] + 1.0, PRANDTL, rtol=1e-13)
    np.testing.assert_allclose(below[:, 0], -np.linspace(0.0, 1.0, 11), atol=1e-13)


@pytest.mark.parametrize("at_strip", [SMOOTH, ROUGH], ids=["smooth", "rough"])
def test_slip_lines_are_in_equilibrium(at_strip: float) -> None:
    """What the strip loads passes through the field's last line: nothing through the free surface."""
    missing = np.array([_unbalanced(lines, at_strip) for lines in (10, 20, 40)])
    assert np.all(missing[-1] < 1e-3)
    assert np.all(np.log2(missing[:-1] / missing[1:]) > 1.8)


def _unbalanced(lines: int, at_strip: float) -> float:
    """Difference of the forces through the strip and through the last line, over the strip's load."""
    rows = field(lines, 1.5, at_strip)
    strip, last = (forces(np.array(points)).sum(axis=0) for points in ([line[-1] for line in rows], rows[-1]))
    return float(np.linalg.norm(strip - last) / strip[1])


@pytest.mark.parametrize("rough", [False, True], ids=["smooth", "rough"])
@pytest.mark.parametrize("ratio", [2.0, 6.0])
def test_bearing_factor_converges_at_second_order(ratio: float, rough: bool) -> None:
    coarse, middle, fine = (bearing_factor(ratio, rough, lines) for lines in (10, 20, 40))
    assert 1.8 < np.log2((coarse - middle) / (middle - fine)) < 2.5
    assert abs(middle - fine) < 5e-4


@pytest.mark.parametrize("ratio", [0.5, 2.0, 6.0, 10.0])
def test_bearing_factor_is_near_a_published_fit(ratio: float) -> None:
    """API RP 2GEO (2011), equation A.17, with the coefficients that groundhog's capacity.py has for it."""
    smooth = 1.372 + 0.07 * ratio - np.hypot(0.07 * ratio - 0.128, 0.342)
    rough = 2.56 + 0.457 * ratio - np.hypot(0.457 * ratio + 0.713, 1.38)
    assert bearing_factor(ratio, False, 20) == pytest.approx(smooth, rel=0.015)
    assert bearing_factor(ratio, True, 20) == pytest.approx(rough, rel=0.015)


@pytest.mark.verify
@pytest.mark.parametrize("rough", [False, True], ids=["smooth", "rough"])
@pytest.mark.parametrize("ratio", [2.0, 6.0])
def test_strip_on_clay_that_grows_stronger_bears_what_slip_lines_tell(tell: Tell, ratio: float, rough: bool) -> None:
    """V/B = F ((2 + π) su0 + k B/4), B = 2 m: from above, at about first order in the cells below it."""
    law = CLAY.model_copy(update={"su_gradient": ratio * SU / 2.0})
    exact = bearing_factor(ratio, rough, 40) * (PRANDTL + 0.25 * ratio)
    sizes = 1.0 / 16.0, 1.0 / 32.0
    pressed = [press_graded_strip(size, 0.25, law, rough=rough, fine=1.0, depth=0.1) for size in sizes]
    errors = np.array([strip.load[-1] for strip in pressed]) / exact - 1.0
    rate, extrapolated = np.log2(errors[0] / errors[1]), 2.0 * errors[1] - errors[0]
    row = f"{signed_percent(errors)} | {rate:.1f} | {signed_percent([extrapolated])}"
    tell({f"growing {ratio:g} {'rough' if rough else 'smooth'}": row})
    assert pressed[1].load[-1] - pressed[1].load[-2] < 1e-3 * exact, "the load still rises"
    assert 0.0 < errors[1] < (0.05 if rough else 0.02)
    assert rate > 0.65
    assert abs(extrapolated) < 0.015
