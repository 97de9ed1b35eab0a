"""Stress cases of lines at rest that hang: little bending stiffness, great axial stiffness, meshes, sizes, slack."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from riser_soil.results import Run
from tests.robustness.stress.bounds import Answer, near
from tests.robustness.stress.case import Trial, one, stress_case
from tests.robustness.stress.closed_forms import hanging
from tests.support.scenes import Mapping, prescribed, riser_scene, static

W = 500.0  # N/m


def rope(EI: float, EA: float = 1e8, scale: float = 1.0, w: float = W, **more: object) -> Mapping:
    """100 m between supports 80 m apart and 30 m above each other, all lengths times `scale`, the rest as given."""
    s = scale
    options: Mapping = {"gravity": 9.81, "elements": 100} | more
    return riser_scene(
        static(),
        pipe={"EA": EA, "EI": EI, "submerged_weight": w, "outer_diameter": 0.2 * s},
        length=100.0 * s,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(80.0 * s, 0.0, 30.0 * s),
        **options,
    )


def top(run: Run) -> tuple[float, float]:
    """H and tension at the end."""
    end = run.summary["stages"][-1]["final"]["end"]
    return float(end["force"][0]), float(end["effective_tension"])


def catenary(
    EA: float = 1e8, scale: float = 1.0, rel: float = 1e-3, w: float = W
) -> Callable[[Run], Iterator[Answer]]:
    """Answers of `rope`."""

    def answers(run: Run) -> Iterator[Answer]:
        exact = hanging(80.0 * scale, 30.0 * scale, 100.0 * scale, w, EA)
        H, T = top(run)
        yield near("H [N]", H, exact.H, rel=rel)
        yield near("top tension [N]", T, exact.T_end, rel=rel)

    return answers


@stress_case(quick=True)
def hanging_line_EI_1e_9() -> Trial:
    """EI = 1e-9 N.m2 in a line of 100 m: the elastic catenary."""
    return one(rope(1e-9), catenary())


@stress_case(quick=True)
def hanging_line_EI_0() -> Trial:
    """EI = 0, a chain: the elastic catenary."""
    return one(rope(0.0), catenary())


@stress_case()
def EA_over_EI_of_1e12() -> Trial:
    """EA = 1e12 N, EI = 1 N.m2: the catenary, hardly elastic (T/EA = 5e-8)."""
    return one(rope(1.0, EA=1e12), catenary(EA=1e12))


@stress_case()
def EA_over_EI_of_1e18() -> Trial:
    """EA = 1e15 N, EI = 1e-3 N.m2: the catenary."""
    return one(rope(1e-3, EA=1e15), catenary(EA=1e15))


@stress_case()
def elements_from_20_mm_to_20_m() -> Trial:
    """Elements that grow from 0.02 m to 20 m along 2 km, 1 : 1000: the catenary, its ends 1.6 km and 0.6 km apart."""
    scene = rope(100.0, scale=20.0)
    scene["riser"]["segments"] = [{"line_type": "pipe", "length": 2000.0, "element_length": [0.02, 20.0]}]
    return one(scene, catenary(scale=20.0))


def long_line(elements: int) -> Mapping:
    """10 km of pipe, 6 km wide and 7 km high; EI = 5e4 N.m2."""
    return riser_scene(
        static(),
        pipe={"EA": 1e9, "EI": 5e4, "submerged_weight": W, "outer_diameter": 0.3},
        length=10e3,
        elements=elements,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(6e3, 0.0, 7e3),
        gravity=9.81,
    )


def _long_line(run: Run) -> Iterator[Answer]:
    """The moment of the sag bend is EI/a, a = H/w, as EI/(w a^3) = 3e-8."""
    exact = hanging(6e3, 7e3, 10e3, W, 1e9)
    H, T = top(run)
    yield near("H [N]", H, exact.H, rel=1e-4)
    yield near("top tension [N]", T, exact.T_end, rel=1e-4)
    moment = run.summary["stages"][-1]["final"]["max_bending_moment"]["value"]
    yield near("largest moment [N.m]", moment, 5e4 * W / exact.H, rel=0.03)


@stress_case()
def ten_km_line_of_400_elements() -> Trial:
    """10 km: H and top tension of the catenary, moment EI w/H in the sag bend."""
    return one(long_line(400), _long_line)


@stress_case(quick=True)
def ten_km_line_of_40_elements() -> Trial:
    """Ten kilometres of line with elements of 250 m, a third of a = H/w: right, or told that the elements are too long
    for the bend.
    """
    return one(long_line(40), _long_line, r"warning: .*element")


@stress_case()
def thread_of_10_mm() -> Trial:
    """10 mm of thread, 0.1 N/m, EA = 10 N, EI = 1e-14 N.m2: the elastic catenary."""
    return one(rope(1e-14, EA=10.0, scale=1e-4, w=0.1), catenary(EA=10.0, scale=1e-4, w=0.1))


@stress_case(quick=True)
def ends_of_a_line_together() -> Trial:
    """100 m of line hang from two points 1 m apart on one level: each bears half the weight, w L/2 = 25 kN, to
    (H/V)^2/2 of it; H from the catenary to what the bend at the bottom, EI/(w a^3) = 0.1, may change.
    """
    scene = rope(1.0, elements=400)
    scene["riser"] |= {"end": prescribed(1.0, 0.0, 0.0)}

    def answers(run: Run) -> Iterator[Answer]:
        end = run.summary["stages"][-1]["final"]["end"]
        yield near("vertical force at the end [N]", end["force"][2], 50.0 * W, rel=1e-6)
        yield near("top tension [N]", end["effective_tension"], 50.0 * W, rel=1e-4)
        yield near("height of the bottom [m]", float(run["position"][-1][:, 2].min()), -49.75, within=0.3)

    return one(scene, answers)


@stress_case()
def line_stretched_by_2_per_cent() -> Trial:
    """Ends 1.02 L apart: the elastic catenary, with T some EA/50."""
    scene = rope(10.0)
    scene["riser"] |= {"end": prescribed(102.0, 0.0, 0.0)}

    def answers(run: Run) -> Iterator[Answer]:
        yield near("H [N]", top(run)[0], hanging(102.0, 0.0, 100.0, W, 1e8).H, rel=1e-4)

    return one(scene, answers)


@stress_case()
def vertical_line_of_no_slack() -> Trial:
    """100 m of line hang straight down between supports 100 m above each other: stretched by its weight, T at the top
    is w L/2, at the bottom -w L/2, from EA du/ds = T and u = 0 at both ends. Its lower half would buckle, as EI is 1
    N.m2: it bows out and bears no more than the bar; so the top bears at least half the weight and at most all of it.
    """
    scene = rope(1.0)
    scene["riser"] |= {"end": prescribed(0.0, 0.0, 100.0)}

    def answers(run: Run) -> Iterator[Answer]:
        T = top(run)[1]
        yield Answer("top tension [N]", T, 50.0 * W * (1.0 - 1e-6), 100.0 * W * (1.0 + 1e-6))

    return one(scene, answers)


@stress_case(quick=True)
def line_that_floats_up() -> Trial:
    """w = -500 N/m, lighter than the water: the catenary upside down, H as of a heavy line with its ends exchanged."""
    scene = rope(10.0)
    scene["line_types"]["pipe"]["submerged_weight"] = -W
    arch = [[0.0, 0.0, 0.0], [10.0, 0.0, 26.0], [40.0, 0.0, 45.0], [80.0, 0.0, 30.0]]
    scene["riser"]["initial"] = {"points": arch}

    def answers(run: Run) -> Iterator[Answer]:
        exact = hanging(80.0, -30.0, 100.0, W, 1e8)
        H, _ = top(run)
        yield near("H [N]", H, exact.H, rel=2e-3)
        end = run.summary["stages"][-1]["final"]["end"]
        yield near("vertical force at the end [N]", end["force"][2], -exact.V_end, rel=2e-3)

    return one(scene, answers, r"lighter|buoyan|float")


@stress_case()
def stretched_in_zero_gravity() -> Trial:
    """No gravity: ends moved 0.1 % apart, T = EA/1000 exactly along the whole line."""
    scene = rope(1e5)
    scene |= {"gravity": 0.0}
    scene["line_types"]["pipe"]["submerged_weight"] = 0.0
    scene["riser"] |= {"end": prescribed(100.0, 0.0, 0.0)}
    scene["stages"] = [static(move={"end": [100.1, 0.0, 0.0]})]

    def answers(run: Run) -> Iterator[Answer]:
        T = run["effective_tension"][-1]
        yield near("least tension [N]", T.min(), 1e5, rel=1e-6)
        yield near("largest tension [N]", T.max(), 1e5, rel=1e-6)

    return one(scene, answers)


@stress_case()
def pressure_of_1000_bar() -> Trial:
    """Inner pressure of 1e8 Pa in a bore of 0.1 m: the effective tension stays the catenary's, the wall bears p A
    more.
    """
    scene = rope(10.0)
    pipe = scene["line_types"]["pipe"]
    pipe["inner_diameter"] = 0.1
    scene["riser"]["contents"] = {"density": 1e-9, "pressure": 1e8}

    def answers(run: Run) -> Iterator[Answer]:
        yield from catenary()(run)
        pA = 1e8 * np.pi * 0.05**2
        yield near("wall tension less effective [N]", run["wall_tension"][-1, -1] - top(run)[1], pA, rel=1e-6)

    return one(scene, answers)
