"""Beams in space that bend, twist and buckle: closed forms, and the rod's equations where there is none."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import jv

from riser_soil.core.arrays import Array
from riser_soil.riser.rotations import exp
from riser_soil.riser.vectors import vector
from tests.support.beam_chain import SpaceChain, alike, load, straight_space
from tests.support.differences import orders
from tests.support.rod_reference import Rod, first_buckling, tip

FOURTH = 3.6  # least order that counts as fourth on coarse meshes


# A helix from bending and twist


def helix(s: Array, m: Array, EI: float, GJ: float) -> tuple[Array, Array]:
    """Axis (n, 3) and frames (n, 3, 3) of a round cantilever along x whose tip bears the moment m about fixed axes.

    Nothing but m acts in any section, so the tangent turns about it at the rate |m|/EI, whatever GJ is; the section
    turns about the tangent by what GJ makes of the torque beyond that.
    """
    M = np.linalg.norm(m)
    e, tangent, rate = m / M, np.array([1.0, 0.0, 0.0]), M / EI
    along = np.asarray((tangent @ e) * e)
    across: Array = tangent - along
    phi = rate * s[:, None]
    aside = np.cross(e, across)
    axis = s[:, None] * along + np.sin(phi) / rate * across + (1.0 - np.cos(phi)) / rate * aside
    spin = m[0] * (1.0 / GJ - 1.0 / EI)
    turn = [np.array(exp(vector(x * m / EI))) @ np.array(exp((float(x * spin), 0.0, 0.0))) for x in s]
    return axis, np.array(turn)


@pytest.mark.parametrize("turns", [1, 3])
@pytest.mark.parametrize("GJ", [0.4, 2.0])
def test_bending_and_twist_make_a_helix(turns: int, GJ: float) -> None:
    """Starting from the closed form: Newton's method moves it to the elements' own equilibrium nearby."""
    m = 2.0 * np.pi * turns * np.array([0.3, 0.8, -np.sqrt(0.27)])
    errors, turned = [], []
    for n in (12 * turns, 24 * turns, 48 * turns):
        chain = straight_space(n, 1.0, 1e5, (1.0, 1.0), GJ)
        exact, frames = helix(np.linspace(0.0, 1.0, n + 1), m, 1.0, GJ)
        chain.x, chain.R = exact.copy(), frames.copy()
        load(chain, np.concatenate([np.zeros(3), m]), steps=1)
        errors.append(float(np.abs(chain.x - exact).max()))
        turned.append(float(np.abs(chain.R[-1] - frames[-1]).max()))
    assert errors[1] < 5e-6
    assert orders(errors).min() > FOURTH
    assert orders(turned).min() > FOURTH


def test_bending_and_twist_reach_the_helix_from_the_straight_beam() -> None:
    m = 2.0 * np.pi * np.array([0.0, 0.8, 0.6])
    chain = straight_space(12, 1.0, 1e5, (1.0, 1.0), 0.4)
    load(chain, np.concatenate([np.zeros(3), m]), steps=20)
    exact, _ = helix(np.linspace(0.0, 1.0, 13), m, 1.0, 0.4)
    assert np.abs(chain.x - exact).max() < 2e-5


# The Princeton beam: a strip bent about both axes at once. Section and lengths: Dowell, Traybar & Hodges,
# J. Sound Vib. 50 (1977); elastic constants: Bauchau et al., Multibody Syst. Dyn. 37 (2016).

LENGTH, HEIGHT, WIDTH, E, NU = 0.508, 12.77e-3, 3.2024e-3, 71.7e9, 0.31
TORSION = 1.0 / 3.0 - 0.21 * WIDTH / HEIGHT * (1.0 - (WIDTH / HEIGHT) ** 4 / 12.0)  # of height width^3; Roark
STRIP_EA = E * HEIGHT * WIDTH
STRIP_EI = (E * HEIGHT * WIDTH**3 / 12.0, E * WIDTH * HEIGHT**3 / 12.0)
STRIP_GJ = 0.5 * E / (1.0 + NU) * TORSION * HEIGHT * WIDTH**3


@pytest.mark.parametrize("force", [4.448, 8.896, 13.345])
@pytest.mark.parametrize("angle", [15.0, 45.0, 75.0, 90.0])
def test_princeton_beam(force: float, angle: float) -> None:
    """Tip force [N] at an angle [deg] from the strip's stiff direction, 90 being along its soft one."""
    tilt = np.radians(angle)
    tip_force = force * np.array([0.0, np.cos(tilt), np.sin(tilt)])
    stiffness = np.array([STRIP_GJ, *STRIP_EI]) / LENGTH**2
    rod = Rod(1.0, STRIP_EA, stiffness, np.zeros(3), np.eye(3))
    exact = LENGTH * tip(rod, tip_force, np.zeros(3))
    errors = []
    for n in (4, 8, 16):
        chain = straight_space(n, LENGTH, STRIP_EA, STRIP_EI, STRIP_GJ)
        load(chain, np.concatenate([tip_force, np.zeros(3)]), steps=8)
        errors.append(float(np.linalg.norm(chain.x[-1] - exact)))
    assert errors[0] < 1e-4 * LENGTH
    assert orders(errors).min() > FOURTH


