"""Soil with inertia: its mass, waves in a column, and boundaries that let them out."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg as spl
from mpi4py import MPI

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Forces, State, Weights
from riser_soil.soil.block import BlockSpec
from riser_soil.soil.families import HEX8, TET10
from riser_soil.soil.grid import DistributedMesh, block_grid
from riser_soil.soil.inertia import CellMatrices, SoilBoundary, SoilInertia, outer_facets
from riser_soil.soil.linear_elastic import LinearElastic
from riser_soil.soil.slices import slice_grid
from riser_soil.soil.soil import Soil
from tests.support.soil_bench import assemble
from tests.support.soil_cases import distorted, slices_spec, small_block

RHO, E, NU = 1800.0, 4.0e7, 0.3
K, G = E / (3.0 * (1.0 - 2.0 * NU)), E / (2.0 * (1.0 + NU))
CP, CS = np.sqrt((K + 4.0 / 3.0 * G) / RHO), np.sqrt(G / RHO)
LAW = LinearElastic(kind="linear-elastic", E=E, nu=NU).at_points


def soil_on(grid: DistributedMesh) -> Soil:
    return Soil(grid, LAW, level=0.0, unit_weight=0.0, inertia=True)


def densities(soil: Soil) -> Array:
    return np.full(len(soil.cells.nodes), RHO)


def matrix(of: CellMatrices, size: int) -> Any:
    n = of.dofs.shape[1]
    rows, cols = np.repeat(of.dofs, n, axis=1), np.tile(of.dofs, (1, n))
    return sp.coo_matrix((of.matrices.ravel(), (rows.ravel(), cols.ravel())), shape=(size, size)).tocsr()


def grid_of(kind: str) -> DistributedMesh:
    return slice_grid(MPI.COMM_SELF, slices_spec(0)) if kind == "sections" else distorted(small_block(kind))


@pytest.mark.parametrize("kind", ["hex", "tet", "sections"])
def test_mass_is_that_of_the_soil_and_its_moments(kind: str) -> None:
    """Mass by bodies that move and turn: integrals of density times 1, x and x²."""
    soil = soil_on(grid_of(kind))
    mass, x, axis = SoilInertia(soil, densities(soil)).mass, soil.grid.nodes.points, soil.grid.family.axes[0]
    one, place = np.zeros((2, *x.shape))
    one[:, axis], place[:, axis] = 1.0, x[:, axis]
    low, high = soil.grid.low, soil.grid.high
    first, last = low[axis], high[axis]
    area = float(np.prod(high - low)) / (last - first)
    for n, (a, b) in enumerate(((one, one), (one, place), (place, place))):
        exact = RHO * area * (last ** (n + 1) - first ** (n + 1)) / (n + 1)
        assert mass.product(a.ravel(), b.ravel()) == pytest.approx(exact, rel=1e-12, abs=1e-9)


@pytest.mark.parametrize("family", [HEX8, TET10], ids=["hex8", "tet10"])
def test_mass_is_positive(family: Any) -> None:
    """No motion of a cell is without it, as with as few points as its stiffness has."""
    soil = soil_on(small_block("hex" if family is HEX8 else "tet", size=1.0))
    lowest = np.linalg.eigvalsh(SoilInertia(soil, densities(soil)).mass.matrices)[:, 0]
    assert lowest.min() > 1e-3 * RHO * soil.cells.volumes.sum(axis=1).min() / soil.cells.nodes.shape[1]


def column(n: int, height: float = 10.0) -> Soil:
    size = height / n
    return soil_on(block_grid(MPI.COMM_SELF, BlockSpec((0.0, size), (0.0, size), height, size, size)))


def matrices(soil: Soil) -> tuple[Any, Any]:
    stiffness = assemble(soil, State.at_rest(1.0, soil.field.size))
    return stiffness, matrix(SoilInertia(soil, densities(soil)).mass, soil.field.size)


def moving(soil: Soil, axis: int, base: bool = False) -> IntArray:
    """Dofs along an axis, those of the base only if asked for."""
    free = np.ones(len(soil.grid.nodes.points), dtype=bool) if base else soil.grid.nodes.points[:, 2] > -9.999
    return 3 * np.flatnonzero(free) + axis


def test_frequencies_of_a_shear_column_converge_as_the_theory_has_it() -> None:
    """(2k - 1) cs/4H, by consistent mass and linear cells too high by (pi (2k - 1)/2n)²/24 of themselves."""
    n = 20
    soil = column(n)
    stiffness, mass = (each[moving(soil, 0)][:, moving(soil, 0)].toarray() for each in matrices(soil))
    frequencies = np.sqrt(scipy.linalg.eigh(stiffness, mass, eigvals_only=True)[:3]) / (2.0 * np.pi)
    order = np.array([1.0, 3.0, 5.0])
    off = frequencies / (order * CS / 40.0) - 1.0
    np.testing.assert_allclose(off, (0.5 * np.pi * order / n) ** 2 / 24.0, rtol=0.06)


def base_dashpots(soil: Soil) -> CellMatrices:
    """Dashpots of the base alone: the column's sides are the planes in which its neighbours would move along."""
    part, facets = SoilBoundary(soil, densities(soil)), outer_facets(soil.grid, soil.cells.nodes)
    damping = part.damping.matrices
    bottom = [number for number, facet in enumerate(damping) if on_base(soil, part.damping.dofs[number], facet)]
    assert len(facets) == len(damping)
    return CellMatrices(damping[bottom], part.damping.dofs[bottom])


