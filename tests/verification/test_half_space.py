"""Elastic soil against the half space: Boussinesq's and Cerruti's loads and a strip's on blocks that grow."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mpi4py import MPI
from scipy.sparse.linalg import splu

from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.part import State
from riser_soil.soil.block import BlockSpec
from riser_soil.soil.grid import DistributedMesh, block_grid
from riser_soil.soil.linear_elastic import LinearElastic
from riser_soil.soil.soil import Soil
from tests.support.pages import Tell
from tests.support.soil_bench import assemble
from tests.support.strip import tet_slice

E, NU = 1.0e6, 0.3
G = 0.5 * E / (1.0 + NU)
DOWN, ALONG = np.array([0.0, 0.0, -1.0]), np.array([1.0, 0.0, 0.0])


def boussinesq(to: Array) -> Array:
    """Displacement (n, 3) [m/N] at points `to` (n, 3) from a unit force downwards at the surface.

    Johnson, Contact Mechanics (1985), section 3.2; z downwards there.
    """
    x, y, z, R = *(to * [1.0, 1.0, -1.0]).T, np.linalg.norm(to, axis=1)
    outwards = z / R**2 - (1.0 - 2.0 * NU) / (R + z)
    down = z**2 / R**2 + 2.0 * (1.0 - NU)
    return np.stack([x * outwards, y * outwards, -down], axis=1) / (4.0 * np.pi * G * R)[:, None]


def cerruti(to: Array) -> Array:
    """Displacements from a unit force along x on the surface; Johnson, section 3.6."""
    x, y, z, R = *(to * [1.0, 1.0, -1.0]).T, np.linalg.norm(to, axis=1)
    a = 1.0 - 2.0 * NU
    along = 1.0 + x**2 / R**2 + a * (R / (R + z) - x**2 / (R + z) ** 2)
    across = x * y * (1.0 / R**2 - a / (R + z) ** 2)
    down = x * z / R**2 + a * x / (R + z)
    return np.stack([along, across, -down], axis=1) / (4.0 * np.pi * G * R)[:, None]


class LoadedBlock:
    """A block `half` m to each side and as deep, with a load of 1 N on a patch of about 1 m x 1 m in its middle.

    h [m]: cells at the patch; far: at the block's faces. u (n, 3) [m]: displacements of its points (n, 3).
    """

    def __init__(self, kind: Any, h: float, half: float, far: float, direction: Array) -> None:
        wide, line = (-half, half), ((-0.5, 0.0), (0.5, 0.0))
        grid = block_grid(MPI.COMM_SELF, BlockSpec(wide, wide, half, h, far, kind=kind, riser=line, strip=1.0))
        soil = Soil(grid, LinearElastic(kind="linear-elastic", E=E, nu=NU).at_points, level=0.0, unit_weight=0.0)
        self.points, self.load = soil.field.points, patch(soil)[:, None] * direction
        self.u = respond(soil, self.load)

    def share(self, unit: Any) -> float:
        """Share of the half space's displacement at all points 1.5 to 2 m from the patch's middle, what the block
        shows.
        """
        distance = np.linalg.norm(self.points, axis=1)
        near = (distance > 1.5) & (distance < 2.0)
        exact, forces = np.zeros((np.count_nonzero(near), 3)), np.linalg.norm(self.load, axis=1)
        for node in np.flatnonzero(forces):
            exact += forces[node] * unit(self.points[near] - self.points[node])
        return float(np.sum(self.u[near] * exact) / np.sum(exact**2))


def patch(soil: Soil) -> Array:
    """Forces (n,) of an even pressure on the facets within half a metre, 1 N in all; consistent with the elements."""
    top, (points, facets) = soil.surface, (soil.surface.points, soil.surface.facets)
    corners = points[facets[:, : 4 if facets.shape[1] == 4 else 3]]
    on = np.all(np.abs(corners.mean(axis=1)[:, :2]) < 0.5, axis=1)
    loaded = facets[on] if facets.shape[1] == 4 else facets[on, 3:]  # of second order the midpoints take it all
    sides = corners[on, 1] - corners[on, 0], corners[on, -1] - corners[on, 0]
    area = np.linalg.norm(np.cross(*sides), axis=1)
    forces = np.zeros(len(soil.field.points))
    nodes = top.global_index.reshape(-1, 3)[:, 0] // 3
    np.add.at(forces, nodes[loaded], (area / area.sum() / loaded.shape[1])[:, None])
    return forces


def respond(soil: Soil, load: Array) -> Array:
    """Displacements (n, 3) of elastic soil under nodal forces (n, 3)."""
    rest = np.zeros(soil.field.size)
    K = assemble(soil, State(0.0, rest, rest, rest))
    free: BoolArray = ~soil.field.prescribed
    u = np.zeros(soil.field.size)
    factors = splu(K[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    u[free] = factors.solve(load.ravel()[free])
    return u.reshape(-1, 3)


def settlement_from_the_middle(x: Array) -> Array:
    """How much less the surface settles at x (n,) than below the strip's middle [m]; of itself it is unbounded."""
    s = 2.0 * x
    both = sum((1.0 + side * s) * np.log(np.maximum(np.abs(1.0 + side * s), 1e-300)) for side in (1.0, -1.0))
    return np.asarray((1.0 - NU**2) / (np.pi * E) * both)


