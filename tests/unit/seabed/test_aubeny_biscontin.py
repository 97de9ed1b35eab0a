"""Aubeny & Biscontin's seafloor: its backbone, loop and turns in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.seabed.aubeny_biscontin_formula import bounding_loop
from tests.support.soil_loops import after, at, aubeny_biscontin, forces, through

D, SU = 0.3, 2000.0
LAW = aubeny_biscontin(D, SU)
Y1 = 0.09
P1 = 6.73 * (Y1 / D) ** 0.29 * SU * D
K = 660.0 * SU
Y2 = Y1 - 1.203 * 1.433 / (0.433 - 0.203) * P1 / K
Y3 = Y2 - 0.661 * (Y1 - Y2)


def test_backbone_begins_with_the_stiffness_and_then_follows_the_power_law() -> None:
    z = np.array([1e-4, 0.01, 0.09])
    expected = [K * 1e-4, *(6.73 * (z[1:] / D) ** 0.29 * SU * D)]
    np.testing.assert_allclose(at(LAW, z, LAW.initial_history((1,)))[0], expected, rtol=1e-13)


def test_slope_of_the_backbone_where_the_clay_hardens_fast() -> None:
    law = aubeny_biscontin(D, SU, 2.0e5, k_over_su=5.0)
    z, h = np.array([0.01, 0.1, 0.3]), 1e-6
    differences = (law.backbone(z + h)[0] - law.backbone(z - h)[0]) / (2 * h)
    np.testing.assert_allclose(law.backbone(z)[1], differences, rtol=1e-7)


def test_rebound_reaches_its_limit_of_tension_and_then_parts() -> None:
    history = after(LAW, np.array([Y1]))
    d = np.array([0.2, 0.6, 1.0]) * (Y1 - Y2)
    np.testing.assert_allclose(
        at(LAW, Y1 - d, history)[0], P1 - d / (1.0 / K + d / (1.433 * P1)), rtol=1e-9, atol=1e-6
    )
    parting = at(LAW, np.array([Y2, 0.5 * (Y2 + Y3), Y3, 0.5 * Y3]), history)[0]
    np.testing.assert_allclose(parting, -0.203 * P1 * np.array([1.0, 0.5, 0.0, 0.0]), atol=1e-9 * P1)


def test_greatest_tension_is_its_share_of_the_deepest_resistance() -> None:
    assert forces(LAW, through(0.0, Y1, 0.0, steps=300)).min() == pytest.approx(-0.203 * P1, rel=1e-3)


def test_full_separation_and_reloading() -> None:
    history = after(LAW, through(0.0, Y1, -0.01))
    z = np.array([0.5 * Y3, Y3, 0.5 * (Y1 + Y3), Y1, 0.12])
    expected = [0.0, 0.0, 0.5 * P1, P1, LAW.backbone(np.array([0.12]))[0][0]]
    np.testing.assert_allclose(at(LAW, z, history)[0], expected, atol=1e-9 * P1)


def test_turn_within_the_loop_starts_with_the_stiffness_and_meets_the_edges() -> None:
    y = 0.5 * (Y1 + Y2)
    history = after(LAW, through(0.0, Y1, y))
    P = history[0, 2]
    d = 0.05 * (Y1 - Y2)
    assert at(LAW, np.array([y + d]), history)[0][0] == pytest.approx(P + d / (1.0 / K + d / (1.433 * P1)))
    assert at(LAW, np.array([Y1]), history)[0][0] <= P1
    assert at(LAW, np.array([2.0 * Y1]), history)[0][0] == pytest.approx(LAW.backbone(np.array([2.0 * Y1]))[0][0])


@pytest.mark.parametrize("deepest", [2e-4, 2e-3, 0.02, 0.045, 0.09])
def test_the_loop_ends_at_the_surface_or_below(deepest: float) -> None:
    loop = bounding_loop(LAW.kernel_data, deepest)
    assert loop.y3 >= -1e-12
    assert loop.y3 == pytest.approx(0.0, abs=1e-12) or loop.tension == pytest.approx(0.203 * loop.P1)


def test_a_light_pipe_rests_on_elastic_ground() -> None:
    """Short of the backbone's knee it comes up as it went down, and finds no suction."""
    path = through(0.0, 3e-4, 0.0, 3e-4)
    np.testing.assert_allclose(forces(LAW, path), K * path, rtol=1e-9, atol=1e-9)
