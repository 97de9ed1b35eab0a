"""A body's contact with the seabed by itself: closed forms, tangents by differences, energy."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.bodies.body import MovingBody
from riser_soil.bodies.seabed_contact import BodyContact
from riser_soil.bodies.seabed_friction import BodyFriction
from riser_soil.contact.coulomb import Adhesion
from riser_soil.contact.law import Penalty
from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, Part, State
from riser_soil.seabed.aubeny_biscontin import AubenyBiscontin
from riser_soil.seabed.grounds import Ground, Plane
from riser_soil.seabed.height_field import HeightField
from riser_soil.seabed.law import NormalLaw
from tests.support.dense_chain import tangent
from tests.support.differences import WEIGHTS, difference_tangent, error
from tests.support.sample_body import body, shaken

pytestmark = pytest.mark.usefixtures("uncompiled")

EXACT = 1e-8
STIFFNESS, WIDE = 3.0e4, 1.4  # N/m2; length of pipe as which all points press, m
FEET = np.array([[0.9, 0.4, -0.5], [-0.7, 0.5, -0.6], [0.1, -0.8, -0.4]])
CLAY = AubenyBiscontin(kind="aubeny-biscontin", su=2.0e3, su_gradient=1.5e3, a=6.7, b=0.254)


def humps(z: float) -> HeightField:
    """Uneven ground about a level."""
    x, y = np.linspace(-3.0, 5.0, 6), np.linspace(-2.0, 6.0, 5)
    return HeightField(x, y, z + 0.3 * np.sin(x)[:, None] * np.cos(0.7 * y))


def slope(z: float) -> Plane:
    return Plane.sloping(np.array([1.0, 2.0, z]), 0.3, 0.8)


def touching(
    made: MovingBody, ground: Ground, law: NormalLaw | None = None, points: Array = FEET, radius: float = 0.2
) -> BodyContact:
    return BodyContact(made, points, radius, WIDE, ground, law or Penalty(STIFFNESS, 0.01))


def rubbing(contact: BodyContact, mu: float) -> BodyFriction:
    return BodyFriction(contact, mu, 2.0e4, Adhesion())


def residual(part: Part, state: State) -> Array:
    forces = Forces.zeros(state.u.size)
    part.residual(state, forces)
    assert not forces.force.any()
    assert not forces.inertia.any()
    return forces.end


@pytest.mark.parametrize("ground", [slope(-4.9), humps(-4.9)], ids=["slope", "humps"])
@pytest.mark.parametrize("law", [Penalty(STIFFNESS, 0.01), CLAY.of_pipe(0.4)], ids=["penalty", "clay"])
@pytest.mark.parametrize("turns", [False, True], ids=["point", "rigid"])
def test_the_tangent_is_exact(ground: Ground, law: NormalLaw, turns: bool) -> None:
    made = body(turns)
    part = touching(made, ground, law, FEET if turns else np.zeros((1, 3)))
    state = shaken(made, size=0.1)
    K = tangent([part], state, WEIGHTS)
    assert part.penetration(state) > 0.1
    assert np.abs(K[:3, :3]).max() > STIFFNESS / 10.0
    if turns:  # the body's rotation counts, and its second derivatives
        assert np.abs(K[3:, 3:]).max() > STIFFNESS / 100.0
    assert error(K, difference_tangent(part, state, WEIGHTS)) < EXACT
    assert error(K, K.T) < EXACT


@pytest.mark.parametrize("mu", [0.05, 50.0], ids=["slides", "sticks"])
@pytest.mark.parametrize("ground", [slope(-4.9), humps(-4.9)], ids=["slope", "humps"])
def test_the_tangent_of_friction_is_exact(ground: Ground, mu: float) -> None:
    made = body()
    contact = touching(made, ground)
    part, state = rubbing(contact, mu), shaken(made, size=0.1)
    K = tangent([part], state, WEIGHTS)
    assert np.abs(K).max() > 1e2
    assert error(K, difference_tangent(part, state, WEIGHTS)) < EXACT


def test_forces_are_the_slope_of_the_energy() -> None:
    made = body()
    part, state, h = touching(made, humps(-4.9)), shaken(made, size=0.1), 1e-5
    forces = residual(part, state)
    for i, direction in enumerate(np.eye(6)):
        there, back = (part.energy(State(0.6, state.u + s * direction, state.v, state.a)) for s in (h, -h))
        assert (there.potential - back.potential) / (2.0 * h) == pytest.approx(forces[i], rel=1e-6, abs=1e-2)


def test_a_sphere_sinks_in_by_its_depth_below_the_seabed() -> None:
    """At a height h over the bed with radius r: k L (r - h) upwards, and square to a slope."""
    made = MovingBody("clump", np.array([3.0, 1.0, -9.7]), False, 1.0)
    part = BodyContact(made, np.zeros((1, 3)), 0.5, 2.0, Plane.level(-10.0), Penalty(1.0e4))
    rest = State.at_rest(0.0, 6)
    assert part.force_on_body(rest) == pytest.approx([0.0, 0.0, 2.0 * 1.0e4 * 0.2])
    assert part.penetration(rest) == pytest.approx(0.2)
    steep = Plane.sloping(np.array([3.0, 1.0, -10.0]), np.radians(30.0), 0.0)
    part = BodyContact(made, np.zeros((1, 3)), 0.5, 2.0, steep, Penalty(1.0e4))
    sunk = 0.5 - 0.3 * np.cos(np.radians(30.0))
    assert part.force_on_body(rest) == pytest.approx(2.0e4 * sunk * steep.normal)
    high = BodyContact(made, np.zeros((1, 3)), 0.5, 2.0, Plane.level(-20.0), Penalty(1.0e4))
    assert not high.force_on_body(rest).any()
    assert high.penetration(rest) == 0.0


def test_a_foot_beside_the_origin_turns_the_body() -> None:
    made = MovingBody("sled", np.array([0.0, 0.0, -9.0]), True, 1.0)
    part = BodyContact(made, np.array([[2.0, 0.0, -1.1]]), 0.0, 1.0, Plane.level(-10.0), Penalty(1.0e4))
    forces = -residual(part, State.at_rest(0.0, 6))
    assert forces == pytest.approx([0.0, 0.0, 1.0e3, 0.0, -2.0e3, 0.0])  # moment r x f


def test_feet_share_the_stiffness() -> None:
    made = MovingBody("sled", np.array([0.0, 0.0, -10.0]), True, 1.0)
    for feet in (FEET[:1], FEET):
        part = BodyContact(made, feet * [1.0, 1.0, 0.0], 0.1, 2.0, Plane.level(-10.0), Penalty(1.0e4))
        assert part.force_on_body(State.at_rest(0.0, 6))[2] == pytest.approx(2.0e3)


def drop(part: Part, made: MovingBody, deep: float) -> tuple[float, float, float]:
    """Dissipated, by the scheme, and the change of the energy stored in a step straight down."""
    before = State.at_rest(0.0, 6)
    after = State(1.0, np.array([0.0, 0.0, -deep, 0.0, 0.0, 0.0]), np.zeros(6), np.zeros(6), dt=1.0)
    work = part.work(before, after)
    return work.dissipated, work.by_scheme, part.energy(after).total - part.energy(before).total


def test_a_step_into_the_ground_loses_what_the_scheme_takes() -> None:
    """The force at the step's end takes k L z z, of which half is stored."""
    made = MovingBody("clump", np.array([0.0, 0.0, -9.5]), False, 1.0)
    part = BodyContact(made, np.zeros((1, 3)), 0.5, 2.0, Plane.level(-10.0), Penalty(1.0e4))
    dissipated, by_scheme, stored = drop(part, made, 0.3)
    assert stored == pytest.approx(0.5 * 2.0e4 * 0.3**2)
    assert dissipated == pytest.approx(stored)
    assert by_scheme == pytest.approx(stored)


