"""The contact part without soil below its surface: derivatives, balance, pattern, readings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from riser_soil.contact.contact import RiserContact
from riser_soil.contact.law import Penalty
from riser_soil.contact.node_contact import NodeContact
from riser_soil.contact.pairing import facet_below
from riser_soil.contact.seabed_contact import SeabedContact
from riser_soil.contact.soil_contact import CandidateRange
from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State, Weights
from riser_soil.riser import shapes
from riser_soil.riser.line import End, Line
from riser_soil.riser.shapes import Curve
from riser_soil.riser.stations import ENDS
from riser_soil.seabed.grounds import Plane
from riser_soil.soil.surface import SoilTop
from tests.support.contact_along import intervals_at, touchdown_at
from tests.support.soil_tops import top

LAW = Penalty(stiffness=2.0e5, smoothing=1e-3)
WEIGHTS = Weights(inertia=0.0, force=0.0, shift_v=0.0, shift_a=0.0)
RADIUS = 0.15
FOOTPRINT = 0.04


def riser_at(position: Array, plane: float | None = None, active: bool = True) -> Line:
    """A riser with its nodes at positions (nn, 3), its arc the horizontal distance along them.

    plane: of a planar riser, the angle [rad] of its vertical plane to the x axis; None: in space.
    """
    arc = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(position[:, :2], axis=0), axis=1)))
    direction = np.array([np.cos(plane or 0.0), np.sin(plane or 0.0), 0.0])
    unstressed = shapes.straight(arc, position[0], direction)
    layout = shapes.layout(arc, np.full(len(arc) - 1, 2.0 * RADIUS), unstressed, Curve(position, unstressed.tangent))
    return Line(3 if plane is None else 2, layout, End(True), End(False), direction, active=active)


@dataclass
class Case:
    """A riser over a surface; dofs of another field lie between them."""

    riser: Line
    surface: SoilTop
    contact: NodeContact

    @classmethod
    def build(
        cls,
        riser: Line,
        surface: SoilTop,
        footprint: float = FOOTPRINT,
        along: Array | None = None,
    ) -> Case:
        riser.offset = 2
        surface.offset = 2 + riser.size + 3
        radius = np.full(riser.nodes, RADIUS)
        contact = NodeContact(
            riser, radius, surface, LAW, footprint=footprint, along=along, reach=CandidateRange(0.5, 0.3)
        )
        return cls(riser, surface, contact)

    @property
    def size(self) -> int:
        return self.riser.offset + self.riser.size + 3 + self.surface.size

    def state(self, u: Array | None = None) -> State:
        z = np.zeros(self.size)
        return State(1.0, z if u is None else u, z, z)

    def residual(self, u: Array) -> Array:
        forces = Forces.zeros(self.size)
        self.contact.residual(self.state(u), forces)
        return forces.end

    def outgrows(self, u: Array) -> bool:
        """Whether the pattern lacks something at u."""
        self.dense_tangent(u)
        return self.contact.outgrown

    def dense_tangent(self, u: Array) -> Array:
        blocks = self.contact.blocks()
        values = {key: block.zeros() for key, block in blocks.items()}
        self.contact.tangent(self.state(u), WEIGHTS, values)
        dense = np.zeros((self.size, self.size))
        for key, block in blocks.items():
            np.add.at(dense, (block.rows[:, :, None], block.cols[:, None, :]), values[key])
        return dense


def deformed_case(kind: str, dimension: int, footprint: float = FOOTPRINT) -> Case:
    """A riser, oblique in space, that touches a surface deformed in all directions."""
    surface = top(kind)
    rng = np.random.default_rng(5)
    surface.points[:, :2] += 0.05 * rng.uniform(-1.0, 1.0, (len(surface.points), 2))
    surface.committed = 0.03 * rng.uniform(-1.0, 1.0, surface.points.shape)
    x = np.linspace(-0.77, 3.61, 12)
    position = np.column_stack([x, np.tan(0.1) * x - 0.03, np.full(12, RADIUS - 0.02)])
    return Case.build(riser_at(position, 0.1 if dimension == 2 else None), surface, footprint)


def small(case: Case, size: float = 2e-3, seed: int = 1) -> Array:
    return np.asarray(size * np.random.default_rng(seed).uniform(-1.0, 1.0, case.size))


def differences(case: Case, u: Array, h: float = 2e-6) -> Array:
    """dR/du by central differences of fourth order."""
    columns = []
    for e in h * np.eye(case.size):
        near, far = (case.residual(u + s * e) - case.residual(u - s * e) for s in (1, 2))
        columns.append((8 * near - far) / (12 * h))
    return np.array(columns).T


KINDS = pytest.mark.parametrize("kind", ["quad4", "tri6"])
DIMENSIONS = pytest.mark.parametrize("dimension", [2, 3])


@KINDS
@DIMENSIONS
@pytest.mark.parametrize("footprint", [0.0, FOOTPRINT])
def test_tangent_is_the_residuals_derivative(kind: str, dimension: int, footprint: float) -> None:
    case = deformed_case(kind, dimension, footprint)
    u = small(case)
    K = case.dense_tangent(u)
    assert not case.contact.outgrown
    assert len(case.contact.touching(case.state(u)).points.node) > 4
    np.testing.assert_allclose(K, differences(case, u), atol=1e-7 * abs(K).max())
    np.testing.assert_allclose(K, K.T, atol=1e-14 * abs(K).max())


@KINDS
def test_tangent_needs_the_gaps_second_derivative(kind: str) -> None:
    case = deformed_case(kind, 3)
    state = case.state(small(case))
    soil = case.contact.touching(state)
    gradient = soil.forms[0][:, 0]
    first = soil.points.slope[:, None, None] * gradient[:, :, None] * gradient[:, None, :]
    assert abs(soil.hessian - first).max() > 1e-3 * abs(first).max()


@KINDS
@DIMENSIONS
def test_residual_is_the_potentials_gradient(kind: str, dimension: int) -> None:
    case = deformed_case(kind, dimension)
    u, h = small(case), 1e-6

    def potential(v: Array) -> float:
        return case.contact.energy(case.state(v)).potential

    steps = h * np.eye(case.size)
    gradient = np.array([(potential(u + e) - potential(u - e)) / (2 * h) for e in steps])
    R = case.residual(u)
    np.testing.assert_allclose(R, gradient, atol=1e-6 * abs(R).max())


@KINDS
@DIMENSIONS
def test_forces_balance_to_round_off(kind: str, dimension: int) -> None:
    case = deformed_case(kind, dimension)
    case.contact = NodeContact(case.riser, np.full(12, RADIUS), case.surface, LAW, footprint=FOOTPRINT)
    state = case.state(small(case))
    on_riser, on_soil = case.contact.force_on_riser(state), case.contact.force_on_soil(state)
    along = case.contact.force_on_soil_per_length(state)
    np.testing.assert_allclose(case.riser.tributary_length @ along, on_soil, atol=1e-13 * np.abs(on_soil).max())
    np.testing.assert_allclose(-along[:, 2], case.contact.force_per_length(state), rtol=1e-12)
    assert on_riser[2] > 100.0
    lowest = case.riser.x[:, -1].min()
    case.riser.x[:, -1] += 10.0 - lowest  # off the soil
    assert not case.contact.force_on_soil_per_length(case.state(small(case))).any()
    case.riser.x[:, -1] += lowest - 10.0
    out_of_plane = np.zeros(3) if dimension == 3 else np.array([-np.sin(0.1), np.cos(0.1), 0.0])
    unbalanced = on_riser + on_soil
    unbalanced -= (unbalanced @ out_of_plane) * out_of_plane
    np.testing.assert_allclose(unbalanced, 0.0, atol=1e-13 * on_riser[2])


def test_the_footprint_follows_the_riser_in_space_as_in_a_plane() -> None:
    def forces(plane: float | None, along: Array | None) -> Array:
        y = np.linspace(-0.8, 0.8, 6)
        position = np.column_stack([np.full(6, 1.3), y, np.full(6, RADIUS - 0.02)])
        case = Case.build(riser_at(position, plane), deformed_case("quad4", 3).surface, along=along)
        return case.contact.force_per_length(case.state())

    planar = forces(0.5 * np.pi, None)
    np.testing.assert_allclose(forces(None, np.array([0.0, 1.0])), planar, rtol=1e-9)
    assert np.abs(forces(None, None) - planar).max() > 1e-3 * planar.max()


def test_force_on_riser_is_minus_its_residual() -> None:
    case = deformed_case("quad4", 3)
    u = small(case)
    rows = case.riser.translation_dofs
    np.testing.assert_allclose(
        case.contact.force_on_riser(case.state(u)), -case.residual(u)[rows].sum(axis=0)
    )


def level_case(depth: Array, surface: SoilTop, plane: float | None = None) -> Case:
    """A level row of nodes over x = 0.25, 0.75, …, each sunk in by its depth [m]."""
    n = len(depth)
    position = np.column_stack([0.25 + 0.5 * np.arange(n), np.zeros(n), RADIUS - depth])
    return Case.build(riser_at(position, plane), surface)


@KINDS
@pytest.mark.parametrize("plane", [None, 0.0])
def test_flat_soil_gives_the_law_itself(kind: str, plane: float | None) -> None:
    depth = np.array([0.01, 0.002, 0.0, -0.01])
    case = level_case(depth, top(kind), plane)
    state = case.state()
    np.testing.assert_allclose(case.contact.force_per_length(state), LAW.force(depth), rtol=1e-10)
    total = float(case.riser.tributary_length @ LAW.force(depth))
    np.testing.assert_allclose(case.contact.force_on_riser(state), [0.0, 0.0, total], atol=1e-9)
    assert case.contact.max_penetration(state) == pytest.approx(0.01, rel=1e-12)


def test_nothing_bears_nodes_beside_the_block() -> None:
    """The block's middle has settled; nodes over it find the settled surface, the others nothing."""
    surface = top("quad4", nx=4)
    surface.committed[:, 2] = -0.01
    case = level_case(np.full(8, 0.012), surface)
    force = case.contact.force_per_length(case.state())
    expected = np.where(np.arange(8) < 4, LAW.force(np.array(0.002)), 0.0)
    np.testing.assert_allclose(force, expected, rtol=1e-9)
    assert case.contact.force_on_soil(case.state())[2] == pytest.approx(-0.5 * 3.5 * LAW.force(np.array(0.002)))
    xy = case.riser.x[:, :2]
    cover = case.contact.covering.make()
    np.testing.assert_array_equal([facet_below(cover, x, y, -1) >= 0 for x, y in xy], np.arange(8) < 4)


