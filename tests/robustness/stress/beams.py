"""Stress cases of beams at rest: rolled up both ways, buckled, of two stiffnesses, of thousands of elements."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from riser_soil.results import Run
from tests.robustness.stress.bounds import Answer, between, near
from tests.robustness.stress.case import Runs, Trial, one, stress_case
from tests.support.rod_reference import Rod, first_buckling
from tests.support.scenes import EULER, Mapping, blade, column, frame, prescribed, riser_scene, static

NAMED_LOAD = r"load factor|of the load|buckl"


def tip(run: Run) -> np.ndarray:
    return np.array(run.summary["stages"][-1]["final"]["end"]["position"])


def rolled(turns: float, dimension: int, load_steps: int) -> Mapping:
    """A cantilever of 60 m along x under the tip moment 2 pi turns EI/L, about -y: positive turns go up."""
    moment = {"at": "end", "moment": [0.0, -2.0 * np.pi * turns * 1e5 / 60.0, 0.0]}
    return riser_scene(
        static(loads=[moment]),
        pipe={"EA": 1e9, "EI": 1e5, "GJ": 1e5},
        length=60.0,
        elements=60,
        start=prescribed(0.0, 0.0, 0.0, rotation="fixed"),
        end="free",
        riser={"unstressed": {"points": [[0.0, 0.0, 0.0], [60.0, 0.0, 0.0]]}},
        dimension=dimension,
        solver={"load_steps": load_steps},
    )


def circle(turns: float, dimension: int, load_steps: int) -> Callable[[], Trial]:
    radius = 60.0 / (2.0 * np.pi * turns)
    angle = 2.0 * np.pi * turns

    def answers(run: Run) -> Iterator[Answer]:
        """x = r sin(s/r), z = r (1 - cos(s/r)), along the whole cantilever."""
        s = run.arc
        exact = np.stack([radius * np.sin(s / radius), 0.0 * s, radius * (1.0 - np.cos(s / radius))], axis=1)
        apart = np.linalg.norm(run["position"][-1] - exact, axis=1).max()
        yield near("largest distance from the circle [m]", float(apart), 0.0, within=0.02)
        yield near("largest moment [N.m]", run["bending_moment"][-1].max(), abs(angle) * 1e5 / 60.0, rel=1e-3)

    def make() -> Trial:
        return one(rolled(turns, dimension, load_steps), answers)

    way = "anticlockwise" if turns > 0.0 else "clockwise"
    make.__doc__ = (
        f"A cantilever of 60 m in {dimension}D under a tip moment that rolls it up {abs(turns):g} times, {way}, in "
        f"{load_steps} load steps: circles of radius EI/M."
    )
    return make


for n, dimension, steps in ((1, 2, 1), (1, 3, 1), (4, 2, 16), (4, 3, 16)):
    for way, sign in (("anticlockwise", 1), ("clockwise", -1)):
        title = f"rolled_up_{n}_times_{way}_in_{dimension}D"
        stress_case(name=title, quick=n == 1 and dimension == 2 and sign > 0)(circle(sign * n, dimension, steps))


def elastica(ratio: float) -> tuple[float, float]:
    """Tip of the buckled cantilever of unit length, along and aside (Timoshenko & Gere 1961, section 2.7)."""
    k = 0.5 * np.pi * np.sqrt(ratio)
    m = brentq(lambda m: ellipk(m) - k, 1e-12, 1.0 - 1e-12, xtol=1e-16)
    return 2.0 * ellipe(m) / k - 1.0, 2.0 * np.sqrt(m) / k


def buckled(ratio: float, dimension: int) -> Callable[[], Trial]:
    def answers(run: Run) -> Iterator[Answer]:
        along, aside = elastica(ratio)
        deflection = tip(run)
        yield near("tip along [m]", deflection[0], along, within=1e-3)
        yield near("tip aside [m]", float(np.hypot(deflection[1], deflection[2])), aside, within=1e-3)

    def make() -> Trial:
        return one(column(40, ratio, 1e7, dimension), answers, NAMED_LOAD)

    make.__doc__ = (
        f"A perfect column of unit length in {dimension}D under {ratio:g} times Euler's load, pi^2 EI/4: the elastica, "
        "or a failure that names the load."
    )
    return make


for ratio, dimension in ((1.001, 2), (2.0, 2), (2.0, 3), (20.0, 2)):
    stress_case(name=f"column_at_{ratio:g}_of_its_buckling_load_in_{dimension}D", quick=ratio == 1.001)(
        buckled(ratio, dimension)
    )


@stress_case()
def column_at_0_999_of_its_buckling_load() -> Trial:
    """A perfect column just below Euler's load stays straight: nothing aside."""

    def answers(run: Run) -> Iterator[Answer]:
        deflection = tip(run)
        yield between("tip aside [m]", float(np.hypot(deflection[1], deflection[2])), 0.0, 1e-6)
        yield near("tip along [m]", deflection[0], 1.0 - 0.999 * EULER / 1e7, within=1e-6)

    return one(column(40, 0.999), answers)


