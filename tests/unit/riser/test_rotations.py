"""Finite rotations against the matrix exponential, each other and finite differences."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from riser_soil.core.arrays import Array
from riser_soil.riser import rotations
from riser_soil.riser.vectors import Mat, Vec, vector

pytestmark = pytest.mark.usefixtures("uncompiled")

NEAR_PI = np.pi - 1e-9
EPS = np.finfo(float).eps
component = st.floats(-1.0, 1.0)
axes = st.tuples(component, component, component).filter(lambda a: np.linalg.norm(a) > 1e-3)
angles = st.one_of(st.floats(0.0, NEAR_PI), st.floats(0.0, 1e-6), st.floats(3.14, NEAR_PI))
UNHURRIED = settings(deadline=None)  # the first call compiles
STENCIL = {-3: -1 / 60, -2: 3 / 20, -1: -3 / 4, 1: 3 / 4, 2: -3 / 20, 3: 1 / 60}


def turned(axis: Vec, angle: float) -> Vec:
    return vector(angle * np.array(axis) / np.linalg.norm(axis))


def derivative(f: Callable[[Vec], Array], at: Vec, step: float = 5e-3) -> Array:
    """Sixth-order finite differences; the last index is the direction."""
    columns = []
    for unit in np.eye(3):
        values = [c * f(vector(np.array(at) + k * step * unit)) for k, c in STENCIL.items()]
        columns.append(np.sum(values, axis=0) / step)
    return np.stack(columns, axis=-1)


def as_array(A: Mat) -> Array:
    return np.array(A)


def as_arrays(function: Callable[[Vec], Mat]) -> Callable[[Vec], Array]:
    return lambda v: as_array(function(v))


def turn_about(axis: Vec, angle: float) -> Array:
    """The matrix of a turn: what lies along the axis stays, what lies across turns in its plane."""
    along: Array = np.array(axis) / np.linalg.norm(axis)
    across: Array = np.cross(along, np.eye(3)[np.abs(along).argmin()])
    across /= np.linalg.norm(across)
    beyond: Array = np.cross(along, across)
    new_across = np.cos(angle) * across + np.sin(angle) * beyond
    new_beyond = np.cos(angle) * beyond - np.sin(angle) * across
    return np.outer(along, along) + np.outer(new_across, across) + np.outer(new_beyond, beyond)


@given(axis=axes, angle=st.floats(0.0, 20.0))
@UNHURRIED
def test_exponential_is_the_turn_about_the_axis(axis: Vec, angle: float) -> None:
    """A rotation vector rounded in its last digit turns by as much more or less: errors grow with the angle."""
    R = as_array(rotations.exp(turned(axis, angle)))
    assert np.abs(R - turn_about(axis, angle)).max() < 16.0 * EPS * (1.0 + angle)
    assert np.abs(R @ R.T - np.eye(3)).max() < 1e-14


@given(axis=axes, angle=angles)
@UNHURRIED
@example(axis=(1.0, 0.0, 0.0), angle=0.0)
@example(axis=(0.0, -1.0, 0.0), angle=NEAR_PI)
@example(axis=(0.0, 0.0, 1.0), angle=NEAR_PI)
@example(axis=(1.0, 1.0, -1.0), angle=NEAR_PI)
def test_logarithm_inverts_the_exponential(axis: Vec, angle: float) -> None:
    rotation = np.array(turned(axis, angle))
    logarithm = np.array(rotations.log(rotations.exp(vector(rotation))))
    assert np.abs(logarithm - rotation).max() < 1e-14 + 1e-14 * angle


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.6, 0.0, -0.8)])
def test_logarithm_of_a_half_turn_has_length_pi(axis: Vec) -> None:
    R = as_array(rotations.exp(turned(axis, np.pi)))
    logarithm = np.array(rotations.log(rotations.exp(turned(axis, np.pi))))
    assert np.linalg.norm(logarithm) == pytest.approx(np.pi, abs=1e-14)
    assert np.abs(as_array(rotations.exp(vector(logarithm))) - R).max() < 1e-14


@pytest.mark.parametrize("angle", [0.0, 1e-5, 0.3, 0.499, 0.501, 1.5, 3.0, 5.0])
def test_tangent_maps_are_the_spin_of_the_exponential(angle: float) -> None:
    rotation = turned((0.3, -0.7, 0.5), angle)
    R = as_array(rotations.exp(rotation))
    rates = derivative(as_arrays(rotations.exp), rotation)
    spins = np.einsum("ijk,lj->ilk", rates, R)  # (dR) R', skew for each direction k
    left = np.stack([spins[2, 1], spins[0, 2], spins[1, 0]])
    assert np.abs(left - as_array(rotations.left_tangent(rotation))).max() < 1e-11
    assert np.abs(R.T @ left - as_array(rotations.left_tangent(rotation)).T).max() < 1e-11


@given(axis=axes, angle=st.floats(0.0, 5.5))
@UNHURRIED
def test_inverse_tangent_map(axis: Vec, angle: float) -> None:
    rotation = turned(axis, angle)
    left = as_array(rotations.left_tangent(rotation)) @ as_array(rotations.left_tangent_inverse(rotation))
    assert np.abs(left - np.eye(3)).max() < 1e-12


@pytest.mark.parametrize("angle", [0.0, 1e-5, 0.3, 0.499, 0.501, 1.5, 3.0, 5.0])
def test_derivative_of_the_tangent_map(angle: float) -> None:
    rotation, m = turned((0.3, -0.7, 0.5), angle), (0.4, 1.1, -0.2)
    computed = as_array(rotations.right_tangent_derivative(rotation, m))
    expected = np.einsum("jik,j->ik", derivative(as_arrays(rotations.left_tangent), rotation), m)
    assert np.abs(computed - expected).max() < 2e-10


@pytest.mark.parametrize(
    "coefficients", [rotations.exp_coefficients, rotations.exp_slopes, rotations.inverse_coefficient]
)
def test_power_series_meet_the_closed_forms(coefficients: Callable[[float], object]) -> None:
    """The first term that the series leave out is largest in db/dtheta: x^5/7.3e9 of 1/12, a share of 1.6e-12."""
    x = rotations.SERIES_BELOW
    below, above = np.array(coefficients(np.nextafter(x, 0.0))), np.array(coefficients(x))
    assert np.abs(below / above - 1.0).max() < 3e-12
