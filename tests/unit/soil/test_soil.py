"""Soil is asked for its stress anew only where its increments or its history have changed."""

from __future__ import annotations

import math

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.soil.law import Formula, StressUpdate
from riser_soil.soil.soil import Soil
from tests.support.soil_bench import force
from tests.support.soil_cases import CLAY, moved, small_block


class Asked:
    """A law that counts how often it is asked. forgetful: its history changes with every update, at rest too."""

    def __init__(self, law: Formula, forgetful: bool) -> None:
        self._law, self._forgetful, self.times = law, forgetful, 0
        self.columns, self.symmetric, self.bulk, self.shear = law.columns, law.symmetric, law.bulk, law.shear
        self.start, self.overstress, self.by_rate = law.start, law.overstress, law.by_rate

    def update(self, strain_increment: Array, history: Array, dt: float = math.inf) -> StressUpdate:
        self.times += 1
        update = self._law.update(strain_increment, history, dt)
        return update._replace(history=update.history + 1e-9) if self._forgetful else update


def asked_soil(forgetful: bool = False) -> tuple[Soil, Asked]:
    def law(depth: Array, initial: Array) -> Formula:
        return Asked(CLAY(depth, initial), forgetful)

    soil = Soil(small_block("hex"), law, level=0.0, unit_weight=5.0e3)
    assert isinstance(soil.law, Asked)
    return soil, soil.law


def again(state: State) -> State:
    """A state again, with the same increments."""
    return State(state.t + 1.0, state.u.copy(), state.v, state.a)


def accept(soil: Soil, state: State) -> None:
    for owner in (soil, soil.field):
        owner.commit(state)


def test_the_same_increments_are_answered_once() -> None:
    soil, law = asked_soil()
    state = moved(soil, 5e-3)
    first = force(soil, state)
    np.testing.assert_array_equal(force(soil, again(state)), first)
    soil.energy(again(state))
    accept(soil, again(state))
    assert law.times == 1


def test_other_increments_are_answered_anew_in_an_array_that_was_seen_too() -> None:
    soil, law = asked_soil()
    state = moved(soil, 5e-3)
    first = force(soil, state)
    state.u[:] *= 0.5
    assert np.abs(force(soil, state) - first).max() > 0.1 * np.abs(first).max()
    assert law.times == 2


def test_after_a_step_the_same_increments_lead_on() -> None:
    """The step goes on from the last history: as soil does that was asked for nothing between."""
    (soil, law), other = asked_soil(), asked_soil()[0]
    state = moved(soil, 5e-3)
    accept(soil, state)
    forces = force(soil, state)
    assert law.times == 2
    other.restore(soil.state())
    np.testing.assert_array_equal(force(other, state), forces)


def steps_at_rest(soil: Soil, law: Asked, size: float) -> int:
    """How often the law is asked in three steps at rest, after one with increments of this size [m]."""
    accept(soil, moved(soil, size))
    rest = State.at_rest(1.0, soil.field.size)
    force(soil, rest)
    asked = law.times
    for _ in range(3):
        accept(soil, again(rest))
        force(soil, again(rest))
        force(soil, again(rest))
    return law.times - asked


def test_steps_at_rest_ask_for_nothing() -> None:
    """At the limit of the strength round-off may change the history: there it is once a step."""
    assert steps_at_rest(*asked_soil(), 1e-6) == 0
    assert steps_at_rest(*asked_soil(), 5e-3) <= 3


def test_a_history_that_changes_at_rest_is_asked_again() -> None:
    soil, law = asked_soil(forgetful=True)
    rest = State.at_rest(1.0, soil.field.size)
    for step in range(3):
        force(soil, again(rest))
        assert law.times == step + 1
        accept(soil, again(rest))


def test_a_state_that_is_restored_is_asked_for() -> None:
    soil, law = asked_soil()
    saved = soil.state()
    state = moved(soil, 5e-3)
    force(soil, state)
    soil.restore(saved)
    force(soil, again(state))
    assert law.times == 2