def test_node_over_a_valley_of_the_mesh_feels_no_side_force() -> None:
    """Below it facets meet in a kink: the four points balance, one point would push to a side."""
    surface = top("quad4")
    surface.committed[:, 2] = 0.05 * abs(surface.points[:, 1])
    side = {}
    for footprint in (0.0, FOOTPRINT):
        position = np.array([[1.0, 0.0, RADIUS - 0.01], [1.5, 0.0, RADIUS - 0.01]])
        case = Case.build(riser_at(position), surface, footprint)
        side[footprint] = abs(case.contact.force_on_riser(case.state())[1])
    assert side[0.0] > 10.0
    assert side[FOOTPRINT] < 1e-10


def test_weightless_groups_and_inactive_ranks() -> None:
    case = level_case(np.full(4, 0.01), top("quad4"))
    forces = Forces.zeros(case.size)
    case.contact.residual(case.state(), forces)
    assert abs(forces.end).max() > 0.0
    assert not forces.inertia.any()
    assert not forces.force.any()
    idle = NodeContact(riser_at(case.riser.x, active=False), np.full(4, RADIUS), case.surface, LAW)
    idle.rebuild(case.state())
    assert not idle.active  # so that the system asks it for no pattern, force, energy or work
    assert_touches_nothing(idle)