def stress_below(points: Array) -> Array:
    """Stress (n, 3) [Pa] σx, σz, τxz at points (n, 3), tension positive; σy = ν (σx + σz)."""
    x, depth = points[:, 0], -points[:, 2]
    left, right = np.arctan2(x + 0.5, depth), np.arctan2(x - 0.5, depth)
    angle, turned = left - right, 0.5 * (np.sin(2.0 * left) - np.sin(2.0 * right))
    shear = 0.5 * (np.cos(2.0 * right) - np.cos(2.0 * left))
    return np.stack([-(angle - turned), -(angle + turned), shear], axis=1) / np.pi


class StripOnSlice:
    """Half of the strip, x > 0, on a slice one cell thick that reaches `widths` strip widths aside and as deep.

    cells: under half of the strip; tetrahedra are half as large at its edge and grow from there, hexahedra beyond 1.5 m
    from the middle, to a share of 1/cells of the size of the block. Held at its bottom and normal to its sides.
    """

    def __init__(self, kind: Any, cells: int, widths: float) -> None:
        h, far = 0.5 / cells, widths / cells
        grid = hexahedra(h, widths, far) if kind == "hex" else tet_slice(0.5, widths, widths, h, 0.5 * h, 2.0 * h, far)
        self.soil = Soil(grid, LinearElastic(kind="linear-elastic", E=E, nu=NU).at_points, level=0.0, unit_weight=0.0)
        self.points = self.soil.field.points
        self.u = respond(self.soil, 0.5 * h * patch(self.soil)[:, None] * DOWN)
        rest = np.zeros(self.soil.field.size)
        self.soil.commit(State(1.0, self.u.ravel(), rest, rest))

    def settlement_error(self) -> float:
        """Error of the settlement from the middle at the surface up to 1.5 B away, largest, over that of the last of
        them.
        """
        top = (self.points[:, 2] > -1e-9) & (self.points[:, 0] < 1.5 + 1e-9)
        x, settled = self.points[top, 0], self.u[top, 2]
        settlement = settled - np.mean(settled[x < 1e-9])
        exact = settlement_from_the_middle(x)
        return float(np.abs(settlement - exact).max() / exact.max())

    def stress_error(self) -> float:
        """Error of the mean stress and the von Mises stress of cells below the strip's middle half, 1.5 B deep; over 1
        Pa.
        """
        mesh, fields = self.soil.output_mesh(), self.soil.output_fields()
        middle = mesh.points[mesh.cells].mean(axis=1)
        near = (middle[:, 0] < 0.25) & (middle[:, 2] > -1.5)
        sx, sz, t = stress_below(middle[near]).T
        sy = NU * (sx + sz)
        mises = np.sqrt(0.5 * ((sx - sy) ** 2 + (sy - sz) ** 2 + (sz - sx) ** 2) + 3.0 * t**2)
        off = fields.mean_stress[near] + (sx + sy + sz) / 3.0, fields.von_mises[near] - mises
        return float(np.abs(off).max())


def hexahedra(h: float, widths: float, far: float) -> DistributedMesh:
    """The slice in cells of the size h [m] to 1.5 m from the middle and half a metre deep."""
    fine = ((-0.5, 0.0), (1.5 - 0.5 * h, 0.0))
    block = BlockSpec((0.0, widths), (0.0, h), widths, h, far, riser=fine, strip=1.0)
    return block_grid(MPI.COMM_SELF, block)


