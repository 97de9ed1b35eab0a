"""Uniform load on plane elements: its potential, and the derivatives of that."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.riser import hermite
from tests.support import planar_elements

pytestmark = pytest.mark.usefixtures("uncompiled")

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


def test_potential_is_that_of_a_cubic_by_the_angles_of_its_ends(loaded: Loaded) -> None:
    """The potential is checked by vectors: each end's angle from the chord over its sine, times the load across the
    chord along its tangent.
    """
    middle = np.random.default_rng(8).normal(size=(NE, 2))
    chord, *ends, length, load = loaded
    expected = -length * np.sum(load * middle, axis=1)
    along = chord / np.linalg.norm(chord, axis=1, keepdims=True)
    for t, sign in zip(np.moveaxis(loaded.tangents(), 1, 0), (-1.0, 1.0), strict=True):
        cosine = np.sum(along * t, axis=1)
        over_sine = 1.0 / np.sinc(np.arccos(np.clip(cosine, -1.0, 1.0)) / np.pi)
        across = np.sum(load * t, axis=1) - cosine * np.sum(load * along, axis=1)
        expected += sign * over_sine * across * length**2 / 12.0
    potential = planar_elements.load_potential(chord, *ends, middle, length, load)
    assert potential == pytest.approx(expected, rel=1e-12, abs=1e-13)


def test_across_its_chord_a_load_acts_like_on_a_fixed_beam() -> None:
    chord, straight = np.array([[2.0, 0.0]]), np.zeros(1)
    f = planar_elements.load_forces(chord, straight, straight, np.array([2.0]), np.array([[0.0, -30.0]]))
    assert f[0] == pytest.approx([0.0, 30.0, 10.0, 0.0, 30.0, -10.0])


def test_it_makes_the_same_residual_as_hermite_on_straight_lines() -> None:
    turn, normal, w = np.array([0.6, 0.8]), np.array([-0.8, 0.6]), np.array([[3.0, -5.0]])
    direction = np.arctan2([0.8], [0.6])
    f = planar_elements.load_forces(2.0 * turn[None], direction, direction, np.array([2.0]), w)[0]
    shares = -hermite.uniform_load(np.array([2.0]))[0] * (w[0] @ normal)
    assert [f[:2] @ normal, f[2], f[3:5] @ normal, f[5]] == pytest.approx(shares)
    assert [f[:2] @ turn, f[3:5] @ turn] == pytest.approx([-w[0] @ turn] * 2)


def test_tangent_is_the_derivative_of_the_forces(loaded: Loaded) -> None:
    K, step = np.zeros((NE, 6, 6)), 1e-6
    planar_elements.add_load_tangent(K, 2.0, *loaded)
    for k in range(6):
        by = np.zeros((NE, 6))
        by[:, k] = step
        change = planar_elements.load_forces(*loaded.moved(by)) - planar_elements.load_forces(*loaded.moved(-by))
        assert K[:, :, k] == pytest.approx(change / step, abs=1e-8)
    assert np.array_equal(K, K.transpose(0, 2, 1))


def test_residual_is_the_derivative_of_the_potential(loaded: Loaded) -> None:
    step, f = 1e-6, planar_elements.load_forces(*loaded)

    def potential(by: Array) -> Array:
        middle = 0.5 * (by[:, :2] + by[:, 3:5])
        chord, *ends, length, load = loaded.moved(by)
        return planar_elements.load_potential(chord, *ends, middle, length, load)

    for k in range(6):
        by = np.zeros((NE, 6))
        by[:, k] = step
        assert f[:, k] == pytest.approx((potential(by) - potential(-by)) / (2.0 * step), abs=1e-8)
