"""Randolph & Quiggin's hysteretic seabed: its curves in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from tests.support.soil_loops import after, at, forces, randolph_quiggin, through

D, SU, K_MAX = 0.3, 2000.0, 200.0
EVEN = randolph_quiggin(D, SU)
DEEP = 0.09


def ultimate(z: float | np.ndarray) -> np.ndarray:
    return np.asarray(6.0 * (np.asarray(z) / D) ** 0.25 * SU * D)


def test_first_penetration_tends_to_the_ultimate_resistance() -> None:
    z = np.array([0.03, 0.06, 0.3])
    zeta = z * K_MAX / D
    force, _ = at(EVEN, z, EVEN.initial_history((1,)))
    np.testing.assert_allclose(force, ultimate(z) * zeta / (1.0 + zeta), rtol=1e-13)


def test_strength_that_grows_with_depth_and_buoyancy_add_up() -> None:
    law = randolph_quiggin(D, SU, 1500.0, unit_weight=4.0e3)
    z = np.array([0.15])
    even, _ = at(EVEN, z, EVEN.initial_history((1,)))
    expected = even * (1.0 + 1500.0 * 0.15 / SU) + 1.5 * 4.0e3 * np.pi * D**2 / 8.0
    np.testing.assert_allclose(at(law, z, law.initial_history((1,)))[0], expected, rtol=1e-13)


def test_uplift_follows_its_hyperbola() -> None:
    history = after(EVEN, np.array([DEEP]))
    P0 = history[0, 2]
    z = np.array([0.089, 0.08, 0.05])
    suction = -0.6 * np.exp(-(DEEP - z) / DEEP) * ultimate(z)
    x, S = (DEEP - z) * K_MAX / D, P0 - suction
    np.testing.assert_allclose(at(EVEN, z, history)[0], P0 - x / (S / ultimate(DEEP) + x) * S, rtol=1e-12)


@pytest.mark.parametrize("x", [0.01, 0.1, 0.3, 1.0])
def test_secant_stiffness_of_small_uplifts_is_the_published_curve(x: float) -> None:
    """K_sec D/Pu = Kmax/(1 + x Pu/S): Kmax at first, degrading over a displacement of D/Kmax (S/Pu)."""
    history = after(EVEN, np.array([DEEP]))
    P0 = history[0, 2]
    normalised = (P0 - at(EVEN, np.array([DEEP - x * D / K_MAX]), history)[0][0]) / (x * ultimate(DEEP))
    S = P0 / ultimate(DEEP) + 0.6
    assert normalised == pytest.approx(1.0 / (1.0 + x / S), rel=1e-2)


def test_suction_peaks_below_its_limit_and_ends_at_the_surface() -> None:
    path = through(0.0, DEEP, 0.0)
    up = forces(EVEN, path)[80:]
    assert -0.6 * ultimate(DEEP) < up.min() < -0.3 * ultimate(DEEP)
    assert up[-1] == 0.0
    assert abs(up[-2]) < 0.15 * ultimate(DEEP)


def test_there_is_no_suction_without_its_parameter() -> None:
    law = randolph_quiggin(D, SU, f_suc=0.0)
    assert forces(law, through(0.0, DEEP, -0.01)).min() >= 0.0


def test_repenetration_is_softer_and_joins_the_first_curve_beyond_the_deepest_point() -> None:
    again = after(EVEN, through(0.0, DEEP, -0.01))
    z = np.array([DEEP, 1.2 * DEEP])
    first = at(EVEN, z, EVEN.initial_history((1,)))[0]
    np.testing.assert_allclose(at(EVEN, z, again)[0], first * np.exp([-0.3, -0.1]), rtol=1e-9)
    later = np.array([1.3 * DEEP, 2.0 * DEEP])
    np.testing.assert_allclose(at(EVEN, later, again)[0], at(EVEN, later, EVEN.initial_history((1,)))[0], rtol=1e-2)


def test_a_tremble_beyond_the_deepest_point_leaves_the_clay_as_whole_as_it_was() -> None:
    """Softened by exp(-0.3) at the deepest point, by exp(-0.2) a tenth beyond it: so it is after a turn there, too."""
    out, on = through(0.0, DEEP, -0.01), through(-0.01, 1.1 * DEEP)
    again = after(EVEN, np.concatenate([out, on, through(1.1 * DEEP, 1.1 * DEEP - 1e-6, 1.1 * DEEP, steps=2)]))
    z = np.array([1.11 * DEEP])
    first = at(EVEN, z, EVEN.initial_history((1,)))[0]
    assert at(EVEN, z, again)[0] == pytest.approx(first * np.exp(-0.2 + 0.01 / 1.1), rel=2e-3)


def test_repenetration_after_a_small_uplift_starts_with_the_greatest_stiffness() -> None:
    history = after(EVEN, through(0.0, DEEP, DEEP - 5e-4, steps=50))
    slope = at(EVEN, np.array([DEEP - 5e-4 + 1e-9]), history)[1][0]
    assert slope == pytest.approx(ultimate(DEEP) * K_MAX / D, rel=2e-2)


def test_suction_comes_back_when_pressed_again_not_by_trembling() -> None:
    out = (0.0, DEEP, -0.01)
    trembled = forces(EVEN, through(*out, 0.05, 0.0499, 0.05, 0.0, steps=60)).min()
    lifted = after(EVEN, through(0.0, DEEP, 0.001))
    tremble = through(0.001, 0.0011, 0.001, 0.0011, 0.0, steps=20)
    weak = forces(EVEN, tremble, lifted).min()
    assert trembled < -0.2 * ultimate(0.05)
    assert weak > -0.6 * ultimate(0.0011)
    assert lifted[0, 6] == 1.0  # of the uplift that goes on
    assert EVEN.update(np.array([0.0011]), lifted).history[0, 6] == pytest.approx(np.exp(-(DEEP - 0.001) / DEEP))


def test_the_first_half_millimetre_gives_back_no_more_than_it_took() -> None:
    """There the first curve is steeper than the greatest stiffness; the pipe comes back along it."""
    z = np.linspace(0.0, 2e-4, 21)
    history = after(EVEN, np.array([2e-4]))
    np.testing.assert_array_less(at(EVEN, z, history)[0], at(EVEN, z, EVEN.initial_history((1,)))[0] + 1e-9)
