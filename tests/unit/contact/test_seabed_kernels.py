"""The seabed's kernels of one point and the loops over them: what has none is named, loops add nothing of their own."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba.core.errors import TypingError

from riser_soil.contact.friction import directions_at, elastic_guess, resistance_by_position, vector_of
from riser_soil.contact.law import Penalty, SuctionLaw
from riser_soil.contact.seabed_contact import SeabedContact
from riser_soil.core.arrays import Array
from riser_soil.seabed.compiled_law import CompiledLaw, answer, may_act
from riser_soil.seabed.grounds import Ground, Plane
from riser_soil.seabed.height_field import Profile
from riser_soil.seabed.law import NormalLaw
from tests.support.covered_ground import beyond
from tests.support.sample_line import START, sample
from tests.support.soil_loops import after, aubeny_biscontin, randolph_quiggin
from tests.support.tractions import traction

D, SU = 0.3, 2000.0
LAWS: dict[str, NormalLaw] = {
    "penalty": Penalty(1.0e5, 1e-3),
    "suction": SuctionLaw(Penalty(1.0e5, 1e-3), 300.0, 0.02),
    "randolph-quiggin": randolph_quiggin(D, SU, 1500.0, unit_weight=4.0e3),
    "aubeny-biscontin": aubeny_biscontin(D, SU, 1500.0),
}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
depths = st.floats(-0.03, 0.1)
numbers = st.floats(-2.0, 2.0)


class BareData(NamedTuple):
    """Data of what has no kernels."""

    k: float


BARE = BareData(1.0)


@dataclass(frozen=True)
class BareLaw(CompiledLaw):
    """A law whose kernels were forgotten."""

    columns: ClassVar[tuple[str, ...]] = ()
    capacity: ClassVar[float] = math.inf
    start: ClassVar[float] = 0.0
    reach: ClassVar[float] = 0.0
    kernel_data: BareData = BARE

    def initial_history(self, shape: tuple[int, ...]) -> Array:
        return np.empty((*shape, 0))


@dataclass(frozen=True)
class BareGround(Ground):
    """A ground whose kernel was forgotten."""

    highest: ClassVar[float] = math.inf
    kernel_data: ClassVar[BareData] = BARE
    flat: ClassVar[bool] = True


def test_a_law_without_kernels_is_named() -> None:
    with pytest.raises(TypingError, match=r"No implementation of function .*\bmay_act\b.*\n.*\n.*may_act\(BareData"):
        BareLaw().update(np.zeros(3), np.empty((3, 0)))


def test_a_ground_without_a_kernel_is_named() -> None:
    named = r"No implementation of function .*\bdistance_at\b.*\n.*\n.*distance_at\(BareData"
    with pytest.raises(TypingError, match=named):
        BareGround().distance(np.zeros((1, 3)))


def test_contact_tells_both_before_a_step() -> None:
    at = sample(3)
    state = at.state(1)
    for ground, law, name in ((BareGround(), LAWS["penalty"], "distance_at"), (Plane.level(0.0), BareLaw(), "may_act")):
        with pytest.raises(TypingError, match=rf"{name}\(BareData"):
            SeabedContact(at.line, np.zeros(at.line.length.size), ground, law).energy(state)


@every_law
@settings(max_examples=40)
@given(way=st.lists(depths, min_size=6, max_size=6), ends=st.lists(depths, min_size=6, max_size=6))
def test_points_are_answered_each_for_itself(law: NormalLaw, way: list[float], ends: list[float]) -> None:
    """Whatever the arrays' shape, order in memory and neighbours."""
    alone = [after(law, np.array(way[: n + 1])) for n in range(6)]
    z, histories = np.array(ends).reshape(2, 3), np.stack(alone).reshape(2, 3, -1)
    whole = law.update(np.asfortranarray(z), np.asfortranarray(histories))
    for n in range(6):
        at, one = np.unravel_index(n, (2, 3)), law.update(z.ravel()[n : n + 1], alone[n])
        for together, expected in zip(whole, one, strict=True):
            np.testing.assert_allclose(together[at], expected[0], rtol=1e-12, atol=1e-12)


@every_law
@pytest.mark.parametrize("seed", range(20))
@pytest.mark.usefixtures("uncompiled")
def test_what_may_not_act_does_not(law: NormalLaw, seed: int) -> None:
    """The loops over points leave it out."""
    random, history = np.random.default_rng(seed), law.initial_history(())
    for z in random.uniform(-0.03, 0.1, size=8):
        before, history = history, np.empty(history.shape)
        force, slope, stored = answer(law.kernel_data, z, before, history)
        assert may_act(law.kernel_data, z, before) or force == slope == stored == 0.0


