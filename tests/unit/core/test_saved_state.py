"""State that can be saved: names within names, values to the last bit, owners that take back what they gave."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.core.part import Energy, LineField, Model, Part, State
from riser_soil.core.saved_state import (
    Saved,
    Stateful,
    gathered,
    packed,
    record_of,
    restore_all,
    unpacked,
    values_of,
    within,
)
from riser_soil.core.snapshot import Ledger, Record, StepRecord, StepStatistics
from riser_soil.core.system import System, Timer
from riser_soil.results.schedule import DueOutputs
from riser_soil.results.tallies import Tallies
from riser_soil.solve.adaptive_steps import AutoSteps
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.step_control import Control, StepControl
from riser_soil.solve.time_scheme import GeneralizedAlpha
from riser_soil.solve.time_stepper import TimeStepper
from tests.support.recorded_run import FACTS, Catenary, stacked
from tests.support.toy_chain import Chain, Inertia, Springs


class Number:
    def __init__(self, value: float) -> None:
        self.value = value

    def state(self) -> Saved:
        return {"value": np.array(self.value)}

    def restore(self, saved: Saved) -> None:
        self.value = float(saved["value"])


def test_owners_have_names_within_names() -> None:
    saved = gathered({"fields/riser": Number(1.0), "fields/riser top": Number(2.0)})
    assert set(saved) == {"fields/riser/value", "fields/riser top/value"}
    assert within(within(saved, "fields"), "riser").keys() == {"value"}
    first, second = Number(0.0), Number(0.0)
    restore_all({"fields/riser": first, "fields/riser top": second}, saved)
    assert (first.value, second.value) == (1.0, 2.0)


def test_plain_values_keep_all_digits() -> None:
    value = {"sizes": [0.1 + 0.2, 1e-310, -0.0, math.inf], "text": "m²", "none": None, "count": 2**60}
    assert unpacked(packed(value)) == value
    assert math.isnan(unpacked(packed(math.nan)))


def test_a_record_comes_back() -> None:
    state = State(0.3, np.array([1.0]), np.zeros(1), np.array([-0.0]))
    again = record_of(State, values_of(state))
    assert again.t == state.t
    assert np.array_equal(again.u, state.u)
    assert again.u is not state.u
    assert record_of(Energy, values_of(Energy(1.0, 2.0, 3.0))) == Energy(1.0, 2.0, 3.0)


def cut_and_grown() -> StepControl:
    return StepControl(1.0, 0.3, 0.3 / 8)


def automatic() -> AutoSteps:
    return AutoSteps(1.0, 1e-3, 1e-6, 0.01, (0.4, 0.7))


@pytest.mark.parametrize("make", [cut_and_grown, automatic])
def test_steps_go_on_as_they_would_have(make: Callable[[], StepControl | AutoSteps]) -> None:
    alone, saved, sizes = make(), dict[int, Saved](), list[tuple[float, float]]()
    while not alone.finished:
        saved[len(sizes)] = alone.state()
        sizes.append(walked(alone, len(sizes)))
    for n in saved:
        again = make()
        again.restore(saved[n])
        assert [walked(again, k) for k in range(n, len(sizes))] == sizes[n:]
        assert again.finished


def walked(control: Control, n: int) -> tuple[float, float]:
    """Target and size of the n-th step; some are cut, and some are hard."""
    control.rejection(3e-4 * (control.dt / 0.04) ** 3)
    if n in (1, 5):
        control.cut()
    values = control.target, control.dt
    control.accept(easy=n % 3 != 0)
    return values


def test_seconds_spent_before_count_too() -> None:
    clock, again = Timer.new(), Timer.new()
    clock.seconds |= {"riser": 2.0, "matrix": 1.0}
    again.seconds["riser"] = 0.5
    again.restore(clock.state())
    assert again.seconds == {"riser": 2.5, "matrix": 1.0}


def test_a_summary_comes_back_as_it_was() -> None:
    """Of a stage that ended, and one under way; other steps follow."""
    arc = np.linspace(0.0, 150.0, 31)
    whole, again = Tallies(FACTS, ("",)), Tallies(FACTS, ("",))
    for kind in ("static", "dynamic"):
        whole.begin_stage(kind, kind, automatic=False)
        whole.stage.implausible, whole.stage.lines[""].implausible = ("doubtful",), ("strained",)
        tallied(whole, 0.1, Catenary(18.0, 30.0).record(arc), residual=0.2)
    again.restore(whole.state())
    assert repr(again.summary.as_dict()) == repr(whole.summary.as_dict())
    for each in (whole, again):
        tallied(each, 0.2, Catenary(16.0, 20.0).record(arc), residual=0.1)
        each.begin_stage("on", "dynamic", automatic=True)
        tallied(each, 0.1, Catenary(17.0, 25.0).record(arc), residual=0.3)
    assert repr(again.summary.as_dict()) == repr(whole.summary.as_dict())


def tallied(tallies: Tallies, t: float, record: Record, residual: float) -> None:
    ledger = Ledger(residual=residual, turned_over=5.0)
    step = StepRecord(t, StepStatistics(3, 0.1, 0.0, 0, local_error=residual), ledger)
    tallies.accept([step], [DueOutputs(series=True, pictures=False)], {"": stacked([record])}, {})


@pytest.mark.parametrize("scheme", [GeneralizedAlpha.newmark(), GeneralizedAlpha.from_rho_inf(0.5)])
def test_a_stepper_goes_on_to_the_last_bit(scheme: GeneralizedAlpha) -> None:
    """Masses on springs, 20 steps; another stepper takes over after 7."""
    chain = Chain(np.array([0.0, 1.1, 1.9]), prescribed=True)
    saved, alone = stepped(chain, scheme, State.at_rest(0.0, 3), 0, 20, save_after=7)
    other = Chain(np.array([0.0, 1.1, 1.9]), prescribed=True)
    other.restore(within(saved, "chain"))
    _, rest = stepped(other, scheme, within(saved, "stepper"), 7, 20)
    assert rest == alone[7:]
    assert np.array_equal(chain.z, other.z)


def stepped(
    chain: Chain, scheme: GeneralizedAlpha, begin: State | Saved, first: int, last: int, save_after: int = 0
) -> tuple[Saved, list[tuple[float, ...]]]:
    """Energies and heights after each step; what was saved after one of them."""
    field: LineField = chain
    parts: list[Part] = [Springs(chain, 1.0, 100.0), Inertia(chain, 2.0)]
    system = System(MPI.COMM_SELF, Model([field], parts), Timer.new())
    newton, control = Newton(system, NewtonSettings(1e-10, 20, 1e-12)), StepControl(1.0, 0.05, 0.05)
    control.restore({"at": np.array(first), "level": np.array(0)})
    stepper, rows, saved = TimeStepper(system, newton, scheme, begin), list[tuple[float, ...]](), Saved()
    owners: dict[str, Stateful] = {"chain": chain, "stepper": stepper}
    for n in range(first, last):
        stepper.commit(stepper.advance(control), control)
        rows.append((stepper.energy.total, *chain.z))
        if n + 1 == save_after:
            saved = gathered(owners)
    newton.destroy()
    system.destroy()
    return saved, rows
