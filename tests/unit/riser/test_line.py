"""The line's dofs, ends, plane and configuration, and the forces recovered from its elements."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.errors import SceneError
from riser_soil.riser import shapes
from riser_soil.riser.beam import Beam
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End, Kinematics
from riser_soil.riser.loads import AppliedLoad, PointLoads
from riser_soil.riser.section_forces import (
    SectionForces,
    element_residual,
    placed,
    section_input,
    viscous_residual,
)
from riser_soil.riser.sections import Elements
from riser_soil.riser.springs import EndSpring
from tests.support.dense_chain import solve
from tests.support.line_solver import SECTION_FORCES
from tests.support.pipes import pipe
from tests.support.said import line_with, telling
from tests.support.sample_line import DIRECTION, START, sample
from tests.support.sections import section_forces

both_dimensions = pytest.mark.parametrize("dimension", [2, 3])


def prescribed(line: Line, t: float) -> tuple[Array, Array, Array]:
    u, v, a = np.full((3, line.size), np.nan)
    line.prescribe(t, u, v, a)
    return line.nodal(u), line.nodal(v), line.nodal(a)


@both_dimensions
def test_prescribed_ends_follow_their_motion_and_nothing_else_is_written(dimension: int) -> None:
    def motion(t: float) -> Kinematics:
        return START + 2.0 * t * DIRECTION, 2.0 * DIRECTION, 0.5 * DIRECTION

    line = sample(dimension, (End(True, rotation_fixed=True, motion=motion), End(True))).line
    u, v, a = prescribed(line, 3.0)
    assert line.to_global(line.x[0] + u[0, :dimension]) == pytest.approx(START + 6.0 * DIRECTION, abs=1e-14)
    assert line.basis @ v[0, :dimension] == pytest.approx(2.0 * DIRECTION)
    assert line.basis @ a[0, :dimension] == pytest.approx(0.5 * DIRECTION)
    assert not np.any(u[0, dimension:])
    assert not np.any(u[-1, :dimension])
    assert np.all(np.isnan(u[1:-1]))
    assert np.all(np.isnan(u[-1, dimension:]))
    assert np.array_equal(np.isfinite(u.ravel()), line.prescribed)


def test_spin_is_prescribed_at_the_start_about_the_pipes_axis() -> None:
    made = sample(3, shaken=False).line
    tangent = made.trial(State.at_rest(0.0, made.size)).turn.tangent[0, 0]
    spinless = Line(3, shapes_layout(), End(True), End(True), prescribe_spin=True)
    assert np.flatnonzero(spinless.prescribed).tolist() == [0, 1, 2, 3, *range(spinless.size - 6, spinless.size - 3)]
    spinless.prescribe_spin(False)
    assert not spinless.prescribed[3]
    spin = np.zeros((made.nodes, 3))
    spin[0, 0] = 0.4
    assert made.frames.turn(spin).tangent[0, 0] == pytest.approx(tangent, abs=1e-15)


def shapes_layout() -> shapes.Layout:
    arc = np.linspace(0.0, 4.0, 3)
    line = shapes.straight(arc)
    return shapes.layout(arc, np.zeros(2), line, line)


@both_dimensions
def test_commits_keep_position_chord_and_orientation_together(dimension: int) -> None:
    line = sample(dimension, shaken=False).line
    for seed in range(50):
        u = np.random.default_rng(seed).normal(scale=0.3, size=line.size)
        line.commit(State(0.0, u, 0.0 * u, 0.0 * u))
    assert line.chord == pytest.approx(np.diff(line.x, axis=0), abs=1e-13)
    tangent = line.trial(State.at_rest(0.0, line.size)).turn.tangent
    assert np.linalg.norm(tangent, axis=-1) == pytest.approx(1.0, abs=1e-14)


def test_planar_angles_grow_beyond_a_full_turn() -> None:
    line = sample(2, shaken=False).line
    before = line.frames.turn(np.zeros((line.nodes, 1))).tangent
    u = np.zeros(line.size)
    line.nodal(u)[:, 2] = 1.0
    for _ in range(8):
        line.commit(State(0.0, u, 0.0 * u, 0.0 * u))
    after = line.frames.turn(np.full((line.nodes, 1), 4.0 * np.pi - 8.0)).tangent
    assert after == pytest.approx(before, abs=1e-13)


@both_dimensions
def test_global_positions_start_at_the_start(dimension: int) -> None:
    line = sample(dimension, shaken=False).line
    position = line.positions3(State.at_rest(0.0, line.size))
    assert position[0] == pytest.approx(START, abs=1e-14)
    across = np.cross(DIRECTION, [0.0, 0.0, 1.0])
    assert (position - START) @ across == pytest.approx(0.0, abs=1e-14)
    if dimension == 2:
        assert line.x[:, 1] == pytest.approx(position[:, 2], abs=1e-14)


def test_entries_describe_themselves() -> None:
    line = sample(3).line
    line_with(line.describe(6 * 2 + 2), "riser node", "arc 3 m", "vertical force")
    line_with(sample(2).line.describe(3 * 1 + 2), "riser node", "arc 1.5 m", "moment")


def test_tributary_lengths_add_up() -> None:
    line = sample(2).line
    assert line.tributary_length.sum() == pytest.approx(8.0)
    assert line.tributary_length[0] == pytest.approx(0.75)


STIFF: dict[str, Any] = {"EA": 1.0e7, "EI": 2.0e6, "GJ": 1.0e4}
HEAVY = {"outer_diameter": 0.2, "submerged_weight": 50.0}
BAR = STIFF | HEAVY | {"EI": 2.0e4}


def bar(dimension: int, start: End, end: End, count: int = 6, kind: dict[str, Any] = BAR) -> tuple[Line, Elements]:
    """A straight bar of 12 m along x."""
    e = pipe(12.0, count, **kind)
    straight = shapes.straight(e.arc)
    return Line(dimension, shapes.layout(e.arc, e.outer_diameter, straight, straight), start, end), e


@both_dimensions
def test_cantilever_reactions_balance_weight_and_tip_load(dimension: int) -> None:
    line, e = bar(dimension, End(True, rotation_fixed=True), End(False))
    tip, moment = np.array([100.0, 0.0, 80.0]), np.array([0.0, 60.0, 0.0])
    loads = PointLoads(line, [AppliedLoad(lambda t: t, 12.0, tip, moment), AppliedLoad(lambda t: t, 5.0, tip)])
    beam = Beam(line, e)
    solve(line, [beam, loads])
    state = State.at_rest(1.0, line.size)
    on_nodes = loads.nodal_forces(state)
    assert on_nodes is not None
    at_tip = section_forces(line, e, state, element_residual(line, [beam, loads], state), nodal=on_nodes)
    start, end = at_tip.end_force
    weight = np.array([0.0, 0.0, -600.0])
    assert start == pytest.approx(-weight - 2.0 * tip, abs=1e-6)
    assert np.abs([end, at_tip.end_moment[1]]).max() < 1e-5
    assert at_tip.force[-1] == pytest.approx(tip, abs=1e-6)
    assert at_tip.moment[-1] == pytest.approx(moment, abs=1e-6)
    assert at_tip.force[0] == pytest.approx(-start, abs=1e-6)


@both_dimensions
def test_loads_that_grow_work_by_their_mean(dimension: int) -> None:
    """Loads grow from 0.2 to 0.8 while the tip goes 0.3 m along and 0.1 m up, and all of the bar half as far."""
    line, _ = bar(dimension, End(True, rotation_fixed=True), End(False))
    tip, spread = np.array([100.0, 0.0, -80.0]), np.array([0.0, 0.0, 5.0])
    loads = PointLoads(line, [AppliedLoad(lambda t: t, 12.0, tip), AppliedLoad(lambda t: t, distributed=spread)])
    before, after = State.at_rest(0.2, line.size), State.at_rest(0.8, line.size)
    line.nodal(after.u)[:, [0, dimension - 1]] = np.array([0.15, 0.05])
    line.nodal(after.u)[-1, [0, dimension - 1]] = np.array([0.3, 0.1])
    work = loads.work(before, after)
    of_spread = 5.0 * 12.0 * 0.05 + 5.0 * 0.5 * 2.0 * 0.05
    assert work.external == pytest.approx(0.5 * (100.0 * 0.3 - 80.0 * 0.1 + of_spread), rel=1e-12)
    assert work.dissipated == work.inertial == 0.0


def test_small_deflections_give_textbook_section_forces() -> None:
    fixed = End(True, rotation_fixed=True)
    line, e = bar(3, fixed, fixed, kind=STIFF | HEAVY)
    beam = Beam(line, e)
    solve(line, [beam])
    state = State.at_rest(1.0, line.size)
    forces = section_forces(line, e, state, element_residual(line, [beam], state))
    middle = 50.0 * 12.0**2 / 24.0
    assert forces.bending_moment[[0, 3, -1]] == pytest.approx([2.0 * middle, middle, 2.0 * middle], rel=1e-3)
    assert forces.curvature == pytest.approx(forces.bending_moment / 2.0e6, rel=1e-12)
    assert forces.moment[3, 1] < 0.0 < forces.moment[0, 1]  # sagging turns the tangent up, about -y


@both_dimensions
def test_section_forces_of_many_states_are_those_of_each(dimension: int) -> None:
    """Forces are the same to the last bit, so that files do not depend on how many steps are written together."""
    made = sample(dimension)
    parts = [made.beam(), made.damping()]
    rows = []
    for n in range(5):
        state = made.state(n, size=0.02)
        residual, viscous = element_residual(made.line, parts, state), viscous_residual(made.line, parts, state)
        rows.append(section_input(made.line, placed(made.line, state), residual, viscous))
    together = SectionForces(made.line, made.elements, np.stack(rows))
    for name in SECTION_FORCES:
        for n, row in enumerate(rows):
            of_one = np.asarray(getattr(SectionForces(made.line, made.elements, row), name))
            of_many = np.asarray(getattr(together, name))
            expected = of_many[:, n] if name.startswith(("least", "largest")) else of_many[n]
            np.testing.assert_array_equal(of_one, expected, err_msg=name)
        assert np.ptp(of_many) > 0.0, name


@both_dimensions
def test_largest_moment_under_an_even_load_lies_between_nodes(dimension: int) -> None:
    """A beam on two supports, w = 50 N/m: w L²/8 in the middle of 12 m, between nodes at 4.8 and 7.2 m."""
    line, e = bar(dimension, End(True), End(True), kind=STIFF | HEAVY, count=5)
    beam = Beam(line, e)
    solve(line, [beam])
    state = State.at_rest(1.0, line.size)
    forces = section_forces(line, e, state, element_residual(line, [beam], state))
    middle = 50.0 * 12.0**2 / 8.0
    assert forces.bending_moment.max() == pytest.approx(0.96 * middle, rel=1e-3)
    assert np.array(forces.largest_moment) == pytest.approx([middle, 6.0], rel=1e-3)
    assert np.array(forces.largest_curvature) == pytest.approx([middle / 2.0e6, 6.0], rel=1e-3)


@both_dimensions
def test_largest_moment_under_a_point_load_is_not_overshot(dimension: int) -> None:
    """The moment has a corner at the load, at a node beside the middle: P a b/L there, and nowhere more."""
    line, e = bar(dimension, End(True), End(True), kind=STIFF, count=5)
    parts = (Beam(line, e), PointLoads(line, [AppliedLoad(lambda t: t, 4.8, force=np.array([0.0, 0.0, -50.0]))]))
    solve(line, parts)
    state = State.at_rest(1.0, line.size)
    forces = section_forces(line, e, state, element_residual(line, parts, state))
    moment, arc = map(float, forces.largest_moment)
    assert moment == forces.bending_moment[2]
    assert arc == pytest.approx(4.8)
    assert moment == pytest.approx(50.0 * 4.8 * 7.2 / 12.0, rel=1e-3)


def test_curvature_is_resolved_in_section_axes() -> None:
    kind = {"EA": 1.0e7, "EI_y": 2.0e4, "EI_z": 8.0e4, "GJ": 1.0e4}
    line, e = bar(3, End(True, rotation_fixed=True), End(False), kind=kind)
    moment = np.array([0.0, 30.0, 40.0])
    parts = (Beam(line, e), PointLoads(line, [AppliedLoad(lambda t: t, 12.0, moment=moment)]))
    solve(line, parts, tolerance=1e-9)
    state = State.at_rest(1.0, line.size)
    forces = section_forces(line, e, state, element_residual(line, parts, state))
    assert forces.bending_moment == pytest.approx(50.0, rel=1e-3)
    assert forces.curvature == pytest.approx(np.hypot(30.0 / 2.0e4, 40.0 / 8.0e4), rel=1e-3)


@both_dimensions
def test_a_spring_holds_the_end_like_its_stiffness_says(dimension: int) -> None:
    line, e = bar(dimension, End(True), End(False))
    loads = PointLoads(line, [AppliedLoad(lambda t: t, 12.0, moment=np.array([0.0, -200.0, 0.0]))])
    weightless = Beam(line, pipe(12.0, 6, **STIFF | {"EI": 2.0e4}))
    spring = EndSpring(line, 0, 1000.0)
    solve(line, [weightless, loads, spring])
    state = State.at_rest(1.0, line.size)
    tangent = line.trial(state).turn.tangent[0, 0] @ line.basis.T
    assert tangent == pytest.approx([np.cos(0.2), 0.0, np.sin(0.2)], abs=1e-9)
    forces = section_forces(line, e, state, element_residual(line, [weightless], state))
    assert forces.end_moment[0] == pytest.approx([0.0, 200.0, 0.0], abs=1e-6)
    assert spring.energy(state).strain == pytest.approx(0.5 * 1000.0 * 0.2**2)


def test_a_moment_between_nodes_is_refused() -> None:
    line = sample(2).line
    with pytest.raises(SceneError, match=telling("arc 2 m", "between nodes", "nearest, 1.5 m")):
        PointLoads(line, [AppliedLoad(lambda t: t, 2.0, moment=np.ones(3))])


def test_a_load_off_the_riser_is_refused() -> None:
    with pytest.raises(SceneError, match=telling("arc 9 m:", "ends at 8 m")):
        PointLoads(sample(2).line, [AppliedLoad(lambda t: t, 9.0, force=np.ones(3))])


@both_dimensions
def test_loads_work_is_force_times_way(dimension: int) -> None:
    at = sample(dimension)
    force = np.array([30.0, 40.0, 25.0])
    loads = PointLoads(at.line, [AppliedLoad(lambda t: 2.0, at.line.arc[-1], force)])
    before, after = State.at_rest(0.0, at.line.size), at.state(1)
    way = at.line.basis @ at.line.nodal(after.u)[-1, :dimension]
    assert loads.work(before, after).external == pytest.approx(2.0 * force @ way)


def test_a_fixed_axis_moment_works_on_the_turn_about_its_axis() -> None:
    at = sample(3)
    moment = np.array([7.0, -3.0, 5.0])
    loads = PointLoads(at.line, [AppliedLoad(lambda t: 1.0, at.line.arc[-1], moment=moment)])
    before, after = State.at_rest(0.0, at.line.size), at.state(1)
    turn = at.line.trial(after).turn
    assert hasattr(turn, "Rn")
    expected = moment @ (turn.Rn[-1] @ at.line.nodal(after.u)[-1, 3:])
    assert loads.work(before, after).external == pytest.approx(expected, rel=1e-12)


def test_a_planar_line_must_stay_in_its_plane() -> None:
    arc = np.linspace(0.0, 4.0, 3)
    straight = shapes.straight(arc)
    bent = shapes.through(arc, [[0.0, 0.0, 0.0], [2.0, 0.1, 0.0], [4.0, 0.0, 0.0]])
    with pytest.raises(SceneError, match=telling("vertical plane", "0.1 m", "use 3")):
        Line(2, shapes.layout(arc, np.zeros(2), straight, bent), End(True), End(True))
