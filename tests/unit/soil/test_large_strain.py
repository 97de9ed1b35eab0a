"""Soil that moves: objective stress, simple shear, volume, energy, and what a change of mesh leaves of stress."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State
from riser_soil.soil.families import point_volumes
from riser_soil.soil.iwan import IwanOverlay
from riser_soil.soil.kinematic_hardening import KinematicHardening
from riser_soil.soil.large_strain import turn, turned
from riser_soil.soil.law import STRESS
from riser_soil.soil.soil import Soil
from riser_soil.soil.von_mises import VonMises
from tests.support.soil_cases import CLAY, KINDS, distorted, inner, small_block

LAWS = (
    VonMises(kind="von-mises", su=4.0e3, E_over_su=300.0),
    KinematicHardening(kind="kinematic-hardening", su=4.0e3, E_over_su=300.0),
    IwanOverlay(kind="iwan", su=4.0e3, E_over_su=300.0),
)
ROOT = np.sqrt(2.0)


def tensors(mandel: Array) -> Array:
    """(n, 3, 3) of (n, 6)."""
    xx, yy, zz, xy, xz, yz = mandel.T * np.array([1, 1, 1, 1 / ROOT, 1 / ROOT, 1 / ROOT])[:, None]
    return np.moveaxis(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]), 2, 0)


def moving(kind: Any, law: Any = CLAY, unit_weight: float = 0.0) -> Soil:
    return Soil(distorted(small_block(kind)), law, level=0.0, unit_weight=unit_weight, moves=True)


def move(soil: Soil, points: Array) -> None:
    """Take one step that brings all nodes to points (n, 3)."""
    u = (points - soil.points).ravel()
    state = State(1.0, u, u, u)
    soil.commit(state)
    soil.field.commit(state)


def stress(soil: Soil) -> Array:
    return soil.state()["law/stress"]


def test_tensors_turn_by_cayleys_rotation() -> None:
    """A spin w over a step turns by 2 atan(|w|/2) about w, see Hughes & Winget 1980."""
    rng = np.random.default_rng(1)
    before, spin = rng.normal(size=(20, 6)), rng.normal(size=(20, 3))
    after = before.copy()
    turn(after, spin)
    size = np.linalg.norm(spin, axis=1, keepdims=True)
    Q = Rotation.from_rotvec(2.0 * np.arctan(0.5 * size) * spin / size).as_matrix()
    np.testing.assert_allclose(tensors(after), Q @ tensors(before) @ Q.transpose(0, 2, 1), atol=1e-14)


def test_only_tensors_of_a_history_turn() -> None:
    columns = ("scalar", *STRESS, "equivalent_plastic_strain", *(f"backstress{name[6:]}" for name in STRESS))
    history, spin = np.random.default_rng(2).normal(size=(4, 14)), np.full((4, 3), 0.3)
    after = turned(history, columns, spin)
    assert (after[:, [0, 7]] == history[:, [0, 7]]).all()
    for first in (1, 8):
        expected = history[:, first : first + 6].copy()
        turn(expected, spin)
        np.testing.assert_array_equal(after[:, first : first + 6], expected)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.kind)
@pytest.mark.parametrize("steps", [1, 7])
def test_a_stressed_block_that_turns_keeps_its_stress_in_its_own_axes(kind: str, law: Any, steps: int) -> None:
    soil = moving(kind, law.at_points)
    gradient = 2e-3 * np.array([[0.5, 1.0, -0.4], [0.3, -0.9, 0.6], [-0.2, 0.7, 0.2]])
    move(soil, soil.points @ (np.eye(3) + gradient).T)
    first, places = tensors(stress(soil)), soil.points
    axis = np.array([2.0, -1.0, 2.0]) / 3.0
    for n in range(1, steps + 1):
        R = Rotation.from_rotvec(0.5 * np.pi * n / steps * axis).as_matrix()
        move(soil, places @ R.T)
    own = R.T @ tensors(stress(soil)) @ R
    assert np.abs(own - first).max() < 1e-10 * np.abs(first).max()


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.kind)
def test_simple_shear_to_four_times_the_height_rises_to_the_strength(law: Any) -> None:
    """An overlay's strongest elements yield beyond a strain of 2, and until then turn with the material."""
    soil = moving("hex", law.at_points)
    first, shear = soil.points.copy(), [0.0]
    for gamma in np.linspace(0.0, 4.0, 401)[1:]:
        move(soil, first + gamma * np.outer(first[:, 2], [1.0, 0.0, 0.0]))
        shear.append(float(stress(soil)[:, 4].mean()) / ROOT)
    assert np.diff(shear).min() > -1e-3 * 4.0e3
    assert (0.95 if law.kind == "iwan" else 0.999) < shear[-1] / 4.0e3 < 1.0 + 1e-9


