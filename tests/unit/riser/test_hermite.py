"""Shape functions, consistent integrals, quadrature stations, and the angle over its sine."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.riser import hermite, stations
from riser_soil.riser.corotation import angle_over_sine

pytestmark = pytest.mark.usefixtures("uncompiled")

L = np.array([0.5, 2.0, 7.0])
XI = np.linspace(0.0, 1.0, 2001)


def test_shape_functions_reproduce_cubics() -> None:
    for length in L:
        s = XI * length
        N = np.array([hermite.shape(x, length) for x in XI])
        dN = np.array([hermite.slope(x, length) for x in XI])
        q = [1.0, 2.0, 1.0 + 2.0 * length + length**2 - length**3, 2.0 + 2.0 * length - 3.0 * length**2]
        assert N @ q == pytest.approx(1.0 + 2.0 * s + s**2 - s**3, rel=1e-12)
        assert dN @ q == pytest.approx(2.0 + 2.0 * s - 3.0 * s**2, rel=1e-11, abs=1e-11)


def test_consistent_integrals_are_those_of_the_shape_functions() -> None:
    nodes, weights = np.polynomial.legendre.leggauss(5)
    for e, length in enumerate(L):
        N = np.array([hermite.shape(0.5 + 0.5 * x, length) for x in nodes])
        w = 0.5 * length * weights
        assert hermite.uniform_load(L)[e] == pytest.approx(w @ N, rel=1e-12)
        expected = 80.0 * np.einsum("g,ga,gb->ab", w, N, N)
        assert hermite.consistent_mass(L, np.full(3, 80.0))[e] == pytest.approx(expected, rel=1e-12)


def test_stations_integrate_a_quadratic_load_exactly() -> None:
    at = stations.stations(L)
    arc = stations.POINTS * L[:, None]
    loads = np.einsum("ega,egi->eai", at.weighted, np.stack([arc**2, arc], axis=-1))
    assert loads[:, 0] + loads[:, 2] == pytest.approx(np.stack([L**3 / 3.0, L**2 / 2.0], axis=1))


@pytest.mark.parametrize("theta", [0.0, 1e-9, 1e-3, 0.3, 0.3175, 0.3176, 0.32, 1.0, 2.5])
def test_angle_over_sine_and_its_derivatives(theta: float) -> None:
    c = np.cos(theta)
    g, slope, bend = angle_over_sine(c, np.sqrt(1.0 - c * c))
    assert g == pytest.approx(theta / np.sin(theta) if theta else 1.0, rel=1e-12)
    # (1 - c^2) g' = c g - 1 and its derivative
    assert (1.0 - c * c) * slope == pytest.approx(c * g - 1.0, abs=1e-14)
    assert (1.0 - c * c) * bend == pytest.approx(g + 3.0 * c * slope, abs=1e-11)
    if theta == 0.0:
        assert (slope, bend) == pytest.approx((-1.0 / 3.0, 4.0 / 15.0))
