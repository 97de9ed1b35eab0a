"""Rotary inertia against closed forms: a spinning top, Rayleigh's beam, a bar in torsion."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh

from riser_soil.core.arrays import Array
from riser_soil.core.part import Part, State, Weights
from riser_soil.riser import shapes
from riser_soil.riser.beam import Beam
from riser_soil.riser.inertia import Inertia, RotaryInertia
from riser_soil.riser.line import End, Line
from tests.support.dense_chain import tangent
from tests.support.driven_stage import built, take
from tests.support.pipes import WEIGHTLESS, pipe
from tests.support.scenes import AVERAGE, dynamic, riser_scene

LENGTH, EA, EI, GJ, MASS, INERTIA = 30.0, 1.0e10, 5.0e5, 3.0e5, 80.0, 300.0
MASS_ONLY = Weights(inertia=1.0, force=0.0, shift_v=0.0, shift_a=1.0)


def frequencies(dimension: int, count: int, moving: list[int]) -> Array:
    """Angular frequencies (rad/s), ascending, of a pinned pipe's dofs `moving`."""
    e = pipe(LENGTH, count, WEIGHTLESS, EA=EA, EI=EI, GJ=GJ, mass=MASS, rotary_inertia=INERTIA)
    straight = shapes.straight(e.arc)
    line = Line(dimension, shapes.layout(e.arc, e.outer_diameter, straight, straight), End(True), End(True))
    state, free = State.at_rest(0.0, line.size), np.zeros((line.nodes, line.ndof), dtype=bool)
    free[:, moving] = True
    at = np.ix_(*[np.flatnonzero(free.ravel() & ~line.prescribed)] * 2)
    parts: list[Part] = [Inertia(line, e.mass), RotaryInertia(line, e.rotary_inertia)]
    K, M = tangent([Beam(line, e)], state)[at], tangent(parts, state, MASS_ONLY)[at]
    return np.asarray(np.sqrt(np.maximum(eigh(K, M, eigvals_only=True), 0.0)))


def rayleigh(n: Array) -> Array:
    """Pinned beam with rotary inertia: w^2 (m + rho I k^2) = EI k^4, k = n pi/L (Rayleigh, Theory of Sound, 1877)."""
    k = n * np.pi / LENGTH
    return np.asarray(np.sqrt(EI * k**4 / (MASS + INERTIA * k**2)))


def orders(errors: Array) -> Array:
    return np.asarray(np.log2(np.abs(errors[:-1] / errors[1:])))


def test_bending_frequencies_are_rayleighs() -> None:
    n = np.array([1.0, 2.0, 3.0])
    assert frequencies(2, 40, [1, 2])[:3] == pytest.approx(rayleigh(n), rel=3e-4)
    assert frequencies(3, 40, [1, 2, 4, 5])[:6] == pytest.approx(np.repeat(rayleigh(n), 2), rel=3e-4)


def test_bending_frequencies_converge_at_second_order() -> None:
    """The order is two, as the rotary inertia sits at the nodes; it takes a sixth off this frequency."""
    values = np.array([frequencies(2, count, [1, 2])[2] for count in (10, 20, 40)])
    assert orders(values / rayleigh(np.array([3.0])) - 1.0) == pytest.approx([2.0, 2.0], abs=0.1)


def test_torsional_frequency_converges_at_second_order() -> None:
    """A bar whose ends are free to spin: w = pi/L sqrt(GJ/J), J = 2 rho I; the lowest frequency is that of its spin."""
    exact = np.pi / LENGTH * np.sqrt(GJ / (2.0 * INERTIA))
    values = np.array([frequencies(3, count, [3])[:2] for count in (8, 16, 32)])
    assert np.all(values[:, 0] < 1e-3 * exact)
    errors = values[:, 1] / exact - 1.0
    assert orders(errors) == pytest.approx([2.0, 2.0], abs=0.05)
    assert abs(errors[-1]) < 1e-3


# A free symmetric top: a stiff pipe of one element

ROD = {"EA": 1.0e9, "EI": 1.0e9, "GJ": 1.0e9, "mass": 60.0, "rotary_inertia": 20.0}
ROD_LENGTH, SPIN, TUMBLE, DURATION = 2.0, 9.0, 1.5, 1.0


def precession() -> Array:
    """Direction of the top at the end: its axis turns about the angular momentum L at the rate |L| / I1."""
    across = 60.0 * ROD_LENGTH**3 / 12.0 + 20.0 * ROD_LENGTH
    momentum = np.array([2.0 * 20.0 * ROD_LENGTH * SPIN, -across * TUMBLE, 0.0])
    size = np.linalg.norm(momentum)
    about, angle = momentum / size, size / across * DURATION
    axis, along = np.array([1.0, 0.0, 0.0]), about[0]
    return np.asarray(
        np.cos(angle) * axis + np.sin(angle) * np.cross(about, axis) + (1.0 - np.cos(angle)) * along * about
    )


def tossed(time_step: float) -> tuple[Array, Array]:
    """The axis at the end, and the energy after each step, of a pipe tossed with a spin and a tumble."""
    points = [[0.0, 0.0, 0.0], [ROD_LENGTH, 0.0, 0.0]]
    stage = dynamic(DURATION, time_step, scheme=AVERAGE)
    more = {"riser": {"initial": {"points": points}}, "solver": {"tolerance": 1e-11}, "dimension": 3}
    assembly = built(riser_scene(stage, pipe=ROD, length=ROD_LENGTH, elements=1, start="free", end="free", **more))
    before, energies = State.at_rest(0.0, assembly.size), list[float]()
    rates = before.v.reshape(-1, 6)
    rates[:, 2], rates[:, 3:] = [-1.0, 1.0], [SPIN, -TUMBLE, 0.0]
    rates[:, 2] *= 0.5 * ROD_LENGTH * TUMBLE
    take(assembly, assembly.scene.stages[-1], before, lambda system, step: energies.append(step.energy.total))
    return assembly.riser.line.chord[0] / np.linalg.norm(assembly.riser.line.chord[0]), np.array(energies)


def test_free_spinning_top_precesses() -> None:
    runs = [tossed(dt) for dt in (5e-3, 2.5e-3, 1.25e-3)]
    errors = np.array([np.linalg.norm(axis - precession()) for axis, _ in runs])
    assert errors[-1] < 1e-4
    assert orders(errors) == pytest.approx([2.0, 2.0], abs=0.1)
    assert np.ptp(runs[-1][1]) < 1e-5 * runs[-1][1][0]
