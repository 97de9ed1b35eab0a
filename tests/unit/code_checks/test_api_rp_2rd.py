"""Formulas of API RP 2RD against closed forms: stresses of each load alone, the side and the wall that count."""

import numpy as np
import pytest

from riser_soil.code_checks import api_rp_2rd
from riser_soil.riser.wall_stress import Loads, Wall, hoop_and_radial_stress

RP_PIPE = (0.2731, 0.0270)  # D, t of a 10 3/4 inch pipe [m]


def test_stresses_of_pressure_are_means_over_the_wall() -> None:
    """Means of Lame's stresses, at Gauss points of the radius."""
    D, t = RP_PIPE
    at, weights = np.polynomial.legendre.leggauss(20)
    zero = np.zeros(20)
    loads = Loads(zero, zero, zero, zero, zero + 3.0e7, zero + 1.2e7)
    wall = Wall(np.asarray(D), np.asarray(D - 2.0 * t))
    hoop, radial = (0.5 * weights @ each for each in hoop_and_radial_stress(loads, D - t + at * t, wall))
    assert api_rp_2rd.hoop_stress(D, t, 3.0e7, 1.2e7) == pytest.approx(hoop, rel=1e-10)
    assert api_rp_2rd.radial_stress(D, t, 3.0e7, 1.2e7) == pytest.approx(radial, rel=1e-10)


def test_each_load_alone_gives_its_stress() -> None:
    D, t = RP_PIPE
    area, I = np.pi * (D - t) * t, np.pi / 64.0 * (D**4 - (D - 2.0 * t) ** 4)
    for sign in (1.0, -1.0):
        pulled = api_rp_2rd.largest_stress(D, t, t, sign * 2.0e6, 0.0, 0.0, 0.0)
        assert pulled == pytest.approx(2.0e6 / area, rel=1e-12)
    bent = api_rp_2rd.largest_stress(D, t, t, 0.0, 3.0e5, 0.0, 0.0)
    assert bent == pytest.approx(3.0e5 * (D - t) / (2.0 * I), rel=1e-12)
    submerged = api_rp_2rd.largest_stress(D, t, t, -2.0e7 * area, 0.0, 2.0e7, 2.0e7)
    assert submerged == pytest.approx(0.0, abs=1e-6)  # pressed alike from all sides


def test_bending_counts_on_the_side_where_it_is_worse() -> None:
    """Along with tension on the one side, along with compression on the other."""
    D, t = RP_PIPE
    alike = [api_rp_2rd.largest_stress(D, t, t, sign * 2.0e6, 3.0e5, 0.0, 0.0) for sign in (1.0, -1.0)]
    assert alike[0] == pytest.approx(alike[1], rel=1e-12)
    under = [api_rp_2rd.largest_stress(D, t, t, sign * 2.0e6, 3.0e5, 5.0e7, 0.0) for sign in (1.0, -1.0)]
    assert under[1] > 1.2 * under[0]


def test_the_thinnest_wall_counts_in_the_hoop_stress_alone() -> None:
    D, t = RP_PIPE
    nominal, thinned = (api_rp_2rd.largest_stress(D, t, t_min, 2.0e6, 3.0e5, 0.0, 0.0) for t_min in (t, 0.7 * t))
    assert thinned == nominal
    assert api_rp_2rd.hoop_stress(D, 0.5 * t, 2.0e7, 2.0e7) == -2.0e7
    assert api_rp_2rd.hoop_stress(D, 0.5 * t, 2.0e7, 0.0) == pytest.approx(2.0e7 * (D / t - 1.0))


@pytest.mark.parametrize(("case", "share"), [("operating", 2.0 / 3.0), ("extreme", 0.8), ("survival", 1.0)])
def test_allowable_share_of_yield_by_case(case: str, share: float) -> None:
    assert api_rp_2rd.utilisation(share * 448.0e6, 448.0e6, case) == pytest.approx(1.0, rel=1e-12)
