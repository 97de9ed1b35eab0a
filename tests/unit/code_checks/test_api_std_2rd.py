"""Formulas of API STD 2RD against closed forms: curves that they meet, limits of thin tubes, and scaling."""

import numpy as np
import pytest

from riser_soil.code_checks import api_std_2rd
from riser_soil.core.arrays import Array
from riser_soil.riser.wall_stress import Wall, von_mises

RNG = np.random.default_rng(7)


def test_collapse_pressure_between_yield_and_elastic_one() -> None:
    assert api_std_2rd.collapse_pressure(3.0, 4.0) == pytest.approx(12.0 / 5.0)
    assert api_std_2rd.yield_collapse_pressure(20.0, 1.0, 450.0) == pytest.approx(45.0)


def test_yield_and_plastic_resistances_of_a_thin_ring() -> None:
    """A ring of mean radius r has T = 2 pi r t S, M_y = pi r^2 t S, M_p = 4 r^2 t S."""
    r, t, S = 5.0, 0.01, 400.0
    D = 2.0 * r + t
    assert api_std_2rd.yield_tension(D, t, S) == pytest.approx(2.0 * np.pi * r * t * S)
    assert api_std_2rd.yield_moment(D, t, S) == pytest.approx(np.pi * r**2 * t * S)
    assert api_std_2rd.plastic_moment(D, t, S) == pytest.approx(4.0 * r**2 * t * S)


def test_method_1_is_met_on_its_line() -> None:
    q, F = 0.3, 0.8
    allowed = np.sqrt(F**2 - q**2)
    tension = np.linspace(0.0, allowed, 9)
    assert api_std_2rd.method_1(tension, allowed - tension, q, F) == pytest.approx(np.ones(9))


def test_method_2_is_met_on_its_curve() -> None:
    q, F = 0.3, 0.8
    s = np.sqrt(F**2 - q**2)
    tension = np.linspace(0.0, s, 9)
    moment = s * np.cos(0.5 * np.pi * tension / s)
    assert api_std_2rd.method_2(tension, moment, q, F) == pytest.approx(np.ones(9))


def test_both_methods_grow_in_proportion_to_the_loads() -> None:
    tension, moment, q = RNG.uniform(0.01, 0.5, (3, 40))
    for method in (api_std_2rd.method_1, api_std_2rd.method_2):
        assert method(2.5 * tension, 2.5 * moment, 2.5 * q, 0.8) == pytest.approx(2.5 * method(tension, moment, q, 0.8))


def test_method_2_allows_more_than_method_1() -> None:
    """M_p = 4/pi M_y, and the cosine lies above the line."""
    tension, moment, q = RNG.uniform(0.0, 0.5, (3, 40))
    second = api_std_2rd.method_2(tension, 0.25 * np.pi * moment, q, 0.8)
    assert (second <= api_std_2rd.method_1(tension, moment, q, 0.8) + 1e-12).all()


def test_no_loads_and_pressures_that_relieve_use_nothing() -> None:
    assert api_std_2rd.method_1(0.0, 0.0, 0.0, 0.8) == 0.0
    assert api_std_2rd.method_2(0.0, 0.0, 0.0, 0.8) == 0.0
    assert api_std_2rd.overpressure(1.0, 2.0, 5.0) == 0.0


@pytest.mark.parametrize(
    ("case", "factors"), [("operating", (0.8, 0.8)), ("extreme", (0.8, 0.8)), ("survival", (1.0, 0.9))]
)
def test_design_factors_by_case(case: str, factors: tuple[float, float]) -> None:
    """In survival less where the pressure outside nears collapse."""
    assert api_std_2rd.design_factor(case, np.array([0.0, 0.5, 0.51])).tolist() == [factors[0], *factors]


SLENDER = (10.0, 20.0, 40.0, 80.0, 160.0)  # D/t


def segment(radius: Array, height: Array) -> tuple[Array, Array]:
    """Area and first moment of the part of a disc beyond a chord at this height over its middle."""
    half = np.sqrt(np.maximum(radius**2 - height**2, 0.0))
    return radius**2 * np.arctan2(half, height) - height * half, 2.0 / 3.0 * half**3


def plastic_loads(D: float, t: float, S: float, share: Array) -> tuple[Array, Array]:
    """Tension and moment of a tube that yields throughout, pulled beyond a chord at this share of its middle radius."""
    height = -share * 0.5 * (D - t)
    (outer, arm), (inner, inner_arm) = (segment(np.asarray(0.5 * d), height) for d in (D, D - 2.0 * t))
    pulled = outer - inner
    return S * (2.0 * pulled - np.pi * (D - t) * t), 2.0 * S * (arm - inner_arm)


@pytest.mark.parametrize("q", [0.0, 0.6])
def test_method_2_is_the_plastic_limit_of_a_thin_tube(q: float) -> None:
    """Under pressure the tube yields along its axis at s = sqrt(1 - q^2) of its strength. What it bears exceeds the
    method's share by a part that goes with the square of t/D.
    """
    share, s, off = np.linspace(0.0, 0.9, 10), np.sqrt(1.0 - q**2), list[float]()
    for slender in SLENDER:
        T, M = plastic_loads(slender, 1.0, 400.0 * s, share)
        T_y, M_p = (of(slender, 1.0, 400.0) for of in (api_std_2rd.yield_tension, api_std_2rd.plastic_moment))
        used = api_std_2rd.method_2(T / T_y, M / M_p, q, 1.0)
        off.append(float(np.abs(used - 1.0).max()))
    assert off[-1] < 2e-5
    assert np.log2(off[:-1] / np.array(off[1:])) == pytest.approx(2.0, abs=0.2)


@pytest.mark.parametrize("q", [0.0, 0.6])
def test_method_1_is_the_first_yield_of_a_thin_tube(q: float) -> None:
    """In the middle of the wall, of tension and bending in any share."""
    share, s, off = np.linspace(0.0, 1.0, 11), np.sqrt(1.0 - q**2), list[float]()
    for slender in SLENDER:
        wall = Wall(np.asarray(slender), np.asarray(slender - 2.0))
        T, M = share * s * 400.0 * wall.area, (1.0 - share) * s * 400.0 * 2.0 * wall.second_moment / (slender - 1.0)
        T_y, M_y = (of(slender, 1.0, 400.0) for of in (api_std_2rd.yield_tension, api_std_2rd.yield_moment))
        used = api_std_2rd.method_1(T / T_y, M / M_y, q, 1.0)
        off.append(float(np.abs(used - 1.0).max()))
    assert off[-1] < 5e-5
    assert np.log2(off[:-1] / np.array(off[1:])) == pytest.approx(2.0, abs=0.2)


def test_pressure_takes_of_the_strength_along_the_axis_what_the_methods_say() -> None:
    """A thin wall, pressed to q of the hoop stress at which it flows, yields at the axial stress of closed ends and
    s = sqrt(1 - q^2) of its strength to both sides of it: effective tension counts from there.
    """
    q, none = np.linspace(0.0, 1.0, 11), np.zeros(11)
    hoop, s = 2.0 / np.sqrt(3.0) * q, np.sqrt(1.0 - q**2)
    for axial in (0.5 * hoop + s, 0.5 * hoop - s):
        assert von_mises(axial, hoop, none, none) == pytest.approx(np.ones(11), rel=1e-12)
