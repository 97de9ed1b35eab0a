"""The energy ledger: the scheme's own dissipation, and what is left over."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, Model, Part, State, Work
from riser_soil.core.snapshot import Ledger
from riser_soil.core.system import System, Timer
from riser_soil.results.energy_ledger import EnergyLedger
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.step import Solution
from riser_soil.solve.step_control import StepControl
from riser_soil.solve.time_scheme import GeneralizedAlpha, Scheme
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from tests.support.toy_chain import Chain, Floor, Inertia, Springs

ALPHA = GeneralizedAlpha.from_rho_inf(0.6)
DAMPED = GeneralizedAlpha.newmark(0.4225, 0.8)
AVERAGE = GeneralizedAlpha.newmark()


class WavingRun(NamedTuple):
    """Ledgers after each step; heights z, rates v and a before all steps and after each (steps + 1, n)."""

    ledgers: list[Ledger]
    z: Array
    v: Array
    a: Array


def balanced(chain: Chain, parts: list[Part], scheme: Scheme, v0: list[float], end: float, dt: float) -> WavingRun:
    system = System(MPI.COMM_SELF, Model([chain], parts), Timer.new())
    newton = Newton(system, NewtonSettings(1e-12, 30, 1e-14))  # the springs' forces are rounded to some 1e-14 of them
    nothing = np.zeros(chain.size)
    stepper = TimeStepper(system, newton, scheme, State(0.0, nothing, np.array(v0), nothing))
    control, balance = StepControl(end, dt, dt / 8), EnergyLedger(stepper.energy, False, ("contact",), ("supports",))
    ledgers, path = [], [(chain.z, stepper.before.v, stepper.before.a)]
    while not control.finished:
        step = stepper.advance(control)
        stepper.commit(step, control)
        balance.add(stepper.energy, step)
        ledgers.append(balance.ledger)
        path.append((chain.z, stepper.now.v, stepper.now.a))
    newton.destroy()
    system.destroy()
    return WavingRun(ledgers, *(np.array(column) for column in zip(*path, strict=True)))


def swing(scheme: Scheme, dt: float = 0.1, cubic: float = 0.0) -> WavingRun:
    """A chain under weight, its first height prescribed."""
    chain = Chain(np.arange(4.0), prescribed=True)
    parts: list[Part] = [Springs(chain, 1.0, 20.0, cubic, weight=1.0), Inertia(chain, 1.0)]
    return balanced(chain, parts, scheme, [0.0, 0.3, 0.1, 0.8], 3.0, dt)


@pytest.mark.parametrize("scheme", [ALPHA, DAMPED, AVERAGE])
def test_linear_motion_leaves_no_residual(scheme: Scheme) -> None:
    last = swing(scheme).ledgers[-1]
    assert abs(last.residual) < 1e-11 * last.turned_over
    assert last.numerical == pytest.approx(0.0, abs=1e-11) if scheme is AVERAGE else last.numerical > 1e-3


def test_newmark_dissipates_as_hughes_says() -> None:
    """d(v.M v + u.K u)/2 + b dt²/2 d(a.M a) = -(g - 1/2) (du.K du + b dt² da.M da) in a step, b = beta - gamma/2."""
    dt, energies = 0.1, swing(DAMPED, dt=0.1)
    M = Inertia(Chain(np.arange(4.0)), 1.0).nodal()
    b, g = DAMPED.beta - 0.5 * DAMPED.gamma, DAMPED.gamma - 0.5
    du, da, a2 = np.diff(energies.z, axis=0), np.diff(energies.a, axis=0), energies.a**2 @ M
    K = 20.0 * np.sum(np.diff(du, axis=1) ** 2, axis=1)
    lost = g * (K + b * dt**2 * da**2 @ M) + 0.5 * b * dt**2 * np.diff(a2)
    assert energies.ledgers[-1].numerical == pytest.approx(lost.sum(), rel=1e-10)


@pytest.mark.parametrize("scheme", [ALPHA, AVERAGE])
def test_nonlinear_forces_leave_a_residual_of_second_order(scheme: Scheme) -> None:
    worst = [max(abs(led.residual) for led in swing(scheme, dt, cubic=50.0).ledgers) for dt in (0.02, 0.01, 0.005)]
    assert np.log2(worst[1] / worst[2]) == pytest.approx(2.0, abs=0.2)
    assert worst[0] > 1e-6


@pytest.mark.parametrize("scheme", [ALPHA, DAMPED, AVERAGE])
def test_impact_is_contact_s_and_not_the_scheme_s(scheme: Scheme) -> None:
    """Two masses that hardly know of each other fall 1 m on a stiff floor and come to rest: contact takes it all."""
    chain = Chain(np.array([1.0, 1.0]))
    parts: list[Part] = [Springs(chain, 0.0, 1e-9, weight=9.81), Inertia(chain, 2.0), Floor(chain, 1e7)]
    last = balanced(chain, parts, scheme, [0.0, 0.0], 5.0, 0.01).ledgers[-1]
    assert last.dissipated_by == {"contact": pytest.approx(2.0 * 9.81, rel=1e-5)}
    assert last.work_by == {"supports": 0.0}
    assert abs(last.residual) < 1e-11 * last.turned_over
    assert abs(last.numerical) < 1e-11 * last.turned_over


def test_sums_are_those_of_the_parts() -> None:
    last = swing(ALPHA).ledgers[-1]
    assert last.dissipated == sum(last.dissipated_by.values()) == 0.0
    assert last.work == sum(last.work_by.values())


@pytest.mark.parametrize("lost", [0.0, 1e-21, 1.0])
def test_accounts_follow_from_what_is_built_and_not_from_what_is_booked(lost: float) -> None:
    balance = EnergyLedger(Energy(), True, ("seabed", "morison"), ("supports",))
    assert balance.ledger.dissipated_by == {"seabed": 0.0, "morison": 0.0}
    balance.add(Energy(), step({"inertia": Work(), "seabed": Work(dissipated=lost), "supports": Work()}))
    assert balance.ledger.dissipated_by == {"seabed": lost, "morison": 0.0}
    assert balance.ledger.work_by == {"supports": 0.0}
    assert all(isinstance(x, float) for x in (balance.ledger.dissipated, balance.ledger.work))


@pytest.mark.parametrize(
    ("stored", "turned"),
    [
        (Energy(kinetic=7.0), {}),
        (Energy(strain=7.0), {}),
        (Energy(), {"seabed": Work(dissipated=7.0)}),
        (Energy(potential=7.0), {"supports": Work(external=7.0)}),
        (Energy(potential=-7.0), {"supports": Work(external=-7.0)}),
    ],
)
def test_turned_over_is_the_most_that_was_stored_or_went_through(stored: Energy, turned: dict[str, Work]) -> None:
    balance = EnergyLedger(Energy(), False, ("seabed",), ("supports",))
    for energy, work in ((stored, turned), (Energy(kinetic=3.0, strain=4.0, potential=9.0), {})):
        balance.add(energy, step(work))
        assert balance.ledger.turned_over == 7.0


@pytest.mark.parametrize(
    ("numerical", "ahead", "made"),
    [(-9.0, 9.0, 0.0), (-9.0, 4.0, -5.0), (-9.0, 20.0, 0.0), (-9.0, -1.0, -9.0), (3.0, 50.0, 3.0), (3.0, -1.0, 2.0)],
)
def test_the_scheme_has_made_what_forces_ahead_of_their_mean_do_not_explain(
    numerical: float, ahead: float, made: float
) -> None:
    assert Ledger(numerical=numerical, ahead=ahead).made == made


def test_what_has_no_account_can_t_be_booked() -> None:
    balance = EnergyLedger(Energy(), True, ("seabed",), ("supports",))
    with pytest.raises(KeyError, match="friction"):
        balance.add(Energy(), step({"friction": Work(dissipated=1e-21)}))


def step(turned: dict[str, Work]) -> AcceptedStep:
    """A static step that turns some energy over."""
    nothing = State.at_rest(1.0, 0)
    return AcceptedStep(1.0, 1.0, Solution(nothing, Forces.zeros(0)), 0, Energy(), turned, 0.0)
