"""Bodies and joints by themselves: closed forms, tangents by differences, balance of what a joint does to its sides."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

from riser_soil.bodies.body import BodyProperties, MovingBody, wet, wet_height
from riser_soil.bodies.drag import BodyDrag
from riser_soil.bodies.inertia import BodyInertia
from riser_soil.bodies.joints import JointOf, Joints, Side
from riser_soil.bodies.loads import BodyWeight, Release
from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, Part, State, Weights
from riser_soil.core.sphere import radius_of
from riser_soil.sea.current import SteadyCurrent
from riser_soil.sea.flows import Sea
from tests.support.differences import WEIGHTS, difference_tangent, error
from tests.support.sample_body import RHO, body, properties, shaken
from tests.support.sample_line import sample

pytestmark = pytest.mark.usefixtures("uncompiled")

EXACT = 1e-8


def sea() -> Sea:
    """A sheared current under a surface at z = 0."""
    return Sea(0.0, [SteadyCurrent(np.array([-20.0, 0.0]), np.array([[0.3, -0.1], [1.2, 0.7]]), False)])


def parts(made: MovingBody) -> list[Part]:
    given = properties(made.turns)
    buoyancy = 9.81 * RHO * given.volume
    return [
        BodyInertia(made, given.mass_matrix()),
        BodyWeight(made, given, 9.81 * given.mass, buoyancy, 0.0),
        BodyDrag(made, given, sea(), RHO, buoyancy, -0.1, still=False),
        Release(made, 1e3 * np.arange(1.0, 7.0)),
    ]


def tangent(part: Part, state: State, weights: Weights) -> Array:
    values = {key: block.zeros() for key, block in part.blocks().items()}
    part.tangent(state, weights, values)
    K = np.zeros((state.u.size, state.u.size))
    for key, block in part.blocks().items():
        for dofs, element in zip(block.rows, values[key], strict=True):
            there = dofs >= 0
            K[np.ix_(dofs[there], dofs[there])] += element[np.ix_(there, there)]
    return K


@pytest.mark.parametrize("turns", [False, True])
@pytest.mark.parametrize("z", [-5.0, 0.05])  # under water, and where it floats
def test_tangents_are_exact(turns: bool, z: float) -> None:
    made = body(turns, z)
    state = shaken(made)
    if z > 0.0:
        state.u[2] = 0.02
    for part in parts(made):
        K = tangent(part, state, WEIGHTS)
        if part.name == "body weight" and not turns and z < 0.0:  # the same everywhere
            assert not K.any()
            continue
        assert np.abs(K).max() > 1.0
        assert error(K, difference_tangent(part, state, WEIGHTS)) < EXACT, part.name


def test_the_weight_is_the_slope_of_its_energy() -> None:
    made = body(z=0.05)
    part, state = parts(made)[1], shaken(made)
    state.u[2] = 0.02
    forces = Forces.zeros(6)
    part.residual(state, forces)
    h = 1e-5
    for i, direction in enumerate(np.eye(6)):
        there, back = (part.energy(State(0.0, state.u + s * direction, state.v, state.a)) for s in (h, -h))
        assert (there.potential - back.potential) / (2.0 * h) == pytest.approx(forces.force[i], rel=1e-6, abs=1e-3)


@pytest.mark.parametrize("turns", [False, True])
def test_what_held_a_body_has_its_reaction_at_first_and_nothing_at_last(turns: bool) -> None:
    made, reaction = body(turns), np.array([3.0, -2.0, 5.0, 4.0, -1.0, 2.0])
    part = Release(made, reaction)
    for t, share in ((0.0, -1.0), (0.5, -0.5), (1.0, 0.0)):
        forces = Forces.zeros(made.size)
        part.residual(State(t, *np.zeros((3, made.size))), forces)
        assert forces.force == pytest.approx(share * reaction, abs=1e-9)


def test_inertia_of_a_body_that_is_thrown() -> None:
    """With a centre of gravity beside the origin, f = m a of the centre, m = J A + W x J W about it."""
    given = properties()
    plain = BodyProperties(
        given.mass, given.inertia, given.gravity_centre, 0.0, np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3),
        np.zeros(3),
    )  # fmt: skip
    made = MovingBody("thrown", np.zeros(3), True, 1.0)
    part, state, c = BodyInertia(made, plain.mass_matrix()), shaken(made), given.gravity_centre
    state.u[:] = 0.0
    W, A, J = state.v[3:], state.a[3:], np.diag(given.inertia)
    force = given.mass * (state.a[:3] + np.cross(A, c) + np.cross(W, np.cross(W, c)))
    moment = np.cross(c, force) + J @ A + np.cross(W, J @ W)
    forces = Forces.zeros(6)
    part.residual(state, forces)
    assert forces.inertia == pytest.approx(np.concatenate([force, moment]), rel=1e-12)


def test_added_mass_makes_no_energy() -> None:
    """The power of the force is the rate of the kinetic energy, however different the added masses are."""
    made = body()
    part, state = parts(made)[0], shaken(made)
    forces, h = Forces.zeros(6), 1e-6
    state = State(0.0, np.zeros(6), state.v, state.a)
    part.residual(state, forces)
    power = float(forces.inertia @ state.v)

    def kinetic(s: float) -> float:
        return part.energy(State(0.0, s * state.v, state.v + s * state.a, state.a)).kinetic

    assert (kinetic(h) - kinetic(-h)) / (2.0 * h) == pytest.approx(power, rel=1e-7)


def test_drag_of_a_point_in_a_current() -> None:
    made = MovingBody("clump", np.array([0.0, 0.0, -20.0]), False, 1.0)
    given, forces = properties(turns=False), Forces.zeros(6)
    BodyDrag(made, given, sea(), RHO, 0.0, 0.0, still=False).residual(State.at_rest(0.0, 6), forces)
    u = np.array([0.3, -0.1, 0.0])
    assert forces.force[:3] == pytest.approx(-0.5 * RHO * 0.8 * np.linalg.norm(u) * u, rel=1e-12)
    assert not forces.force[3:].any()


def test_a_sphere_is_wet_by_its_cap() -> None:
    """The volume of a cap of height d is pi d^2 (3 r - d)/3."""
    r = radius_of(2.0)
    for d in (0.3 * r, r, 1.7 * r):
        assert wet(d - r, r)[0] == pytest.approx(math.pi * d**2 * (3.0 * r - d) / 3.0 / 2.0, rel=1e-12)
        slope = (wet_height(d - r + 1e-6, r) - wet_height(d - r - 1e-6, r)) / 2e-6
        assert slope == pytest.approx(wet(d - r, r)[0], rel=1e-8)
    assert wet(-2.0 * r, r) == (0.0, 0.0)
    assert wet(2.0 * r, r) == (1.0, 0.0)
    assert wet_height(3.0 * r, r) == pytest.approx(3.0 * r)
    assert wet_height(-3.0 * r, r) == 0.0


def joined(kinds: Sequence[tuple[float, float]] = ((3.0e4, 500.0), (2.0e4, 0.0))) -> tuple[Joints, int]:
    """A line's node on a rigid body, and its end on a point, both in general position; and the dofs of all."""
    line = sample(3).line
    rigid, point = body(), body(turns=False)
    rigid.offset = line.size
    point.offset = line.size + 6
    first = Side(line, 2, np.array([0.1, 0.0, -0.2])), Side(rigid, 0, np.array([0.5, -0.4, 0.3]))
    second = Side(point, 0, np.zeros(3)), Side(line, line.nodes - 1, np.zeros(3))
    made = [JointOf(f"joint {n}", sides, *kinds[n]) for n, sides in enumerate((first, second))]
    return Joints(made, [False, False]), line.size + 12


