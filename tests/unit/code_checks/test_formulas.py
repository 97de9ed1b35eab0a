"""Formulas of codes against closed forms: equations that they solve, limits, and scaling."""

import numpy as np
import pytest

from riser_soil.code_checks import api_rp_2rd, api_std_2rd, capacity_curve, dnv_st_f201, flexible_pipe
from riser_soil.code_checks.load_effects import LoadEffects, LoadFactors, SectionEffects, design_effects
from riser_soil.core.arrays import Array
from riser_soil.riser.wall_stress import Loads, Wall, hoop_and_radial_stress, von_mises

RNG = np.random.default_rng(7)


def one(tension: float = 0.0, moment_y: float = 0.0, moment_z: float = 0.0) -> SectionEffects:
    return SectionEffects(*(np.array([value]) for value in (tension, moment_y, moment_z)))


@pytest.mark.parametrize(
    ("functional", "environmental", "design"),
    [
        (100.0, 50.0, 1.1 * 100.0 + 1.3 * 50.0),
        (100.0, -50.0, 1.1 * 100.0 - 50.0 / 1.3),  # the environment relieves
        (100.0, -300.0, 1.3 * 300.0 - 100.0 / 1.1),  # what acts at rest relieves
        (-100.0, -50.0, 1.1 * 100.0 + 1.3 * 50.0),
    ],
)
def test_what_relieves_counts_with_one_over_its_factor(
    functional: float, environmental: float, design: float
) -> None:
    effects = LoadEffects(one(functional, functional), one(environmental, environmental), one())
    moment, tension = design_effects(effects, dnv_st_f201.LOAD_FACTORS["ULS"])
    assert [moment[0], tension[0]] == pytest.approx([design, design])


def test_moments_of_both_planes_add_as_vectors() -> None:
    effects = LoadEffects(one(moment_y=30.0), one(moment_z=40.0), one())
    moment, _ = design_effects(effects, LoadFactors(1.0, 1.0, 1.0))
    assert moment[0] == pytest.approx(50.0)


@pytest.mark.parametrize(("state", "factor"), [("ALS", 1.0), ("SLS", 1.0), ("ULS", 0.0), ("FLS", 0.0)])
def test_accidental_effects_count_in_some_limit_states_alone(state: str, factor: float) -> None:
    moment, _ = design_effects(LoadEffects(one(), one(), one(moment_y=9.0)), dnv_st_f201.LOAD_FACTORS[state])
    assert moment[0] == pytest.approx(9.0 * factor)


def test_collapse_resistance_is_the_least_positive_root() -> None:
    for _ in range(50):
        p_el, p_p, f0, slender = RNG.uniform([1e6, 1e6, 0.005, 15.0], [1e8, 1e8, 0.03, 45.0])
        roots = np.roots([1.0, -p_el, -(p_p**2 + p_el * p_p * f0 * slender), p_el * p_p**2])
        least = min(root.real for root in roots if root.real > 0.0)
        pressure = dnv_st_f201.collapse_resistance(p_el, p_p, f0, slender, 1.0)
        assert pressure == pytest.approx(least, rel=1e-9)
        assert pressure < min(p_el, p_p)


def test_a_round_pipe_collapses_at_the_lower_of_both_pressures() -> None:
    assert dnv_st_f201.collapse_resistance(4e6, 9e6, 0.0, 20.0, 1.0) == pytest.approx(4e6, rel=1e-6)
    assert dnv_st_f201.collapse_resistance(9e6, 4e6, 0.0, 20.0, 1.0) == pytest.approx(4e6, rel=1e-6)


@pytest.mark.parametrize(("slender", "share"), [(10.0, 0.4), (15.0, 0.4), (37.5, 0.2), (60.0, 0.0), (80.0, 0.0)])
def test_flow_stress_between_yield_and_tensile_strength(slender: float, share: float) -> None:
    """D/t below 15 counts as 15, above 60 there is no hardening."""
    alpha_c = dnv_st_f201.flow_stress_parameter(slender, 1.0, 400.0, 500.0, -5.0, 30.0)
    assert alpha_c == pytest.approx(1.0 + 0.25 * share)


def test_flow_stress_is_bounded() -> None:
    """Beta is 1.4 at the hoop stress of yielding."""
    assert dnv_st_f201.flow_stress_parameter(15.0, 1.0, 400.0, 500.0, 25.9, 30.0) == pytest.approx(1.2)
    assert dnv_st_f201.flow_stress_parameter(15.0, 1.0, 400.0, 500.0, 5.0, 30.0) < 1.2


