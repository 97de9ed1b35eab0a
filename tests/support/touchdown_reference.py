"""A riser at rest on a level floor as a boundary value problem: references that share no formula with the elements.

Extensible elastica, s the unstressed arc from the anchor on the floor, theta the slope, M = EI theta' the moment, H the
horizontal force, V the vertical force that the part beyond s exerts, all in a vertical plane:

    T = H cos(theta) + V sin(theta),   e = 1 + T/EA,   x' = e cos(theta),   z' = e sin(theta),
    M' = e (H sin(theta) - V cos(theta)),   V' = w - f(z),

f the floor's force per length. Both ends are pinned: M = 0.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.integrate import solve_bvp
from scipy.optimize import brentq, minimize_scalar

from riser_soil.core.arrays import Array

TOLERANCE = 1e-8


@dataclass(frozen=True)
class Hose:
    """EA [N], EI [N.m2], weight w [N/m], length [m], position of the top [m] over the anchor at the origin."""

    EA: float
    EI: float
    w: float
    length: float
    top: tuple[float, float]


@dataclass(frozen=True, eq=False)
class AtRest:
    """H [N]; top tension [N]; touchdown arc [m] and the force there [N]; largest moment [N.m] and its arc [m]."""

    H: float
    top_tension: float
    touchdown: float
    reaction: float
    moment: float
    moment_arc: float


class Rigid:
    """Lying straight on a rigid floor up to the arc s0, which is sought with H and the force R at s0.

    Ground side: theta = M = 0, V = 0. Position, slope and, as nothing there can bear a couple, moment are continuous at
    s0; the floor's concentrated force R >= 0 lets V jump to -R, so the curvature has a kink.
    """

    def __init__(self, hose: Hose) -> None:
        self.hose = hose
        xi = np.linspace(0.0, 1.0, 400)
        shape, unknowns = self._guess(xi)
        self.solution = solve_bvp(self._rates, self._ends, xi, shape, unknowns, tol=TOLERANCE, max_nodes=100_000)
        assert self.solution.success, self.solution.message
        self.H, self.R, self.s0 = (float(p) for p in self.solution.p * self._units)

    @cached_property
    def _units(self) -> Array:
        h = self.hose
        return np.array([h.w * h.length, h.w * h.length, h.length])

    def _guess(self, xi: Array) -> tuple[Array, Array]:
        """The catenary that is tangent to the floor, without stretch: suspended length l, l² = h (h + 2 H/w)."""
        h = self.hose
        x, z = h.top

        def beyond(c: float) -> float:
            return float(h.length - np.sqrt(z * (z + 2.0 * c)) + c * np.arccosh(1.0 + z / c) - x)

        c = float(brentq(beyond, 1e-6 * z, 0.5 * (h.length**2 / z - z)))
        hanging = np.sqrt(z * (z + 2.0 * c))
        s = xi * hanging
        shape = np.array([h.length - hanging + c * np.arcsinh(s / c), np.hypot(s, c) - c, np.arctan(s / c), 0.0 * s])
        return shape, np.array([c, np.sqrt(h.EI / (h.w * c)), h.length - hanging]) / [h.length, h.length, h.length]

    def _rates(self, xi: Array, y: Array, p: Array) -> Array:
        h = self.hose
        H, R, s0 = p * self._units
        s = xi * (h.length - s0)
        return np.asarray((h.length - s0) * rates(h, H, h.w * s - R, y))

    def _ends(self, a: Array, b: Array, p: Array) -> Array:
        h = self.hose
        H, _, s0 = p * self._units
        x, z = h.top
        return np.array([a[0] - s0 * (1.0 + H / h.EA), *a[1:], b[0] - x, b[1] - z, b[3] / (h.w * h.length)])

    @cached_property
    def at_rest(self) -> AtRest:
        h = self.hose
        hanging = h.length - self.s0
        theta = float(self.solution.sol(1.0)[2])
        V = h.w * hanging - self.R
        xi, moment = largest(lambda at: self.solution.sol(at)[3], np.linspace(0.0, 1.0, 2001))
        tension = self.H * np.cos(theta) + V * np.sin(theta)
        return AtRest(self.H, float(tension), self.s0, self.R, moment, self.s0 + xi * hanging)


class Winkler:
    """Lying on a bed of springs: f = k times the depth below the floor, from a gap of s on, its corner rounded
    by a parabola; H is sought. The floor's force need not begin at one point only: nothing is assumed of where it acts.

    Heights are counted in w/k, the depth at rest, so that the springs' forces come out as finely as all else.
    """

    def __init__(self, hose: Hose, k: float, smoothing: float = 0.0, start: Rigid | None = None) -> None:
        self.hose, self.k, self.unit = hose, k, hose.w / k
        self.corner = smoothing / self.unit
        rigid = start or Rigid(hose)
        s, shape = self._guess(rigid)
        unknown = np.array([rigid.H / (hose.w * hose.length)])
        for tolerance in (1e-4, 1e-5, 1e-6, 1e-7):
            self.solution = solve_bvp(
                self._rates, self._ends, s, shape, unknown, fun_jac=self._derivatives, tol=tolerance, max_nodes=100_000
            )
            assert self.solution.success, self.solution.message
            s = self._mesh()
            shape, unknown = self.solution.sol(s), self.solution.p
        self.H = float(self.solution.p[0]) * hose.w * hose.length

    @cached_property
    def at_rest(self) -> AtRest:
        s, share, f = self.forces
        touchdown, reaction = equivalent_point(s, share, f, self.hose.w)
        theta, _, V = self.solution.sol(self.hose.length)[2:]
        arc, moment = largest(lambda at: self.solution.sol(at)[3], np.linspace(touchdown, self.hose.length, 4001))
        tension = self.H * np.cos(theta) + V * np.sin(theta)
        return AtRest(self.H, float(tension), touchdown, reaction, moment, arc)

    @cached_property
    def forces(self) -> tuple[Array, Array, Array]:
        """Gauss points' arc and share of the arc [m], and f there [N/m]."""
        x, weight = np.polynomial.legendre.leggauss(5)
        first, size = self.solution.x[:-1, None], np.diff(self.solution.x)[:, None]
        s, share = (first + 0.5 * size * (1.0 + x)).ravel(), (0.5 * size * weight).ravel()
        return s, share, self.hose.w * self._force(self.solution.sol(s)[1])

    @property
    def contact_end(self) -> float:
        """The last place that feels the floor [m]."""
        s, z = self.solution.x, self.solution.y[1] - self.corner
        i = int(np.flatnonzero(z < 0.0)[-1])
        return float(brentq(lambda at: self.solution.sol(at)[1] - self.corner, s[i], s[i + 1]))

    def _guess(self, rigid: Rigid) -> tuple[Array, Array]:
        """The rigid floor's shape with the layer of a stiff bed: under the force R at s0, with b⁴ = k/(4 EI) and
        t = b (s0 - s) + 1, the depth grows by 2 b R/k exp(-t) sin(t).
        """
        h, s0, R = self.hose, rigid.s0, rigid.R
        b = (0.25 * self.k / h.EI) ** 0.25
        near = s0 + np.linspace(-12.0, 6.0, 300) / b
        s = np.unique(np.clip(np.concatenate([np.linspace(0.0, h.length, 800), near]), 0.0, h.length))
        x, z, theta, M = rigid.solution.sol(np.maximum(s - s0, 0.0) / (h.length - s0))
        t = np.maximum(b * (s0 - s) + 1.0, 0.0)
        C, S = (2.0 * b * R / self.k * np.exp(-t) * f(t) for f in (np.cos, np.sin))
        lying = t > 0.0
        x = np.where(s < s0, s * (1.0 + rigid.H / h.EA), x)
        z = np.where(lying, -h.w / self.k - S, z - R / (6.0 * h.EI * b**3))
        theta, M = np.where(lying, b * (C - S), theta), np.where(lying, 2.0 * h.EI * b**2 * C, M)
        V = np.where(lying, -2.0 * h.EI * b**3 * (C + S), h.w * (s - s0) - R)
        return s, np.array([x, z / self.unit, theta, M, V])

    def _force(self, z: Array) -> Array:
        """f/w at the height z, in w/k."""
        ramp, s = np.maximum(-z, 0.0), self.corner
        return ramp if s == 0.0 else np.where(np.abs(z) < s, (s - z) ** 2 / (4.0 * s), ramp)

    def _slope(self, z: Array) -> Array:
        """-d(f/w)/dz."""
        step, s = np.where(z < 0.0, 1.0, 0.0), self.corner
        return step if s == 0.0 else np.where(np.abs(z) < s, (s - z) / (2.0 * s), step)

    def _corners(self) -> Array:
        """Where f's derivatives jump; the collocation needs a point there."""
        s, place, places = self.solution.x, self.solution.sol, []
        for level in {self.corner, -self.corner}:
            over = self.solution.y[1] - level
            for i in np.flatnonzero(over[1:] * over[:-1] < 0.0):
                places.append(brentq(lambda at, level=level: place(at)[1] - level, s[i], s[i + 1], xtol=1e-13))
        return np.array(places)

    def _mesh(self) -> Array:
        """The points of the solution, those beside a corner moved there."""
        s, corners = self.solution.x, self._corners()
        if corners.size:
            apart = np.abs(s[:, None] - corners).min(axis=1) > 1e-6
            apart[[0, -1]] = True
            s = np.union1d(s[apart], corners)
        return s

    def _rates(self, s: Array, y: Array, p: Array) -> Array:
        h = self.hose
        up = rates(h, p[0] * h.w * h.length, y[4], y[:4])
        up[1] /= self.unit
        return np.vstack([up, h.w * (1.0 - self._force(y[1]))])

    def _derivatives(self, s: Array, y: Array, p: Array) -> tuple[Array, Array]:
        """Derivatives of the rates by y and by the unknown."""
        h = self.hose
        H, V, scale = p[0] * h.w * h.length, y[4], h.w * h.length
        c, n = np.cos(y[2]), np.sin(y[2])
        T, across = H * c + V * n, H * n - V * c
        e = 1.0 + T / h.EA
        by, by_H = np.zeros((5, 5, s.size)), np.zeros((5, 1, s.size))
        by[0, 2], by[0, 4], by_H[0, 0] = -e * n - across * c / h.EA, n * c / h.EA, c * c / h.EA
        by[1, 2], by[1, 4], by_H[1, 0] = e * c - across * n / h.EA, n * n / h.EA, c * n / h.EA
        by[1], by_H[1] = by[1] / self.unit, by_H[1] / self.unit
        by[2, 3] = 1.0 / h.EI
        by[3, 2], by[3, 4] = e * T - across**2 / h.EA, across * n / h.EA - e * c
        by_H[3, 0] = across * c / h.EA + e * n
        by[4, 1] = h.w * self._slope(y[1])
        return by, by_H * scale

    def _ends(self, a: Array, b: Array, p: Array) -> Array:
        h = self.hose
        x, z = h.top
        moment = h.w * h.length
        return np.array([a[0], a[1], a[3] / moment, b[0] - x, b[1] * self.unit - z, b[3] / moment])


