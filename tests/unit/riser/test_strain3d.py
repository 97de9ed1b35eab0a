"""Strain energy of an element in space whose stiffnesses differ by far: positive, and the least over its twist."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from riser_soil.core.arrays import Array
from riser_soil.riser.stiffness import Stiffness
from riser_soil.riser.strain3d import Strain, energy, stress, stress_change
from riser_soil.riser.tension_only import Linear
from tests.support.differences import slope

pytestmark = pytest.mark.usefixtures("uncompiled")

STRIP = Stiffness(12.0, 1.28e6, 9.6e7, 3.8e4, 5.9e4, Linear())  # of 30 x 0.6, N and mm, deep about its second axis


def strain(values: Array) -> Strain:
    axial, twist, *curvature = (float(value) for value in values)
    return Strain(axial, twist, (curvature[0], curvature[1]), (curvature[2], curvature[3]), 0.0)


def as_list(strains: Strain) -> Array:
    return np.array([strains.axial, strains.twist, *strains.first, *strains.second])


def bent(seed: int, largest: float) -> Array:
    """Strains of an element that is bent about both axes, by up to so much [1/m]."""
    values = np.random.default_rng(seed).uniform(-1.0, 1.0, 6)
    values[2:] *= largest
    return values


@pytest.mark.parametrize("largest", [1e-4, 1e-2, 0.2])
def test_stress_and_its_change_are_derivatives(largest: float) -> None:
    """Where the torque rate counts little, as much as bending, and is held back by it. A straight element."""
    at, moved = bent(1, largest), bent(2, largest)

    def gradient(s: float) -> Array:
        total = strain(at + s * moved)
        return as_list(stress(STRIP, total, total))

    def stored(s: float) -> Array:
        total = strain(at + s * moved)
        return np.array(energy(STRIP, total, total))

    total = strain(at)
    assert gradient(0.0) @ moved == pytest.approx(slope(stored, 1e-3), rel=1e-8)
    change = as_list(stress_change(STRIP, total, total, strain(moved)))
    assert np.abs(change - slope(gradient, 1e-3)).max() < 1e-8 * np.abs(change).max()


@given(seed=st.integers(0, 2**32 - 1), power=st.floats(-4.0, 2.0), ratio=st.floats(-5.0, 5.0))
def test_bending_never_sets_energy_free(seed: int, power: float, ratio: float) -> None:
    values = bent(seed, 10.0**power)
    values[:2] = 0.0
    stiffness = Stiffness(1.0, 1.0, 10.0**ratio, 1.0, 1.0, Linear())
    total = strain(values)
    assert energy(stiffness, total, total) > 0.0


@pytest.mark.parametrize("curvature", [(1e-4, 0.02), (0.03, 1e-3), (0.01, 0.01)])
def test_twist_takes_the_least_energy(curvature: tuple[float, float]) -> None:
    """Over a, by Gauss-Legendre quadrature, of a deviation a (1 - 4 x^2/L^2) that turns the curvature by a k'."""
    L, _, EIy, EIz, GJ, *_ = STRIP
    points, weights = np.polynomial.legendre.leggauss(6)
    shape, rate = 1.0 - points**2, -4.0 * points / L
    k = np.array(curvature)
    turned = np.array([k[1], -k[0]])

    def stored(a: float) -> float:
        local = k[:, None] + a * turned[:, None] * shape
        per_length = EIy * local[0] ** 2 + EIz * local[1] ** 2 + GJ * (a * rate) ** 2
        return float(0.25 * L * (weights @ per_length))

    three = [stored(a) for a in (-1.0, 0.0, 1.0)]
    first, second = 0.5 * (three[2] - three[0]), three[2] + three[0] - 2.0 * three[1]
    strains = strain(np.array([0.0, 0.0, *curvature, *curvature]))
    assert energy(STRIP, strains, strains) == pytest.approx(three[1] - 0.5 * first**2 / second, rel=1e-12)
