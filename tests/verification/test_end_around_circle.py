"""A riser's end is led once around its start, either way: mirror images move as mirror images, and both ways are right.

From the side where the end begins one way leads over the start and the other below it, through a sag bend that is
crushed: these are no mirror images of each other. The mirror image of a way begins on the other side.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.assembly import build
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.results.observer import riser_snapshot
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from tests.support.driven_stage import Watcher
from tests.support.end_around_circle import LARGEST, end_led_around, way_around


@cache
def led_around(way: int, side: int, time_step: float, elements: int = 60, dimension: int = 2) -> Array:
    """Effective tension at both ends and largest moment, step by step."""
    with TemporaryDirectory() as folder:
        table = Path(folder) / "way.csv"
        table.write_text(way_around(way, side))
        scene = end_led_around(str(table), side, time_step, elements, dimension)
        assembly = build(scene_from_mapping(scene), MPI.COMM_SELF)
    rows, before = list[tuple[float, float, float]](), State.at_rest(0.0, assembly.size)

    def watch(stepper: TimeStepper, step: AcceptedStep) -> None:
        found = riser_snapshot(assembly, stepper)
        rows.append((found.effective_tension[0], found.effective_tension[-1], found.bending_moment.max()))

    for stage in assembly.scene.stages:
        before = run_stage(assembly, stage, before, Watcher(watch), Timer.new())
    return np.array(rows)


@pytest.mark.parametrize("way", [-1, pytest.param(1, marks=pytest.mark.verify)])
def test_mirror_images_move_as_such(way: int) -> None:
    here, there = led_around(way, 1, 0.2), led_around(way, -1, 0.2)
    np.testing.assert_allclose(there, here, rtol=1e-9, atol=1e-9 * np.abs(here).max())


@pytest.mark.parametrize(("way", "off"), [(1, 0.002), (-1, 0.03)])
def test_both_ways_in_long_steps(way: int, off: float) -> None:
    """Largest tension at the start, above what 2,000 steps find: 34.375 kN one way, 47.563 kN the other."""
    assert led_around(way, 1, 0.2)[:, 0].max() == pytest.approx(LARGEST[way], rel=off)


@pytest.mark.verify
@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize(("elements", "dimension", "time_step"), [(60, 2, 0.05), (120, 2, 0.05), (60, 3, 0.025)])
def test_both_ways_converge(way: int, elements: int, dimension: int, time_step: float) -> None:
    """In space the crushed bend rebounds with 49.95 kN in steps of 0.05 s; such a run warns, and asks for 0.022 s."""
    found = led_around(way, 1, time_step, elements, dimension)[:, 0].max()
    assert found == pytest.approx(LARGEST[way], rel=0.002)
