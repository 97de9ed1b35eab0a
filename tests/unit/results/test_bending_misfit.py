"""How elements are found too long for the bending of a line: closed forms, and catenaries whose moments are known."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest

from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.results.bending_misfit import bending_misfits
from riser_soil.riser.section_forces import SectionForces, element_residual, placed, section_input, viscous_residual
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from tests.support.driven_stage import Watcher, built
from tests.support.sample_line import sample
from tests.support.scenes import Mapping, prescribed, riser_scene, static


class Misfit(NamedTuple):
    """The largest of a riser's elements [N.m], by the formula with shear and by the trapezoidal rule."""

    smooth: float
    steep: float


def misfit_of(scene: Mapping) -> tuple[Misfit, float]:
    """At the end of the last stage, and the riser's largest bending moment then [N.m]."""
    assembly = built(scene)
    misfits: list[tuple[Misfit, float]] = []

    def watch(stepper: TimeStepper, step: AcceptedStep) -> None:
        line, elements, accepted = assembly.riser.line, assembly.riser.elements, stepper.newton.accepted
        sections = SectionForces(line, elements, accepted.section_input(line, stepper.now))
        smooth, steep = bending_misfits(line, elements, sections.ends)
        residual = accepted.element_residual(line, stepper.now)
        moment = np.abs(residual[:, [2, -1]] if line.dimension == 2 else residual[:, [4, 10]])
        misfits.append((Misfit(float(smooth.max()), float(steep.max())), float(moment.max())))

    before = State.at_rest(0.0, assembly.size)
    for stage in assembly.scene.stages:
        before = run_stage(assembly, stage, before, Watcher(watch), Timer.new())
    return misfits[-1]


def too_long(misfit: Misfit, largest: float) -> bool:
    """Whether a misfit exceeds the limits of warnings."""
    return misfit.smooth > 0.1 * largest or misfit.steep > 0.2 * largest


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("elements", [2, 4])
def test_a_cantilever_under_its_weight(elements: int, dimension: int) -> None:
    """k falls off as a parabola, for which the formula with shear is exact; the trapezoidal rule misses by h^2 k''/12,
    over k at the clamp 1/(6 n^2).
    """
    pipe: Mapping = {"EA": 1.0e9, "EI": 1.0e5, "GJ": 1.0e5, "mass": 1.0, "submerged_weight": 1.0}
    start = prescribed(0.0, 0.0, 0.0, rotation="fixed")
    scene = riser_scene(
        static(), pipe=pipe, length=10.0, elements=elements, start=start, end="free", gravity=9.81, dimension=dimension
    )
    misfit, largest = misfit_of(scene)
    assert largest == pytest.approx(50.0, rel=1e-5)
    assert misfit.steep == pytest.approx(50.0 / (6.0 * elements**2), rel=1e-4)
    assert misfit.smooth < 1e-4


def test_two_bending_stiffnesses_have_each_their_curvature() -> None:
    """Pushed across both section axes, by a force for which curvature is linear: both rules are exact."""
    pipe: Mapping = {"EA": 1.0e9, "EI_y": 1.0e6, "EI_z": 3.0e6, "GJ": 1.0e6, "mass": 1.0}
    push = static(loads=[{"at": "end", "force": [0.0, 3.0, 2.0]}])
    start = prescribed(0.0, 0.0, 0.0, rotation="fixed")
    misfit, _ = misfit_of(riser_scene(push, pipe=pipe, length=10.0, elements=2, start=start, end="free"))
    assert misfit.steep < 1e-6
    assert misfit.smooth < 1e-6


def test_a_misfit_counts_with_the_larger_stiffness() -> None:
    """The line bends about one of both axes: with the stiffness of that one, or with three times as much."""
    start, steep = prescribed(0.0, 0.0, 0.0, rotation="fixed"), []
    for y, z in ((1.0e5, 3.0e5), (3.0e5, 1.0e5)):
        pipe: Mapping = {"EA": 1.0e9, "EI_y": y, "EI_z": z, "GJ": 1.0e5, "mass": 1.0, "submerged_weight": 1.0}
        scene = riser_scene(static(), pipe=pipe, length=10.0, elements=4, start=start, end="free", gravity=9.81)
        steep.append(misfit_of(scene)[0].steep)
    assert sorted(steep) == pytest.approx([50.0 / 96.0, 150.0 / 96.0], rel=1e-3)