def test_the_joints_tangent_is_exact_and_symmetric() -> None:
    joints, size = joined()
    u, v, a = np.random.default_rng(5).normal(size=(3, size))
    state = State(0.3, 0.3 * u, v, a)
    joints.open = 0.4
    K = tangent(joints, state, WEIGHTS)
    assert error(K, difference_tangent(joints, state, WEIGHTS)) < EXACT
    assert np.abs(K - K.T).max() < 1e-9 * np.abs(K).max()


def test_action_is_reaction() -> None:
    """No motion of all together as one rigid body meets a force or a moment."""
    joints, size = joined()
    u = 0.3 * np.random.default_rng(5).normal(size=size)
    state = State(0.0, u, np.zeros(size), np.zeros(size))
    forces = Forces.zeros(size)
    joints.residual(state, forces)
    at = joints._places(state)
    spin = np.array([0.7, -1.1, 0.4])
    for move in (*np.eye(3), None):
        power = 0.0
        for n, dofs in enumerate(joints.dofs.reshape(-1, 2, 6)):
            for s in range(2):
                speed = np.cross(spin, at.x[n, s]) if move is None else move
                turn = np.linalg.solve(at.H[n, s], spin) if move is None else np.zeros(3)
                there = dofs[s] >= 0
                alone = Forces.zeros(size)
                _one(joints, n).residual(state, alone)
                power += float(alone.force[dofs[s][there]] @ np.concatenate([speed, turn])[there])
        assert abs(power) < 1e-9 * np.abs(forces.force).max() * 10.0


def _one(joints: Joints, n: int) -> Joints:
    """The joint of a number alone, as it was made."""
    alone = Joints.__new__(Joints)
    alone.joints, alone.open = [joints.joints[n]], joints.open
    alone.laws = type(joints.laws)(*(values[n : n + 1] for values in joints.laws))
    return alone


def test_a_joint_that_keeps_its_distance_is_at_rest_where_it_is_made() -> None:
    joints, size = joined()
    kept = Joints(joints.joints, [True, True])
    forces = Forces.zeros(size)
    kept.residual(State.at_rest(0.0, size), forces)
    assert np.abs(forces.force).max() < 1e-9
    assert joints.first_gap.min() > 0.1
