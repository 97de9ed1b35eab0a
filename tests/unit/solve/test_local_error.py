"""The estimate of a step's local error against the exact motion, and second order with steps of changing size."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.core.arrays import Array
from riser_soil.core.part import Model, Part, State
from riser_soil.core.system import System, Timer
from riser_soil.solve.local_error import LocalError, first_step
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.time_scheme import GeneralizedAlpha
from riser_soil.solve.time_stepper import TimeStepper
from tests.support.toy_chain import Chain, Floor, Inertia, Springs

SCHEMES = [GeneralizedAlpha.newmark(), GeneralizedAlpha.from_rho_inf(0.8), GeneralizedAlpha.from_rho_inf(0.3)]


class Given:
    """Steps of given sizes whatever their error, which is kept."""

    judges_error = True

    def __init__(self, sizes: Array) -> None:
        self._ends, self.end = np.cumsum(sizes), float(np.sum(sizes))
        self._done = 0
        self.errors: list[float] = []

    @property
    def finished(self) -> bool:
        return self._done == len(self._ends)

    @property
    def target(self) -> float:
        return float(self._ends[self._done])

    @property
    def dt(self) -> float:
        return self.target - (float(self._ends[self._done - 1]) if self._done else 0.0)

    def rejection(self, error: float) -> str:
        self.errors.append(error)
        return ""

    def accept(self, easy: bool) -> None:
        self._done += 1

    def cut(self) -> bool:
        return False


def walk(
    chain: Chain, parts: list[Part], scheme: GeneralizedAlpha, v0: Array, steps: Given
) -> list[tuple[Array, Array]]:
    """Heights and velocities after each step, the beginning first."""
    system = System(MPI.COMM_SELF, Model([chain], parts), Timer.new())
    newton = Newton(system, NewtonSettings(1e-10, 30, 1e-11))
    stepper = TimeStepper(system, newton, scheme, State(0.0, 0.0 * v0, v0.copy(), 0.0 * v0))
    path = [(chain.z.copy(), v0.copy())]
    while not steps.finished:
        stepper.commit(stepper.advance(steps), steps)
        path.append((chain.z.copy(), stepper.before.v.copy()))
    newton.destroy()
    system.destroy()
    return path


def swing(scheme: GeneralizedAlpha, sizes: Array) -> tuple[list[tuple[Array, Array]], Given]:
    """A mass of 1 kg on a spring of 4 N/m, from rest length 1 m, moving off at 1 m/s."""
    chain, steps = Chain(np.array([0.0, 1.0]), prescribed=True), Given(sizes)
    parts: list[Part] = [Springs(chain, 1.0, 4.0), Inertia(chain, 2.0)]
    return walk(chain, parts, scheme, np.array([0.0, 1.0]), steps), steps


def exactly(z: float, v: float, dt: float) -> float:
    """Height of the swinging mass a time dt after it was at z with the velocity v."""
    return 1.0 + (z - 1.0) * np.cos(2.0 * dt) + 0.5 * v * np.sin(2.0 * dt)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_estimate_is_the_error_of_one_step(scheme: GeneralizedAlpha) -> None:
    dt = 0.01
    path, steps = swing(scheme, np.full(60, dt))
    after = 20  # steps until the scheme's own accelerations are in line
    errors = [abs(b[0][1] - exactly(a[0][1], a[1][1], dt)) for a, b in pairwise(path[after:])]
    np.testing.assert_allclose(steps.errors[after:], errors, atol=0.05 * max(errors))


def off_after_uneven_steps(scheme: GeneralizedAlpha, size: float) -> float:
    sizes = size * np.resize([1.0, 0.4, 0.7, 0.3, 0.9], round(6.6 / size))
    path, _ = swing(scheme, sizes * 3.0 / sizes.sum())
    return abs(float(path[-1][0][1]) - exactly(1.0, 1.0, 3.0))


@pytest.mark.parametrize("scheme", [SCHEMES[0], *(pytest.param(x, marks=pytest.mark.verify) for x in SCHEMES[1:])])
def test_second_order_with_uneven_steps(scheme: GeneralizedAlpha) -> None:
    errors = [off_after_uneven_steps(scheme, size) for size in (0.02, 0.01, 0.005)]
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.2)


def test_uneven_steps_need_accelerations_of_their_own_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(LocalError, "start", lambda self, before, dt: before)
    errors = [off_after_uneven_steps(SCHEMES[2], size) for size in (0.02, 0.01, 0.005)]
    assert np.log2(errors[1] / errors[2]) < 1.5


def test_impact_shorter_than_the_step_is_seen() -> None:
    """A mass at 1 m/s meets a stiff floor: what it can't go on is the error's order. At rest there is none."""
    chain, dt = Chain(np.array([0.0, 0.105]), prescribed=True), 0.02
    steps = Given(np.full(200, dt))
    parts: list[Part] = [Springs(chain, 0.0, 1e-9), Inertia(chain, 2.0), Floor(chain, 1e7)]
    walk(chain, parts, SCHEMES[1], np.array([0.0, -1.0]), steps)
    assert max(steps.errors[:5]) < 1e-9
    assert max(steps.errors[5:7]) > 0.5 * dt


def test_prescribed_places_have_no_error() -> None:
    chain, steps = Chain(np.array([0.0, 1.0]), prescribed=True), Given(np.full(5, 0.1))
    parts: list[Part] = [Springs(chain, 1.0, 4.0), Inertia(chain, 2.0)]
    walk(chain, parts, SCHEMES[0], np.zeros(2), steps)
    assert max(steps.errors) == 0.0


def test_first_step_moves_the_riser_by_the_tolerance() -> None:
    chain = Chain(np.array([0.0, 1.0]))
    system = System(MPI.COMM_SELF, Model([chain], [Springs(chain, 1.0, 4.0), Inertia(chain, 1.0)]), Timer.new())
    rest = State.at_rest(0.0, 2)
    assert first_step(system, rest, 1e-3) == np.inf
    falling = State(0.0, rest.u, rest.v, np.array([0.0, -9.81]))
    dt = first_step(system, falling, 1e-3)
    assert 0.5 * 9.81 * dt**2 == pytest.approx(1e-3)
    system.destroy()
