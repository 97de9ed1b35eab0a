"""Natural frequencies of a pinned beam under tension, from the assembled stiffness and mass."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh

from riser_soil.core.arrays import Array
from riser_soil.core.part import State, Weights
from riser_soil.riser import shapes
from riser_soil.riser.beam import Beam
from riser_soil.riser.inertia import Inertia
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End, Kinematics
from riser_soil.sea.morison import in_still_water
from riser_soil.sea.morison_law import added_masses
from riser_soil.sea.pipe import Pipe
from tests.support.dense_chain import solve, tangent
from tests.support.pipes import WEIGHTLESS, pipe

LENGTH, EA, EI, MASS, TENSION = 30.0, 1.0e10, 5.0e5, 80.0, 4.0e4
DIAMETER, RHO = 0.3, 1025.0
MASS_ONLY = Weights(inertia=1.0, force=0.0, shift_v=0.0, shift_a=1.0)
ORDER = 3.7


def exact(mass: float, n: Array) -> Array:
    k = n * np.pi / LENGTH
    return np.asarray(np.sqrt((k**4 * EI + k**2 * TENSION) / mass))


def frequencies(dimension: int, count: int, tension: float = TENSION, added: float = 0.0) -> Array:
    """All transverse angular frequencies (rad/s), ascending; in space each comes twice."""
    e = pipe(LENGTH, count, WEIGHTLESS, EA=EA, EI=EI, GJ=EI, mass=MASS)
    straight = shapes.straight(e.arc)

    def stretch(t: float) -> Kinematics:
        return np.array([LENGTH * (1.0 + t * tension / EA), 0.0, 0.0]), np.zeros(3), np.zeros(3)

    layout = shapes.layout(e.arc, e.outer_diameter, straight, straight)
    line = Line(dimension, layout, End(True), End(True, motion=stretch), prescribe_spin=True)
    beam, inertia = Beam(line, e), Inertia(line, e.mass)
    normal, none = np.full(count, added), np.zeros(count)
    masses = added_masses(RHO, np.full(count, DIAMETER), normal, none)
    water = in_still_water(Pipe(line), np.zeros((count, 2)), masses)
    solve(line, [beam], tolerance=1e-9)
    state = State.at_rest(1.0, line.size)
    across = np.zeros((line.nodes, line.ndof), dtype=bool)
    across[:, [1, 2] if dimension == 2 else [1, 2, 4, 5]] = True
    at = np.ix_(*[np.flatnonzero(across.ravel() & ~line.prescribed)] * 2)
    K, M = tangent([beam], state)[at], tangent([inertia, water], state, MASS_ONLY)[at]
    assert np.abs(M - M.T).max() <= 1e-12 * np.abs(M).max()
    return np.asarray(np.sqrt(eigh(K, M, eigvals_only=True)))


def test_first_three_frequencies_in_the_plane() -> None:
    n = np.array([1.0, 2.0, 3.0])
    assert frequencies(2, 16)[:3] == pytest.approx(exact(MASS, n), rel=1e-4)


def test_first_three_frequencies_in_space_come_in_pairs() -> None:
    n = np.repeat([1.0, 2.0, 3.0], 2)
    assert frequencies(3, 16)[:6] == pytest.approx(exact(MASS, n), rel=1e-4)


def test_added_mass_lowers_the_frequency_as_mass_does() -> None:
    """The closed form on the stretched length, with the mass that is left per stretched length."""
    whole, stretch = MASS + RHO * 0.25 * np.pi * DIAMETER**2, 1.0 + TENSION / EA
    k = np.pi / (LENGTH * stretch)
    wet = frequencies(2, 24, added=1.0)[0]
    assert wet == pytest.approx(np.sqrt((k**4 * EI + k**2 * TENSION) * stretch / whole), rel=5e-7)
    assert wet / frequencies(2, 24)[0] == pytest.approx(np.sqrt(MASS / whole), rel=1e-9)


def test_tension_and_added_mass_count() -> None:
    bare, slack, wet = frequencies(2, 16)[0], frequencies(2, 16, 0.0)[0], frequencies(2, 16, added=1.0)[0]
    extra = RHO * 0.25 * np.pi * DIAMETER**2
    assert slack == pytest.approx((np.pi / LENGTH) ** 2 * np.sqrt(EI / MASS), rel=1e-4)
    assert wet == pytest.approx(bare * np.sqrt(MASS / (MASS + extra)), rel=1e-4)


def test_frequencies_converge_at_fourth_order() -> None:
    errors = np.array([frequencies(2, n)[2] / exact(MASS, np.array([3.0]))[0] - 1.0 for n in (6, 12, 24)])
    orders = np.log2(np.abs(errors[:-1] / errors[1:]))
    assert np.all(orders > ORDER), f"errors {errors}, orders {orders}"