def assert_touches_nothing(contact: RiserContact) -> None:
    state = State.at_rest(0.0, 4 * 6)
    along = contact.force_per_length, contact.penetration, contact.depth
    assert all(np.array_equal(force(state), np.zeros(4)) for force in along)
    np.testing.assert_array_equal(contact.force_on_riser(state), np.zeros(3))
    assert contact.max_penetration(state) == 0.0
    assert contact.predict(state) is state.u


def test_contacts_of_all_grounds_tell_the_same() -> None:
    """Nodes that lie, soil and seabed a level plane: one law, two players of one role."""
    depth = np.array([0.01, 0.01, 0.002, 0.01])
    case = level_case(depth, top("quad4"))
    seabed = SeabedContact(case.riser, np.full(3, RADIUS), Plane.level(0.0), LAW, ENDS)
    players: tuple[RiserContact, ...] = (case.contact, seabed)
    for player in players:
        assert isinstance(player, RiserContact)
    alike = "force_per_length", "penetration", "depth", "max_penetration", "force_on_riser", "predict"
    for name in alike:
        on_soil, on_seabed = (np.asarray(getattr(player, name)(case.state())) for player in players)
        np.testing.assert_allclose(on_soil, on_seabed, rtol=1e-9, atol=1e-9, err_msg=name)
    intervals = [intervals_at(player, case.state()) for player in players]
    assert intervals == 2 * [[(0.0, 1.5, True, True)]]
    elsewhere = riser_at(case.riser.x, active=False)
    assert_touches_nothing(SeabedContact(elsewhere, np.full(3, RADIUS), Plane.level(0.0), LAW))