@cache
def lateral_torsional() -> float:
    rod = Rod(1.0, 1e5, np.array([0.5, 1.0, 1e3]), np.zeros(3), np.eye(3))
    return first_buckling([(rod, np.eye(3))], np.array([0.0, 1.0, 0.0]), 2.0, 3.5)


@stress_case()
def blade_just_below_and_beyond_lateral_torsional_buckling() -> Trial:
    """A blade's tip loaded across its deep section, P = 4.013 (EI GJ)^0.5/L^2 (Timoshenko & Gere 1961, section 6.3),
    here from the rod's equations: at 0.995 P it stays in its plane, at 1.0025 P and 1.01 P it leaves it as the root of
    the excess, twice as far at the latter.
    """
    ratios = {"below": 0.995, "near": 1.0025, "far": 1.01}

    def answers(runs: Runs) -> Iterator[Answer]:
        aside = {name: abs(float(tip(run)[1])) for name, run in runs.items()}
        yield between("aside below the load [m]", aside["below"], 0.0, 1e-6)
        yield between("aside beyond the load [m]", aside["near"], 1e-3)
        yield near("aside at 1.01 over 1.0025 [-]", aside["far"] / max(aside["near"], 1e-12), 2.0, rel=0.02)

    scenes = {name: blade(20, ratio * lateral_torsional()) for name, ratio in ratios.items()}
    return Trial(scenes, answers, NAMED_LOAD)


@stress_case()
def right_angle_frame_below_and_beyond_its_buckling_load() -> Trial:
    """The right-angle frame pushed in its plane, critical at 1.088 N (Simo & Vu-Quoc 1986): at 0.97 of it nothing
    leaves the plane; at 1.06 it is out of it by more than a twentieth of a leg, alike with 40 and 80 elements.
    """

    def answers(runs: Runs) -> Iterator[Answer]:
        yield between("out of plane below the load [mm]", abs(float(tip(runs["below"])[1])), 0.0, 1e-3)
        coarse, fine = (abs(float(tip(runs[name])[1])) for name in ("coarse", "fine"))
        yield between("out of plane beyond the load [mm]", fine, 12.0)
        yield near("that of 40 elements [mm]", coarse, fine, within=4.8)

    load = 1.0878
    scenes = {"below": frame(40, 0.97 * load), "coarse": frame(40, 1.06 * load), "fine": frame(80, 1.06 * load)}
    return Trial(scenes, answers, NAMED_LOAD)


def cantilever(EI: tuple[float, float], elements: int, force: float) -> Mapping:
    """Two stretches of half a metre under a tip force along z."""
    scene = riser_scene(
        static(loads=[{"at": "end", "force": [0.0, 0.0, force]}]),
        pipe={"EA": 1e9, "EI": EI[0]},
        length=1.0,
        elements=2,
        start=prescribed(0.0, 0.0, 0.0, rotation="fixed"),
        end="free",
        riser={"unstressed": {"points": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]}},
    )
    scene["line_types"]["other"] = {"EA": 1e9, "EI": EI[1]}
    kinds = ("pipe", "other")
    scene["riser"]["segments"] = [{"line_type": k, "length": 0.5, "elements": elements // 2} for k in kinds]
    return scene


@stress_case(quick=True)
def stiffness_that_falls_by_a_million() -> Trial:
    """A cantilever of unit length, EI = 1e6 then 1: the tip sinks by P [7/(24 EI_1) + 1/(24 EI_2)] (small
    deflection).
    """

    def answers(run: Run) -> Iterator[Answer]:
        exact = 1e-3 * (7.0 / 24.0e6 + 1.0 / 24.0)
        yield near("tip deflection [m]", tip(run)[2], exact, rel=1e-5)

    return one(cantilever((1e6, 1.0), 20, 1e-3), answers)


@stress_case()
def cantilever_of_5000_elements() -> Trial:
    """Round-off of the tangent grows with n^4: P L^3/(3 EI) all the same, to a thousandth."""

    def answers(run: Run) -> Iterator[Answer]:
        yield near("tip deflection [m]", tip(run)[2], 1e-3 / 3.0, rel=1e-3)

    return one(cantilever((1.0, 1.0), 5000, 1e-3), answers)


@stress_case()
def load_below_the_round_off_of_EA() -> Trial:
    """A tip force of 1e-6 N, EA = 1e9 N: P L^3/(3 EI) = 0.33 um, a billion times the round-off of places."""

    def answers(run: Run) -> Iterator[Answer]:
        yield near("tip deflection [m]", tip(run)[2], 1e-6 / 3.0, rel=1e-3)

    return one(cantilever((1.0, 1.0), 20, 1e-6), answers)
