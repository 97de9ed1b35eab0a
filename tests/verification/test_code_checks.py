"""Code checks of runs: utilisations recomputed by hand from the tension, moments and pressures in the results."""

from __future__ import annotations

import re
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.assembly import build
from riser_soil.cases.case_values import case_values
from riser_soil.checks.plausibility import physical_warnings
from riser_soil.errors import SceneError
from riser_soil.results import Run
from riser_soil.scene.problem import dotted
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.sizes import doubts
from riser_soil.scene.variants import at_offset
from tests.support.interrupted_run import differing, differing_rows, resumed, summary, whole
from tests.support.run_on_ranks import ran
from tests.support.runs import run_of
from tests.support.said import line_with
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene, static

D, BORE, T_CORR, T_FAB = 0.1143, 0.0801, 0.002, 0.0015  # m
T1, T2 = 0.5 * (D - BORE) - T_CORR - T_FAB, 0.5 * (D - BORE) - T_CORR
SMYS, SMTS, LOST = 4.48e8, 5.31e8, 2.0e7  # Pa
PRESSURE, DESIGN = 1.2e7, 1.5e7  # Pa
STEEL: Mapping = {"EA": 1.08e9, "EI": 1.31e6, "GJ": 1.0e6, "mass": 41.0, "outer_diameter": D, "inner_diameter": BORE}
STEEL |= {"wall": {}, "drag": {"normal": 1.0}, "added_mass": {"normal": 1.0}}
DNV: Mapping = {"kind": "dnv-st-f201", "safety_class": "normal", "yield_stress": SMYS, "tensile_strength": SMTS}
DNV |= {"corrosion_allowance": T_CORR, "fabrication_tolerance": T_FAB, "yield_derating": LOST, "ovality": 0.01}
DNV |= {"design_pressure": DESIGN, "fabrication_factor": 1.0}
GAMMA = 1.15 * 1.14
FY, FU = 0.96 * (SMYS - LOST), 0.96 * SMTS
API: Mapping = {"kind": "api-std-2rd", "case": "operating", "yield_stress": SMYS, "tensile_strength": SMTS}
API |= {"corrosion_allowance": T_CORR, "burst_factor": 0.6, "collapse_factor": 0.7}
LOW = 3.0e5  # Pa
RP: Mapping = {"kind": "api-rp-2rd", "case": "extreme", "yield_stress": SMYS, "yield_derating": LOST}
RP |= {"corrosion_allowance": T_CORR, "fabrication_tolerance": T_FAB, "design_pressure": LOW}


def hanging(*checks: Mapping, pipe: Mapping = STEEL, water: float = 100.0, **pressure: float) -> Mapping:
    """A steel pipe from a spring bed to a floater that pulls it sideways, and heaves."""
    heaves = {"end": {"harmonic": {"amplitude": [0.0, 0.5, 1.5], "period": 4.0, "ramp": 2.0}}}
    across = {"loads": [{"at": 75.0, "force": [0.0, 3.0e3, 0.0]}]}
    scene = riser_scene(
        static("hang"),
        static("current", **across),
        dynamic(3.0, 0.25, "heave", motion=heaves, **across),
        pipe=pipe,
        length=150.0,
        elements=30,
        start=prescribed(0.0, 0.0, 0.06),
        end=prescribed(85.0, 0.0, 100.0),
        riser={"contents": {"density": 850.0, "pressure": PRESSURE} | pressure},
        gravity=9.81,
        dimension=3,
        water={"density": 1025.0, "surface_level": water},
        seabed={"kind": "spring", "stiffness": 1.0e5},
    )
    return scene | {"code_check": list(checks)}


@pytest.fixture(scope="module")
def dnv(tmp_path_factory: pytest.TempPathFactory) -> Run:
    check = DNV | {"functional_stage": "hang"}
    return run_of(hanging(check), tmp_path_factory.mktemp("dnv") / "run")


def worst(functional: np.ndarray, environmental: np.ndarray) -> np.ndarray:
    """Size of the design effect, of vectors (2, ...)."""
    sums = [F * functional + E * environmental for F in (1.1, 1.0 / 1.1) for E in (1.3, 1.0 / 1.3)]
    return np.max([np.hypot(*each) for each in sums], axis=0)