depths = st.lists(st.floats(-0.01, 0.02), min_size=4, max_size=4)


@settings(max_examples=60, deadline=None)
@given(before=depths, after=depths, sunk=st.lists(st.floats(-0.01, 0.01), min_size=4, max_size=4))
def test_vertical_steps_never_gain_energy(before: list[float], after: list[float], sunk: list[float]) -> None:
    """Riser and soil move vertically; two nodes of four are over it."""
    case = level_case(np.array(before), top("quad4", nx=2))
    u = np.zeros(case.size)
    u[case.riser.translation_dofs[:, 2]] = np.array(before) - np.array(after)
    heights = np.resize(sunk, len(case.surface.points))
    u[case.surface.offset + 2 :: 3] = heights
    start, end = case.state(), case.state(u)
    dissipated = case.contact.work(start, end).dissipated
    assert dissipated >= -1e-12
    work = case.residual(u) @ u
    stored = case.contact.energy(end).potential - case.contact.energy(start).potential
    assert dissipated == pytest.approx(work - stored, abs=1e-12)


def test_pattern_is_outgrown_and_rebuilt() -> None:
    case = level_case(np.array([0.01, 0.01, -1.0, -1.0, 0.01]), top("quad4", nx=4))
    pairs = case.contact.blocks()["contact.soil"].shape[0]
    u = np.zeros(case.size)
    u[case.riser.translation_dofs[2, 2]] = -1.01
    np.testing.assert_array_equal(case.dense_tangent(u), case.dense_tangent(np.zeros(case.size)))
    assert case.outgrows(u)
    case.contact.rebuild(case.state())
    assert not case.outgrows(u), "the node that was missed belongs to the new pattern"
    assert case.contact.blocks()["contact.soil"].shape[0] > pairs
    K = case.dense_tangent(u)
    np.testing.assert_allclose(K, differences(case, u), atol=1e-7 * abs(K).max())
    case.contact.rebuild(case.state())
    assert not case.outgrows(u), "what is missed counts until the step's end"
    case.contact.commit(case.state())
    case.contact.rebuild(case.state())
    assert case.outgrows(u), "what is neither near nor missed is dropped"
    case.contact.rebuild(case.state(u))
    assert not case.outgrows(u)


def test_a_matrix_of_the_pattern_before_is_refused() -> None:
    case = level_case(np.array([0.01, 0.01, -1.0, -1.0, 0.01]), top("quad4", nx=4))
    values = {key: block.zeros() for key, block in case.contact.blocks().items()}
    u = np.zeros(case.size)
    u[case.riser.translation_dofs[2, 2]] = -1.01
    case.contact.tangent(case.state(u), WEIGHTS, values)
    case.contact.rebuild(case.state(u))
    with pytest.raises(RuntimeError, match="was rebuilt"):
        case.contact.tangent(case.state(u), WEIGHTS, values)


def test_sliding_within_the_patch_keeps_the_pattern() -> None:
    case = level_case(np.full(3, 0.01), top("quad4"))
    assert case.contact.blocks()["contact.soil"].shape[1:] == (15, 15)
    u = np.zeros(case.size)
    u[case.riser.translation_dofs[:, 0]] = 0.45
    assert not case.outgrows(u)
    u[case.riser.translation_dofs[:, 0]] = 1.1
    assert case.outgrows(u)