@pytest.mark.parametrize("kind", KINDS)
def test_pressure_is_that_of_the_volume_that_there_is(kind: str) -> None:
    """Cells stretched to half of their height in 20 steps, their volume less by 1e-3: p = -K ln(1 - 1e-3)."""
    soil = moving(kind, LAWS[0].at_points)
    first, volume = soil.points.copy(), point_volumes(soil.grid.family, soil.points, soil.grid.nodes.cells)
    for n in range(1, 21):
        height, plan = 0.5 ** (n / 20), (1.0 - 1e-3) ** (n / 20)
        move(soil, first * np.array([plan / height, 1.0, height]))
    now = point_volumes(soil.grid.family, soil.points, soil.grid.nodes.cells)
    np.testing.assert_allclose(now.sum(axis=1) / volume.sum(axis=1), 1.0 - 1e-3, rtol=1e-12)
    pressure = -stress(soil)[:, :3].mean(axis=1)
    np.testing.assert_allclose(pressure, -soil.law.bulk * np.log(1.0 - 1e-3), rtol=5e-3)


def nodal_forces(soil: Soil, u: Array) -> Array:
    """On all nodes (n, 3) at increments u (n, 3)."""
    forces = Forces.zeros(u.size)
    soil.residual(State(1.0, u.ravel(), u.ravel(), u.ravel()), forces)
    return forces.end.reshape(-1, 3)


@pytest.mark.parametrize("kind", KINDS)
def test_forces_are_those_on_the_geometry_of_the_state_that_it_is_placed_at(kind: str) -> None:
    """The strain H is by gradients there, and forces f at places x of a volume V do the work f x = sigma V."""
    soil = moving(kind, LAWS[0].at_points)
    first, H = soil.points.copy(), 1e-4 * np.random.default_rng(5).normal(size=(3, 3))
    at = first * [1.1, 0.95, 0.9]
    u, placed = at @ H.T, (at - first).ravel()
    there = nodal_forces(soil, u)
    soil.place(State(1.0, placed, placed, placed))
    forces = nodal_forces(soil, u)
    strain = 0.5 * (H + H.T)
    stress = 2.0 * soil.law.shear[0] * strain
    stress += (soil.law.bulk[0] - 2.0 / 3.0 * soil.law.shear[0]) * np.trace(strain) * np.eye(3)
    volume = float(point_volumes(soil.grid.family, at, soil.grid.nodes.cells).sum())
    np.testing.assert_allclose(forces.T @ at, stress * volume, rtol=1e-9)
    soil.place(State.at_rest(1.0, u.size))
    np.testing.assert_allclose(nodal_forces(soil, u), there, rtol=1e-9, atol=1e-9 * np.abs(there).max())


def test_areas_stay_where_a_step_was_solved_until_the_next() -> None:
    """On the rank that has the surface, whose own cells may not move; what is solved without a step takes new ones."""
    soil = moving("hex")
    surface = soil.surface
    surface.offset = soil.field.size
    u = np.zeros(soil.field.size + surface.size)
    u[surface.offset :] = 0.01
    moved = State(1.0, u, u, u)
    soil.place(moved)
    assert (surface.placed == 0.01).all()
    surface.commit(moved)
    assert (surface.placed == surface.committed).all()
    soil.place(State.at_rest(1.0, u.size))
    surface.commit(moved)
    assert (surface.placed == 0.01).all()
    assert (surface.committed == 0.02).all()
    surface.commit(moved)
    assert (surface.placed == surface.committed).all()