def test_strength_in_bursting_is_the_lower_of_yield_and_reduced_tensile() -> None:
    by_yield = dnv_st_f201.bursting_resistance(11.0, 1.0, 400.0, 500.0)
    assert by_yield == pytest.approx(2.0 / np.sqrt(3.0) * 2.0 / 10.0 * 400.0)
    by_tensile = dnv_st_f201.bursting_resistance(11.0, 1.0, 460.0, 500.0)
    assert by_tensile == pytest.approx(2.0 / np.sqrt(3.0) * 0.2 * 500.0 / 1.15)


def test_pressures_that_relieve_use_nothing() -> None:
    assert dnv_st_f201.bursting(1.0, 2.0, 5.0, 1.3) == 0.0
    assert dnv_st_f201.hoop_buckling(1.0, 2.0, 5.0, 1.3) == 0.0
    assert dnv_st_f201.propagating_buckling(1.0, 2.0, 5.0, 1.3) == 0.0
    assert api_std_2rd.overpressure(1.0, 2.0, 5.0) == 0.0


def test_combined_loading_at_its_corners() -> None:
    """Each load alone at its resistance over the factors is allowed, and no more."""
    gamma = 1.15 * 1.26
    assert dnv_st_f201.combined_internal(1.0 / gamma, 0.0, 0.0, 1.0, gamma) == pytest.approx(1.0)
    assert dnv_st_f201.combined_internal(0.0, gamma**-0.5, 0.0, 1.0, gamma) == pytest.approx(1.0)
    assert dnv_st_f201.combined_internal(0.0, 0.0, 1.0, 1.0, gamma) == pytest.approx(1.0)
    assert dnv_st_f201.combined_external(1.0 / gamma, 0.0, 0.0, 1.0, gamma) == pytest.approx(1.0)
    assert dnv_st_f201.combined_external(0.0, gamma**-0.5, 0.0, 1.0, gamma) == pytest.approx(1.0)
    assert dnv_st_f201.combined_external(0.0, 0.0, 1.0 / gamma, 1.0, gamma) == pytest.approx(1.0)


def test_a_pipe_beyond_bursting_is_overused_whatever_bends_it() -> None:
    assert dnv_st_f201.combined_internal(0.0, 0.0, 1.2, 1.0, 1.3) == pytest.approx(1.44)


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


def test_no_loads_use_nothing_by_both_methods() -> None:
    assert api_std_2rd.method_1(0.0, 0.0, 0.0, 0.8) == 0.0
    assert api_std_2rd.method_2(0.0, 0.0, 0.0, 0.8) == 0.0


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


def test_limits_of_flexible_pipe() -> None:
    assert flexible_pipe.bend_radius(0.1, 5.0) == pytest.approx(0.5)
    assert flexible_pipe.tension(np.array([200.0, -50.0]), 400.0) == pytest.approx([0.5, 0.0])
    assert flexible_pipe.compression(np.array([200.0, -50.0]), 100.0) == pytest.approx([0.0, 0.5])
    assert flexible_pipe.crushing(np.array([30.0, -5.0]), 60.0) == pytest.approx([0.5, 0.0])


CURVE = np.array([[-2.0e4, 0.1], [0.0, 0.4], [1.0e5, 0.3], [2.0e5, 0.0]])


def test_capacity_curve_is_used_up_on_itself() -> None:
    first, second = CURVE[:-1, None], CURVE[1:, None]
    share = np.linspace(0.0, 1.0, 5)[:, None]
    T, kappa = np.moveaxis(first + share * (second - first), -1, 0)
    assert capacity_curve.utilisation(T, kappa, CURVE) == pytest.approx(np.ones((3, 5)))
    assert capacity_curve.utilisation(2.0 * T, 2.0 * kappa, CURVE) == pytest.approx(2.0 * np.ones((3, 5)))
    assert capacity_curve.utilisation(np.zeros(1), np.zeros(1), CURVE) == pytest.approx([0.0])


def test_capacity_curve_bounds_tension_and_compression_alone() -> None:
    used = capacity_curve.utilisation(np.array([1.0e5, -1.0e4, -4.0e4]), np.zeros(3), CURVE)
    assert used == pytest.approx([0.5, 0.5, 2.0])


def test_capacity_curve_from_no_tension_says_nothing_of_compression() -> None:
    used = capacity_curve.utilisation(np.array([-1.0e6, -1.0e6]), np.array([0.0, 0.2]), CURVE[1:])
    assert used == pytest.approx([0.0, 0.5])


def test_capacity_curve_with_an_upright_end() -> None:
    curve = np.array([[0.0, 0.4], [1.0e5, 0.2]])
    assert capacity_curve.utilisation(np.array([2.0e5]), np.array([0.1]), curve) == pytest.approx([2.0])
