"""docs/speed.md: each of its tables is that of the benchmark of its name."""

from __future__ import annotations

import re
from importlib import import_module

import pytest

from benchmarks import riser_only
from benchmarks.speed_page import PAGE
from benchmarks.stage import last_stage
from demos.page import block, places
from riser_soil.core.system import Timer

TEXT = PAGE.read_text(encoding="utf-8")


def cells(name: str) -> list[list[str]]:
    rows = [line for line in block(TEXT, name).splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in row.split("|")[1:-1]] for row in rows]


@pytest.mark.parametrize("name", sorted(places(TEXT)))
def test_a_table_has_the_columns_of_its_benchmark(name: str) -> None:
    assert cells(name)[0] == [*import_module(f"benchmarks.{name}").HEAD]
    assert f"`python -m benchmarks.{name}" in block(TEXT, name)


def test_numbers_of_runs_stand_in_tables_alone() -> None:
    """Whoever adds a time in words would have to measure it by hand again."""
    prose = re.sub(r"<!-- (\w+) -->.*?<!-- end of \1 -->", "", TEXT, flags=re.DOTALL)
    assert re.findall(r"[\d.]+ (?:ms|µs|MB|GB|times)\b", prose) == []


def test_cases_and_iterations_are_those_of_the_benchmark() -> None:
    table = {row[0]: row for row in cells("riser_only")[2:]}
    assert [*table] == [*riser_only.CASES]
    case, (scene, overrides) = next(iter(riser_only.CASES.items()))
    stage = last_stage(scene, overrides, Timer.new())
    stage.walk(riser_only.RAMP + 1)
    stage.iterations, began = 0, stage.stepper.now.t
    stage.walk(riser_only.STEPS)
    iterations = (stage.stepper.now.t - began) / riser_only.STEPS
    assert table[case][1:3] == [f"{iterations:.3g}", f"{stage.iterations / riser_only.STEPS:.2f}"]
    stage.destroy()