def test_touchdown_ends_an_even_contact_of_the_same_force() -> None:
    """Shares of 0.25, 0.5, 0.5 m at rest and one of 0.5 m pressed 0.3 times as much: in sum 1.4 m, with the moment
    0.975 m² about the end. So have 1.3 m pressed evenly and what 0.1 m bears at their end.
    """
    depth = np.array([0.01, 0.01, 0.01, 0.003, -0.005, -0.2])
    case, turned = level_case(depth, top("quad4")), level_case(depth[::-1], top("quad4"))
    assert touchdown_at(case.contact, case.state()) == pytest.approx(1.3)
    assert touchdown_at(turned.contact, turned.state()) == pytest.approx(2.5 - 1.3)
    above, below = (level_case(np.full(3, depth), top("quad4")) for depth in (-0.1, 0.1))
    assert np.isnan(touchdown_at(above.contact, above.state()))
    assert touchdown_at(below.contact, below.state()) == pytest.approx(1.0)


def test_committed_settlement_counts_and_memory_is_dropped() -> None:
    case = level_case(np.full(4, 0.01), top("quad4"))
    state = case.state()
    force = case.contact.force_per_length(state)
    case.contact.commit(state)
    case.riser.commit(state)
    case.surface.committed[:, 2] -= 0.005
    np.testing.assert_allclose(case.contact.force_per_length(state), force - 0.005 * LAW.stiffness, rtol=1e-9)


def soil_springs(surface: SoilTop, stiffness: float) -> Array:
    """Matrix of a soft bed: springs to the ground, and between all nodes of a facet, in each direction."""
    n = len(surface.points)
    K = np.zeros((n, n))
    for nodes in surface.facets:
        K[np.ix_(nodes, nodes)] += 0.1 * stiffness * (len(nodes) * np.eye(len(nodes)) - 1.0)
        K[nodes, nodes] += 0.05 * stiffness
    return np.kron(K, np.eye(3))


def balance(kind: str, dimension: int, footprint: float) -> tuple[list[float], Array]:
    """Newton's residual norms [N] and the force on the riser; weights press nodes into points of the mesh."""
    position = np.column_stack([0.5 * np.arange(1, 6), np.zeros(5), np.full(5, RADIUS)])
    riser = riser_at(position, None if dimension == 3 else 0.0)
    case = Case.build(riser, top(kind), footprint)
    rows, soil = case.riser.translation_dofs, slice(case.surface.offset, case.size)
    K, weight = np.zeros((case.size, case.size)), np.zeros(case.size)
    K[soil, soil] = soil_springs(case.surface, 1.2e6)
    K[rows[:, :-1], rows[:, :-1]] = 1.0e3
    weight[rows[:, -1]] = -728.0 * case.riser.tributary_length * np.linspace(1.0, 3.0, 5)
    free = np.concatenate([rows.ravel(), np.arange(soil.start, soil.stop)])
    u, norms = np.zeros(case.size), list[float]()
    for _ in range(12):
        R = K @ u + case.residual(u) - weight
        norms.append(float(np.linalg.norm(R[free])))
        u[free] -= np.linalg.solve((K + case.dense_tangent(u))[np.ix_(free, free)], R[free])
    return norms, case.contact.force_on_riser(case.state(u))


@KINDS
@DIMENSIONS
def test_newton_finds_the_balance_over_points_of_the_mesh(kind: str, dimension: int) -> None:
    norms, force = balance(kind, dimension, FOOTPRINT)
    assert min(norms[:9]) < 1e-9 * norms[0]
    assert force[2] == pytest.approx(728.0 * 0.5 * (0.5 * 1.0 + 1.5 + 2.0 + 2.5 + 0.5 * 3.0), rel=1e-9)
    assert abs(force[1]) < (1e-9 if kind == "quad4" else 1e-3) * force[2]


@KINDS
def test_one_point_on_a_kink_has_no_balance(kind: str) -> None:
    norms, _ = balance(kind, 2, 0.0)
    assert min(norms) > 1e-5 * norms[0]


def test_default_footprint_is_an_eighth_of_the_diameter() -> None:
    case = deformed_case("quad4", 3)
    contact = NodeContact(case.riser, np.full(12, RADIUS), case.surface, LAW)
    np.testing.assert_allclose(contact.points.offset[:4, 1], RADIUS / 4 * np.array([-1, 1, -1, 1]))


def test_riser_far_above_touches_nothing() -> None:
    case = level_case(np.full(4, -20.0), top("quad4"))
    assert not case.residual(np.zeros(case.size)).any()
    assert {key: block.shape[0] for key, block in case.contact.blocks().items()} == {"contact.soil": 0}
    assert not case.outgrows(np.zeros(case.size))
    assert case.contact.max_penetration(case.state()) == 0.0
    assert np.isnan(touchdown_at(case.contact, case.state()))
