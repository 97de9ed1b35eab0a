"""Half of a soil that is symmetric about the riser's plane does what all of it does."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from tests.support.half_soil import Results, along_y, pressed, run
from tests.support.on_ranks import mpirun

SAME = 1e-8  # of the largest, where Newton's tolerance of 1e-11 leaves some 1e-9
MODELS = pytest.mark.parametrize("model", ["block", "sections"])
SECTIONS_FIRST = pytest.mark.parametrize("model", [pytest.param("block", marks=pytest.mark.verify), "sections"])


def apart(values: Mapping[str, Array], wanted: Mapping[str, Array]) -> dict[str, float]:
    """Largest differences, over the largest values."""
    assert values.keys() == wanted.keys()
    return {name: float(np.abs(values[name] - wanted[name]).max() / np.abs(wanted[name]).max()) for name in wanted}


@cache
def whole(model: str) -> Results:
    return run(pressed("whole", model=model))


@SECTIONS_FIRST
def test_half_of_the_soil_is_as_good_as_all_of_it(model: str) -> None:
    """At large strain, on new meshes, with friction."""
    half = run(pressed("auto", model=model))
    assert half.unknowns == whole(model).unknowns / 2
    assert half.renewals == whole(model).renewals > 0
    assert whole(model).plastic.max() > 0.3
    assert max(apart(half.compared, whole(model).compared).values()) < SAME


@SECTIONS_FIRST
def test_so_is_half_under_a_riser_along_y_with_suction_at_small_strain(model: str) -> None:
    def scene(symmetry: str) -> dict[str, object]:
        made = along_y(pressed(symmetry, model=model, strain="small"))
        made["contact"]["suction"] = {"cap": 300.0, "reach": 0.02}
        return made

    half, all_of = run(scene("auto")), run(scene("whole"))
    assert half.unknowns == all_of.unknowns / 2
    assert max(apart(half.compared, all_of.compared).values()) < SAME


@SECTIONS_FIRST
def test_so_is_half_where_nodes_lie_in_the_plane(model: str) -> None:
    """The number of cells across is even, as where the block is narrower than the strip."""
    half, all_of = (
        run(pressed(symmetry, width=0.16, model=model, law={"kind": "von-mises", "su": 900.0, "E_over_su": 200.0}))
        for symmetry in ("auto", "whole")
    )
    assert half.unknowns < 0.6 * all_of.unknowns
    assert max(apart(half.compared, all_of.compared).values()) < SAME


@MODELS
@pytest.mark.verify
def test_two_ranks_find_the_same(model: str) -> None:
    done = mpirun(2, "-m", "tests.support.half_soil", model)
    assert done.returncode == 0, done.stderr
    result = Results(**json.loads(done.stdout.splitlines()[-1]))
    assert result.unknowns == whole(model).unknowns / 2
    assert result.renewals == whole(model).renewals
    compared = {name: np.asarray(getattr(result, name)) for name in whole(model).compared}
    assert max(apart(compared, whole(model).compared).values()) < SAME
