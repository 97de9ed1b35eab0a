"""The hanging flexible riser against the catenary, the elastica and balance of forces."""

from __future__ import annotations

import numpy as np
import pytest

from tests.support.flexible_riser import LENGTH, elastica_H, guess, hang, properties
from tests.support.pages import Tell

ORDER = 3.5


@pytest.fixture(scope="module")
def elastica() -> tuple[float, float]:
    return elastica_H()


def test_without_bending_stiffness_it_is_a_catenary() -> None:
    expected, shape = guess(properties(140)), hang(140, EI=20.0)
    vertical = expected.tension[[0, -1]] * expected.curve.tangent[[0, -1], [0, 1], 2]
    assert pytest.approx(expected.H, rel=1e-4) == shape.H
    assert shape.sections.end_force[0, 2] == pytest.approx(-vertical[0], rel=1e-4)
    assert shape.sections.end_force[1, 2] == pytest.approx(vertical[1], rel=1e-4)


@pytest.mark.parametrize("dimension", [2, 3])
def test_supports_carry_the_weight(dimension: int) -> None:
    result, weight = hang(35, dimension), float(properties(1).weight[0]) * LENGTH
    total = result.sections.end_force.sum(axis=0)
    assert np.abs(total - [0.0, 0.0, weight]).max() < 1e-9 * weight
    assert np.abs(result.sections.end_moment).max() < 1e-9 * weight


def test_convergence_to_the_elastica(elastica: tuple[float, float]) -> None:
    counts = [35, 70, 140]
    errors = np.array([abs(hang(n).H / elastica[0] - 1.0) for n in counts])
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all(orders > ORDER), f"errors of H {errors}, orders {orders}"
    assert errors[-1] < 2e-8


@pytest.mark.parametrize(
    ("count", "error", "moment", "angle"),
    [
        (20, 4.3e-5, 680.8, 71.48),
        (35, 3.4e-6, 634.9, 71.39),
        (80, 9e-8, 629.6, 71.33),
        (160, 7e-9, 632.38, 71.307),
    ],
)
def test_accuracy_on_given_meshes(
    tell: Tell, elastica: tuple[float, float], count: int, error: float, moment: float, angle: float
) -> None:
    """Relative error of H, largest moment (exact 632.41 N m), start angle (exact 71.303 degrees)."""
    result = hang(count)
    off = abs(result.H / elastica[0] - 1.0)
    assert off < error
    assert result.largest_moment == pytest.approx(moment, abs=0.06)
    assert 71.303 < result.start_angle < angle
    between = float(result.sections.largest_moment[0])
    moments = " | ".join(f"{each:.1f} N.m" for each in (result.largest_moment, between))
    tell({f"hanging H {count}": f"{off:.1e}"})
    tell({f"hanging {count}": f"{moments} | {result.start_angle:.2f}°"})


def test_newton_converges_from_the_catenary() -> None:
    assert hang(140).iterations <= 8


def test_plane_and_space_agree() -> None:
    plane, space = hang(35, 2), hang(35, 3)
    assert pytest.approx(plane.H, rel=1e-9) == space.H
    assert space.sections.bending_moment == pytest.approx(plane.sections.bending_moment, abs=1e-5)
