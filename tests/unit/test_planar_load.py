"""Uniform load on plane elements: that of elements in space, and its tangent."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.riser import hermite, planar_load, uniform_load

NE = 6


class Loaded(NamedTuple):
    """Elements (ne,) with chords and loads (ne, 2), and the directions of their ends' tangents (ne,) [rad]."""

    chord: Array
    direction1: Array
    direction2: Array
    length: Array
    load: Array

    def moved(self, by: Array) -> Loaded:
        """After increments of the elements' dofs (ne, 6)."""
        chord = self.chord + by[:, 3:5] - by[:, :2]
        return self._replace(
            chord=chord, direction1=self.direction1 + by[:, 2], direction2=self.direction2 + by[:, 5]
        )

    def tangents(self, turned: float = 0.0) -> Array:
        """Unit tangents (ne, 2, 2) at the ends, or turned by an angle [rad]."""
        angle = np.stack([self.direction1, self.direction2], axis=1) + turned
        return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


@pytest.fixture
def loaded() -> Loaded:
    """Elements that turn by up to 2 rad, the first of them not at all, the second beyond the axis at pi."""
    rng = np.random.default_rng(7)
    chord = rng.normal(size=(NE, 2))
    chord[1] = -1.0, -1e-3
    angle = np.arctan2(chord[:, 1], chord[:, 0])
    first, second = (angle + rng.uniform(-2.0, 2.0, NE) for _ in range(2))
    first[0] = second[0] = angle[0]
    first[1] += 2.0 * np.pi
    return Loaded(chord, first, second, 1.0 + rng.random(NE), rng.normal(size=(NE, 2)))


def test_forces_are_those_of_a_load_in_space(loaded: Loaded) -> None:
    F = uniform_load.residual(loaded.chord, loaded.tangents(), loaded.length, loaded.load)
    normals = loaded.tangents(turned=0.5 * np.pi)[..., None]
    expected = hermite.pull_back(F, np.ascontiguousarray(normals))
    assert planar_load.forces(*loaded) == pytest.approx(expected, rel=1e-13, abs=1e-14)


def test_potential_is_that_of_a_load_in_space(loaded: Loaded) -> None:
    middle = np.random.default_rng(8).normal(size=(NE, 2))
    chord, *ends, length, load = loaded
    expected = uniform_load.potential(chord, middle, loaded.tangents(), length, load)
    assert planar_load.potential(chord, *ends, middle, length, load) == pytest.approx(expected, rel=1e-13, abs=1e-14)


def test_tangent_is_the_derivative_of_the_forces(loaded: Loaded) -> None:
    K, step = np.zeros((NE, 6, 6)), 1e-6
    planar_load.add_tangent(K, 2.0, *loaded)
    for k in range(6):
        by = np.zeros((NE, 6))
        by[:, k] = step
        change = planar_load.forces(*loaded.moved(by)) - planar_load.forces(*loaded.moved(-by))
        assert K[:, :, k] == pytest.approx(change / step, abs=1e-8)
    assert np.array_equal(K, K.transpose(0, 2, 1))


def test_residual_is_the_derivative_of_the_potential(loaded: Loaded) -> None:
    step, f = 1e-6, planar_load.forces(*loaded)

    def potential(by: Array) -> Array:
        middle = 0.5 * (by[:, :2] + by[:, 3:5])
        chord, *ends, length, load = loaded.moved(by)
        return planar_load.potential(chord, *ends, middle, length, load)

    for k in range(6):
        by = np.zeros((NE, 6))
        by[:, k] = step
        assert f[:, k] == pytest.approx((potential(by) - potential(-by)) / (2.0 * step), abs=1e-8)