@given(angle=st.floats(-3.1, 3.1), lean=st.floats(-1.2, 1.2), origin=st.tuples(numbers, numbers))
def test_a_profile_looks_the_same_from_wherever_it_is_measured(
    angle: float, lean: float, origin: tuple[float, float]
) -> None:
    """Turned about the vertical and moved with its points."""
    s, z = np.array([0.0, 2.0, 5.0, 9.0]), np.array([0.0, 0.8, -0.5, 0.3])
    turn = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
    x = np.random.default_rng(2).uniform(-3.0, 12.0, size=(9, 3)) + lean
    first = Profile(np.zeros(2), np.array([1.0, 0.0]), s, z).distance(x)
    moved = Profile(np.array(origin), turn[:2, 0], s, z).distance(x @ turn.T + np.array([*origin, 0.0]))
    assert first.hessian is not None
    assert moved.hessian is not None
    np.testing.assert_allclose(moved.value, first.value, atol=1e-11)
    np.testing.assert_allclose(moved.gradient, first.gradient @ turn.T, atol=1e-11)
    away = np.abs(x[:, :1] - s).min(axis=1) > 1e-9  # round-off may move a point over a corner of the third derivative
    np.testing.assert_allclose(moved.hessian[away], (turn @ first.hessian @ turn.T)[away], atol=1e-10)


@settings(max_examples=200)
@given(guess=numbers, N=st.just(0.0) | st.floats(1e-100, 2.0), mu=st.floats(0.1, 2.0), other=st.floats(0.1, 2.0))
def test_friction_in_the_plane_is_that_in_space_along_the_pipe(guess: float, N: float, mu: float, other: float) -> None:
    flat = traction(np.array([[guess]]), np.array([N]), np.array([5.0]), np.array([mu]))
    spatial = traction(np.array([[guess, 0.0]]), np.array([N]), np.array([5.0]), np.array([mu, other]))
    for one, two in zip(flat, spatial, strict=True):
        assert one.ravel()[0] == pytest.approx(two.ravel()[0], rel=1e-12)
    assert spatial[0][0, 1] == spatial[2][0, 1] == 0.0


@given(st.lists(numbers, min_size=9, max_size=9), st.floats(0.1, 2.0))
def test_stuck_ground_resists_by_its_stiffness_along_itself(given: list[float], k: float) -> None:
    """Nothing along its normal, k in every direction of the ground, from the traction at the start of the step."""
    n, tau, moved = (np.array(given[i : i + 3]) for i in (0, 3, 6))
    if min(np.linalg.norm(n), np.linalg.norm(np.cross(n, tau))) < 1e-3:
        return
    along = directions_at(tuple(tau), tuple(n))
    n /= np.linalg.norm(n)
    ground = np.eye(3) - np.outer(n, n)
    t = vector_of(along, elastic_guess(along, (0.0, 0.0, 0.0), k, tuple(moved)))
    np.testing.assert_allclose(t, -k * ground @ moved, atol=1e-9)
    stuck = ((1.0, 0.0), (0.0, 1.0))
    resistance = resistance_by_position(along, k, stuck, (0.0, 0.0), tuple(n))
    np.testing.assert_allclose(resistance, k * ground, atol=1e-9)


@pytest.mark.parametrize("dimension", [2, 3])
def test_covered_stations_feel_nothing_and_keep_their_history(dimension: int) -> None:
    """Half of the line lies on something else; there is no penetration there, and the ground stays untouched."""
    at, law = sample(dimension), LAWS["suction"]
    middle = float(np.median(at.line.to_global(at.line.x)[:, 0]))
    ground, radius = Plane.level(START[2] + 5.0), np.zeros(at.line.length.size)
    free = SeabedContact(at.line, radius, ground, law)
    part = SeabedContact(at.line, radius, ground, law, covering=beyond(middle))
    state = at.state(1)
    here, alone = (contact.kernel_data() for contact in (part, free))
    for contact in (part, free):
        contact.find(state)
    covered = here.place[:, 0] > middle
    near = alone.touching.penetration > -law.reach
    assert (covered & near).any()
    assert not covered.all()
    assert np.all(here.touching.penetration[covered & near] == -np.inf)
    np.testing.assert_array_equal(here.touching.penetration[~covered], alone.touching.penetration[~covered])
    clear, force = part.contact_along_line(state)
    assert np.isinf(clear[covered]).all()
    assert not force[covered].any()
    part.commit(state)
    covered = covered.reshape(part.share.shape)
    assert np.all(np.isinf(part.memory[covered]))
    assert np.all(part.memory[~covered] == 0.0)
