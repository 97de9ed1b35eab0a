"""Steps in which the riser lands: first guess, and work of the ground by closed forms and loop areas."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.contact.along_step import landing_predictor, work_along_step
from riser_soil.contact.law import Penalty, SuctionLaw
from riser_soil.contact.seabed_contact import SeabedContact
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser import shapes
from riser_soil.riser.line import End, Line
from riser_soil.seabed.grounds import Plane
from riser_soil.seabed.law import NormalLaw
from tests.support.pipe_on_surface import STIFFNESS, pipe_on_surface, sagging
from tests.support.soil_loops import after, aubeny_biscontin, forces, randolph_quiggin, through, work
from tests.support.soil_tops import top

D, SU, LENGTH = 0.3, 2000.0, 4.0
HYSTERETIC = {"randolph-quiggin": randolph_quiggin(D, SU, 1500.0), "aubeny-biscontin": aubeny_biscontin(D, SU, 1500.0)}
every_law = pytest.mark.parametrize("law", HYSTERETIC.values(), ids=HYSTERETIC.keys())
CYCLE = (0.0, 0.06, 0.052, 0.06, 0.052, 0.06, -0.005)  # m


def along(law: NormalLaw, path: Array, history: Array | None = None) -> Array:
    """Work (n,) of the law in each step of a path from the surface."""
    history, z, works = law.initial_history((1,)) if history is None else history, np.zeros(1), []
    for end in path:
        works.append(work_along_step(law, z, np.array([end]), history)[0])
        history, z = law.update(np.array([end]), history).history, np.array([end])
    return np.array(works)


def test_penalty_gives_back_all() -> None:
    law, z = Penalty(1e5, 1e-3), np.array([-0.3, -5e-4, 0.0, 2e-3, 0.1])
    work = work_along_step(law, np.full(5, -0.2), z, np.empty((5, 0)))
    np.testing.assert_array_equal(work, law.potential(z))


@pytest.mark.parametrize("steps", [1, 3, 20])
def test_breaking_away_takes_half_the_cap_times_the_reach_in_any_steps(steps: int) -> None:
    cap, reach = 500.0, 0.02
    law = SuctionLaw(Penalty(1e5), cap, reach)
    history = after(law, np.array([0.0]))
    work = along(law, through(0.0, -3.0 * reach, steps=steps), history).sum()
    assert work == pytest.approx(0.5 * cap * reach, rel=0.02)


@every_law
def test_area_of_a_slow_loop_hangs_little_on_the_steps(law: NormalLaw) -> None:
    """What the force at the end of steps takes too much is of first order; the law's own work is not."""
    exact = along(law, through(*CYCLE, steps=400)).sum()
    paths = {steps: through(*CYCLE, steps=steps) for steps in (2, 8, 32)}
    own = [abs(along(law, path).sum() / exact - 1.0) for path in paths.values()]
    at_end = [abs(work(path, forces(law, path))[-1] / exact - 1.0) for path in paths.values()]
    print(f"own {own}, at the end of steps {at_end}")
    assert own[0] < 0.05
    assert own[1] < 0.01
    assert own[2] < 1e-3
    assert at_end[1] > 5.0 * own[1]
    assert at_end[1] / at_end[2] == pytest.approx(4.0, rel=0.3)


@every_law
def test_short_steps_are_told_by_both_ends_to_fourth_order(law: NormalLaw) -> None:
    """Where the force is all but straight; the trapezoid alone would be of second order."""

    def deeper(steps: int) -> float:
        return float(along(law, np.append(0.03, through(0.03, 0.06, steps=steps)))[1:].sum())

    exact = deeper(4096)
    off = [abs(deeper(steps) - exact) for steps in (64, 128)]
    print(f"{off[0] / exact:.2e}, {off[1] / exact:.2e}")
    assert off[0] < 1e-7 * exact
    assert off[0] > 10.0 * off[1]


