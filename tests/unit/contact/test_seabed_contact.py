"""Contact along the elements with a seabed without dofs: tangent, closed forms, energy, readings. The cushion on which
a riser is laid: how it bears, fades and is absent beside the soil; its tangent.
"""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.contact.law import Penalty
from riser_soil.contact.seabed_contact import Cushion, SeabedContact
from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State
from riser_soil.riser import shapes, stations
from riser_soil.riser.line import End, Line
from riser_soil.seabed.grounds import Ground, Plane
from riser_soil.seabed.height_field import HeightField, Profile
from riser_soil.seabed.randolph_quiggin import RandolphQuiggin
from tests.support.contact_along import intervals_at, touchdown_at
from tests.support.covered_ground import beyond
from tests.support.dense_chain import STATIC, residual, tangent
from tests.support.differences import WEIGHTS, difference_tangent, error
from tests.support.sample_line import DIRECTION, START, Sample, sample

pytestmark = pytest.mark.usefixtures("uncompiled")

both_dimensions = pytest.mark.parametrize("dimension", [pytest.param(2, marks=pytest.mark.verify), 3])
ROUND = Penalty(4.0e4, smoothing=30.0)  # its rounded corner holds the whole sample, so that differences are smooth
HILL = Profile(START[:2], DIRECTION[:2], np.array([-1.0, 2.0, 4.0, 8.0]), START[2] + np.array([0.5, -0.6, 0.3, 1.0]))
AT = np.array([-9.0, -4.0, -1.0, 1.5, 4.0, 9.0])
GROUNDS: dict[str, Ground] = {
    "level": Plane.level(START[2] - 0.1),
    "slope": Plane.sloping(START, 0.2, np.arctan2(DIRECTION[1], DIRECTION[0])),
    "profile": HILL,
    "grid": HeightField(START[0] + AT, START[1] + AT, START[2] + 0.3 * np.sin(AT + 0.7 * AT[:, None])),
}
RULES = {"ends": stations.ENDS, "three points": stations.THREE_POINTS, "five points": stations.gauss(5)}
COMBINED = [  # all with all in verify
    pytest.param(ground, rule, marks=[pytest.mark.verify] * (rule != "three points" and ground != "grid"))
    for ground in GROUNDS
    for rule in RULES
]


def contact(at: Sample, ground: Ground, law: Penalty = ROUND, rule: str = "three points") -> SeabedContact:
    return SeabedContact(at.line, 0.5 * at.elements.outer_diameter, ground, law, RULES[rule])


@both_dimensions
@pytest.mark.parametrize(("ground", "rule"), COMBINED)
def test_tangent_is_the_derivative_of_the_residual(dimension: int, ground: str, rule: str) -> None:
    at = sample(dimension)
    part, state = contact(at, GROUNDS[ground], rule=rule), at.state(1)
    K = tangent([part], state, WEIGHTS)
    assert error(K, difference_tangent(part, state, WEIGHTS)) < 1e-7
    assert np.abs(K - K.T).max() < 1e-11 * np.abs(K).max()


@both_dimensions
def test_forces_are_the_derivative_of_the_stored_energy(dimension: int) -> None:
    at = sample(dimension)
    part, state = contact(at, HILL), at.state(2)
    forces = Forces.zeros(state.u.size)
    part.residual(state, forces)
    h, direction = 1e-5, np.random.default_rng(3).normal(size=state.u.size)
    ahead, behind = (State(state.t, state.u + s * h * direction, state.v, state.a) for s in (1.0, -1.0))
    slope = (part.energy(ahead).potential - part.energy(behind).potential) / (2.0 * h)
    assert float(forces.end @ direction) == pytest.approx(slope, rel=1e-8)
    assert not forces.force.any()
    assert not forces.inertia.any()


@both_dimensions
def test_the_first_guess_lands_as_it_does_beside_soil(dimension: int) -> None:
    """Where something covers the seabed it stands aside: far away, or below all of the line."""
    at = sample(dimension)
    ground = Plane.sloping(START - np.array([0.0, 0.0, 0.1]), 0.1, 0.3)
    radius, guess = np.full(at.line.length.size, 0.1), at.state(1)
    alone = SeabedContact(at.line, radius, ground, ROUND)
    beside, below = (SeabedContact(at.line, radius, ground, ROUND, covering=beyond(x)) for x in (1e6, -1e6))
    predicted = alone.predict(guess)
    assert np.abs(predicted - guess.u).max() > 0.0
    np.testing.assert_array_equal(predicted, beside.predict(guess))
    np.testing.assert_array_equal(guess.u, below.predict(guess))


