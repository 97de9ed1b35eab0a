"""Largest values in the soil: where and when they were met."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.core.snapshot import SoilSnapshot
from riser_soil.results import Run
from riser_soil.results.soil_extremes import SoilExtremes, places
from tests.support.recorded_run import block, record, soil

MESH = block(4, 3, 2)


def followed(*snapshots: SoilSnapshot) -> dict[str, Any]:
    """Extremes of snapshots at 0.1 s, 0.2 s and so on."""
    extremes = SoilExtremes()
    for n, snapshot in enumerate(snapshots):
        extremes.update(0.1 * (n + 1), snapshot, places(MESH))
    return extremes.nested()


def test_the_largest_is_kept_with_its_place_and_time() -> None:
    first = soil(MESH, 30.0)
    cell = 7
    later = replace(first, strength_used=np.where(np.arange(len(MESH.cells)) == cell, 1.5, 0.0))
    largest = followed(first, later, first)
    centre = MESH.points[MESH.cells[cell]].mean(axis=0).tolist()
    assert largest["max_strength_used"] == {"value": 1.5, "position": centre, "time": 0.2}
    assert largest["max_von_mises_stress"]["value"] == first.von_mises.max()
    assert largest["max_von_mises_stress"]["time"] == 0.1, "the same again is nothing new"
    sunk = -first.displacement[:, 2]
    deepest = MESH.points[sunk >= (1.0 - 1e-6) * sunk.max()]
    assert largest["max_settlement"]["position"] == deepest[0].tolist()
    assert len(deepest) == 4, "on either side of the riser, and along it"


def test_round_off_does_not_choose_among_places() -> None:
    first = soil(MESH, 30.0)
    largest = []
    for seed in range(8):
        noise = 1.0 + 1e-12 * np.random.default_rng(seed).normal(size=len(MESH.cells))
        noisy = replace(first, strength_used=first.strength_used * noise)
        largest += [followed(first, noisy), followed(noisy)]
    assert len({tuple(each["max_strength_used"]["position"]) for each in largest}) == 1
    assert {each["max_strength_used"]["time"] for each in largest} == {0.1}


def test_the_summary_has_them_for_each_stage(tmp_path: Path) -> None:
    record(tmp_path, mesh=MESH)
    run = Run(tmp_path)
    lay, heave = (stage["soil"] for stage in run.summary["stages"])
    frames = [run.soil_frame(n).fields for n in range(len(run.soil_times))]
    assert lay["max_settlement"]["value"] == -frames[0]["displacement"][:, 2].min()
    assert heave["max_settlement"]["value"] == max(-frame["displacement"][:, 2].min() for frame in frames[1:])
    assert heave["max_strength_used"]["time"] == pytest.approx(0.1)
    assert heave.keys() == {
        "max_settlement",
        "max_von_mises_stress",
        "max_strength_used",
        "max_equivalent_plastic_strain",
    }


def test_without_soil_there_are_none(tmp_path: Path) -> None:
    record(tmp_path)
    assert all("soil" not in stage for stage in Run(tmp_path).summary["stages"])
