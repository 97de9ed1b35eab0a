"""Stress in a pipe's wall, against equilibrium, formulas written out by hand, and what looking around finds."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.riser.wall_stress import (
    Loads,
    Wall,
    axial_stress_at,
    hoop_and_radial_stress,
    largest_von_mises,
    shear_stress,
    von_mises_at,
    wall_sections,
)

PIPE = Wall(np.array(0.2731), np.array(0.2319))  # 10 3/4 in x 20.6 mm
a, b = 0.5 * 0.2319, 0.5 * 0.2731
LOADS = Loads(*(np.array(x) for x in (9.0e5, 4.0e4, -3.0e4, 2.0e4, 34.5e6, 12.0e6)))


def polar(n: int = 400) -> tuple[Array, Array, Array]:
    """Radii, angles and shares of the area of a fine grid, by Gauss's rule across and the midpoint rule around."""
    x, w = np.polynomial.legendre.leggauss(20)
    r, angle = 0.5 * (a + b) + 0.5 * (b - a) * x, 2.0 * np.pi * (np.arange(n) + 0.5) / n
    return r[:, None], angle[None, :], (0.5 * (b - a) * w * r)[:, None] * np.full(n, 2.0 * np.pi / n)


def test_stress_along_the_pipe_is_in_equilibrium_with_tension_and_moments() -> None:
    r, angle, area = polar()
    stress = axial_stress_at(angle, LOADS, 2.0 * r, PIPE)
    assert (stress * area).sum() == pytest.approx(9.0e5, rel=1e-12)
    assert (stress * r * np.sin(angle) * area).sum() == pytest.approx(4.0e4, rel=1e-12)
    assert -(stress * r * np.cos(angle) * area).sum() == pytest.approx(-3.0e4, rel=1e-12)


def test_shear_stress_is_in_equilibrium_with_the_torque() -> None:
    r, _, area = polar()
    assert (shear_stress(LOADS.torque, 2.0 * r, PIPE) * r * area).sum() == pytest.approx(2.0e4, rel=1e-12)


def test_lame_s_tube() -> None:
    """-p on the surfaces; hoop stress bears the pressures on half the tube; thin walls have p D/(2 t)."""
    x, w = np.polynomial.legendre.leggauss(20)
    r = 0.5 * (a + b) + 0.5 * (b - a) * x
    hoop, radial = hoop_and_radial_stress(LOADS, 2.0 * r, PIPE)
    assert (hoop * 0.5 * (b - a) * w).sum() == pytest.approx(34.5e6 * a - 12.0e6 * b, rel=1e-12)
    assert hoop + radial == pytest.approx(np.full(20, 2.0 * (34.5e6 * a**2 - 12.0e6 * b**2) / (b**2 - a**2)))
    at = [hoop_and_radial_stress(LOADS, np.array(2.0 * radius), PIPE)[1] for radius in (a, b)]
    assert at == pytest.approx([-34.5e6, -12.0e6], rel=1e-12)
    thin, burst = Wall(np.array(1.0), np.array(1.0 - 2e-6)), LOADS._replace(outside=np.array(0.0))
    computed, _ = hoop_and_radial_stress(burst, np.array(1.0), thin)
    assert computed == pytest.approx(34.5e6 * 1.0 / (2.0 * 1e-6), rel=1e-5)


def test_von_mises_by_hand() -> None:
    """Outside, where bending pulls most: every number written out."""
    A, I = np.pi * (b**2 - a**2), 0.25 * np.pi * (b**4 - a**4)
    axial = 9.0e5 / A + 5.0e4 * b / I
    hoop, radial = (2.0 * 34.5e6 * a**2 - 12.0e6 * (a**2 + b**2)) / (b**2 - a**2), -12.0e6
    shear = 2.0e4 * b / (2.0 * I)
    expected = np.sqrt(
        axial**2 + hoop**2 + radial**2 - axial * hoop - hoop * radial - radial * axial + 3.0 * shear**2
    )
    angle = np.arctan2(4.0e4, 3.0e4)  # M_y sin - M_z cos is largest there
    assert von_mises_at(angle, LOADS, PIPE.outer_diameter, PIPE) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("pressures", [(34.5e6, 12.0e6), (0.0, 40.0e6), (0.0, 0.0)])
@pytest.mark.parametrize("tension", [-2.0e6, 0.0, 9.0e5])
def test_the_largest_is_what_looking_around_finds(tension: float, pressures: tuple[float, float]) -> None:
    inside, outside = (np.array(p) for p in pressures)
    loads = LOADS._replace(tension=np.array(tension), inside=inside, outside=outside)
    angles = np.linspace(0.0, 2.0 * np.pi, 100_001)
    around = max(von_mises_at(angles, loads, diameter, PIPE).max() for diameter in PIPE)
    assert around <= largest_von_mises(loads, PIPE) * (1.0 + 1e-12)
    assert largest_von_mises(loads, PIPE) == pytest.approx(around, rel=1e-8)


def test_at_a_joint_both_walls_have_a_section() -> None:
    """Thick, thin, none, thin: what the side with the larger stress has is told at the node."""
    wall = Wall(np.array([0.30, 0.28, 0.0, 0.28]), np.array([0.20, 0.25, 0.0, 0.25]))
    sections = wall_sections(wall, np.array([3.0, 2.0, 0.0, 2.0]), np.ones((4, 2)))
    assert sections.node.tolist() == [0, 1, 1, 2, 3, 4]
    assert sections.wall.outer_diameter.tolist() == [0.30, 0.30, 0.28, 0.28, 0.28, 0.28]
    assert sections.allowable.tolist() == [3.0, 3.0, 2.0, 2.0, 2.0, 2.0]
    stress = np.array([1.0, 2.0, 5.0, 6.0, 7.0, 8.0])
    assert sections.at_nodes(-stress, stress, 5).tolist() == [-1.0, -5.0, -6.0, -7.0, -8.0]
    assert sections.at_nodes(-stress, -stress, 5).tolist() == [-1.0, -2.0, -6.0, -7.0, -8.0]
    tension = sections.loads(*np.array([[10.0] * 5, *([[0.0] * 5] * 3), [2.0] * 5, [1.0] * 5])).tension
    assert tension[1] == pytest.approx(10.0 + 0.25 * np.pi * (2.0 * 0.20**2 - 0.30**2))
    assert tension[2] == pytest.approx(10.0 + 0.25 * np.pi * (2.0 * 0.25**2 - 0.28**2))


def test_nodes_between_no_walls_have_none() -> None:
    wall = Wall(np.array([0.3, 0.0, 0.0]), np.array([0.2, 0.0, 0.0]))
    sections = wall_sections(wall, np.zeros(3), np.ones((3, 2)))
    assert sections.node.tolist() == [0, 1]
    values = sections.at_nodes(np.array([1.0, 2.0]), np.array([1.0, 2.0]), 4)
    assert np.isnan(values).tolist() == [False, False, True, True]
