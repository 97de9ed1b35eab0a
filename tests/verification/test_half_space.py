"""Elastic soil against the half space: Boussinesq's and Cerruti's loads and a strip's on blocks that grow."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from tests.support.elastic_strip import StripOnSlice
from tests.support.half_space import ALONG, DOWN, LoadedBlock, boussinesq, cerruti
from tests.support.pages import Tell

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
