"""The bend of a pipe at its touchdown: balance on both sides, continuity between them, its limits, what is far away."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.riser.touchdown_bend import TouchdownBend

W, H, EI = 1256.0, 135e3, 3.18e7
EQUAL = 4.0 * W * EI / H**2  # m: where both roots of what fades in the ground are the same
DEPTHS = (1e-3, 0.025, 0.3, EQUAL, 3.0 * EQUAL)  # m: what fades swings up to the last but one


def pipe(bend: TouchdownBend, s: Array) -> Array:
    """Height over the surface [m]."""
    cable = bend.rise + 0.5 * bend.curvature * np.maximum(s - bend.lift_off, 0.0) ** 2
    return np.asarray(bend.beyond_cable(s)[0] + cable)


def derivatives(bend: TouchdownBend, s: float, h: float) -> Array:
    """Derivatives of the height at s, orders 0 to 4, by a polynomial through nine places h apart that all lie on one
    side.
    """
    t = np.arange(9.0) * (1.0 if s >= 0.0 else -1.0)
    fit = np.polynomial.Polynomial.fit(t, pipe(bend, s + h * t), 8)
    return np.array([float(fit.deriv(n)(0.0)) / h**n if n else float(fit(0.0)) for n in range(5)])


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("s", [-9.0, -2.0, 0.0, 3.0, 20.0])
def test_forces_are_in_balance(depth: float, s: float) -> None:
    """Where it lies the ground carries it, too; each force counts: none is small beside the sum of sizes."""
    y, _, curvature, _, fourth = derivatives(TouchdownBend(W, H, EI, depth), s, 0.15)
    ground = W / depth * y if s < 0.0 else 0.0
    forces = EI * fourth, -H * curvature, ground
    assert sum(forces) == pytest.approx(-W, abs=2e-3 * sum(map(abs, (*forces, W))))


@pytest.mark.parametrize("depth", DEPTHS)
def test_both_sides_meet(depth: float) -> None:
    bend = TouchdownBend(W, H, EI, depth)
    before, after = (derivatives(bend, side * 1e-12, 0.05) for side in (-1.0, 1.0))
    assert after[0] == pytest.approx(0.0, abs=1e-9)
    assert before[:3] == pytest.approx(after[:3], rel=1e-6, abs=1e-9)
    assert before[3] == pytest.approx(after[3], rel=2e-3)


@pytest.mark.parametrize("depth", DEPTHS)
def test_slope_is_the_heights_derivative(depth: float) -> None:
    bend, s, h = TouchdownBend(W, H, EI, depth), np.linspace(-60.3, 60.2, 41), 1e-4
    slope = (bend.beyond_cable(s + h)[0] - bend.beyond_cable(s - h)[0]) / (2.0 * h)
    assert bend.beyond_cable(s)[1] == pytest.approx(slope, abs=1e-8)


@pytest.mark.parametrize("depth", DEPTHS)
def test_far_away_it_rests_and_hangs(depth: float) -> None:
    bend = TouchdownBend(W, H, EI, depth)
    (lies, hangs), slope = bend.beyond_cable(np.array([-1e4, 1e3]))
    assert lies == pytest.approx(-depth - bend.rise)
    assert hangs == pytest.approx(0.0, abs=1e-6)
    assert slope == pytest.approx([0.0, 0.0], abs=1e-8)


def test_on_rigid_ground() -> None:
    bend = TouchdownBend(W, H, EI, 1e-15)
    assert bend.lift_off == pytest.approx(np.sqrt(EI / H), rel=1e-3)
    assert bend.rise == pytest.approx(0.5 * W / H * EI / H, rel=1e-9)


def test_without_stiffness_it_is_a_cable_on_springs() -> None:
    """H y'' = w + k y, whose solution that fades is y = -d (1 - e^(s sqrt(k/H)))."""
    depth = 0.3
    bend, s = replace(TouchdownBend(W, H, EI, depth), EI=1e-4), np.linspace(-20.0, -0.1, 30)
    expected = -depth * (1.0 - np.exp(s * np.sqrt(W / depth / H)))
    assert pipe(bend, s) == pytest.approx(expected, abs=1e-5)