def hanging(elements: int, rotation: Any = "free", **more: Any) -> Mapping:
    """Ten kilometres of riser in the plane or in space; its largest moment is 264.4 N.m."""
    pipe: Mapping = {"EA": 1.0e9, "EI": 1.0e6, "GJ": 1.0e6, "mass": 120.0, "submerged_weight": 500.0}
    ends = prescribed(0.0, 0.0, 0.0), prescribed(7000.0, 0.0, 6000.0, rotation=rotation)
    options: Mapping = {"pipe": pipe, "length": 1.0e4, "elements": elements, "start": ends[0], "end": ends[1]}
    return riser_scene(static(), **options, gravity=9.81, **more)


@pytest.mark.parametrize(
    ("elements", "least", "most", "warned"),
    [(40, 3.0, 5.0, True), (80, 0.15, 0.3, True), (160, 0.005, 0.02, False), (320, 0.0, 0.002, False)],
)
@pytest.mark.parametrize("dimension", [2, 3])
def test_moments_of_a_long_riser(elements: int, least: float, most: float, warned: bool, dimension: int) -> None:
    """The error of its largest moment lies between two bounds, and is told where it is large."""
    misfit, largest = misfit_of(hanging(elements, dimension=dimension))
    assert least < abs(largest / 264.42 - 1.0) < most
    assert too_long(misfit, largest) == warned


@pytest.mark.parametrize(("elements", "most", "warned"), [(20, 0.4, True), (40, 0.09, True), (80, 0.02, False)])
def test_moments_at_a_clamp(elements: int, most: float, warned: bool) -> None:
    """150 m, clamped in the direction of the catenary, then moved by 10 m; its largest moment is 3,207.4 N.m."""
    pipe: Mapping = {"EA": 3.0e8, "EI": 5.0e4, "mass": 120.0, "submerged_weight": 700.0}
    ends = prescribed(0.0, 0.0, 60.0), prescribed(80.0, 0.0, 100.0, rotation="fixed")
    stages = static("hang"), static("pull", move={"end": [90.0, 0.0, 100.0]})
    options: Mapping = {"pipe": pipe, "length": 150.0, "elements": elements, "start": ends[0], "end": ends[1]}
    misfit, largest = misfit_of(riser_scene(*stages, **options, gravity=9.81))
    assert 0.2 * most < largest / 3207.4 - 1.0 < most
    assert too_long(misfit, largest) == warned


def test_a_straight_riser_bends_by_round_off_only() -> None:
    pipe: Mapping = {"EA": 1.0e8, "EI": 1.0e4, "mass": 50.0}
    pull = static(loads=[{"at": "end", "force": [1.0e5, 0.0, 0.0]}])
    start = prescribed(0.0, 0.0, 0.0, rotation="fixed")
    misfit, _ = misfit_of(riser_scene(pull, pipe=pipe, length=30.0, elements=6, start=start, end="free"))
    assert max(misfit.smooth, misfit.steep) < 1e-6


@pytest.mark.parametrize("dimension", [2, 3])
def test_misfits_of_many_states_are_those_of_each(dimension: int) -> None:
    """Misfits are the same to the last bit; and viscous forces, which bend nothing, are left out."""
    made, rows, undamped = sample(dimension), list[Any](), list[Any]()
    parts = [made.beam(), made.damping()]
    for n in range(4):
        state = made.state(n, size=0.02)
        residual, at = element_residual(made.line, parts, state), placed(made.line, state)
        undamped.append(section_input(made.line, at, residual))
        rows.append(section_input(made.line, at, residual, viscous_residual(made.line, parts, state)))

    def misfits(given: Any) -> tuple[Any, Any]:
        return bending_misfits(made.line, made.elements, SectionForces(made.line, made.elements, given).ends)

    for n, row in enumerate(rows):
        for of_one, of_many in zip(misfits(row), misfits(np.stack(rows)), strict=True):
            np.testing.assert_array_equal(of_one, of_many[n])
    assert not np.allclose(misfits(np.stack(rows)), misfits(np.stack(undamped)), rtol=1e-3)