LOADS = pytest.mark.parametrize(("direction", "unit"), [(DOWN, boussinesq), (ALONG, cerruti)], ids=["down", "along"])


def shares(tell: Tell, kind: str, h: float, direction: Array, unit: Any) -> Array:
    """Shares of the half space's displacement 1.5 to 2 m from the patch, in blocks of 4 and 8 m to each side."""
    values = [LoadedBlock(kind, h, half, 0.25 * half, direction).share(unit) for half in (4.0, 8.0)]
    shown = " | ".join(f"{share:.3f}" for share in (*values, 2.0 * values[1] - values[0]))
    tell({f"half space {kind} {h:g} {'down' if direction is DOWN else 'along'}": shown})
    return np.array(values)


def in_large_blocks(values: Array) -> None:
    """What a block misses goes with 1/size; what is left of it without any is the cells'."""
    missing = 1.0 - values
    assert missing[0] / missing[1] == pytest.approx(2.0, rel=0.06)
    assert 2.0 * values[1] - values[0] == pytest.approx(1.0, abs=0.03)


@LOADS
def test_displacement_is_that_of_the_half_space(tell: Tell, direction: Array, unit: Any) -> None:
    in_large_blocks(shares(tell, "tet", 0.5, direction, unit))


@pytest.mark.verify
@pytest.mark.parametrize(("kind", "h"), [("hex", 0.25), ("tet", 0.25)])
@LOADS
def test_displacement_is_that_of_the_half_space_on_finer_cells(
    tell: Tell, kind: str, h: float, direction: Array, unit: Any
) -> None:
    in_large_blocks(shares(tell, kind, h, direction, unit))


@LOADS
def test_solutions_of_the_half_space_are_in_equilibrium(direction: Array, unit: Any) -> None:
    """Navier's equation (λ + G) grad div u + G Δu = 0 by differences, at some points below the surface."""
    points, h, nu = np.array([[0.7, 0.4, -0.9], [-0.3, 1.1, -0.6]]), 1e-2, 0.3
    steps = h * np.eye(3)
    grad_div, laplacian = np.zeros((2, 3)), np.zeros((2, 3))
    for i in range(3):
        laplacian += unit(points + steps[i]) - 2.0 * unit(points) + unit(points - steps[i])
        for j in range(3):
            mixed = [a * b * unit(points + a * steps[i] + b * steps[j]) for a in (-1, 1) for b in (-1, 1)]
            grad_div[:, i] += 0.25 * np.sum(mixed, axis=0)[:, j]
    residual = grad_div / (1.0 - 2.0 * nu) + laplacian
    assert np.abs(residual).max() < 1e-2 * np.abs(laplacian).max()


def strip_errors(kind: str, cells: int) -> tuple[Array, Array]:
    """Errors of settlement and of stress below the strip, in blocks of 8, 16 and 32 widths to the side and as deep."""
    slices = [StripOnSlice(kind, cells, widths) for widths in (8.0, 16.0, 32.0)]
    errors = np.array([[block.settlement_error(), block.stress_error()] for block in slices])
    print(f"{kind}, {cells} cells: settlement {errors[:, 0]}, stress {errors[:, 1]}, orders {orders(errors)}")
    return errors[:, 0], errors[:, 1]


def orders(errors: Array) -> Array:
    return np.asarray(np.log2(errors[:-1] / errors[1:]))


@pytest.mark.parametrize("kind", ["hex", "tet"])
def test_strip_settles_as_on_the_half_space(kind: str) -> None:
    """A block's end takes from the stress in proportion to 1/size, from the settlement's differences to 1/size²."""
    settlement, stress = strip_errors(kind, 8)
    assert orders(stress) == pytest.approx(1.0, abs=0.15)
    assert orders(settlement[:2]) == pytest.approx(2.0, abs=0.2)
    assert settlement[2] < 2.5e-3
    assert stress[2] < 1e-2


@pytest.mark.verify
@pytest.mark.parametrize(("kind", "blocks"), [("hex", 2), ("tet", 3)])
def test_strip_settles_as_on_the_half_space_on_fine_cells(kind: str, blocks: int) -> None:
    """blocks: how many of them, the smallest first, err more by their size than by their cells."""
    settlement, stress = strip_errors(kind, 16)
    assert orders(stress) == pytest.approx(1.0, abs=0.12)
    assert orders(settlement[:blocks]) == pytest.approx(2.0, abs=0.1)
    assert settlement[2] < 1.1e-3
