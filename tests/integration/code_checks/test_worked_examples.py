"""Formulas of codes against worked examples of public material.

Sources: a comparison of LRFD and WSD by DNV-OS-F201 (pipe of 20 inch and X65, high safety class), the oracle of
test_dnv_os_f201_lrfd_wsd.py in vamseeachanta/digitalmodel on GitHub, in kips, inches and ksi; notebooks of
qwilka/PDover2t on GitHub by DNVGL-ST-F101 (2017), whose collapse and propagation formulas DNV-OS-F201 shares, in SI
units; the workflow pipe-capacity of vamseeachanta/digitalmodel by API STD 2RD (2013), in inches and psi; a stress joint
of that repository by API RP 2RD (1998), of which input and formulas are published and the result follows from these.
"""

import numpy as np
import pytest

from riser_soil.code_checks import api_rp_2rd, api_std_2rd, dnv_st_f201
from riser_soil.code_checks.collapse import elastic_collapse_pressure
from riser_soil.code_checks.load_effects import LoadEffects, SectionEffects, design_effects

SHOWN = 1e-6  # digits that the sources give
FY, FU = 62.4, 73.92  # ksi
D, T2 = 20.0, 0.82678  # in
INSIDE = 3.0  # ksi
HIGH = 1.26  # of the safety class, with a material factor of 1


def moment_resistance(overpressure: float) -> float:
    p_b = dnv_st_f201.bursting_resistance(D, T2, FY, FU)
    alpha_c = dnv_st_f201.flow_stress_parameter(D, T2, FY, FU, overpressure, p_b)
    return float(dnv_st_f201.plastic_moment(D, T2, FY, alpha_c)) / 12.0  # kips ft


def test_strengths() -> None:
    assert dnv_st_f201.characteristic_strength(65.0, 0.0, 0.96) == pytest.approx(FY, rel=SHOWN)
    assert dnv_st_f201.characteristic_strength(77.0, 0.0, 0.96) == pytest.approx(FU, rel=SHOWN)
    assert dnv_st_f201.characteristic_strength(450e6, 6e6, 1.0) == pytest.approx(444e6, rel=SHOWN)  # PDover2t, 60 C


def test_resistances_under_internal_pressure() -> None:
    p_b = dnv_st_f201.bursting_resistance(D, T2, FY, FU)
    alpha_c = dnv_st_f201.flow_stress_parameter(D, T2, FY, FU, INSIDE, p_b)
    assert p_b == pytest.approx(6.214109, rel=SHOWN)
    assert alpha_c == pytest.approx(1.140662, rel=SHOWN)
    assert moment_resistance(INSIDE) == pytest.approx(1802.77008, rel=SHOWN)
    assert dnv_st_f201.plastic_tension(D, T2, FY, alpha_c) == pytest.approx(3544.674857, rel=SHOWN)


def test_resistances_under_less_internal_overpressure() -> None:
    """The sheet for external overpressure, with 3 ksi inside and 1 ksi outside."""
    assert moment_resistance(2.0) == pytest.approx(1759.625046, rel=SHOWN)
    p_b = dnv_st_f201.bursting_resistance(D, T2, FY, FU)
    alpha_c = dnv_st_f201.flow_stress_parameter(D, T2, FY, FU, 2.0, p_b)
    assert dnv_st_f201.plastic_tension(D, T2, FY, alpha_c) == pytest.approx(3459.841457, rel=SHOWN)


def test_design_moment() -> None:
    half = SectionEffects(np.zeros(1), np.array([-522.0]), np.zeros(1))
    effects = LoadEffects(half, half, SectionEffects(np.zeros(1), np.zeros(1), np.zeros(1)))
    moment, tension = design_effects(effects, dnv_st_f201.LOAD_FACTORS["ULS"])
    assert moment == pytest.approx(1252.8, rel=SHOWN)
    assert tension == pytest.approx(0.0)


def test_combined_loading_under_internal_overpressure() -> None:
    p_b, M_k = dnv_st_f201.bursting_resistance(D, T2, FY, FU), moment_resistance(INSIDE)
    used = dnv_st_f201.combined_internal(1252.8 / M_k, 0.0, INSIDE, p_b, HIGH)
    assert used == pytest.approx(0.999883, rel=SHOWN)
    without_factors = dnv_st_f201.combined_internal(1044.0 / M_k, 0.0, INSIDE, p_b, 1.0)
    assert without_factors == pytest.approx(0.740221, rel=SHOWN)


def test_combined_loading_under_external_overpressure() -> None:
    used = dnv_st_f201.combined_external(1207.908894 / 1759.625046, 0.0, 1.0, 2.507218511, HIGH)
    assert used == pytest.approx(1.000672, rel=SHOWN)


def test_hoop_buckling_of_a_26_inch_pipe() -> None:
    p_el = elastic_collapse_pressure(0.660, 0.0197, 2.07e11, 0.3)
    p_p = dnv_st_f201.plastic_collapse_pressure(0.660, 0.0197, 444e6, 0.85)
    p_c = dnv_st_f201.collapse_resistance(p_el, p_p, 0.005, 0.660, 0.0197)
    assert p_el == pytest.approx(12098341.0, rel=SHOWN)
    assert p_p == pytest.approx(22529636.4, rel=SHOWN)
    assert p_c == pytest.approx(10831164.1, rel=SHOWN)
    assert dnv_st_f201.hoop_buckling(4130696.7, 0.0, p_c, 1.15 * 1.14) == pytest.approx(0.500, abs=5e-4)


def test_propagating_buckling_of_a_26_inch_pipe() -> None:
    p_pr = dnv_st_f201.propagating_pressure(0.660, 0.0207, 444e6, 0.85)
    assert p_pr == pytest.approx(2301102.5, rel=SHOWN)
    assert dnv_st_f201.propagating_buckling(4130696.7, 0.0, p_pr, 1.15 * 1.14) == pytest.approx(2.353, abs=5e-4)


def test_burst_pressure_of_a_12_inch_pipe() -> None:
    allowed = 0.60 * api_std_2rd.burst_pressure(12.75, 0.5, 65300.0, 77500.0, 0.45)
    assert allowed == pytest.approx(3149.178164, rel=SHOWN)
    thin = 0.375 - 0.125  # of the example's corrosion allowance
    assert api_std_2rd.burst_pressure(12.75, thin, 65300.0, 77500.0, 0.45) * 0.60 > 1440.0


def test_stresses_of_a_9_inch_stress_joint() -> None:
    """The wall is as thick as it is nominally; the tension is effective, 556.227 kN."""
    outer, t, inside = 0.288925, 0.0508, 1.03e8
    wall_tension = 556227.0 + inside * 0.25 * np.pi * (outer - 2.0 * t) ** 2
    assert api_rp_2rd.radial_stress(outer, t, inside, 0.0) == pytest.approx(-40513333.3, rel=SHOWN)
    assert api_rp_2rd.hoop_stress(outer, t, inside, 0.0) == pytest.approx(189906250.0, rel=SHOWN)
    stress = api_rp_2rd.largest_stress(outer, t, t, wall_tension, 7679.624316, inside, 0.0)
    assert stress == pytest.approx(200348930.9, rel=SHOWN)