def apart(done: Run) -> tuple[np.ndarray, np.ndarray]:
    """Size of design moment and tension (nt, nn): what comes after the first record is environmental."""
    moments = np.stack([done["bending_moment_y"], done["bending_moment_z"]])
    pulls = np.stack([done["effective_tension"], 0.0 * done["effective_tension"]])
    moment, pull = (worst(each[:, :1], each - each[:, :1]) for each in (moments, pulls))
    return moment, pull


def collapse(t: float) -> float:
    """The least root of the code's equation, as a polynomial's."""
    p_el, p_p = 2.0 * 2.07e11 * (t / D) ** 3 / 0.91, 2.0 * t / D * FY
    roots = np.roots([1.0, -p_el, -(p_p**2 + p_el * p_p * 0.01 * D / t), p_el * p_p**2])
    return float(min(root.real for root in roots if root.real > 0.0))


def test_pressures_against_bursting_and_buckling(dnv: Run) -> None:
    inside, outside = dnv["internal_pressure"] + DESIGN - PRESSURE, dnv["external_pressure"]
    bursts = 2.0 / np.sqrt(3.0) * 2.0 * T1 / (D - T1) * min(FY, FU / 1.15)
    expected = GAMMA * np.maximum(inside + 0.1 * DESIGN - outside, 0.0) / bursts
    assert dnv["bursting_utilisation"] == pytest.approx(expected, rel=1e-12)
    assert dnv["hoop_buckling_utilisation"] == pytest.approx(GAMMA * outside / collapse(T1), rel=1e-9)
    propagates = 35.0 * FY * (T2 / D) ** 2.5
    assert dnv["propagating_buckling_utilisation"] == pytest.approx(GAMMA * outside / propagates, rel=1e-12)