def equivalent_point(s: Array, share: Array, f: Array, w: float) -> tuple[float, float]:
    """Touchdown arc d [m] and concentrated force R [N] on a rigid floor with the resultant and the moment of the forces
    f beyond the middle of what lies. Counted from the line's end, of f - w there: F = R - w d, G = R d - w d²/2.
    """
    end = float(share.sum())
    part = s > 0.5 * float(s[f > 0.0][-1])
    F = float(np.sum((share * (f - w))[part]))
    G = float(np.sum((share * (f - w) * (end - s))[part]))
    R = float(np.sqrt(F**2 + 2.0 * w * G))
    return end - (R - F) / w, R


def rates(h: Hose, H: float, V: Array, y: Array) -> Array:
    """Rates of x, z, theta, M (4, n) along the unstressed arc."""
    _, _, theta, M = y
    c, s = np.cos(theta), np.sin(theta)
    e = 1.0 + (H * c + V * s) / h.EA
    return np.array([e * c, e * s, M / h.EI, e * (H * s - V * c)])


def largest(f: Callable[[Array], Array], grid: Array) -> tuple[float, float]:
    """Place and value of the largest of f between points of a grid."""
    i = int(np.argmax(f(grid)))
    near = (grid[max(i - 1, 0)], grid[min(i + 1, grid.size - 1)])
    best = minimize_scalar(lambda at: -float(f(np.array(at))), bounds=near, method="bounded", options={"xatol": 1e-10})
    return float(best.x), -float(best.fun)
