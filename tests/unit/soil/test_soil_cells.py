"""Element integration: patch test, exact tangent, energy balance, on both families with distorted cells."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State
from riser_soil.soil import mandel
from riser_soil.soil.grid import DistributedMesh
from riser_soil.soil.iwan import IwanOverlay
from riser_soil.soil.kinematic_hardening import KinematicHardening
from riser_soil.soil.law import SoilLaw
from riser_soil.soil.linear_elastic import LinearElastic
from riser_soil.soil.soil import Soil
from riser_soil.soil.soil_cells import SoilCells
from riser_soil.soil.von_mises import VonMises
from tests.support.b_bar import cells_of
from tests.support.soil_bench import assemble
from tests.support.soil_cases import CLAY, ELASTIC, KINDS, clay_block, distorted, inner, moved, sheared, small_block

CYCLIC = (
    KinematicHardening(kind="kinematic-hardening", su=4.0e3, E_over_su=300.0),
    IwanOverlay(kind="iwan", su=4.0e3, E_over_su=300.0),
)
EPS = np.finfo(float).eps
GRADIENT = 1e-3 * np.array([[1.0, 0.4, -0.2], [0.7, -0.5, 0.3], [-0.6, 0.1, 0.8]])


def strain_of(grid: DistributedMesh, displacement: Array) -> Array:
    cells = SoilCells(grid)
    return cells.strain(displacement.ravel()).reshape(*cells.shape, 6)


def force(soil: Soil, state: State) -> Array:
    forces = Forces.zeros(soil.field.size)
    soil.residual(state, forces)
    assert not forces.force.any()
    assert not forces.inertia.any()
    return forces.end


@pytest.mark.parametrize("kind", KINDS)
def test_linear_displacement_gives_constant_strain(kind: str) -> None:
    grid = distorted(small_block(kind))
    strain = strain_of(grid, grid.nodes.points @ GRADIENT.T)
    e, root = 0.5 * (GRADIENT + GRADIENT.T), np.sqrt(2.0)
    exact = [e[0, 0], e[1, 1], e[2, 2], root * e[0, 1], root * e[0, 2], root * e[1, 2]]
    np.testing.assert_allclose(strain, np.broadcast_to(exact, strain.shape), atol=1e-15)


@pytest.mark.parametrize("kind", KINDS)
def test_patch_test_inner_nodes_are_in_equilibrium(kind: str) -> None:
    grid = distorted(small_block(kind))
    soil = Soil(grid, ELASTIC, level=0.0, unit_weight=0.0)
    u = (grid.nodes.points @ GRADIENT.T).ravel()
    nodal = force(soil, State(1.0, u, u, u)).reshape(-1, 3)
    assert np.count_nonzero(inner(grid)) >= 4
    assert np.abs(nodal[inner(grid)]).max() < 1e-12 * np.abs(nodal).max()


@pytest.mark.parametrize("nu", [0.49, 0.4999])
def test_patch_test_of_cells_fifty_times_as_long_as_wide(nu: float) -> None:
    """Displacements as large as a cell is long would drown in round-off what the short sides see."""
    grid = distorted(small_block("hex"))
    stretch = np.array([50.0, 1.0, 1.0])
    grid = replace(grid, nodes=replace(grid.nodes, points=grid.nodes.points * stretch), high=grid.high * stretch)
    law = LinearElastic(kind="linear-elastic", E=1.2e6, nu=nu).at_points
    u = (grid.nodes.points @ (GRADIENT / stretch).T).ravel()
    nodal = force(Soil(grid, law, level=0.0, unit_weight=0.0), State(1.0, u, u, u)).reshape(-1, 3)
    assert np.abs(nodal[inner(grid)]).max() < 1e-12 * np.abs(nodal).max()


@pytest.mark.parametrize("kind", KINDS)
def test_volume_and_rigid_rotation(kind: str) -> None:
    grid = distorted(small_block(kind))
    cells = cells_of(grid.family, grid.nodes.points, grid.nodes.cells)
    assert SoilCells(grid).volumes.sum() == pytest.approx(3.0, rel=1e-13)
    turn = np.cross(np.array([0.1, -0.2, 0.3]), grid.nodes.points)
    terms = np.abs(cells.gradients).sum(axis=2).max() * np.abs(turn).max()  # strains are sums of them, rounded each
    assert np.abs(strain_of(grid, turn)).max() < 8.0 * EPS * terms


def test_mean_dilatation_makes_the_volume_change_uniform_in_a_hexahedron() -> None:
    grid = distorted(small_block("hex"))
    rng = np.random.default_rng(4)
    u = rng.standard_normal(grid.nodes.points.shape)
    volume = 3.0 * mandel.mean(strain_of(grid, u))
    assert np.ptp(volume, axis=1).max() < 1e-13 * np.abs(volume).max()
    full = 3.0 * mandel.mean(strain_of(replace(grid, family=replace(grid.family, mean_dilatation=False)), u))
    assert np.ptp(full, axis=1).min() > 1e-3 * np.abs(full).max()


@pytest.mark.parametrize("kind", KINDS)
def test_tangent_matches_finite_differences_in_the_plastic_range(kind: str) -> None:
    soil = clay_block(kind)
    soil.commit(moved(soil, 2e-3, seed=1))
    state = moved(soil, 5e-3, seed=2)
    tangent, scale = assemble(soil, state), 1e-7
    without_flow = assemble(
        Soil(soil.grid, CLAY, level=0.0, unit_weight=0.0), State.at_rest(1.0, len(state.u))
    )
    for seed in range(3):
        direction = moved(soil, 1.0, seed=10 + seed).u
        ahead, behind = (force(soil, replace(state, u=state.u + s * scale * direction)) for s in (1.0, -1.0))
        numeric = (ahead - behind) / (2.0 * scale)
        assert np.linalg.norm(tangent @ direction - numeric) < 1e-8 * np.linalg.norm(numeric)
        assert np.linalg.norm(without_flow @ direction - numeric) > 1e-2 * np.linalg.norm(numeric)
    assert abs(tangent - tangent.T).max() < 1e-12 * abs(tangent).max()


@pytest.mark.parametrize("kind", KINDS)
def test_residual_has_no_memory(kind: str) -> None:
    soil = clay_block(kind)
    state = moved(soil, 5e-3)
    first = force(soil, state)
    force(soil, moved(soil, 5e-2, seed=8))
    soil.energy(moved(soil, 5e-2, seed=8))
    np.testing.assert_array_equal(force(soil, state), first)


@pytest.mark.parametrize("kind", KINDS)
def test_tangent_has_no_memory(kind: str) -> None:
    """Cells that yielded at one state and not at the next, and the other way round."""
    soil = clay_block(kind)
    for state in (moved(soil, 5e-3), State.at_rest(1.0, soil.field.size), moved(soil, 1e-3, seed=7)):
        assert abs(assemble(soil, state) - assemble(clay_block(kind), state)).max() == 0.0


@pytest.mark.parametrize("kind", KINDS)
def test_elastic_residual_is_the_gradient_of_the_energy(kind: str) -> None:
    soil = Soil(distorted(small_block(kind)), ELASTIC, level=0.0, unit_weight=5.0e3, start="unstressed")
    state, direction = moved(soil, 1e-3), moved(soil, 1.0, seed=3).u
    ahead, behind = (soil.energy(replace(state, u=state.u + s * 1e-4 * direction)).total for s in (1, -1))
    assert (ahead - behind) / 2e-4 == pytest.approx(float(force(soil, state) @ direction), rel=1e-8)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("K0", [1.0, 0.9])
def test_energy_given_to_the_soil_is_stored_or_dissipated(kind: str, K0: float) -> None:
    """Force at the end of a step times increment = change of the stored energy + dissipation."""
    soil = clay_block(kind, K0=K0)
    for seed in range(4):
        start, after = State.at_rest(1.0, soil.field.size), moved(soil, 3e-3, seed=20 + seed)
        given = float(force(soil, after) @ after.u)
        stored = soil.energy(after).total - soil.energy(start).total
        dissipated = soil.work(start, after).dissipated
        assert dissipated > 0.0
        assert given == pytest.approx(stored + dissipated, rel=1e-9)
        soil.commit(after)
        soil.field.commit(after)


@pytest.mark.parametrize("kind", KINDS)
def test_committed_state_is_where_the_next_step_starts(kind: str) -> None:
    soil = clay_block(kind)
    state = moved(soil, 5e-3)
    before, energy = force(soil, state), soil.energy(state).total
    soil.commit(state)
    soil.field.commit(state)
    rest = State.at_rest(1.0, soil.field.size)
    np.testing.assert_allclose(force(soil, rest), before, atol=1e-9 * np.abs(before).max())
    assert soil.energy(rest).total == pytest.approx(energy, rel=1e-9)
    np.testing.assert_array_equal(soil.output_fields().displacement.ravel(), state.u)
    assert soil.output_fields().plastic_strain.max() > 0.0


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("unit_weight", [0.0, 5.0e3])
def test_plastic_flow_in_simple_shear_takes_su_times_plastic_strain(kind: str, unit_weight: float) -> None:
    """Also in the step that meets the limit; the scheme's share is half the product of the elastic changes."""
    su, G = 4.0e3, 1.2e6 / (2.0 * 1.49)
    law = VonMises(kind="von-mises", su=su, E_over_su=300.0, nu=0.49).at_points
    soil = Soil(distorted(small_block(kind)), law, level=0.0, unit_weight=unit_weight)
    gamma, volume = np.array([0.0, 0.4, 1.3, 2.0, 3.0, 2.5, 0.5, -1.0]) * su / G, 3.0
    elastic = np.array([0.0, 0.4, 1.0, 1.0, 1.0, 0.5, -1.0, -1.0]) * su / G
    plastic = np.abs(np.diff(gamma - elastic))
    start = State.at_rest(1.0, soil.field.size)
    for n, increment in enumerate(np.diff(gamma)):
        state = sheared(soil, increment)
        work = soil.work(start, state)
        own = work.dissipated - work.by_scheme
        assert own == pytest.approx(su * plastic[n] * volume, rel=1e-9, abs=1e-9 * su**2 / G)
        assert work.by_scheme == pytest.approx(0.5 * G * np.diff(elastic)[n] ** 2 * volume, rel=1e-9, abs=1e-9)
        soil.commit(state)
        soil.field.commit(state)


