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
from tests.support.riser_scenes import dynamic, prescribed, riser_scene, static

R, LENGTH, DURATION = 30.0, 60.0, 40.0
PIPE = {"EA": 3e8, "EI": 5e4, "GJ": 4e4, "mass": 120.0, "outer_diameter": 0.3}
PIPE |= {"drag": {"normal": 1.1}, "added_mass": {"normal": 1.0}}  # type: ignore[dict-item]


def _way(file: Path, way: int, side: int) -> Path:
    """Once around, up (+1) or down (-1) first, from a side, +x or -x, with a smooth start and end."""
    t = np.linspace(0.0, DURATION, 161)
    s = t / DURATION
    angle = 2.0 * np.pi * way * (10.0 * s**3 - 15.0 * s**4 + 6.0 * s**5)
    x, z = side * R * (np.cos(angle) - 1.0), R * np.sin(angle)
    rows = (f"{a:.9g},{b:.15g},0,{c:.15g}" for a, b, c in zip(t, x, z, strict=True))
    file.write_text("\n".join(("t [s],x [m],y [m],z [m]", *rows)) + "\n")
    return file


@cache
def led_around(way: int, side: int, time_step: float, elements: int = 60, dimension: int = 2) -> Array:
    """Effective tension at both ends and largest moment, step by step."""
    with TemporaryDirectory() as folder:
        motion = {"end": {"table": str(_way(Path(folder) / "way.csv", way, side))}}
        scene = riser_scene(
            static(),
            dynamic(DURATION, time_step, motion=motion),
            pipe=PIPE,
            length=LENGTH,
            elements=elements,
            start=prescribed(0.0, 0.0, 0.0),
            end=prescribed(side * R, 0.0, 0.0),
            gravity=9.81,
            water={"density": 1025.0},
            dimension=dimension,
        )
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
    right = {1: 34375.0, -1: 47563.0}[way]
    assert led_around(way, 1, 0.2)[:, 0].max() == pytest.approx(right, rel=off)


@pytest.mark.verify
@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize(("elements", "dimension"), [(60, 2), (120, 2), (60, 3)])
def test_both_ways_converge(way: int, elements: int, dimension: int) -> None:
    right = {1: 34375.0, -1: 47563.0}[way]
    assert led_around(way, 1, 0.05, elements, dimension)[:, 0].max() == pytest.approx(right, rel=0.002)