# Buckling out of the plane: the load at which the tangent of the planar state becomes singular


def critical_load(chain: Callable[[], SpaceChain], direction: Array, low: float, high: float) -> float:
    """Tip force [N] between low and high where the smallest eigenvalue of the loaded chain's tangent passes zero."""

    def smallest(force: float) -> float:
        loaded, tip_load = chain(), np.concatenate([force * direction, np.zeros(3)])
        load(loaded, tip_load, steps=2)
        _, K = loaded.residual(np.zeros(loaded.nn * 6), tip_load)
        free = K[6:, 6:]
        assert np.abs(free - free.T).max() < 1e-7 * np.abs(free).max()
        return float(np.linalg.eigvalsh(0.5 * (free + free.T))[0])

    return float(brentq(smallest, low, high, xtol=1e-11 * high))


BLADE_EI = (1.0, 1e3)  # of a cantilever of unit length; it hardly bends in its plane
BLADE_GJ, BLADE_EA = 0.5, 1e5


def lateral_torsional(n: int) -> float:
    """Critical tip force of n elements."""
    blade = partial(straight_space, n, 1.0, BLADE_EA, BLADE_EI, BLADE_GJ)
    return critical_load(blade, np.array([0.0, 1.0, 0.0]), 2.0, 3.5)


def test_lateral_torsional_buckling_of_a_cantilever() -> None:
    """Bending in its plane before it buckles makes the strip stronger than Timoshenko's straight one by about EI/2EI_z.

    P = 4.0126 sqrt(EI GJ)/L^2; Timoshenko & Gere, Theory of Elastic Stability (1961), section 6.3.
    """
    root = brentq(lambda y: jv(-0.25, y), 1.5, 2.5, xtol=1e-14)
    closed_form = 2.0 * root * np.sqrt(BLADE_GJ)
    rod = Rod(1.0, BLADE_EA, np.array([BLADE_GJ, *BLADE_EI]), np.zeros(3), np.eye(3))
    exact = first_buckling([(rod, np.eye(3))], np.array([0.0, 1.0, 0.0]), 2.0, 3.5)
    assert exact == pytest.approx(closed_form, rel=1.5e-3)
    errors = [abs(lateral_torsional(n) / exact - 1.0) for n in (4, 8, 16)]
    assert errors[-1] < 5e-6
    assert orders(errors).min() > FOURTH


# A right-angle frame of a thin strip, clamped at one end and pushed in its plane at the other: Argyris et al.,
# Comput. Methods Appl. Mech. Engng 20 (1979); N and mm

LEG = 240.0
FRAME_EA = 71240.0 * 30.0 * 0.6
FRAME_EI = (71240.0 * 30.0 * 0.6**3 / 12.0, 71240.0 * 0.6 * 30.0**3 / 12.0)
FRAME_GJ = 71240.0 / (2.0 * 1.31) * 30.0 * 0.6**3 / 3.0
PUSH = np.array([1.0, 0.0, 0.0])
LEGS = (np.eye(3), np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]))  # tangents along x, then -y


def right_angle(n: int) -> SpaceChain:
    """Two legs of n elements each; section axes: the second in the frame's plane, the third across it."""
    at, o = np.linspace(0.0, LEG, n + 1), np.zeros(n + 1)
    first, second = np.stack([at, o, o], axis=1), np.stack([LEG + o, -at, o], axis=1)
    frames = np.repeat(np.stack(LEGS), n, axis=0)
    section = alike(2 * n, 2.0 * LEG, FRAME_EA, *FRAME_EI, FRAME_GJ)
    return SpaceChain(np.concatenate([first, second[1:]]), np.stack([frames, frames]), section)


def test_right_angle_frame_buckles_out_of_its_plane() -> None:
    rod = Rod(LEG, FRAME_EA, np.array([FRAME_GJ, *FRAME_EI]), np.zeros(3), np.eye(3))
    exact = first_buckling([(rod, leg) for leg in LEGS], PUSH, 0.9, 1.3)
    assert exact == pytest.approx(1.088, abs=0.003)  # Simo & Vu-Quoc, Comput. Methods Appl. Mech. Engng 58 (1986)
    errors = [abs(critical_load(partial(right_angle, n), PUSH, 0.8, 1.3) / exact - 1.0) for n in (3, 6, 12)]
    assert errors[-1] < 1e-5
    assert orders(errors).min() > FOURTH
