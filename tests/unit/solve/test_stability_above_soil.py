"""Negative pivots of a riser over soil that it does not touch: those of the whole, the soil's counted once."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from riser_soil.core.system import System
from riser_soil.solve import direct_solver, stability
from riser_soil.solve.stability import PivotCounter
from tests.support.above_soil import hanging
from tests.support.driven_stage import FirstStep, built


@pytest.fixture
def system() -> Iterator[System]:
    scene = hanging()
    scene["stages"] = scene["stages"][:1]
    step = FirstStep(built(scene))
    step.matrix(np.zeros(step.free))
    yield step.system
    step.system.destroy()


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What has been factorised: "whole" or "soil"."""
    calls, usual, behind = list[str](), stability.negative_pivots, direct_solver.negative_pivots_behind

    def of_whole(system: System) -> int:
        calls.append("whole")
        return usual(system)

    def of_soil(system: System, rows: int) -> int:
        calls.append("soil")
        return behind(system, rows)

    monkeypatch.setattr(stability, "negative_pivots", of_whole)
    monkeypatch.setattr(direct_solver, "negative_pivots_behind", of_soil)
    return calls


def lower(system: System, first: int, count: int) -> None:
    """Make some rows of the matrix' diagonal negative, far beyond what is beside it."""
    more = system.numbering.zeros()
    more[first : first + count] = -1e12
    system.matrix.add_to_diagonal(more)


def test_a_riser_over_soil_has_pivots_of_its_own(system: System, asked: list[str]) -> None:
    pivots = PivotCounter(system)
    lower(system, 3, 2)
    assert pivots.count() == direct_solver.negative_pivots(system) == 2
    lower(system, 9, 1)
    assert pivots.count() == direct_solver.negative_pivots(system) == 3
    assert asked == ["soil"]


def test_soil_that_has_changed_is_counted_again(system: System, asked: list[str]) -> None:
    pivots = PivotCounter(system)
    assert pivots.count() == 0
    lower(system, system.line_rows + 5, 4)
    assert pivots.count() == direct_solver.negative_pivots(system) == 4
    assert asked == ["soil", "soil"]


def test_what_touches_is_counted_together(system: System, asked: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(System, "couples", property(lambda _: True))
    assert PivotCounter(system).count() == 0
    assert asked == ["whole"]
