"""Loads of moving water against closed forms: current, waves around a small cylinder, frames of reference."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.part import Part, State, Weights
from riser_soil.riser import shapes
from riser_soil.riser.line import End, Line
from riser_soil.sea.components import regular
from riser_soil.sea.flows import Sea, WaterMotion, add_flow
from riser_soil.sea.morison import Morison
from riser_soil.sea.morison_law import added_masses, drag_coefficients
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.waves import WaveField, linear_waves
from tests.support import sample_water
from tests.support.dense_chain import residual
from tests.support.sample_line import Sample, sample

pytestmark = pytest.mark.usefixtures("uncompiled")

RHO, G, CD, CA = 1025.0, 9.81, 1.1, 0.9
ALL = Weights(1.0, 1.0, 0.0, 0.0)
HEIGHT, PERIOD, DEPTH, MIDDLE = 1.5, 7.0, 30.0, np.array([4.0, -2.0, -6.0])
DIRECTION = np.array([np.cos(0.5), np.sin(0.5), 0.0])


def straight(tangent: Array, D: float, L: float = 0.5) -> Line:
    """A short pipe about MIDDLE."""
    arc = np.linspace(0.0, L, 2)
    curve = shapes.straight(arc, MIDDLE - 0.5 * L * tangent, tangent)
    return Line(3, shapes.layout(arc, np.full(1, D), curve, curve), End(False), End(False))


def loads(line: Line, sea: Sea, Cd: float = CD, Ca: float = CA, Cdt: float = 0.0) -> Morison:
    D = line.outer_diameter
    ones, displaced = np.ones_like(D), RHO * 0.25 * np.pi * D**2
    drag, mass = drag_coefficients(RHO, D, Cd * ones, Cdt * ones), added_masses(RHO, D, Ca * ones, 0.0 * ones)
    return sample_water.driven(sample_water.Resistance(Pipe(line), drag, mass, displaced), sea)


def force_on(line: Line, part: Morison, state: State) -> Array:
    """Total force of the water (3,)."""
    return -line.nodal(residual([part], state, ALL))[:, :3].sum(axis=0)


def airy() -> WaveField:
    return linear_waves(regular(HEIGHT, PERIOD, 0.5, 0.3, G, DEPTH), DEPTH, 0.0, "vertical")


def wave(t: float) -> tuple[float, float, Array, Array]:
    """Wave number, phase, velocity and acceleration at MIDDLE by Airy's formulas."""
    w = 2.0 * np.pi / PERIOD
    k = w**2 / G
    for _ in range(200):
        k = w**2 / (G * np.tanh(k * DEPTH))
    theta = k * float(DIRECTION @ MIDDLE) - w * t + 0.3
    up = np.array([0.0, 0.0, 1.0])
    C, S = (f(k * (MIDDLE[2] + DEPTH)) / np.sinh(k * DEPTH) for f in (np.cosh, np.sinh))
    a = 0.5 * HEIGHT
    velocity = a * w * (C * np.cos(theta) * DIRECTION + S * np.sin(theta) * up)
    return k, theta, velocity, a * w * w * (C * np.sin(theta) * DIRECTION - S * np.cos(theta) * up)


TANGENTS = [np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]), np.array([0.48, 0.6, 0.64])]


@pytest.mark.parametrize("tangent", TANGENTS)
def test_a_short_fixed_cylinder_in_waves(tangent: Array) -> None:
    D, L, t = 0.2, 1e-3, 1.7
    line = straight(tangent, D, L)
    _, _, u, du = wave(t)
    across, da = u - (u @ tangent) * tangent, du - (du @ tangent) * tangent
    area = 0.25 * np.pi * D**2
    expected = 0.5 * RHO * D * CD * np.linalg.norm(across) * across + RHO * area * (du + CA * da)
    state = State.at_rest(t, line.size)
    assert force_on(line, loads(line, Sea(0.0, [airy()])), state) == pytest.approx(expected * L, rel=1e-6)