@both_dimensions
def test_on_clay_the_first_guess_goes_on(dimension: int) -> None:
    """The line is raised over stiffer ground."""
    at = sample(dimension)
    ground = Plane.sloping(START - np.array([0.0, 0.0, 0.1]), 0.1, 0.3)
    radius, guess = np.full(at.line.length.size, 0.1), at.state(1)
    clay = RandolphQuiggin(kind="randolph-quiggin", su=2.0e3).of_pipe(0.2)
    assert SeabedContact(at.line, radius, ground, ROUND).predict(guess) is not guess.u
    assert SeabedContact(at.line, radius, ground, clay).predict(guess) is guess.u


@both_dimensions
@pytest.mark.parametrize("rule", RULES)
def test_sum_and_nodal_forces_of_a_line_pressed_evenly(dimension: int, rule: str) -> None:
    """A level line 0.2 m deep everywhere feels k 0.2 on its length, whatever the rule."""
    arc = np.array([0.0, 1.0, 1.5, 3.5, 4.0])
    flat = shapes.straight(arc, (0.0, 0.0, -0.2))
    line = Line(dimension, shapes.layout(arc, np.full(4, 0.1), flat, flat), End(True), End(False))
    part = SeabedContact(line, np.zeros(4), Plane.level(0.0), Penalty(1e3, 1e-3), RULES[rule])
    state = State.at_rest(0.0, line.size)
    assert part.force_per_length(state) == pytest.approx(np.full(5, 200.0))
    assert part.force_on_riser(state) == pytest.approx([0.0, 0.0, 800.0])
    assert part.max_penetration(state) == pytest.approx(0.2)
    assert touchdown_at(part, state) == pytest.approx(4.0)
    ((start, end, *whole),) = intervals_at(part, state)
    assert (start, end) == pytest.approx((0.0, 4.0))
    assert all(whole)


@both_dimensions
def test_landing_takes_energy_and_never_gives_it(dimension: int) -> None:
    at = sample(dimension, shaken=False)
    part = contact(at, Plane.level(START[2] - 1.0), Penalty(4.0e4, 1e-3))
    rest = State.at_rest(0.0, at.line.size)
    for seed in range(6):
        moved = at.state(seed, 0.5)
        assert part.work(rest, moved).dissipated >= 0.0
        assert part.work(rest, moved).external == 0.0


RADIUS, LEVEL, WEIGHT, DEPTH = 0.15, -2.0, 700.0, 0.003


def lying(dimension: int = 2, above: float = 0.0, covered: float = np.inf) -> tuple[Line, Cushion]:
    """A straight pipe whose underside is so far above the soil; nothing but the cushion up to x = covered."""
    arc = np.linspace(0.0, 10.0, 6)
    flat = shapes.straight(arc, (0.0, 0.0, LEVEL + RADIUS + above))
    line = Line(dimension, shapes.layout(arc, np.full(5, 0.3), flat, flat), End(False), End(False))
    return line, Cushion(line, np.full(5, RADIUS), LEVEL, WEIGHT, DEPTH, beyond(-1.0, covered))


def state_at(line: Line, t: float, u: Array | None = None) -> State:
    u = np.zeros(line.size) if u is None else u
    return State(t, u, np.zeros(line.size), np.zeros(line.size))


def borne(line: Line, cushion: Cushion, t: float) -> float:
    forces = residual([cushion], state_at(line, t))
    return -float(forces[line.translation_dofs[:, -1]].sum())


@pytest.mark.parametrize(("t", "share"), [(0.0, 1.0), (0.25, 0.5625), (0.5, 0.25), (1.0, 0.0)])
def test_a_pipe_that_touches_the_soil_is_borne_and_the_less_the_farther(t: float, share: float) -> None:
    line, cushion = lying()
    assert borne(line, cushion, t) == pytest.approx(share * WEIGHT * 10.0, rel=1e-9)


def test_beside_the_soil_there_is_no_cushion() -> None:
    line, cushion = lying(covered=4.0)
    assert borne(line, cushion, 0.0) == pytest.approx(4.0 * WEIGHT, rel=1e-9)
    line, cushion = lying(above=2.0 * DEPTH)
    assert borne(line, cushion, 0.0) == 0.0


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_cushion_s_tangent_is_the_slope_of_its_residual(dimension: int) -> None:
    line, cushion = lying(dimension, above=0.3 * DEPTH)
    random = np.random.default_rng(3)
    state = state_at(line, 0.3, 2e-4 * random.normal(size=line.size))
    wanted = difference_tangent(cushion, state, STATIC, h=1e-6)
    assert error(tangent([cushion], state), wanted) < 1e-6