def test_clay_dissipates_by_itself_and_remembers() -> None:
    made = MovingBody("clump", np.array([0.0, 0.0, -9.5]), False, 1.0)
    part = BodyContact(made, np.zeros((1, 3)), 0.5, 2.0, Plane.level(-10.0), CLAY.of_pipe(1.0))
    dissipated, by_scheme, _ = drop(part, made, 0.3)
    assert 0.0 < by_scheme < dissipated
    after = State(1.0, np.array([0.0, 0.0, -0.3, 0.0, 0.0, 0.0]), np.zeros(6), np.zeros(6), dt=1.0)
    pressed = part.force_on_body(after)[2]
    part.commit(after)
    made.commit(after)
    kept = part.state()
    risen = State(2.0, np.array([0.0, 0.0, 0.01, 0.0, 0.0, 0.0]), np.zeros(6), np.zeros(6), dt=1.0)
    assert part.force_on_body(risen)[2] < 0.8 * pressed  # unloads along a steep line
    new = BodyContact(made, np.zeros((1, 3)), 0.5, 2.0, Plane.level(-10.0), CLAY.of_pipe(1.0))
    assert new.force_on_body(risen)[2] != pytest.approx(part.force_on_body(risen)[2], rel=0.1)
    new.restore(kept)
    assert new.force_on_body(risen)[2] == pytest.approx(part.force_on_body(risen)[2], rel=1e-12)


def test_friction_drags_no_harder_than_the_coefficient_and_is_kept() -> None:
    made = MovingBody("clump", np.array([0.0, 0.0, -9.7]), False, 1.0)
    contact = BodyContact(made, np.zeros((1, 3)), 0.5, 2.0, Plane.level(-10.0), Penalty(1.0e4))
    part, pressed = rubbing(contact, 0.4), 2.0e4 * 0.2

    def slid(x: float, y: float) -> State:
        return State(1.0, np.array([x, y, 0.0, 0.0, 0.0, 0.0]), np.zeros(6), np.zeros(6), dt=1.0)

    assert part.force_on_body(slid(1e-3, 0.0)) == pytest.approx([-2.0 * 2.0e4 * 1e-3, 0.0, 0.0])
    far = slid(0.3, -0.4)
    assert part.force_on_body(far) == pytest.approx(0.4 * pressed * np.array([-0.6, 0.8, 0.0]))
    work = part.work(State.at_rest(0.0, 6), far)
    stored = part.energy(far).potential
    assert work.dissipated == pytest.approx(0.4 * pressed * 0.5 - stored)
    part.commit(far)
    made.commit(far)
    rest = State.at_rest(1.0, 6)
    assert part.force_on_body(rest) == pytest.approx(0.4 * pressed * np.array([-0.6, 0.8, 0.0]))
    again = rubbing(contact, 0.4)
    again.restore(part.state())
    assert again.force_on_body(rest) == pytest.approx(part.force_on_body(rest))


def test_a_rank_that_does_not_evaluate_it_tells_of_nothing() -> None:
    made = MovingBody("clump", np.array([0.0, 0.0, -9.7]), False, 1.0, active=False)
    contact = BodyContact(made, np.zeros((1, 3)), 0.5, 2.0, Plane.level(-10.0), Penalty(1.0e4))
    rest = State.at_rest(0.0, 6)
    assert not contact.force_on_body(rest).any()
    assert not rubbing(contact, 0.3).force_on_body(rest).any()
    assert contact.penetration(rest) == 0.0
