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
from riser_soil.errors import SolveError
from riser_soil.results import Run
from riser_soil.results.riser_record import riser_record
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from riser_soil.whole_run import run
from tests.support.driven_stage import Watcher
from tests.support.scenes import (
    LARGEST_AROUND,
    Mapping,
    dynamic,
    end_led_around,
    prescribed,
    riser_scene,
    static,
    way_around,
)


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
        record = riser_record(assembly.riser, stepper)
        rows.append((record.effective_tension[0], record.effective_tension[-1], record.bending_moment.max()))

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
    assert led_around(way, 1, 0.2)[:, 0].max() == pytest.approx(LARGEST_AROUND[way], rel=off)


@pytest.mark.verify
@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize(("elements", "dimension", "time_step"), [(60, 2, 0.05), (120, 2, 0.05), (60, 3, 0.025)])
def test_both_ways_converge(way: int, elements: int, dimension: int, time_step: float) -> None:
    """In space the crushed bend rebounds with 49.95 kN in steps of 0.05 s; such a run warns, and asks for 0.022 s."""
    peak = led_around(way, 1, time_step, elements, dimension)[:, 0].max()
    assert peak == pytest.approx(LARGEST_AROUND[way], rel=0.002)


def catenary_led_around(table: str, elements: int, time_step: float) -> Mapping:
    """The 350 m riser, whose upper end is led around, up first, at up to 9.9 m/s."""
    pipe: Mapping = {"outer_diameter": 0.26, "inner_diameter": 0.2, "mass": 57.5, "EA": 15.38e8, "EI": 20.96e3}
    pipe |= {"drag": {"normal": 1.0}, "added_mass": {"normal": 1.0}}
    ends: Mapping = {"start": prescribed(0.0, 0.0, 0.0), "end": prescribed(150.0, 0.0, 150.0)}
    ends["riser"] = {"contents": {"density": 1025.0}, "initial": "catenary"}
    stages = static(), dynamic(60.0, time_step, motion={"end": {"table": table}})
    more: Mapping = {"gravity": 9.81, "water": {"density": 1025.0}}
    return riser_scene(*stages, pipe=pipe, length=350.0, elements=elements, **ends, **more)


def wide_circle(folder: Path) -> str:
    """Once around a circle of 60 m radius in 60 s, up first from its rightmost place, slow at both ends."""
    t = np.linspace(0.0, 60.0, 601)
    angle = np.pi * (1.0 - np.cos(np.pi * t / 60.0))
    rows = np.stack([t, 60.0 * (np.cos(angle) - 1.0), 0.0 * t, 60.0 * np.sin(angle)], axis=1)
    np.savetxt(folder / "way.csv", rows, "%.15g", ",", header="t [s],x [m],y [m],z [m]", comments="")
    return str(folder / "way.csv")


def test_a_bend_that_drag_closes_is_reported(tmp_path: Path) -> None:
    """The riser's upper end comes down faster than it sinks: it buckles into a bend that closes, below the end."""
    scene = catenary_led_around(wide_circle(tmp_path), 70, 0.1)
    said = r"folded at arc 2\d\d m.*had come to [89]\d degrees.*radius is down to 1\.\d+ m"
    with pytest.raises(SolveError, match=said):
        run(scene_from_mapping(scene), tmp_path / "run")


@pytest.mark.verify
@pytest.mark.parametrize("time_step", [0.02, 0.01])
def test_elements_that_follow_it_find_a_kink(time_step: float, tmp_path: Path) -> None:
    """1,120 elements go on to a bend tighter than the pipe's own radius, 0.13 m, in the same place; a warning tells."""
    scene = catenary_led_around(wide_circle(tmp_path), 1120, time_step)
    run(scene_from_mapping(scene), tmp_path / "run")
    curvature = Run(tmp_path / "run").summary["stages"][1]["extremes"]["max_curvature"]
    assert 1.0 / curvature["max"] < 0.13
    assert 280.0 < curvature["arc_max"] < 300.0
