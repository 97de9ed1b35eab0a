"""The line solver of a riser in space and on a floor: kernels are those of the parts, steps are those of SNES."""

from __future__ import annotations

import pytest

from riser_soil.solve.time_stepper import AcceptedStep
from tests.support.driven_stage import built, take
from tests.support.line_solver import (
    CASES,
    IN_WATER,
    all_parts,
    require_kernels,
    require_kernels_of_parts,
    require_mass,
    require_steps_of_snes,
    require_tangles,
)
from tests.support.sample_line import sample
from tests.support.scenes import turned_bar

pytestmark = pytest.mark.verify


def test_kernels_in_space_are_those_of_the_parts() -> None:
    require_kernels_of_parts(3)


def test_the_mass_in_space_is_that_of_the_parts() -> None:
    at = sample(3)
    require_mass(at, all_parts(at))


def test_tangles_in_space_are_those_of_the_line() -> None:
    require_tangles(3)


@pytest.mark.parametrize("dimension", [2, 3])
def test_kernels_in_water_are_those_of_the_parts(dimension: int) -> None:
    at = sample(dimension)
    parts = [make(at) for make in IN_WATER]
    require_kernels(at, parts)
    require_mass(at, [at.inertia(), *parts])


@pytest.mark.parametrize("case", CASES)
def test_steps_are_those_of_snes(case: str) -> None:
    require_steps_of_snes(case)


def test_a_bar_that_has_turned_many_times_comes_to_rest_without_a_cut_step(monkeypatch: pytest.MonkeyPatch) -> None:
    """By SNES: `tests/unit/solve/test_convergence.py`."""
    assembly, watched = built(turned_bar(20) | {"solver": {"newton": "compiled"}}), list[AcceptedStep]()
    turn, rest = assembly.scene.stages
    monkeypatch.setattr("riser_soil.solve.newton.StepIteration", None)
    take(assembly, rest, take(assembly, turn), watch=lambda _, step: watched.append(step))
    assert len(watched) == 100
    assert assembly.riser.line.x[-1] == pytest.approx([1.0, 0.0], abs=1e-9)
    assert watched[-1].solution.norms[-1] > assembly.scales.force_floor