def test_it_is_not_placed_where_a_cell_would_fold() -> None:
    soil, rng = moving("hex", LAWS[0].at_points), np.random.default_rng(5)
    u = 1e-4 * rng.normal(size=soil.points.shape)
    before, folds = nodal_forces(soil, u), 3.0 * rng.normal(size=u.size)
    reason = soil.inadmissible(State(1.0, 1e6 * folds, folds, folds))
    assert "would fold" in reason
    place = [float(number) for number in re.findall(r"[-\d.e+]+(?=[,)])", reason)]
    assert (soil.points.min(axis=0) <= place).all()  # where the cell lies, not where it would end
    assert (place <= soil.points.max(axis=0)).all()
    soil.place(State(1.0, folds, folds, folds))
    np.testing.assert_array_equal(nodal_forces(soil, u), before)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.kind)
def test_energy_is_balanced_over_steps_that_move(kind: str, law: Any) -> None:
    """What forces put in is stored or dissipated, steps after others that have moved the cells included."""
    soil = moving(kind, law.at_points, unit_weight=5.0e3)
    first, rng = soil.points.copy(), np.random.default_rng(3)
    free = inner(soil.grid)
    stored = soil.energy(State.at_rest(0.0, soil.field.size)).total
    for n in range(4):
        target = first.copy()
        target[free] += 0.005 * (n + 1) * rng.uniform(-1.0, 1.0, (np.count_nonzero(free), 3))
        u = (target - soil.points).ravel()
        state, rest = State(1.0, u, u, u), State.at_rest(0.0, soil.field.size)
        force = soil._response(state).force
        put_in, turned_over = float(force @ u), soil.work(rest, state)
        after = soil.energy(state).total
        assert after - stored + turned_over.dissipated == pytest.approx(put_in, rel=1e-10)
        soil.commit(state)
        soil.field.commit(state)
        stored = after


def test_weight_goes_along_with_the_cells() -> None:
    soil = moving("hex", unit_weight=5.0e3)
    raised = soil.points + np.array([0.0, 0.0, 0.4]) * (1.0 + soil.points[:, 2:])
    move(soil, raised)
    whole = 5.0e3 * 2.0 * 1.5 * 1.4
    assert -(soil._load - soil._initial_reaction)[2::3].sum() == pytest.approx(whole, rel=1e-12)


def waved(soil: Soil, amount: float) -> Array:
    """Points of the soil, inner ones moved in a smooth manner."""
    x, y, z = soil.points.T
    bump = amount * np.sin(np.pi * x / 2.0) * np.sin(np.pi * y / 1.5) * np.sin(np.pi * z)
    return np.asarray(soil.points + np.outer(bump, [1.0, 0.5, -0.7]))


@pytest.mark.parametrize("kind", KINDS)
def test_a_uniform_stress_survives_a_hundred_new_meshes(kind: str) -> None:
    gradient = 2e-4 * np.array([[0.5, 1.0, -0.4], [0.3, -0.9, 0.6], [-0.2, 0.7, 0.2]])
    law = VonMises(kind="von-mises", su=4.0e3, E_over_su=300.0, nu=0.3)
    soil = Soil(small_block(kind), law.at_points, level=0.0, unit_weight=0.0, moves=True)
    move(soil, soil.points @ (np.eye(3) + gradient).T)
    first, here, there = stress(soil)[0], soil.points.copy(), waved(soil, 0.05)
    for n in range(100):
        soil.take_mesh((here if n % 2 else there)[np.argsort(soil.grid.nodes.number)])
    assert np.abs(stress(soil) - first).max() < 1e-10 * np.abs(first).max()