def test_combined_loading(dnv: Run) -> None:
    """The larger of what the code says of the design pressure inside, and of an empty pipe."""
    moment, tension = apart(dnv)
    over, outside = dnv["internal_pressure"] + DESIGN - PRESSURE - dnv["external_pressure"], dnv["external_pressure"]
    bursts = 2.0 / np.sqrt(3.0) * 2.0 * T2 / (D - T2) * min(FY, FU / 1.15)

    def shares(q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        beta = (0.4 + 2.0 / np.sqrt(3.0) * q) * min((60.0 - D / T2) / 45.0, 1.0)
        strength = FY * (1.0 - beta) + FU * beta
        return moment / (strength * (D - T2) ** 2 * T2), tension / (strength * np.pi * (D - T2) * T2)

    (m, T), q = shares(over / bursts), over / bursts
    internal = GAMMA * (m * np.sqrt(1.0 - q**2) + T**2) + q**2
    m, T = shares(0.0 * over)
    external = GAMMA**2 * ((m + T**2) ** 2 + (outside / collapse(T2)) ** 2)
    assert (over > 0.0).all()
    expected = np.maximum(internal, external * (outside > 0.0))
    assert dnv["combined_loading_utilisation"] == pytest.approx(expected, rel=1e-9)
    both = [dnv[f"{name}_utilisation"] for name in ("bursting", "hoop_buckling", "propagating_buckling")]
    expected = np.max([*both, dnv["combined_loading_utilisation"]], axis=0)
    assert dnv["code_utilisation"] == pytest.approx(expected, rel=1e-15)


def test_the_second_moment_counts(dnv: Run) -> None:
    """The pull across the plane bends the pipe about the other axis, or a test of both would see one."""
    at = np.abs(dnv["bending_moment_z"][1]).max(), np.abs(dnv["bending_moment_y"][1]).max()
    assert at[0] > 0.1 * at[1]


def test_summary_has_the_largest_of_each_check(dnv: Run) -> None:
    for number, stage in enumerate(dnv.summary["stages"]):
        names = [each["check"] for each in stage["code_check"]]
        assert names == ["bursting", "hoop buckling", "propagating buckling", "combined loading"]
        own = dnv["stage"] == number
        for each in stage["code_check"]:
            facts = [each[key] for key in ("line_type", "code", "limit_state", "safety_class", "exceeded")]
            assert facts == ["pipe", "DNV-ST-F201", "ULS", "normal", each["utilisation"] > 1.0]
            figure = stage["extremes"][f"max_{each['variable']}"]
            assert stage["kind"] != "static" or (each["utilisation"], each["arc"]) == (figure["max"], figure["arc_max"])
            assert each["utilisation"] >= dnv[each["variable"]][own].max() - 1e-15
    heave = dnv.summary["stages"][-1]["code_check"][-1]
    used = dnv["combined_loading_utilisation"][dnv["stage"] == 2]
    at, node = np.unravel_index(used.argmax(), used.shape)
    assert heave["utilisation"] == pytest.approx(used[at, node], rel=1e-15)
    assert (heave["arc"], heave["time"]) == (dnv.arc[node], pytest.approx(dnv["time"][dnv["stage"] == 2][at]))


def test_load_cases_have_the_utilisations(dnv: Run) -> None:
    values = {value.key: value for value in case_values(dnv.folder, 0.0)}
    for stage in dnv.summary["stages"]:
        for each in stage["code_check"]:
            value = values[f"{stage['name']}: {each['variable'].replace('_', ' ')}"]
            assert (value.value, value.unit, value.sign) == (each["utilisation"], "1", "")
    sample = values["heave: combined loading utilisation"].sample
    assert sample is not None
    assert (sample.value, sample.least) == (values["heave: combined loading utilisation"].value, False)


def test_largest_utilisation_is_not_made_of_largest_moment_and_tension(dnv: Run) -> None:
    """Taken apart in time they would give more: each instant is checked by itself."""
    moment, tension = apart(dnv)
    own = dnv["stage"] == 2
    together = np.argmax(moment[own], axis=0) == np.argmax(tension[own], axis=0)
    assert not together.all()


def test_functional_effects_are_those_of_the_last_static_stage_by_default(dnv: Run, tmp_path: Path) -> None:
    other = run_of(hanging(DNV), tmp_path / "run")
    assert other["effective_tension"] == pytest.approx(dnv["effective_tension"], rel=1e-12)
    first, second = (each["combined_loading_utilisation"] for each in (dnv, other))
    assert second[0] == pytest.approx(first[0], rel=1e-12)
    assert (np.abs(second[1] - first[1]) > 1e-6).any()  # the current's effects were environmental there
    assert second[1].max() < first[1].max()


IN_CURRENT: Mapping = {"density": 1025.0, "surface_level": 100.0}
IN_CURRENT |= {"current": {"profile": [[0.0, 0.1, 0.2], [100.0, 0.6, 0.4]]}}


@pytest.fixture(scope="module")
def still(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Without current, at rest."""
    scene = hanging()
    scene["stages"] = scene["stages"][:1]
    return run_of(scene, tmp_path_factory.mktemp("still") / "run")


def test_functional_effects_of_a_run_without_current(still: Run, tmp_path: Path) -> None:
    scene = hanging(DNV | {"functional_run": str(still.folder), "minimum_pressure": "contents"})
    scene["water"] = IN_CURRENT
    assert not [each for each in warnings_of(scene) if "current" in each]
    done = run_of(scene, tmp_path / "run")
    moments, pulls = (
        [np.stack([run[name][-1:] if run is still else run[name] for name in names]) for run in (still, done)]
        for names in (("bending_moment_y", "bending_moment_z"), ("effective_tension",) * 2)
    )
    M_d = worst(moments[0], moments[1] - moments[0])
    T_d = worst(pulls[0], pulls[1] - pulls[0]) / np.sqrt(2.0)
    q = (done["internal_pressure"] + DESIGN - PRESSURE - done["external_pressure"]) / (
        2.0 / np.sqrt(3.0) * 2.0 * T2 / (D - T2) * min(FY, FU / 1.15)
    )
    beta = (0.4 + 2.0 / np.sqrt(3.0) * q) * min((60.0 - D / T2) / 45.0, 1.0)
    strength = FY * (1.0 - beta) + FU * beta
    m, T = M_d / (strength * (D - T2) ** 2 * T2), T_d / (strength * np.pi * (D - T2) * T2)
    expected = GAMMA * (m * np.sqrt(1.0 - q**2) + T**2) + q**2
    assert done["combined_loading_utilisation"] == pytest.approx(expected, rel=1e-9)
    by_stage = run_of(scene | {"code_check": [DNV | {"minimum_pressure": "contents"}]}, tmp_path / "other")
    assert by_stage["combined_loading_utilisation"][0].max() < 0.995 * expected[0].max()


def test_a_current_that_counts_as_functional_is_a_warning() -> None:
    scene = hanging(DNV)
    scene["water"] = IN_CURRENT
    warnings = warnings_of(scene)
    line_with(warnings, "code_check.0", "a current acts in all stages", "factor of 1.1", "functional_run")


def test_an_offset_that_counts_as_functional_is_a_warning() -> None:
    scene = hanging(DNV)
    assert not [each for each in warnings_of(scene) if "functional_run" in each]
    moved = at_offset(scene_from_mapping(scene | {"vessel": {"offset": [4.0, 0.0]}}))
    warnings = [*physical_warnings(build(moved, MPI.COMM_SELF))]
    line_with(warnings, "code_check.0", "first stage, hang, moves an end", "offset", "factor of 1.1", "functional_run")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"segments": [{"line_type": "pipe", "length": 150.0, "elements": 29}]}, "other nodes"),
        ({}, ""),
    ],
)
def test_a_functional_run_has_the_same_nodes(change: Mapping, message: str, still: Run, tmp_path: Path) -> None:
    scene = hanging(DNV | {"functional_run": str(still.folder)})
    scene["riser"] |= change
    scene["stages"] = scene["stages"][:1]
    if not message:
        assert run_of(scene, tmp_path / "run").summary["finished"]
        return
    with pytest.raises(SceneError, match=rf"code_check\.0\.functional_run.*{message}"):
        run_of(scene, tmp_path / "run")
    assert not (tmp_path / "run" / "results.nc").exists()


def test_a_functional_run_has_moments(tmp_path: Path) -> None:
    plain = hanging(pipe={key: value for key, value in STEEL.items() if key != "wall"})
    plain["stages"] = plain["stages"][:1]
    done = run_of(plain, tmp_path / "plain")
    with pytest.raises(SceneError, match=r"functional_run.*no bending_moment_y.*wall"):
        run_of(hanging(DNV | {"functional_run": str(done.folder)}), tmp_path / "run")


def test_accidental_effects_have_a_factor_of_their_own(tmp_path: Path) -> None:
    """In ALS all factors are 1: with any share of stages the design effects are those of the run."""
    check = DNV | {"limit_state": "ALS", "functional_stage": "hang", "accidental_stage": "current"}
    done = run_of(hanging(check), tmp_path / "run")
    inside, outside = done["internal_pressure"] + DESIGN - PRESSURE, done["external_pressure"]
    bursts = 2.0 / np.sqrt(3.0) * 2.0 * T2 / (D - T2) * min(FY, FU / 1.15)
    q = (inside - outside) / bursts
    beta = (0.4 + 2.0 / np.sqrt(3.0) * q) * min((60.0 - D / T2) / 45.0, 1.0)
    strength = FY * (1.0 - beta) + FU * beta
    m = np.hypot(done["bending_moment_y"], done["bending_moment_z"]) / (strength * (D - T2) ** 2 * T2)
    T = done["effective_tension"] / (strength * np.pi * (D - T2) * T2)
    internal = GAMMA * (m * np.sqrt(1.0 - q**2) + T**2) + q**2
    top = done["position"][..., 2] > 60.0  # where the pressure outside does not govern
    assert done["combined_loading_utilisation"][top] == pytest.approx(internal[top], rel=1e-9)


@pytest.mark.parametrize("method", [1, 2])
def test_api_by_both_methods(method: int, tmp_path: Path) -> None:
    check = API | {"method": method, "design_factor": 0.75, "minimum_pressure": "contents"}
    done = run_of(hanging(check, pressure=0.0), tmp_path / "run")
    inside, outside = done["internal_pressure"], done["external_pressure"]
    t = T2 + T_CORR
    bursts = 0.45 * (SMYS + SMTS) * np.log(D / (D - 2.0 * T2))
    p_y, p_el = 2.0 * SMYS * T2 / D, 2.0 * 2.07e11 * (T2 / D) ** 3 / 0.91
    collapses = p_y * p_el / np.sqrt(p_y**2 + p_el**2)
    assert done["bursting_utilisation"] == pytest.approx(np.maximum(inside - outside, 0.0) / (0.6 * bursts), abs=1e-14)
    assert done["hoop_buckling_utilisation"] == pytest.approx(
        np.maximum(outside - inside, 0.0) / (0.7 * collapses), abs=1e-14
    )
    q = np.where(inside > outside, (inside - outside) / bursts, (outside - inside) / collapses)
    T = np.abs(done["effective_tension"]) / (SMYS * np.pi * (D - t) * t)
    m = np.hypot(done["bending_moment_y"], done["bending_moment_z"]) / (SMYS * (D - t) ** 2 * t)
    used = done["combined_loading_utilisation"]
    if method == 1:
        assert used == pytest.approx(np.hypot(T + 4.0 / np.pi * m, q) / 0.75, rel=1e-9)
        return
    s = np.sqrt(np.maximum((0.75 * used) ** 2 - q**2, 1e-30))  # loads over their utilisation lie on the curve
    assert s * np.cos(0.5 * np.pi * T / s) == pytest.approx(m, rel=1e-6, abs=1e-12)


def test_api_design_factors_by_case(tmp_path: Path) -> None:
    """Method 2 has the factors of method 1: 0.8 in operation, 1 in survival."""
    used = []
    for case in ("operating", "survival"):
        scene = hanging(API | {"method": 2, "case": case, "minimum_pressure": "contents"})
        scene["stages"] = scene["stages"][:1]
        used.append(run_of(scene, tmp_path / case)["combined_loading_utilisation"])
    assert used[0] == pytest.approx(used[1] / 0.8, rel=1e-12)


def von_mises_of_wall(done: Run, inside: np.ndarray, area: float, I: float) -> np.ndarray:
    """Largest of both sides of the bend [Pa], in the middle of the wall."""
    outside, t = done["external_pressure"], 0.5 * (D - BORE)
    tension = done["effective_tension"] + 0.25 * np.pi * (inside * BORE**2 - outside * D**2)
    bent = np.hypot(done["bending_moment_y"], done["bending_moment_z"]) * 0.5 * (D - t) / I
    hoop = (inside - outside) * D / (2.0 * T1) - inside
    radial = -(outside * D + inside * BORE) / (D + BORE)
    stresses = []
    for axial in (tension / area + bent, tension / area - bent):
        stresses.append(np.sqrt(0.5 * ((axial - hoop) ** 2 + (hoop - radial) ** 2 + (radial - axial) ** 2)))
    return np.max(stresses, axis=0)


COATED = 0.15  # m, of the coat, which bears the water on itself


def test_von_mises_stress_by_api_rp_2rd(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Stress of a coated pipe, the larger under the design pressure and empty; all recorded instants."""
    coated = STEEL | {"outer_diameter": COATED, "wall": {"outer_diameter": D}}
    done = run_of(hanging(RP, pipe=coated, pressure=0.0), tmp_path / "run")
    area, I = 0.25 * np.pi * (D**2 - BORE**2), np.pi / 64.0 * (D**4 - BORE**4)
    design = done["internal_pressure"] + LOW
    under = [von_mises_of_wall(done, inside, area, I) for inside in (design, 0.0 * design)]
    expected = np.max(under, axis=0) / (1.2 * 2.0 / 3.0 * (SMYS - LOST))
    assert done["combined_loading_utilisation"] == pytest.approx(expected, rel=1e-9)
    assert done["code_utilisation"] == pytest.approx(expected, rel=1e-9)
    assert (under[1] > under[0]).any()
    assert (under[1] < under[0]).any()
    (check,) = done.summary["stages"][-1]["code_check"]
    facts = [check[key] for key in ("code", "check", "limit_state", "safety_class")]
    assert facts == ["API RP 2RD", "von Mises stress", "extreme", ""]
    assert "table 2" in check["clause"]
    assert "code: combined loading" in capsys.readouterr().out


def test_a_pipe_without_strength_in_tension_is_checked_by_stress() -> None:
    """The code asks for the yield stress alone, and for any slenderness: it knows no collapse."""
    slim = RP | {"corrosion_allowance": 0.0, "fabrication_tolerance": 0.0}
    assert scene_from_mapping(hanging(slim, pipe=SLIM)).code_check
    for key in ("tensile_strength", "E", "method"):
        with pytest.raises(SceneError, match=rf"code_check\.0\.{key}.*no such key"):
            scene_from_mapping(hanging(RP | {key: 5.0e8}))


def test_each_line_type_by_its_own_code(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Lower half flexible, its bend radius by the kind of stage; upper half by a capacity curve."""
    flexible = STEEL | {"EI": 1.0e5}
    limits = {"static_radius": 10.0, "dynamic_radius": 20.0, "max_tension": 1.0e5, "max_compression": 1.0e4}
    checks = (
        {"kind": "flexible-pipe", "line_types": ["flexible"], "max_contact_force": 500.0, **limits},
        {"kind": "capacity-curve", "line_types": ["pipe"], "curve": [[0.0, 0.01], [2.0e4, 0.0]]},
    )
    scene = hanging(*checks)
    scene["line_types"]["flexible"] = flexible
    half = {"length": 75.0, "elements": 15}
    scene["riser"]["segments"] = [{"line_type": name} | half for name in ("flexible", "pipe")]
    done = run_of(scene, tmp_path / "run")
    bent, moving = done["bend_radius_utilisation"], done["stage"] == 2
    assert np.isnan(bent).all(axis=0).tolist() == [False] * 16 + [True] * 15
    radius = np.where(moving, 20.0, 10.0)[:, None]
    assert bent[:, :15] == pytest.approx(done["curvature"][:, :15] * radius, rel=1e-6)
    T = done["effective_tension"][:, :16]
    assert done["tension_limit_utilisation"][:, :16] == pytest.approx(np.maximum(T, 0.0) / 1.0e5, rel=1e-12)
    assert done["compression_utilisation"][:, :16] == pytest.approx(np.maximum(-T, 0.0) / 1.0e4, rel=1e-12)
    pressed = done["contact_force"][:, :16]
    assert done["crushing_utilisation"][:, :16] == pytest.approx(np.maximum(pressed, 0.0) / 500.0, rel=1e-12)
    T, kappa = done["effective_tension"][:, 16:], done["curvature"][:, 16:]
    straight = np.maximum(T, 0.0) / 2.0e4 + kappa / 0.01
    assert done["capacity_curve_utilisation"][:, 16:] == pytest.approx(straight, rel=1e-6)
    (warning,) = [each for each in done.summary["stages"][0]["warnings"] if "capacity curve" in each]
    check = done.summary["stages"][0]["code_check"][-1]
    line_with([warning], "pipe", f"{check['utilisation']:.4g} times", f"arc {check['arc']:.5g} m")
    assert "code: capacity curve" in capsys.readouterr().out


@pytest.mark.verify
def test_two_ranks_find_the_same(dnv: Run, tmp_path: Path) -> None:
    two = ran(hanging(DNV | {"functional_stage": "hang"}), tmp_path / "two", ranks=2)
    for name in ("combined_loading_utilisation", "hoop_buckling_utilisation", "code_utilisation"):
        assert two[name] == pytest.approx(dnv[name], rel=1e-6)


def test_a_run_goes_on_with_what_was_functional(tmp_path: Path) -> None:
    scene = scene_from_mapping(hanging(DNV | {"functional_stage": "hang"}))
    kept = whole(scene, tmp_path / "whole", (5,))
    again = resumed(scene, tmp_path / "rest", kept.states[5])
    assert differing(kept.last, again.last) == []
    assert differing_rows(tmp_path / "whole", tmp_path / "rest") == []
    checked = [summary(tmp_path / name)["stages"][-1]["code_check"] for name in ("whole", "rest")]
    assert checked[0] == checked[1]


def test_without_a_check_nothing_of_it_is_there(tmp_path: Path) -> None:
    scene = hanging()
    scene["stages"] = scene["stages"][:1]
    done = run_of(scene, tmp_path / "run")
    assert not [name for name in done.variables if name.startswith(("code", "bursting", "combined"))]
    assert "code_check" not in done.summary["stages"][0]
    assert done.summary["parts"]["left_out"]["code check"] == "the scene has no code_check"


SLIM = STEEL | {"inner_diameter": 0.11, "mass": 6.0, "EA": 1.5e8, "EI": 2.3e5}


@pytest.mark.parametrize(
    ("change", "pipe", "message"),
    [
        ({"corrosion_allowance": 0.016}, STEEL, r"code_check\.0\.corrosion_allowance.*0\.0171 m thick"),
        ({"corrosion_allowance": 0.0, "fabrication_tolerance": 0.0}, SLIM, "D/t = 45.*53.16"),
        ({"line_types": ["pope"]}, STEEL, r"code_check\.0\.line_types\.0.*one of them.*pipe"),
        ({"functional_stage": "hung"}, STEEL, r"code_check\.0\.functional_stage.*hang, current, heave"),
        ({"limit_state": "SLS"}, STEEL, "material_factor.*not built in for SLS"),
        ({"accidental_stage": "heave"}, STEEL, "accidental_stage.*no factor for accidental load effects in ULS"),
        ({"ovality": 0.001}, STEEL, "ovality.*at least 0.005"),
        ({"tensile_strength": 4.0e8}, STEEL, "tensile_strength.*not be below yield_stress"),
        ({"safety": "high"}, STEEL, "code_check.0.safety.*no such key"),
        ({"kind": "dnv"}, STEEL, "code_check.0.kind.*dnv-st-f201, api-std-2rd"),
    ],
)
def test_what_a_code_says_nothing_of_is_refused(change: Mapping, pipe: Mapping, message: str) -> None:
    with pytest.raises(SceneError, match=message) as refused:
        scene_from_mapping(hanging(DNV | change, pipe=pipe))
    assert len(str(refused.value).splitlines()) == 1


def test_accident_before_what_is_functional_is_refused() -> None:
    check = DNV | {"limit_state": "ALS", "functional_stage": "current", "accidental_stage": "hang"}
    with pytest.raises(SceneError, match=r"accidental_stage.*must come after functional_stage"):
        scene_from_mapping(hanging(check))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"yield_stress": 448.0, "tensile_strength": 531.0}, "yield_stress: 448 Pa.*MPa"),
        ({"corrosion_allowance": 3.0, "fabrication_tolerance": 1.5}, "corrosion_allowance: 3 m.*mm"),
        ({"design_pressure": 345.0}, "design_pressure: 345 Pa.*bar"),
    ],
)
def test_other_units_are_named(change: Mapping, message: str) -> None:
    (check,) = hanging(DNV | {"yield_derating": 0.0} | change)["code_check"]
    texts = [f"{dotted(path)}: {text}" for path, text in doubts({"code_check": [check]})]
    assert any(re.search(message, each) for each in texts)
    assert not doubts({"code_check": [DNV]})


def warnings_of(scene: Mapping) -> list[str]:
    warnings = physical_warnings(build(scene_from_mapping(scene), MPI.COMM_SELF))
    return [each for each in warnings if each.startswith("code_check")]


def test_what_is_doubtful_is_a_warning() -> None:
    """D/t2 of 7.57, below the range of the propagation formula; a line type that no check is for; no static stage."""
    (thick,) = warnings_of(hanging(DNV))
    line_with([thick], "code_check.0", "pipe", "D/t = 7.57", "propagating buckling", "from 15")
    scene = hanging(API | {"line_types": ["other"]})
    scene["line_types"]["other"] = STEEL
    (missing,) = warnings_of(scene)
    line_with([missing], "no check is for pipe")
    scene = hanging(DNV)
    scene["stages"] = scene["stages"][2:]
    _, first = warnings_of(scene)
    line_with([first], "code_check.0", "no static stage comes before heave")


def test_two_yield_stresses_of_one_pipe_are_a_warning() -> None:
    warnings = warnings_of(hanging(DNV, pipe=STEEL | {"wall": {"yield_stress": 4.15e8}}))
    line_with(warnings, "code_check.0", "4.48e+08 Pa", "line_types.pipe.wall", "4.15e+08 Pa")
    assert len(warnings_of(hanging(DNV, pipe=STEEL | {"wall": {"yield_stress": SMYS}}))) == len(warnings) - 1


def test_line_types_without_a_bore_may_stand_beside_checked_ones() -> None:
    """A chain in the same line, of which no wall is known."""
    scene = hanging(DNV | {"line_types": ["pipe"], "corrosion_allowance": 0.0})
    scene["line_types"]["chain"] = {"EA": 1.0e8, "EI": 0.0, "GJ": 1.0, "mass": 50.0, "outer_diameter": 0.1}
    half = {"length": 75.0, "elements": 15}
    scene["riser"]["segments"] = [{"line_type": name} | half for name in ("chain", "pipe")]
    line_with(warnings_of(scene), "no check is for chain")


def test_the_pressure_outside_is_known_of_all_line_types() -> None:
    """Without an outer diameter of each, no pressure would be known anywhere, and none would count."""
    scene = hanging(DNV | {"line_types": ["pipe"]}, pipe={key: value for key, value in STEEL.items() if key != "wall"})
    scene["line_types"]["chain"] = {"EA": 1.0e8, "EI": 0.0, "GJ": 1.0, "mass": 50.0, "submerged_weight": 400.0}
    scene["seabed"] |= {"contact_at": "axis"}
    half = {"length": 75.0, "elements": 15}
    scene["riser"]["segments"] = [{"line_type": name} | half for name in ("chain", "pipe")]
    with pytest.raises(SceneError, match=r"line_types\.chain\.outer_diameter.*code check"):
        scene_from_mapping(scene)


def test_a_line_type_checked_twice_is_refused() -> None:
    with pytest.raises(SceneError, match=r"code_check\.1\.line_types.*already checked"):
        scene_from_mapping(hanging(DNV, API))


def test_pressure_outside_is_needed() -> None:
    scene = deepcopy(hanging(DNV, pipe={key: value for key, value in STEEL.items() if key != "wall"}))
    del scene["water"]["surface_level"]
    with pytest.raises(SceneError, match=r"code_check\.0.*water\.surface_level"):
        scene_from_mapping(scene)


@pytest.mark.parametrize(
    ("check", "message"),
    [
        ({"kind": "flexible-pipe"}, "checks nothing without a limit"),
        ({"kind": "flexible-pipe", "storage_radius": 3.0, "dynamic_radius": 2.0}, "dynamic_radius.*below storage"),
        ({"kind": "capacity-curve", "curve": [[1.0, 0.1], [2.0, 0.0]]}, "tension 0 or less"),
        ({"kind": "capacity-curve", "curve": [[0.0, 0.1], [0.0, 0.0]]}, "must increase"),
        ({"kind": "capacity-curve", "curve": [[0.0, 0.1], [1.0, 0.0], [2.0, 0.1]]}, "each ray"),
        ({key: value for key, value in RP.items() if key != "case"}, r"code_check\.0\.case"),
        (RP | {"corrosion_allowance": 0.016}, "leaves nothing of the wall of pipe"),
        (RP | {"yield_derating": 4.5e8}, r"yield_derating.*below the strength \(4.48e\+08 Pa\)"),
        (API | {"case": "storm"}, "case.*operating, extreme, survival"),
    ],
)
def test_incomplete_checks_are_refused(check: Any, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        scene_from_mapping(hanging(check))
