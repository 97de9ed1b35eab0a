"""While a riser does not touch the soil, its band alone is solved: the states of riser and soil solved together."""

from __future__ import annotations

import json
from functools import cache

import numpy as np
import pytest

from tests.support.above_soil import SCENES, Counts, changes, counted_run
from tests.support.on_ranks import mpirun

LINEAR = pytest.mark.parametrize("linear", ["direct", "kept", "iterative"])
FALLS = 16  # steps in which the pipe falls


@cache
def run(name: str, linear: str, coupled: bool = False) -> Counts:
    return counted_run(SCENES[name](linear), coupled)


@cache
def run_on_two_ranks(name: str, linear: str) -> Counts:
    done = mpirun(2, "-m", "tests.support.above_soil", name, linear)
    assert done.returncode == 0, done.stderr
    return Counts(**json.loads(done.stdout.splitlines()[-1]))


def require_same_states(one: Counts, other: Counts) -> None:
    """States of some 0.1 to 10 m; solved to 1e-7 of the forces, or to 1e-9."""
    assert np.abs(np.array(one.places) - other.places).max() < 1e-9
    assert np.abs(np.array(one.settled) - other.settled).max() < 1e-9


@LINEAR
def test_a_riser_over_soil_asks_for_no_factors_of_it_and_for_no_law(linear: str) -> None:
    """But for the first step: its stability is judged by pivots of soil at rest, whose stress it asks for."""
    counts = run("hanging", linear)
    assert all(alone for step in counts.alone for alone in step)
    assert counts.factorisations[0] <= 1
    assert counts.laws[0] <= 1
    assert not any(counts.factorisations[1:])
    assert not any(counts.laws[1:])
    assert sum(run("hanging", linear, coupled=True).factorisations) > 1


@LINEAR
@pytest.mark.parametrize("name", SCENES)
def test_states_are_those_of_riser_and_soil_solved_together(name: str, linear: str) -> None:
    require_same_states(run(name, linear), run(name, linear, coupled=True))


def test_it_takes_as_many_iterations() -> None:
    alone, together = (run("bouncing", "direct", coupled) for coupled in (False, True))
    assert [len(step) for step in alone.alone] == [len(step) for step in together.alone]


@LINEAR
def test_contact_that_sets_in_within_a_step_is_solved_with_the_soil(linear: str) -> None:
    """The pipe strikes as the step begins, and for the second time within one; the soil yields, and is left alone
    between.
    """
    counts = run("bouncing", linear)
    assert all(all(step) for step in counts.alone[:FALLS])
    assert not any(counts.alone[FALLS])
    assert changes(counts)[True, False] >= 1
    assert counts.settled[-1] > 0.02


def test_soil_that_is_left_is_brought_to_rest_first() -> None:
    """Within the step in which contact ends: its last iterations are the riser's alone."""
    assert changes(run("bouncing", "direct"))[False, True] >= 1


@pytest.mark.verify
@pytest.mark.parametrize(("name", "linear"), [("hanging", "kept"), ("bouncing", "direct"), ("bouncing", "kept")])
def test_two_ranks_find_the_same(name: str, linear: str) -> None:
    """Two ranks choose alike, and as one rank does; whether a step that changes nothing takes an iteration is
    round-off.
    """
    both, one = run_on_two_ranks(name, linear), run(name, linear)
    require_same_states(both, one)
    assert all(alone for counts in (both, one) for step in counts.alone[:FALLS] for alone in step)
    if name == "hanging":
        assert not any(both.laws[1:])
        assert not any(both.factorisations[1:])