def test_stress_by_weight_and_strength_by_depth_are_those_of_the_new_places() -> None:
    soil = Soil(small_block("hex", 0.25), CLAY, level=0.0, unit_weight=5.0e3, moves=True)
    for amount in (0.04, -0.03, 0.05):
        soil.take_mesh(waved(soil, amount)[np.argsort(soil.grid.nodes.number)])
    depth = -soil.cells.at_points(soil.points)[:, 2]
    limit = np.sqrt(3.0) * (4.0e3 + 1.5e3 * depth)
    np.testing.assert_allclose(vars(soil.law)["limit"], limit, rtol=1e-10)
    of_cell = soil.cells.mean(5.0e3 * depth)
    np.testing.assert_allclose(-soil.cells.mean(stress(soil)[:, 2]), of_cell, rtol=1e-10)


def test_a_stress_that_varies_goes_along_with_the_way() -> None:
    """Linear in x: inside, what is missed is a small part of the change along the way."""
    soil = Soil(small_block("hex", 0.125), LAWS[0].at_points, level=0.0, unit_weight=0.0, moves=True)
    x, strained = soil.points, 1e-5
    move(soil, x + strained * np.stack([x[:, 0] * x[:, 2], 0.0 * x[:, 0], -0.5 * x[:, 2] ** 2], axis=1))
    before = soil.cells.at_points(soil.points)
    soil.take_mesh(waved(soil, 0.02)[np.argsort(soil.grid.nodes.number)])
    at = soil.cells.at_points(soil.points)
    inside = ((at > soil.grid.low + 0.2) & (at < soil.grid.high - 0.2)).all(axis=1)
    slope = soil.law.shear[0] * strained
    missed = stress(soil)[:, 4] / ROOT - slope * at[:, 0]
    changed = slope * (at - before)[:, 0]
    assert np.sqrt(np.mean(missed[inside] ** 2)) < 0.05 * np.sqrt(np.mean(changed[inside] ** 2))


def test_cells_beside_new_ones_stay_as_they_are() -> None:
    """A strained block gets new nodes where x < 1: cells beyond keep stress, wear and places to the last bit."""
    soil = Soil(small_block("hex", 0.25), CLAY, level=0.0, unit_weight=5.0e3, moves=True)
    x = soil.points
    move(soil, x + 0.01 * np.stack([x[:, 0] * x[:, 2], 0.0 * x[:, 0], -0.5 * x[:, 2] ** 2], axis=1))
    made, order = x[:, 0] < 1.0 - 1e-9, np.argsort(soil.grid.nodes.number)
    there = np.where(made[:, None], waved(soil, 0.02), soil.points)
    beside = ~made[soil.cells.nodes].any(axis=1)
    kept = stress(soil).reshape(*soil.cells.shape, 6), soil.worn, soil.cells.made_at.copy()
    assert np.allclose(soil.gathered_wear(soil.worn)[order].max(), soil.worn.max())
    soil.take_mesh(there[order], made[order])
    now = stress(soil).reshape(*soil.cells.shape, 6), soil.worn, soil.cells.made_at
    assert 0 < beside.sum() < beside.size
    for before, after in zip(kept, now, strict=True):
        assert np.array_equal(before[beside], after[beside])
        assert not np.array_equal(before[~beside], after[~beside])
    assert soil.worn[made[soil.cells.nodes].all(axis=1)].max() == 0.0


def test_cells_wear_by_strain_and_not_by_turns() -> None:
    soil = moving("hex")
    first, turn_of = soil.points, Rotation.from_rotvec([0.1, 0.2, 0.3])
    soil.field.total = (turn_of.apply(first) - first).ravel()
    assert soil.worn.max() == pytest.approx(0.0, abs=1e-12)
    soil.field.total = (turn_of.apply(first * [1.0, 1.0, 1.1]) - first).ravel()
    assert soil.worn.max() == pytest.approx(0.5 * (1.1**2 - 1.0), rel=0.05)
    soil.take_mesh(soil.gathered_points())
    assert soil.worn.max() == 0.0
