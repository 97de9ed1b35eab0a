"""What UFL states and FFCx compiles of it, against the strain operator written out; on distorted and curved cells."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import ufl
from mpi4py import MPI

from riser_soil.core.arrays import Array
from riser_soil.soil import cell_loops
from riser_soil.soil.cell_loops import kernels_of
from riser_soil.soil.families import HEX8, QUAD4, TET10, Family
from riser_soil.soil.ffcx_compat import cell_kernel, require_one_degree
from riser_soil.soil.grid import DistributedMesh
from riser_soil.soil.slices import slice_grid
from riser_soil.soil.soil_cells import SoilCells
from riser_soil.soil.weak_form import WeakForm
from tests.support.b_bar import Cells, cells_of
from tests.support.soil_cases import slices_spec, small_block

RNG = np.random.default_rng(11)
WAYS = ("hexahedra", "curved tetrahedra", "sections along x", "sections along y")


def distorted(way: str) -> DistributedMesh:
    """Every node moved at random, those in the middle of a side as well."""
    if way.startswith("sections"):
        grid, size = slice_grid(MPI.COMM_SELF, slices_spec(0 if way.endswith("x") else 1)), 0.06
    else:
        grid, size = small_block("hex" if way == "hexahedra" else "tet"), 0.03
    points = grid.nodes.points + size * RNG.uniform(-1.0, 1.0, grid.nodes.points.shape) * axes_of(grid.family)
    return replace(grid, nodes=replace(grid.nodes, points=points))


def axes_of(family: Family) -> Array:
    return np.isin(np.arange(3), family.axes).astype(float)


def both(way: str) -> tuple[SoilCells, Cells, DistributedMesh]:
    grid = distorted(way)
    return SoilCells(grid), cells_of(grid.family, grid.nodes.points, grid.nodes.cells), grid


def off(values: Array, exact: Array) -> float:
    return float(np.abs(values.ravel() - exact.ravel()).max() / np.abs(exact).max())


def of_cells(grid: DistributedMesh, u: Array) -> Array:
    """Displacements (nc, d nn) of the cells' nodes."""
    own = u.reshape(-1, 3)[grid.nodes.cells][..., list(grid.family.axes)]
    return np.asarray(own.reshape(len(own), -1))