def pressure_force(tangent: Array, D: float, L: float, t: float) -> Array:
    """Integral of -p n over a closed cylinder about MIDDLE by Gauss-Legendre and trapezoidal rules; p the wave's
    dynamic pressure rho g eta cosh k(z + h)/cosh kh.
    """
    k, _, _, _ = wave(t)
    w = 2.0 * np.pi / PERIOD

    def pressure(x: Array) -> Array:
        theta = k * (x @ DIRECTION) - w * t + 0.3
        return RHO * G * 0.5 * HEIGHT * np.cosh(k * (x[..., 2] + DEPTH)) / np.cosh(k * DEPTH) * np.cos(theta)

    points, weights = np.polynomial.legendre.leggauss(8)
    first = np.cross(tangent, [0.3, -0.8, 0.5])
    first /= np.linalg.norm(first)
    angle = np.arange(32) * np.pi / 16
    normal = np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * np.cross(tangent, first)
    side = MIDDLE + 0.5 * D * normal[:, None] + 0.5 * L * points[:, None] * tangent
    total = -np.einsum("ag,g,ai->i", pressure(side), weights * 0.5 * L * np.pi * D / 32, normal)
    r, rings = 0.25 * D * (points + 1.0), 0.25 * D * weights
    for end in (-1.0, 1.0):
        face = MIDDLE + 0.5 * end * L * tangent + r[:, None, None] * normal
        total -= end * tangent * float(np.einsum("ra,r->", pressure(face), rings * r * np.pi / 16))
    return np.asarray(total)


@pytest.mark.parametrize("tangent", TANGENTS)
def test_froude_krylov_is_the_pressure_of_the_undisturbed_wave(tangent: Array) -> None:
    """In all directions, the closed ends included; the remainder is of the order (D/wave length)^2."""
    t, errors = 2.3, []
    for D in (2.0, 1.0):
        line = straight(tangent, D, 0.5)
        expected = pressure_force(tangent, D, 0.5, t)
        force = force_on(line, loads(line, Sea(0.0, [airy()]), Cd=0.0, Ca=0.0), State.at_rest(t, line.size))
        errors.append(np.linalg.norm(force - expected) / np.linalg.norm(expected))
    length = 2.0 * np.pi / wave(t)[0]
    assert errors[0] < 4.0 * (2.0 / length) ** 2
    assert errors[1] < 4.0 * (1.0 / length) ** 2
    assert errors[0] / errors[1] > 3.0


class Drift(NamedTuple):
    """A uniform flow (3,) [m/s]."""

    velocity: Array


@add_flow.of(Drift)
def _drift(flow: Drift, motion: WaterMotion, t: Array, x: Array) -> None:
    for p in range(x.shape[0]):
        for i in range(3):
            motion.velocity[p, i] += flow.velocity[i]


def uniform(velocity: Array) -> Sea:
    return Sea(None, [Drift(velocity)])


def test_a_pipe_that_drifts_with_the_current_feels_nothing() -> None:
    at, current = sample(3), np.array([0.7, -1.1, 0.2])
    state = State.at_rest(0.4, at.line.size)
    at.line.nodal(state.v)[:, :3] = current
    part = loads(at.line, uniform(current), Cdt=0.2)
    assert np.abs(residual([part], state, ALL)).max() < 1e-20
    part = loads(at.line, uniform(1.01 * current), Cdt=0.2)
    assert np.abs(residual([part], state, ALL)).max() > 0.01


def test_loads_do_not_depend_on_the_frame_of_reference() -> None:
    """A pipe and its water are seen from a ship under way."""
    at, ship = sample(3), np.array([1.2, -0.4, 0.3])
    state = at.state(2)

    moved = State(state.t, state.u.copy(), state.v.copy(), state.a)
    at.line.nodal(moved.u)[:, :3] -= ship * state.t
    at.line.nodal(moved.v)[:, :3] -= ship
    seas = (Sea(sample_water.LEVEL, [sample_water.general(under_way)]) for under_way in (0.0 * ship, ship))
    parts = [loads(at.line, sea, Cdt=0.2) for sea in seas]
    forces = [residual([part], s, ALL) for part, s in zip(parts, (state, moved), strict=True)]
    assert forces[1] == pytest.approx(forces[0], rel=1e-11, abs=1e-10 * np.abs(forces[0]).max())


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("make", [sample_water.waves, sample_water.half_out_in_waves, sample_water.floating_in_waves])
def test_moving_water_neither_dissipates_nor_stores(make: Callable[[Sample], Part], dimension: int) -> None:
    """All that it does is external work: force times way, less what goes into the added mass."""
    at = sample(dimension)
    part, start = make(at), at.state(3)
    h = 1e-4
    before = State(0.0, 0.0 * start.u, start.v, start.a)
    after = State(h, h * start.v + 0.5 * h * h * start.a, start.v + h * start.a, start.a)
    middle = State(0.5 * h, 0.5 * h * start.v, start.v + 0.5 * h * start.a, start.a)
    done = -residual([part], middle, ALL) @ (start.v + 0.5 * h * start.a) * h
    work, gained = part.work(before, after), part.energy(after).kinetic - part.energy(before).kinetic
    assert work.dissipated == 0.0
    assert part.energy(after).potential == 0.0
    assert work.external - gained == pytest.approx(done, rel=1e-3)