@pytest.mark.parametrize("kind", KINDS)
def test_elastic_soil_has_no_plastic_flow(kind: str) -> None:
    """All that elastic soil seems to take is the scheme's."""
    soil = Soil(distorted(small_block(kind)), ELASTIC, level=0.0, unit_weight=5.0e3)
    for seed in range(3):
        state = moved(soil, 3e-3, seed)
        work = soil.work(State.at_rest(1.0, soil.field.size), state)
        assert work.by_scheme > 1.0
        assert abs(work.dissipated - work.by_scheme) < 1e-11 * work.by_scheme
        soil.commit(state)
        soil.field.commit(state)


@pytest.mark.parametrize("law", CYCLIC, ids=lambda law: law.kind)
def test_plastic_flow_of_cyclic_clay_takes_work_in_every_step(law: SoilLaw) -> None:
    soil = Soil(small_block("hex"), law.at_points, level=0.0, unit_weight=5.0e3)
    own = []
    for gamma in 0.002 * np.array([0.001, 1.0, 2.0, 1.0, -1.0, -2.0, -0.5, 1.0]):
        state = sheared(soil, gamma)
        work = soil.work(State.at_rest(1.0, soil.field.size), state)
        own.append(work.dissipated - work.by_scheme)
        soil.commit(state)
        soil.field.commit(state)
    assert abs(own[0]) < 1e-6 * max(own)
    assert min(own[1:]) > 0.0


@pytest.mark.parametrize("kind", KINDS)
def test_tangent_of_unloading_is_that_of_undisturbed_soil(kind: str) -> None:
    """However far the soil has yielded; that of a step that goes on is softer."""
    soil, rest = clay_block(kind), State.at_rest(1.0, small_block(kind).nodes.points.size)
    undisturbed = assemble(soil, rest)
    for _ in range(2):
        state = sheared(soil, 0.02)
        soil.commit(state)
        soil.field.commit(state)
    further = sheared(soil, 0.001)
    on = assemble(soil, further)
    soil.mix_elastic(0.25)
    mixed = assemble(soil, further)
    soil.mix_elastic(1.0)
    unloading = assemble(soil, rest)
    assert abs(unloading - undisturbed).max() < 1e-12 * abs(undisturbed).max()
    assert abs(on - undisturbed).max() > 0.01 * abs(undisturbed).max()
    assert abs(mixed - 0.75 * on - 0.25 * undisturbed).max() < 1e-12 * abs(undisturbed).max()