@pytest.mark.parametrize("way", WAYS)
def test_strain_force_and_stiffness_are_those_of_the_strain_operator(way: str) -> None:
    """Moduli of no symmetry: an entry at a wrong place shows."""
    cells, exact, grid = both(way)
    nc, nq = cells.shape
    u, stress = RNG.normal(size=3 * len(grid.nodes.points)), RNG.normal(size=(nc, nq, 6))
    moduli = RNG.normal(size=(nc, nq, 6, 6))
    assert off(cells.volumes, exact.volumes) < 1e-13
    assert off(cells.strain(u), exact.strain(of_cells(grid, u))) < 1e-12
    assert off(cells.stiffness(moduli.reshape(-1, 6, 6)), exact.stiffness(moduli)) < 1e-12
    force, summed = cells.internal_force(stress.reshape(-1, 6), len(u)), np.zeros((len(u) // 3, 3))
    for k, axis in enumerate(grid.family.axes):
        each = exact.force(stress).reshape(nc, -1, len(grid.family.axes))
        np.add.at(summed[:, axis], grid.nodes.cells, each[..., k])
    assert off(force, summed) < 1e-12


@pytest.mark.parametrize("way", WAYS)
def test_weight_spin_and_slope(way: str) -> None:
    cells, exact, grid = both(way)
    points, nodes = grid.nodes.points, grid.nodes.cells
    u, level = RNG.normal(size=(len(points), 3)) * axes_of(grid.family), RNG.normal(size=len(points))
    gamma = RNG.uniform(1.0, 2.0, cells.shape)
    down = -np.einsum("cq,cq,qa->ca", gamma, exact.volumes, grid.family.values)
    weight = np.zeros((len(points), 3))
    np.add.at(weight[:, 2], nodes, down)
    assert off(cells.weight(gamma.ravel(), u.size), weight) < 1e-12
    gradient = np.einsum("cqaj,cai->cqij", exact.gradients, u[nodes])
    turned = 0.5 * np.stack([gradient[..., i, j] - gradient[..., j, i] for i, j in ((2, 1), (0, 2), (1, 0))], axis=-1)
    strain, spin = cells.motion(points, u.ravel())
    assert off(spin, turned) < 1e-12
    np.testing.assert_array_equal(strain, cells.strain(u.ravel()))
    assert off(cells.slopes(level), np.einsum("cqai,ca->cqi", exact.gradients, level[nodes])) < 1e-12


@pytest.mark.parametrize("family", [HEX8, TET10, QUAD4], ids=["hex8", "tet10", "quad4"])
def test_kernels_give_the_same_bits_wherever_arrays_lie(family: Family) -> None:
    """Ranks and resumed runs have them elsewhere. Sums in vectors may begin where memory is aligned."""
    kernels, n = kernels_of(family), family.values.shape[1] * len(family.axes)
    if family.mean_dilatation:
        n += 1
    nq = len(family.quadrature[1])
    at, moduli = np.zeros((1, family.values.shape[1], 3)), RNG.normal(size=(1, nq * 36))
    at[0, :, : len(family.axes)] = reference_nodes(family) + RNG.uniform(-0.1, 0.1, (len(at[0]), len(family.axes)))
    none, results = np.empty((1, 0)), []
    for place in range(8):
        given, there = shifted(moduli, place), shifted(at, 7 - place)
        out = shifted(np.zeros((1, n, n)), place // 2)
        cell_loops.renew_matrices(kernels.tangent, there, none, np.ones(1), given, np.full_like(given, np.nan), out)
        results.append(out.copy())
        assert np.abs(out).max() > 0.0
    for out in results[1:]:
        np.testing.assert_array_equal(out, results[0])


def shifted(values: Array, places: int) -> Array:
    """The numbers, moved so many places of eight bytes behind a multiple of 64."""
    room = np.empty(values.size + 16)
    first = (-room.ctypes.data // 8) % 8 + places
    out = room[first : first + values.size].reshape(values.shape)
    out[:] = values
    return out


def reference_nodes(family: Family) -> Array:
    import basix

    element = basix.create_element(basix.ElementFamily.P, family.cell, family.degree, basix.LagrangeVariant.gll_warped)
    return np.asarray(element.points)


def test_every_form_has_one_quadrature_degree() -> None:
    for family, mean in ((HEX8, True), (TET10, False), (QUAD4, True)):
        form = WeakForm(family.cell.name, family.degree, family.quadrature_degree, mean, family.axes)
        for each in (form.force(), form.tangent(), form.weight(), *([form.mean_divergence()] if mean else [])):
            require_one_degree(each)


def two_rules() -> tuple[Any, Any]:
    form = WeakForm("hexahedron", 1, 3, False, (0, 1, 2))
    one = ufl.Measure("dx", form.mesh, metadata={"quadrature_degree": 1})
    return ufl.div(form.u) * ufl.div(form.v) * one, ufl.inner(ufl.grad(form.u), ufl.grad(form.v)) * form.dx


def test_a_form_of_two_rules_is_refused() -> None:
    """FFCx compiles it to other numbers than those of the two forms: once it doesn't, on all releases, it may."""
    volume, shape = two_rules()
    require_one_degree(volume)
    require_one_degree(shape)
    with pytest.raises(ValueError, match=r"one quadrature degree: \{1, 3\}"):
        cell_kernel(volume + shape)


def test_two_rules_in_one_form_are_silently_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("riser_soil.soil.ffcx_compat.require_one_degree", lambda form: None)
    at = np.zeros((1, 8, 3))
    at[0] = reference_nodes(HEX8) + RNG.uniform(-0.2, 0.2, (8, 3))
    volume, shape = two_rules()
    one, first, second = (matrix(form, at) for form in (volume + shape, volume, shape))
    assert off(one, first + second) > 1e-4


def matrix(form: Any, at: Array) -> Array:
    out, none = np.zeros((1, 24, 24)), np.zeros((1, 1))
    cell_loops.renew_matrices(cell_kernel(form), at, np.empty((1, 0)), np.ones(1), none, none * np.nan, out)
    return out


@pytest.mark.parametrize("way", WAYS)
def test_a_rank_without_cells_has_nothing_of_each(way: str) -> None:
    grid = distorted(way)
    none = replace(grid, nodes=replace(grid.nodes, cells=grid.nodes.cells[:0]), volume=grid.volume[:0])
    cells, size = SoilCells(none), 3 * len(grid.nodes.points)
    assert cells.strain(np.ones(size)).shape == (0, 6)
    assert len(cells.stiffness(np.empty((0, 6, 6)))) == 0
    assert not cells.internal_force(np.empty((0, 6)), size).any()
    assert not cells.weight(np.empty(0), size).any()
    strain, spin = cells.motion(grid.nodes.points, np.ones(size))
    assert (strain.shape, spin.shape) == ((0, 6), (0, 3))
    assert cells.slopes(np.ones(size // 3)).shape == (0, 3)
    assert len(cells.mass(np.empty(0))) == 0
