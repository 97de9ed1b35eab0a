"""Stress cases of impact: pipes that fall on the ground, through water, and in the middle of a step."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from riser_soil.results import Run
from tests.robustness.stress.bounds import Answer, between, near
from tests.robustness.stress.case import Trial, one, stress_case
from tests.support.scenes import AVERAGE, Mapping, dynamic, riser_scene

W, G = 700.0, 9.81
IMPACT = r"impact|time scheme (removed|added)|time_step"


def level_pipe(
    height: float, k: float, dt: float, duration: float, pipe: Mapping | None = None, **more: Any
) -> Mapping:
    """40 m of level pipe, free at both ends, its underside `height` above a rigid ground of stiffness k [N/m2]."""
    usual: Mapping = {"EA": 3e7, "EI": 5e4, "mass": W / G, "outer_diameter": 0.3, "submerged_weight": W}
    return riser_scene(
        dynamic(duration, dt, "fall", **more.pop("stage", {})),
        pipe=usual | (pipe or {}),
        length=40.0,
        elements=20,
        start="free",
        end="free",
        gravity=G,
        dimension=2,
        seabed={"kind": "rigid", "level": -0.15 - height},
        contact={"stiffness": k, "smoothing": 0.0},
        riser={"initial": "straight"},
        **more,
    )


def impact(dt: float) -> Callable[[], Trial]:
    def answers(run: Run) -> Iterator[Answer]:
        exact = 40.0 * (W + np.sqrt(W * W + 2.0 * 1e6 * W * 0.1))
        force = run.summary["stages"][0]["extremes"]["contact_force"]["max"]
        yield near("largest contact force [N]", force, exact, rel=0.02)

    def make() -> Trial:
        return one(level_pipe(0.1, 1e6, dt, 0.25), answers, IMPACT)

    make.__doc__ = (
        f"40 m of level pipe fall 0.1 m on a lossless ground of 1e6 N/m2 in steps of {dt:g} s: w + (w^2 + 2 k w h)^0.5 "
        "per length; or told what impact has lost."
    )
    return make


for dt in (1e-2, 1e-3, 1e-4):
    stress_case(name=f"impact_in_steps_of_{1e3 * dt:g}_ms", quick=dt == 1e-2)(impact(dt))


@stress_case()
def first_contact_in_mid_step() -> Trial:
    """A pipe falls 1 m on a ground of 1e5 N/m2 in steps of 0.1 s, in the middle of one of which it meets the ground:
    never more force than w + (w^2 + 2 k w h)^0.5 per length, never higher than where it began, in the end the weight.
    """

    def answers(run: Run) -> Iterator[Answer]:
        stage = run.summary["stages"][0]
        most = 40.0 * (W + np.sqrt(W * W + 2.0 * 1e5 * W * 1.0))
        yield between("largest contact force [N]", stage["extremes"]["contact_force"]["max"], 0.0, 1.001 * most)
        yield between("greatest height [m]", float(run["position"][:, :, 2].max()), -1.1, 1e-9)
        last = run.time > 15.0
        yield near("mean contact force at rest [N]", run["contact_force_sum"][last][:, 2].mean(), 40.0 * W, rel=1e-2)

    return one(level_pipe(1.0, 1e5, 0.1, 20.0), answers)


@stress_case()
def penalty_of_1e12_struck_at_10_m_per_s() -> Trial:
    """A pipe falls 5 m on a ground of 1e12 N/m2 in steps of 0.01 s: energy never grows, in the end the ground bears the
    weight. How long it rattles until then, up to 6 s, hangs on round-off.
    """

    def answers(run: Run) -> Iterator[Answer]:
        yield between("greatest height [m]", float(run["position"][:, :, 2].max()), -5.2, 1e-9)
        last = run.time > 9.0
        yield near("mean contact force at rest [N]", run["contact_force_sum"][last][:, 2].mean(), 40.0 * W, rel=1e-2)

    return one(level_pipe(5.0, 1e12, 0.01, 10.0), answers)


def sinking(drag: float) -> Callable[[], Trial]:
    scene = level_pipe(1e5, 1e5, 0.05, 20.0, pipe={"drag": {"normal": drag}}, water={"density": 1025.0})

    def answers(run: Run) -> Iterator[Answer]:
        z, t = run["position"][:, :, 2].mean(axis=1), run.time
        exact = np.sqrt(W / (0.5 * 1025.0 * 0.3 * drag))
        yield near("speed at the end [m/s]", (z[-11] - z[-1]) / (t[-1] - t[-11]), exact, rel=1e-3)

    def make() -> Trial:
        return one(scene, answers)

    make.__doc__ = f"A level pipe sinks with Cd = {drag:g}, steps of 0.05 s: it comes to (2 w/(rho D Cd))^0.5."
    return make


for drag in (1.0, 1e6):
    stress_case(name=f"sinking_with_a_drag_coefficient_of_{drag:g}")(sinking(drag))


@stress_case()
def free_fall_in_steps_of_a_second() -> Trial:
    """A pipe falls freely for 20 s in steps of 1 s: g t^2/2 = 1962 m, without tension and bending."""
    scene = level_pipe(1e5, 1e5, 1.0, 20.0, stage={"scheme": AVERAGE})

    def answers(run: Run) -> Iterator[Answer]:
        yield near("fall [m]", -run["position"][-1, :, 2].mean(), 0.5 * G * 400.0, rel=1e-6)
        yield between("largest moment [N.m]", float(run["bending_moment"].max()), 0.0, 1.0)

    return one(scene, answers)