def on_base(soil: Soil, dofs: IntArray, facet: Array) -> bool:
    acted = dofs[np.abs(facet).max(axis=1) > 0.0]
    return bool((soil.grid.nodes.points[acted // 3, 2] < -9.999).all())


@pytest.mark.parametrize(("axis", "speed"), [(2, CP), (0, CS)], ids=["P", "S"])
def test_a_pulse_leaves_by_the_base(axis: int, speed: float) -> None:
    """Newmark's average acceleration keeps all energy, until the pulse reaches the base: at most 1e-6 of it comes back,
    where the mesh resolves it.
    """
    n = 200
    soil = column(n)
    dofs, z = moving(soil, axis, base=True), soil.grid.nodes.points[:, 2]
    stiffness, mass = (each[dofs][:, dofs].tocsc() for each in matrices(soil))
    damping = matrix(base_dashpots(soil), soil.field.size)[dofs][:, dofs].tocsc()
    shape = np.exp(-(((z + 5.0) / 0.6) ** 2))
    u, v = shape, speed * (-2.0 * (z + 5.0) / 0.36) * shape  # u(z + c t) runs downwards
    dt = 0.5 * 10.0 / n / speed
    factor = spl.splu(mass + 0.5 * dt * damping + 0.25 * dt**2 * stiffness)
    a = spl.spsolve(mass, -stiffness @ u - damping @ v)
    energy = []
    for _ in range(2 * n + 60):
        ahead, speeds = u + dt * v + 0.25 * dt**2 * a, v + 0.5 * dt * a
        a = factor.solve(-stiffness @ ahead - damping @ speeds)
        u, v = ahead + 0.25 * dt**2 * a, speeds + 0.5 * dt * a
        energy.append(0.5 * (v @ (mass @ v) + u @ (stiffness @ u)))
    np.testing.assert_allclose(energy[: n // 2], energy[0], rtol=1e-9)
    assert energy[-1] < 1e-6 * energy[0]


def test_parts_are_those_matrices() -> None:
    """Residuals of both parts are linear in rates and accelerations; what holds the boundary acts against itself."""
    soil = soil_on(distorted(small_block("hex")))
    parts: list[Any] = [SoilInertia(soil, densities(soil)), SoilBoundary(soil, densities(soil))]
    rng, size = np.random.default_rng(3), soil.field.size
    u, v, a = rng.normal(size=(3, size))
    weights, direction = Weights(0.7, 0.4, 30.0, 900.0), rng.normal(size=size)
    state = State(0.0, u, v, a)
    ahead = replace(state, u=u + direction, v=v + 30.0 * direction, a=a + 900.0 * direction)
    for part in parts:
        matrices = [Forces.zeros(size), Forces.zeros(size)]
        for each, forces in zip((state, ahead), matrices, strict=True):
            part.residual(each, forces)
        change = 0.7 * (matrices[1].inertia - matrices[0].inertia) + 0.4 * (matrices[1].force - matrices[0].force)
        block = part.blocks()
        values = {key: each.zeros() for key, each in block.items()}
        part.tangent(state, weights, values)
        (key,) = block
        np.testing.assert_allclose(
            CellMatrices(values[key], block[key].rows).times(direction), change, atol=1e-9 * np.abs(change).max()
        )
        assert np.abs(change).max() > 0.0
