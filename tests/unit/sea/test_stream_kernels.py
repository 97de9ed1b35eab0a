"""The water's motion at a pipe's stations: found once for a time and places."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import State
from riser_soil.sea import morison
from riser_soil.sea.buoyancy import Buoyancy, dry_pipe
from riser_soil.sea.flows import Sea, WaterMotion, add_flow
from riser_soil.sea.morison import Morison
from riser_soil.sea.stream_kernels import FlowAtStations
from tests.support import sample_water
from tests.support.dense_chain import residual, tangent
from tests.support.differences import WEIGHTS
from tests.support.sample_line import Sample, sample

pytestmark = pytest.mark.usefixtures("uncompiled")


class Counted(NamedTuple):
    """Uneven water, the times (n,) at which it was asked for, and how often that was (1,)."""

    flow: sample_water.General
    times: Array
    asked: IntArray

    @property
    def asked_at(self) -> list[float]:
        return list(self.times[: self.asked[0]])


def counted() -> Counted:
    return Counted(sample_water.general(), np.zeros(20), np.zeros(1, dtype=np.int64))


@add_flow.of(Counted)
def _add_counted(counted: Counted, motion: WaterMotion, t: Array, x: Array) -> None:
    counted.times[counted.asked[0]] = t[0]
    counted.asked[0] += 1
    sample_water.add_to(motion, counted.flow, t[0], x)


def at_time(at: Sample, t: float, moved: float, rate: float) -> State:
    state = at.state(2)
    return State(t, (1.0 + moved) * state.u, rate * state.v, rate * state.a)


def in_sea(at: Sample, *flows: Counted) -> Morison:
    sea = Sea(sample_water.LEVEL, flows) if flows else sample_water.water
    return sample_water.driven(sample_water.resistance(at), sea)


@pytest.mark.parametrize("dimension", [2, 3])
def test_water_is_asked_once_for_a_time_and_places(dimension: int) -> None:
    """Rates may change; the motion where the step begins is known at its end, for work."""
    at, water = sample(dimension), counted()
    part, first, last = in_sea(at, water), at_time(at, 1.0, 0.0, 1.0), at_time(at, 1.5, 0.2, 2.0)
    for state in (first, at_time(at, 1.0, 0.0, 2.0), at_time(at, 1.5, 0.1, 2.0), last):
        residual([part], state)
    tangent([part], last, WEIGHTS)
    part.work(first, last)
    residual([part], at_time(at, 1.5, 0.2, 3.0))
    assert water.asked_at == [1.0, 1.5, 1.5]
    part.work(at_time(at, 1.0, 0.1, 1.0), last)
    assert water.asked_at == [1.0, 1.5, 1.5, 1.0]


@pytest.mark.parametrize("dimension", [2, 3])
def test_motion_is_that_of_the_time_and_the_places(dimension: int) -> None:
    """Whatever was asked before, the same as of a stream that is new."""
    at = sample(dimension)
    used = in_sea(at)
    for t, moved in ((1.0, 0.0), (1.5, 0.0), (1.5, 0.1), (1.0, 0.0), (1.0, 0.1), (1.5, 0.1), (1.0, 0.0)):
        state = at_time(at, t, moved, 1.0)
        np.testing.assert_array_equal(residual([used], state, WEIGHTS), residual([in_sea(at)], state, WEIGHTS))


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_tangent_has_the_water_of_its_own_state(dimension: int) -> None:
    """And so has energy, where another part at the same stations has been asked at another state since."""
    at = sample(dimension)
    of, state = sample_water.resistance(at), at.state(1)
    water = FlowAtStations(of.pipe, sample_water.water)
    part = morison.in_sea(water, of.drag, of.mass, morison.pushed_masses(of.mass, of.displaced), of.pipe.span)
    other = Buoyancy(water, dry_pipe(of.displaced), flat=False)
    expected = tangent([part], state, WEIGHTS), part.energy(state).kinetic
    for _ in range(2):
        residual([part], state)
        residual([other], at.state(2))
        np.testing.assert_array_equal(tangent([part], state, WEIGHTS), expected[0])
        residual([other], at.state(2))
        assert part.energy(state).kinetic == expected[1]
