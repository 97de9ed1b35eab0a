"""A field at scattered points is carried along short ways."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.contact.integration_points import PointMemory
from riser_soil.core.arrays import Array
from riser_soil.core.carried import carried


def scattered(rng: np.random.Generator, n: int = 12) -> Array:
    """A grid of points 1 m apart in a plane, each moved by up to 0.2 m."""
    grid = np.stack(np.meshgrid([0.0], np.arange(n), np.arange(n), indexing="ij"), axis=-1).reshape(-1, 3)
    return grid + np.array([0.0, 0.2, 0.2]) * rng.uniform(-1.0, 1.0, grid.shape)


def test_a_linear_field_goes_along_with_the_way() -> None:
    rng = np.random.default_rng(1)
    places = scattered(rng)
    within = ((places[:, 1:] > 1.5) & (places[:, 1:] < 9.5)).all(axis=1)
    asked = places[within] + np.array([0.0, 0.1, 0.1]) * rng.uniform(-1.0, 1.0, (int(within.sum()), 3))
    slope = np.array([[0.0], [2.0], [-3.0]])
    values = carried(places, places @ slope, asked)
    missed = np.abs(values - asked @ slope)
    assert np.median(missed) < 0.005
    assert missed.max() < 0.03


def test_points_that_stay_keep_what_they_hold_and_others_do_not_exceed_it() -> None:
    rng = np.random.default_rng(2)
    places = scattered(rng)
    values = rng.uniform(size=(len(places), 2))
    np.testing.assert_array_equal(carried(places, values, places), values)
    moved = carried(places, values, places + np.array([0.0, 0.3, -0.2]))
    assert moved.min() >= values.min()
    assert moved.max() <= values.max()
    assert (moved != values).any()


def test_a_field_does_not_stick_to_the_mesh() -> None:
    """Forty ways of a twentieth of the distance between points: what is nearest would stay where it was."""
    y, z = np.meshgrid(np.arange(30.0), np.arange(5.0), indexing="ij")
    places = np.stack([0.0 * y.ravel(), y.ravel(), z.ravel()], axis=1)
    values = np.exp(-(((places[:, 1:2] - 18.0) / 4.0) ** 2))
    middle = [float(places[:, 1] @ values[:, 0] / values.sum())]
    for _ in range(40):
        values = carried(places, values, places + np.array([0.0, 0.05, 0.0]))
        middle.append(float(places[:, 1] @ values[:, 0] / values.sum()))
    assert middle[0] - middle[-1] == pytest.approx(2.0, rel=0.03)


def test_what_points_of_contact_remember_does_not_stick_to_them() -> None:
    """Memory is kept of those points alone that touch."""
    y, x = np.meshgrid(np.arange(30.0), np.arange(4.0), indexing="ij")
    places = np.stack([x.ravel(), y.ravel(), 0.0 * y.ravel()], axis=1)
    numbers, memory = np.arange(len(places)), PointMemory(np.zeros(1))
    memory.keep(numbers, np.maximum(1.0 - ((places[:, 1:2] - 18.0) / 6.0) ** 2, 0.0))

    def middle() -> float:
        return float(places[memory.numbers, 1] @ memory.rows[:, 0] / memory.rows.sum())

    before = middle()
    for _ in range(40):
        memory.go_over(numbers, places, places + np.array([0.0, 0.05, 0.0]))
    assert before - middle() == pytest.approx(2.0, rel=0.03)
    assert 11 * 4 <= len(memory.numbers) < len(places)
