"""Contact with condensed soil in the line solver, without the solver: what is noticed, and what the parts adopt."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.contact.condensed_contact import CondensedContact
from riser_soil.contact.law import Penalty
from riser_soil.contact.node_contact import NodeContact
from riser_soil.contact.on_condensed_soil import SUPPORTED, UNREACHED, UNWATCHED, TopMotion, add_contact
from riser_soil.contact.soil_contact import CandidateRange, SoilContact
from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State
from riser_soil.riser.part_kernels import Border, LineForces, forces_at
from riser_soil.riser.placed_line import LineTrials
from tests.support.pipe_on_surface import RADIUS, PipeOnSurface, pipe_on_surface, sagging
from tests.support.soil_tops import top

pytestmark = pytest.mark.usefixtures("uncompiled")

METHODS = pytest.mark.parametrize("method", ["node", "surface"])
NARROW = CandidateRange(above=0.02, around=0.02)


class Beside:
    """A riser's contact in the line solver, the soil's dofs all supported or, as chosen, free and not reached."""

    def __init__(self, method: str, row: int = SUPPORTED) -> None:
        made = pipe_on_surface(sagging(angle=0.0), top("quad4"))
        self.made, self.contact = made, contact_of(made, method)
        self.touching = CondensedContact(self.contact, None)
        none, size = np.empty(0, dtype=np.int64), made.surface.points.shape
        self._top = TopMotion(none, np.zeros((0, 0)), made.surface.points, np.full(size, row))
        n, nodes = made.line.size, made.line.nodes
        square, beside = np.zeros((0, 0)), np.zeros((n, 0))
        self._border = Border(np.zeros(0), np.zeros(0), square, beside, beside, np.zeros(nodes, dtype=np.bool_))
        self.touching.begin()
        self.touching.look(tried=False)

    def at(self, state: State) -> LineForces:
        """Readings at a state, the soil as it is."""
        placed = self.made.line.once(LineTrials).now
        placed.move(state)
        out, data = forces_at(placed.at), self.touching._data
        add_contact.kernels[type(data)](data, self._top, placed.at, out, self._border)
        return out

    def moved(self, *by: float) -> State:
        """All of the riser moved [m]."""
        u = np.zeros(self.made.size)
        self.made.line.nodal(u)[:, :3] = by
        return self.made.state(u)

    def leaves(self, *by: float) -> bool:
        self.at(self.moved(*by))
        return bool(self.touching.touched.counts[UNWATCHED])


def contact_of(made: PipeOnSurface, method: str) -> SoilContact:
    if method == "surface":
        made.contact._reach = NARROW
        return made.contact
    radius, law = np.full(made.line.nodes, RADIUS), Penalty(2.0e5, 1e-3)
    return NodeContact(made.line, radius, made.surface, law, reach=NARROW)


@METHODS
def test_what_comes_over_soil_that_is_not_watched_is_noticed(method: str) -> None:
    """But not high above it; once it has been looked for there it is watched."""
    case = Beside(method)
    assert not case.leaves(0.0, 0.0, 0.0)
    assert not case.leaves(0.0, 0.0, 0.5)
    assert not case.leaves(0.0, 0.7, 0.5)
    assert case.leaves(0.0, 0.7, 0.0)
    case.touching.look(tried=True)
    assert not case.leaves(0.0, 0.7, 0.0)
    assert not case.leaves(0.0, 0.0, 0.0)


@METHODS
def test_nodes_that_are_not_reached_are_noticed_where_they_bear_a_force(method: str) -> None:
    for row in (SUPPORTED, UNREACHED):
        case = Beside(method, row)
        case.at(case.made.state())
        forces = Forces.zeros(case.made.size)
        case.contact.residual(case.made.state(), forces)
        bearing = forces.end[case.made.surface.offset :].reshape(-1, 3).any(axis=1)
        assert bearing.any()
        np.testing.assert_array_equal(case.touching.touched.newly_loaded, bearing & (row == UNREACHED))


def readings(contact: SoilContact, state: State) -> list[Array]:
    """Forces and energies of a contact at a state."""
    forces = contact.force_per_length(state), contact.force_on_riser(state), contact.force_on_soil(state)
    return [*forces, np.array([contact.energy(state).potential, contact.work(state, state).dissipated])]


@METHODS
def test_the_part_adopts_the_evaluation_at_a_step_s_end(method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The part has what its own evaluation gives, and stays as it is when the solver goes on."""
    case, other = Beside(method), Beside(method)
    end = case.moved(1e-3, 2e-3, -3e-3)
    case.at(end)
    case.touching.end(end)
    case.at(case.moved(0.0, 0.0, -0.01))
    expected = readings(other.contact, end)
    monkeypatch.setattr(case.contact, {"node": "_find_touching", "surface": "_evaluate"}[method], None)
    adopted = readings(case.contact, end)
    assert all(np.abs(values).max() > 0.0 for values in expected)
    for values, wanted in zip(adopted, expected, strict=True):
        np.testing.assert_allclose(values, wanted, rtol=1e-9, atol=1e-12 * np.abs(wanted).max())