def pressed(law: NormalLaw, steps: int) -> tuple[float, float]:
    """Dissipated by the ground, and by the scheme, of a level line that goes through the cycle [J]."""
    arc = np.linspace(0.0, LENGTH, 5)
    flat = shapes.straight(arc, (0.0, 0.0, 0.0))
    line = Line(2, shapes.layout(arc, np.full(4, LENGTH / 4.0), flat, flat), End(True), End(False))
    part = SeabedContact(line, np.zeros(4), Plane.level(0.0), law)
    rest, z, own, by_scheme = State.at_rest(0.0, line.size), 0.0, 0.0, 0.0
    for to in through(*CYCLE, steps=steps):
        state = State.at_rest(0.0, line.size)
        state.u[line.translation_dofs[:, 1]] = to - z
        state.u[line.translation_dofs[:, 1]] *= -1.0
        turned = part.work(rest, state)
        own, by_scheme = own + turned.dissipated - turned.by_scheme, by_scheme + turned.by_scheme
        part.commit(state)
        line.commit(state)
        z = to
    return own, by_scheme


@every_law
def test_a_slow_cycle_on_the_seabed_is_its_loop(law: NormalLaw) -> None:
    loop = along(law, through(*CYCLE, steps=400)).sum() * LENGTH
    loops = {steps: pressed(law, steps) for steps in (8, 16)}
    assert loops[8][0] == pytest.approx(loop, rel=0.01)
    assert loops[16][0] == pytest.approx(loop, rel=3e-3)
    assert loops[8][1] / loops[16][1] == pytest.approx(2.0, rel=0.2)
    assert loops[8][1] > 0.1 * loop


def test_ground_that_gives_back_all_dissipates_nothing() -> None:
    own, by_scheme = pressed(Penalty(1e5, 1e-3), 8)
    assert own == 0.0
    assert by_scheme > 1.0


def pulled_off_soil(law: Penalty | SuctionLaw, steps: int) -> tuple[float, float]:
    """Dissipated by contact with soil, and by the scheme, of a pipe that is pulled off it [J]."""
    made, own, by_scheme = pipe_on_surface(sagging(), top("quad4"), 2, pressure=law), 0.0, 0.0
    made.commit(made.state().u)
    for _ in range(steps):
        u = made.state().u
        u[made.line.translation_dofs[:, 1]] = 0.06 / steps
        turned = made.contact.work(made.state(), made.state(u))
        own, by_scheme = own + turned.dissipated - turned.by_scheme, by_scheme + turned.by_scheme
        made.commit(u)
    return own, by_scheme


def test_suction_of_soil_takes_as_much_in_any_steps() -> None:
    law = SuctionLaw(Penalty(STIFFNESS), 4e3, 0.01)
    many, few = pulled_off_soil(law, 60), pulled_off_soil(law, 6)
    print(f"60 steps {many}, 6 steps {few}")
    assert many[0] > 1.0
    assert few[0] == pytest.approx(many[0], rel=0.1)
    assert abs(few[1]) > 3.0 * abs(many[1])


def test_contact_with_soil_by_the_penalty_dissipates_nothing() -> None:
    own, by_scheme = pulled_off_soil(Penalty(STIFFNESS, 1e-3), 6)
    assert own == 0.0
    assert by_scheme > 1.0


def test_a_node_is_lifted_to_its_present_depth_or_half_the_corner() -> None:
    """Start of the force 0.2 m above the ground. Nodes: aloft; landing; lying deep, pressed deeper; rising."""
    present, guessed = np.array([3.0, 1.0, -0.5, -0.5]), np.array([2.0, -0.7, -0.9, -0.3])
    guess, heights = State.at_rest(0.0, 8), np.array([1, 3, 5, 7])
    guess.u[:] = np.arange(8.0)
    landed = landing_predictor(guess, heights, present, guessed, 0.2)
    np.testing.assert_allclose((landed - guess.u)[heights], [0.0, 0.6, 0.4, 0.0], rtol=1e-14)
    np.testing.assert_array_equal(landed[::2], guess.u[::2])
    np.testing.assert_array_equal(guess.u, np.arange(8.0))
