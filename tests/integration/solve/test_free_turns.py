"""Turns that the supports leave free: they move no support, are rigid, and are told from modes of buckling."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from scipy.sparse import csr_matrix

from riser_soil.assembly import Assembly
from riser_soil.core.part import State
from riser_soil.core.system import System, Timer
from riser_soil.riser.line_ends import End
from riser_soil.solve import stability
from riser_soil.solve.newton import Newton
from riser_soil.solve.newton_settings import NewtonSettings
from riser_soil.solve.time_scheme import Static
from tests.support.driven_stage import built, take
from tests.support.sample_line import sample
from tests.support.scenes import Mapping, prescribed, riser_scene, static

FREE, HINGED, CLAMPED = End(False), End(True), End(True, rotation_fixed=True)


@pytest.mark.parametrize(
    ("dimension", "start", "end", "count"),
    [
        (2, HINGED, HINGED, 0),
        (2, HINGED, FREE, 1),
        (2, CLAMPED, FREE, 0),
        (2, FREE, FREE, 3),
        (3, HINGED, HINGED, 1),
        (3, HINGED, FREE, 3),
        (3, CLAMPED, CLAMPED, 0),
        (3, FREE, FREE, 6),
    ],
)
def test_what_the_supports_leave_free(dimension: int, start: End, end: End, count: int) -> None:
    """In space the spin of the start about its axis is prescribed, as always in statics."""
    line = sample(dimension, (start, end)).line
    line.prescribe_spin(True)
    turns, x = line.free_turns(State.at_rest(0.0, line.size)), line.x
    assert len(turns) == count
    assert np.abs(turns[:, line.prescribed]).max(initial=0.0) < 1e-8 * line.arc[-1]
    for turn in turns.reshape(count, line.nodes, line.ndof):
        moved = turn[:, :dimension]
        assert np.abs(moved).max() == pytest.approx(line.arc[-1])
        stretch = np.sum((x[:, None] - x) * (moved[:, None] - moved), axis=2)
        assert np.abs(stretch).max() < 1e-9 * line.arc[-1] ** 2


def test_an_increment_of_a_whole_turn_leaves_none_free() -> None:
    """There rotation vectors have no rates that would tell a spin."""
    line = sample(3, (FREE, FREE)).line
    state = State.at_rest(0.0, line.size)
    line.nodal(state.u)[:, 3] = 2.0 * np.pi
    assert line.free_turns(state).shape == (0, line.size)


def hinged(x: float, z: float, given: Mapping, **pipe: float) -> Mapping:
    """A line in space between balls, 12 m long."""
    made: Mapping = {"EA": 1e8, "EI": 1e3, "GJ": 1e3} | pipe
    ends: Mapping = {"start": prescribed(0.0, 0.0, 0.0), "end": prescribed(x, 0.0, z)}
    return riser_scene(static(), pipe=made, length=12.0, elements=24, **ends, dimension=3, **given)


@pytest.mark.parametrize("axis", [(0.0, 0.0, -1.0), (0.36, 0.48, -0.8), (0.6, 0.64, 0.48)])
def test_a_straight_line_turns_about_itself_as_its_sections_spin(axis: tuple[float, float, float]) -> None:
    """Two of its three turns about a ball are free where the spin of that end is prescribed, and none comes twice."""
    shape: Mapping = {"riser": {"unstressed": {"points": [[0.0, 0.0, 0.0], [12.0 * a for a in axis]]}}, "gravity": 9.81}
    pipe: Mapping = {"EA": 1e8, "EI": 1e3, "GJ": 1e3, "submerged_weight": 500.0}
    ends: Mapping = {"start": prescribed(0.0, 0.0, 0.0), "end": "free"}
    assembly = built(riser_scene(static(), pipe=pipe, length=12.0, elements=6, **ends, dimension=3, **shape))
    assembly.begin(assembly.scene.stages[0])
    line = assembly.riser.line
    line.prescribe_spin(True)
    turns = line.free_turns(State.at_rest(0.0, assembly.size))
    sizes = np.linalg.svd(turns / np.linalg.norm(turns, axis=1)[:, None], compute_uv=False)
    assert len(turns) == 2
    assert sizes.min() > 1e-3


@contextmanager
def started(assembly: Assembly) -> Iterator[tuple[System, Newton]]:
    system = System(assembly.comm, assembly.begin(assembly.scene.stages[-1]), Timer.new())
    newton = Newton(system, NewtonSettings(1e-8, 25, assembly.scales.force_floor))
    yield system, newton
    newton.destroy()
    system.destroy()


def judged(assembly: Assembly, forces: float) -> tuple[int, int]:
    """Free turns that meet no force where the riser is, and its unstable modes."""
    with started(assembly) as (system, newton):
        state = State.at_rest(1.0, assembly.size)
        system.assemble(state, Static().weights(0.0))
        neutral = stability._neutral(system, state, stability.NO_STIFFNESS * forces)
        return len(neutral), newton.unstable_modes(state)


def hanging(x: float) -> Assembly:
    """A slack riser at rest, its end 11 m above the start and x aside."""
    scene = hinged(4.0, 9.0, {"gravity": 9.81}, submerged_weight=500.0)
    scene["stages"] = [static("hang"), static("move", move={"end": [x, 0.0, 11.0]})]
    assembly = built(scene)
    before = take(assembly, assembly.scene.stages[0])
    take(assembly, assembly.scene.stages[1], before)
    return assembly


@pytest.mark.parametrize(("x", "neutral"), [(0.0, 1), (0.1, 0), (4.0, 0)])
def test_a_riser_turns_freely_about_the_vertical_only(x: float, neutral: int) -> None:
    assert judged(hanging(x), 6e3) == (neutral, 0)


@pytest.mark.parametrize("bow", [0.0, 1e-9, 1e-3])
def test_a_mode_of_buckling_is_no_free_turn(bow: float) -> None:
    """However small the bow is that a turn about the chord would move: the strut buckles both ways aside."""
    points = [[0.5 * k, 0.0, bow * np.sin(np.pi * k / 24.0)] for k in range(25)]
    thrust = 2.0 * np.pi**2 * 1e3 / 12.0**2
    squeezed = np.array(points) * (1.0 - thrust / 1e8, 1.0, 1.0)
    shapes: Mapping = {"unstressed": {"points": points}, "initial": {"points": squeezed.tolist()}}
    assembly = built(hinged(12.0 * (1.0 - thrust / 1e8), 0.0, {"riser": shapes}))
    assert judged(assembly, thrust) == (0, 2)


def test_a_prescribed_turn_leaves_newton_a_regular_matrix() -> None:
    """The smallest eigenvalue of the scaled tangent is one of bending, and not that of the turn."""
    assembly = hanging(0.0)
    with started(assembly) as (system, _):
        state, turns = State.at_rest(1.0, assembly.size), list[float]()
        for least in (0.0, 1e-4 * 6e3):
            system.assemble(state, Static().weights(0.0))
            stability.prescribe_free_turns(system, state, least)
            starts, columns, values = system.matrix.stored.csr()
            K = csr_matrix((values, columns, starts)).toarray()
            d = np.sqrt(np.diag(K))
            turns.append(float(np.linalg.eigvalsh(K / np.outer(d, d))[0]))
    assert turns[1] > 0.0
    assert abs(turns[0]) < 1e-3 * turns[1]
