"""Friction on a seabed: the law's return map, and the part along the riser's elements."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from riser_soil.contact.coulomb import Adhesion, adhesion_at
from riser_soil.contact.friction import CoulombFriction, directions_at, mobilised_within
from riser_soil.contact.law import Penalty
from riser_soil.contact.seabed_contact import SeabedContact
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser import shapes, stations
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End
from riser_soil.seabed.bearing import Strength
from riser_soil.seabed.grounds import Ground, Plane
from riser_soil.seabed.height_field import Profile
from tests.support.dense_chain import residual, tangent
from tests.support.differences import WEIGHTS, difference_tangent, error
from tests.support.sample_line import DIRECTION, START, sample
from tests.support.tractions import traction

pytestmark = pytest.mark.usefixtures("uncompiled")

both_dimensions = pytest.mark.parametrize("dimension", [pytest.param(2, marks=pytest.mark.verify), 3])
MU = np.array([0.3, 0.7])
EPS, TINY = np.finfo(float).eps, np.finfo(float).tiny  # round-off: of a number of order 1, of products that underflow
AXIAL, LATERAL = 0.4, 0.8
DEPTH, K_N, MOBILISATION = 0.01, 1.0e5, 0.02
PRESSED = DEPTH * K_N  # N/m, on each metre of the pipe


@settings(max_examples=200, deadline=None)
@given(
    numbers=st.lists(st.floats(-2.0, 2.0), min_size=6, max_size=6),
    N=st.lists(st.just(0.0) | st.floats(1e-100, 2.0), min_size=3, max_size=3),  # squares that don't underflow
    A=st.just(np.inf) | st.floats(0.01, 1.0),
)
def test_every_step_dissipates_and_keeps_to_its_limits(numbers: list[float], N: list[float], A: float) -> None:
    """Taken less the change of what is stored, for steps of any size under any normal force, with and without adhesion;
    t lies in the ellipse of the limits along both directions.
    """
    t: Array = np.zeros(2)
    k = 1.7
    for ds, normal in zip(np.array(numbers).reshape(3, 2), N, strict=True):
        new, _, _ = traction(t - k * ds, np.array(normal), np.array(0.0), MU, A)
        most = (np.linalg.norm(t) + k * np.linalg.norm(ds)) ** 2 / k  # no term of this balance is larger
        assert -(new @ ds) - (new @ new - t @ t) / (2.0 * k) >= -8.0 * EPS * most - TINY
        limit = np.minimum(MU * normal, A)
        assert np.linalg.norm(np.divide(new, limit, out=new.copy(), where=limit > 0.0)) <= 1.0 + 1e-12
        t = new


@pytest.mark.parametrize("most", [np.inf, 0.4, 0.1], ids=["coulomb", "adhesion across", "adhesion"])
@pytest.mark.parametrize("N", [5.0, 0.7, 0.0])
def test_derivatives_of_the_return_map(N: float, most: float) -> None:
    """Derivatives by t* and by the penetration, with which both the normal force and the adhesion change."""
    t, h, slope, widening = np.array([0.25, -0.6]), 1e-6, 1.3, 0.2

    def at(guess: Array, deeper: float) -> tuple[Array, Array, Array]:
        return traction(
            guess, np.array(N + slope * deeper), np.array(slope), MU, most + widening * deeper, widening
        )

    _, by_elastic, by_penetration = at(t, 0.0)
    for j, e in enumerate(np.eye(2)):
        ahead, behind = (at(t + s * h * e, 0.0)[0] for s in (1, -1))
        assert by_elastic[:, j] == pytest.approx((ahead - behind) / (2 * h), abs=1e-8)
    if N > 0.0:
        ahead, behind = (at(t, s * h)[0] for s in (1, -1))
        assert by_penetration == pytest.approx((ahead - behind) / (2 * h), abs=1e-8)


def test_directions_lie_in_the_ground_and_follow_the_pipe() -> None:
    up = (0.0, 0.0, 2.0)
    np.testing.assert_allclose(directions_at((0.6, 0.0, 0.8), up), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], atol=1e-15)
    np.testing.assert_allclose(directions_at((0.0, 1.0, 0.0), up), [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]], atol=1e-15)
    np.testing.assert_array_equal(directions_at((0.0, 0.0, 1.0), up), np.zeros((2, 3)))


def straight(dimension: int, adhesion: Adhesion | None = None) -> tuple[Line, CoulombFriction]:
    """10 m of pipe, evenly pressed into level ground."""
    arc = np.linspace(0.0, 10.0, 6)
    flat = shapes.straight(arc, (0.0, 0.0, -DEPTH))
    line = Line(dimension, shapes.layout(arc, np.full(5, 0.2), flat, flat), End(False), End(False))
    contact = SeabedContact(line, np.zeros(5), Plane.level(0.0), Penalty(K_N))
    stiffness = mobilised_within(MOBILISATION, AXIAL, LATERAL, np.full(5, PRESSED))
    return line, CoulombFriction(contact, AXIAL, LATERAL, stiffness, adhesion)


def slid(line: Line, move: Array) -> State:
    u = np.zeros(line.size)
    line.nodal(u)[:, : line.dimension] = move @ line.basis
    return State(0.0, u, np.zeros(line.size), np.zeros(line.size))


def slide(line: Line, friction: CoulombFriction, moves: Array) -> tuple[Array, float, float]:
    """Force on the riser at the last of some moves (n, 3), the energy taken and that dissipated."""
    work, lost = 0.0, 0.0
    force: Array = np.zeros(3)
    for move in moves:
        rest, state = slid(line, np.zeros(3)), slid(line, move)
        force = friction.force_on_riser(state)
        lost += friction.work(rest, state).dissipated
        work -= float(force @ move)
        friction.commit(state)
        line.commit(state)
    return force, work, lost


@both_dimensions
def test_dragged_along_it_resists_with_mu_w_L_after_mobilisation(dimension: int) -> None:
    line, friction = straight(dimension)
    force, _, _ = slide(line, friction, np.array([[0.25 * MOBILISATION, 0.0, 0.0]]))
    assert force == pytest.approx([-0.25 * LATERAL * PRESSED * 10.0, 0.0, 0.0])  # still stuck
    force, _, _ = slide(line, friction, np.array([[MOBILISATION, 0.0, 0.0]] * 3))
    assert force == pytest.approx([-AXIAL * PRESSED * 10.0, 0.0, 0.0])


def test_dragged_across_it_resists_with_the_lateral_coefficient() -> None:
    line, friction = straight(3)
    force, _, _ = slide(line, friction, np.array([[0.0, 0.5 * MOBILISATION, 0.0]]))
    assert force == pytest.approx([0.0, -0.5 * LATERAL * PRESSED * 10.0, 0.0])
    force, _, _ = slide(line, friction, np.array([[0.0, MOBILISATION, 0.0]] * 2))
    assert force == pytest.approx([0.0, -LATERAL * PRESSED * 10.0, 0.0])


def test_dragged_askew_it_resists_by_the_ellipse() -> None:
    line, friction = straight(3)
    force, _, _ = slide(line, friction, np.array([[0.01, 0.01, 0.0]] * 400))
    share = force[:2] / (PRESSED * 10.0) / np.array([AXIAL, LATERAL])
    assert share @ share == pytest.approx(1.0)
    assert np.all(force[:2] < 0.0)


@both_dimensions
def test_back_and_forth_it_takes_four_slides(dimension: int) -> None:
    """A cycle of amplitude A loses 4 mu w L (A - m), m being the slide that mobilises it, and keeps its traction."""
    line, friction = straight(dimension)
    A, m = 0.1, MOBILISATION * AXIAL / LATERAL
    step = np.array([0.002, 0.0, 0.0])
    slide(line, friction, np.array([step] * 50))
    before, way = friction.energy(slid(line, np.zeros(3))).potential, friction.slip()
    cycle = np.concatenate([np.tile(-step, (100, 1)), np.tile(step, (100, 1))])
    force, work, lost = slide(line, friction, cycle)
    limit = AXIAL * PRESSED * 10.0
    assert friction.slip() - way == pytest.approx(np.full(line.nodes, 4.0 * (A - m)))
    assert force[0] == pytest.approx(-limit)
    assert friction.energy(slid(line, np.zeros(3))).potential == pytest.approx(before)
    assert before == pytest.approx(0.5 * limit * m)
    assert lost == pytest.approx(work)
    assert lost == pytest.approx(4.0 * limit * (A - m), rel=0.03)  # the force at the end of each step of m/5 counts


def test_stick_and_slip() -> None:
    """Pulled by a spring whose end moves on, a pipe sticks until the spring overcomes friction, then follows."""
    line, friction = straight(2)
    k_t, limit, spring = LATERAL * PRESSED / MOBILISATION * 10.0, AXIAL * PRESSED * 10.0, 2.0e4
    place, pulls = 0.0, []
    for end in np.linspace(0.0, 0.6, 61)[1:]:
        moved = 0.0
        for _ in range(30):
            state = slid(line, np.array([moved, 0.0, 0.0]))
            out = spring * (end - place - moved) + friction.force_on_riser(state)[0]
            slope = tangent([friction], state)[:: line.ndof, :: line.ndof].sum() + spring
            moved += out / slope
            if abs(out) < 1e-9 * limit:
                break
        else:
            raise AssertionError("no balance")
        friction.commit(state)
        line.commit(state)
        place += moved
        pulls.append(spring * (end - place))
        free = min(spring * k_t / (spring + k_t) * end, limit)
        assert pulls[-1] == pytest.approx(free, rel=1e-8)
    assert pulls[-1] == pytest.approx(limit)


def test_a_lifted_pipe_lets_go_and_begins_anew() -> None:
    line, friction = straight(3)
    slide(line, friction, np.array([[0.0, 0.05, 0.0]]))
    force, _, lost = slide(line, friction, np.array([[0.0, 0.0, 0.02]]))
    assert not force.any()
    assert lost == pytest.approx(0.5 * LATERAL * PRESSED * MOBILISATION * 10.0)  # what was stored
    force, _, _ = slide(line, friction, np.array([[0.0, 0.0, -0.02]]))
    assert not force.any()


HILL = Profile(START[:2], DIRECTION[:2], np.array([-1.0, 2.0, 4.0, 8.0]), START[2] + np.array([0.5, -0.6, 0.3, 1.0]))
GROUNDS: dict[str, Ground] = {"level": Plane.level(START[2] - 0.1), "profile": HILL}
ROUND = Penalty(4.0e4, smoothing=30.0)  # its rounded corner holds the whole sample


def test_arc_below_the_seabed() -> None:
    """A pipe above the seabed, on it, sunk in by a quarter of its diameter (a third of a turn), by half and more."""
    D, clay = 0.4, Adhesion(0.5, Strength(2.0e3, 3.0e3), 0.4)
    z = np.array([-0.1, 0.0, 0.25 * D, 0.5 * D, 0.7 * D])
    adhesion, slope = np.transpose([adhesion_at(clay, depth) for depth in z])
    arc = np.pi * D * np.array([0.0, 0.0, 1.0 / 3.0, 0.5, 0.5])
    np.testing.assert_allclose(adhesion, 0.5 * (2.0e3 + 3.0e3 * np.maximum(z, 0.0)) * arc, rtol=1e-12)
    deeper, shallower = (np.array([adhesion_at(clay, depth + h)[0] for depth in z]) for h in (1e-7, -1e-7))
    inside = [0, 2, 4]
    np.testing.assert_allclose(slope[inside], (deeper - shallower)[inside] / 2e-7, rtol=1e-7)
    assert {adhesion_at(Adhesion(), depth)[0] for depth in z} == {np.inf}


@both_dimensions
def test_dragged_along_clay_it_resists_with_its_adhesion(dimension: int) -> None:
    """su over the arc below the seabed, here less than friction; mobilised over that over k."""
    adhesion = Adhesion(0.6, Strength(1.0e3, 2.0e4), 0.3)
    line, friction = straight(dimension, adhesion)
    arc = 2.0 * 0.3 * np.arcsin(np.sqrt(DEPTH / 0.3))
    most = 0.6 * 1.2e3 * arc
    assert most < AXIAL * PRESSED
    mobilised = most / (LATERAL * PRESSED) * MOBILISATION
    force, _, _ = slide(line, friction, np.array([[0.5 * mobilised, 0.0, 0.0]]))
    assert force == pytest.approx([-0.5 * most * 10.0, 0.0, 0.0])
    force, work, lost = slide(line, friction, np.array([[mobilised, 0.0, 0.0]] * 3))
    assert force == pytest.approx([-most * 10.0, 0.0, 0.0])
    assert lost == pytest.approx(work + 0.5 * most * 10.0 * (0.25 - 1.0) * mobilised)


#: Below friction at some stations of the sample, above it at others.
CLAY = Adhesion(0.5, Strength(2.5e5, 1.0e5), 0.5)


def rubbing(
    dimension: int, ground: str, stiffness: float, adhesion: Adhesion | None = None
) -> tuple[CoulombFriction, State]:
    at = sample(dimension)
    contact = SeabedContact(at.line, 0.5 * at.elements.outer_diameter, GROUNDS[ground], ROUND)
    friction = CoulombFriction(contact, AXIAL, LATERAL, np.full(at.line.length.size, stiffness), adhesion)
    first = at.state(5, 0.1)
    friction.commit(first)
    contact.commit(first)
    at.line.commit(first)
    state = at.state(1)
    at.line.nodal(state.u)[:, :dimension] += DIRECTION @ at.line.basis  # far from where the slip turns round
    return friction, state


@both_dimensions
@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize(
    ("stiffness", "adhesion"), [(1.0e3, None), (1.0e7, None), (1.0e7, CLAY)], ids=["sticks", "slips", "slips on clay"]
)
def test_tangent_is_the_derivative_of_the_residual(
    dimension: int, ground: str, stiffness: float, adhesion: Adhesion | None
) -> None:
    friction, state = rubbing(dimension, ground, stiffness, adhesion)
    K = tangent([friction], state, WEIGHTS)
    assert error(K, difference_tangent(friction, state, WEIGHTS)) < 1e-7
    symmetric = bool(np.abs(K - K.T).max() <= 1e-11 * np.abs(K).max())
    assert symmetric == (stiffness < 1.0e6)
    assert not friction.traits.symmetric


@both_dimensions
def test_adhesion_limits_some_of_the_sample(dimension: int) -> None:
    (limited, state), (free, _) = (rubbing(dimension, "profile", 1.0e7, clay) for clay in (CLAY, None))
    for friction in (free, limited):
        friction.energy(state)
    most, least = (np.linalg.norm(f.kernel_data().resistance, axis=2) for f in (free, limited))
    lower = least < 0.99 * most
    assert lower.any()
    assert not lower.all()
    assert (least <= most * (1.0 + 1e-12)).all()


@both_dimensions
def test_random_steps_along_a_hill_dissipate(dimension: int) -> None:
    at = sample(dimension)
    contact = SeabedContact(at.line, 0.5 * at.elements.outer_diameter, HILL, Penalty(1.0e4, 1e-3), stations.gauss(5))
    friction = CoulombFriction(contact, AXIAL, LATERAL, np.full(at.line.length.size, 5.0e4))
    for seed in range(8):
        rest, state = State.at_rest(0.0, at.line.size), at.state(seed, 0.05)
        assert friction.work(rest, state).dissipated >= -1e-9
        assert friction.work(rest, state).external == 0.0
        for part in (friction, contact):
            part.commit(state)
        at.line.commit(state)


def test_plane_and_space_agree_along_the_pipe() -> None:
    (flat, planar), (_, spatial) = straight(2), straight(3)
    move = np.array([0.013, 0.0, -0.002])
    flat_force, spatial_force = (f.force_on_riser(slid(f.line, move)) for f in (planar, spatial))
    assert flat_force == pytest.approx(spatial_force)
    assert residual([planar], slid(flat, move)).reshape(-1, 3)[:, 0].sum() == pytest.approx(-flat_force[0])
