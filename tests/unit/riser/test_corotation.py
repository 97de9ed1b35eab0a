"""The split of a rotation into twist and swing, against rotations and finite differences."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from riser_soil.core.arrays import Array
from riser_soil.riser import corotation, rotations
from riser_soil.riser.vectors import Vec, matrix, vector

pytestmark = pytest.mark.usefixtures("uncompiled")

UNHURRIED = settings(deadline=None)  # the first call compiles
STENCIL = {-3: -1 / 60, -2: 3 / 20, -1: -3 / 4, 1: 3 / 4, 2: -3 / 20, 3: 1 / 60}
MU = (0.7, -1.3, 0.4)
ANGLES = [(0.0, 0.0, 0.0), (0.4, 1e-5, 0.0), (-0.2, 0.1, -0.2), (1.0, 0.2, 0.3), (-2.0, -1.2, 1.5)]


def rotation(twist: float, y: float, z: float) -> Array:
    return np.array(rotations.exp((0.0, y, z))) @ np.array(rotations.exp((twist, 0.0, 0.0)))


def by_spin(f: Callable[[corotation.SwingTwist], Vec], A: Array, step: float = 5e-3) -> Array:
    """Sixth-order finite differences by the spin of A; the last index is its direction."""
    columns = []
    for unit in np.eye(3):
        turned = {k: np.array(rotations.exp(vector(k * step * unit))) @ A for k in STENCIL}
        values = [c * np.array(f(corotation.split(matrix(turned[k])))) for k, c in STENCIL.items()]
        columns.append(np.sum(values, axis=0) / step)
    return np.stack(columns, axis=-1)


@given(twist=st.floats(-3.1, 3.1), swing=st.floats(0.0, 3.0), direction=st.floats(-4.0, 4.0))
@UNHURRIED
def test_split_inverts_the_composition(twist: float, swing: float, direction: float) -> None:
    angles = twist, swing * np.cos(direction), swing * np.sin(direction)
    split_angles = corotation.split(matrix(rotation(*angles))).angles
    assert np.abs(np.array(split_angles) - angles).max() < 1e-11


@pytest.mark.parametrize("angles", ANGLES)
def test_rate_is_the_derivative_of_the_angles(angles: Vec) -> None:
    A = rotation(*angles)
    at = corotation.split(matrix(A))
    rates = np.array([corotation.rate(at, vector(unit)) for unit in np.eye(3)]).T
    assert np.abs(rates - by_spin(lambda s: s.angles, A)).max() < 1e-10


@pytest.mark.parametrize("angles", ANGLES)
def test_moment_does_the_work_of_the_generalised_moment(angles: Vec) -> None:
    at = corotation.split(matrix(rotation(*angles)))
    rates = np.array([corotation.rate(at, vector(unit)) for unit in np.eye(3)])
    assert np.abs(np.array(corotation.moment(at, MU)) - rates @ MU).max() < 1e-14


@pytest.mark.parametrize("angles", ANGLES)
def test_moment_variation_is_the_derivative_of_the_moment(angles: Vec) -> None:
    A = rotation(*angles)
    at = corotation.split(matrix(A))
    variation = np.array([corotation.moment_variation(at, MU, vector(unit)) for unit in np.eye(3)]).T
    expected = by_spin(lambda s: corotation.moment(s, MU), A)
    assert np.abs(variation - expected).max() < 1e-9
    assert np.abs(expected).max() > 0.1


def test_power_series_meets_the_closed_form() -> None:
    cosine = 1.0 - corotation.SERIES_BELOW
    sides = [np.nextafter(cosine, 1.0), np.nextafter(cosine, 0.0)]
    series, closed = (np.array(corotation.angle_over_sine(c, np.sqrt(1.0 - c * c))) for c in sides)
    assert np.abs(series / closed - 1.0).max() < 1e-12
