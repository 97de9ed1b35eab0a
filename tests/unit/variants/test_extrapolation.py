"""Limits of refinements: known orders at unequal ratios, several terms, noise, values that turn back."""

from __future__ import annotations

import math

import numpy as np
import pytest

from riser_soil.variants.extrapolation import limit, observed_order

SIZES = (1.0, 0.6, 0.25, 0.2, 0.07)  # unequal ratios


@pytest.mark.parametrize("p", [0.5, 1.0, 2.0, 3.7, 6.0])
@pytest.mark.parametrize("c", [3.0, -40.0])
def test_a_pure_power_is_found_with_its_order(p: float, c: float) -> None:
    values = [7.0 + c * h**p for h in SIZES]
    assert observed_order(SIZES[:3], values[:3]) == pytest.approx(p, rel=1e-9)
    result = limit(SIZES, values)
    assert result.order == pytest.approx(p, rel=1e-6)
    assert result.value == pytest.approx(7.0, rel=1e-9)
    assert result.uncertainty == pytest.approx(0.3 * abs(values[-1] - 7.0), rel=1e-6)


def test_order_of_points_does_not_matter() -> None:
    values = [2.0 + h**2 for h in SIZES]
    assert limit(SIZES[::-1], values[::-1]) == limit(SIZES, values)


@pytest.mark.parametrize("second", [0.5, 2.0, -0.3])
@pytest.mark.parametrize("count", [3, 4, 5])
def test_uncertainty_holds_the_error_where_higher_terms_disturb(second: float, count: int) -> None:
    sizes = [1.0, 0.5, 0.25, 0.125, 0.0625][:count]
    result = limit(sizes, [1.0 + 0.4 * (h + second * h**3) for h in sizes])
    finest = 0.4 * (sizes[-1] + second * sizes[-1] ** 3)
    assert abs(result.value - 1.0) <= (0.5 if count > 3 else 1.0 + 1e-9) * abs(finest)
    assert abs(result.value - 1.0) <= result.uncertainty


def test_values_that_turn_back_show_no_order() -> None:
    result = limit((4.0, 2.0, 1.0), (1.3, 0.9, 1.0))
    assert (result.value, result.order) == (1.0, None)
    assert result.uncertainty == pytest.approx(0.4)


def test_values_that_drift_away_show_no_order() -> None:
    """Changes that grow, or fall too slowly to tell where they end."""
    for values in ((1.0, 1.1, 1.4), (1.0, 1.1, 1.19)):
        result = limit((4.0, 2.0, 1.0), values)
        assert (result.value, result.order) == (values[-1], None)
        assert result.uncertainty == pytest.approx(values[-1] - 1.0)


def test_noise_stays_within_the_uncertainty() -> None:
    """Values at rest but for round-off, and ones whose last change drowns in noise: nothing is thrown far off."""
    random, inside = np.random.default_rng(1), 0
    for trial in range(400):
        sizes, noise = (1.0, 0.5, 0.25, 0.125), 1e-3 * random.standard_normal(4)
        error = 0.01 * (trial % 2)
        result = limit(sizes, [1.0 + error * h**2 + e for h, e in zip(sizes, noise, strict=True)])
        assert abs(result.value - 1.0) < 0.02
        inside += abs(result.value - 1.0) <= result.uncertainty + 1e-3
    assert inside >= 0.95 * 400


def test_few_values() -> None:
    assert limit((1.0,), (5.0,)).uncertainty == math.inf
    assert limit((2.0, 1.0), (5.0, 4.5)) == limit((1.0, 2.0), (4.5, 5.0))
    assert (limit((2.0, 1.0), (5.0, 4.5)).value, limit((2.0, 1.0), (5.0, 4.5)).uncertainty) == (4.5, 0.5)
    assert limit((4.0, 2.0, 1.0), (3.0, 3.0, 3.0)).uncertainty == 0.0
    with pytest.raises(ValueError, match="twice"):
        limit((1.0, 1.0), (2.0, 3.0))
