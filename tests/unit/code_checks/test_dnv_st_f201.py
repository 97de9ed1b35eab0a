"""Formulas of DNV-ST-F201 against closed forms: equations that they solve, bounds, corners."""

import numpy as np
import pytest

from riser_soil.code_checks import dnv_st_f201

RNG = np.random.default_rng(7)


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
