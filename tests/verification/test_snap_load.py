"""A weight falls until its slack line snaps taut, is thrown up, and crushes the line; nothing gets more than it had.

While the line is slack it buckles in as many waves as it has elements. In steps of 1/50 of the weight's period on the
line each of them may create a little energy, and the sum once tore the line.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI
from scipy.optimize import brentq

from riser_soil.assembly import build
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.results import Run
from riser_soil.results.riser_record import riser_record
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from riser_soil.whole_run import run
from tests.support.driven_stage import Watcher
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene

L, SLACK, MASS, EA, g = 20.0, 1.0, 500.0, 1.0e7, 9.81
WEIGHT = MASS * g
PEAK = WEIGHT + np.sqrt(WEIGHT**2 + 2.0 * EA / L * WEIGHT * SLACK)
"""Tension [N] where all that the weight has fallen stretches the line."""


def arc_of(length: float, slack: float) -> tuple[float, float]:
    """Radius and half the angle of an arc whose chord is shorter by the slack."""
    half = brentq(lambda a: np.sin(a) / a - (length - slack) / length, 0.01, 3.0)
    return 0.5 * length / half, half


def bow(points: int = 41) -> list[list[float]]:
    """An arc of the line's length between ends that are nearer by the slack, downwards."""
    radius, half = arc_of(L, SLACK)
    angle = np.linspace(-half, half, points)
    aside, along = radius * (np.cos(angle) - np.cos(half)), radius * np.sin(angle) + 0.5 * (L - SLACK)
    return [[float(x), 0.0, -float(z)] for x, z in zip(aside, along, strict=True)]


def dropped(elements: int, time_step: float) -> Mapping:
    pipe = {"EA": EA, "EI": 10.0, "GJ": 10.0, "mass": 1.0, "outer_diameter": 0.03}
    riser = {"attachments": [{"at": L, "mass": MASS}], "initial": {"points": bow()}}
    riser["unstressed"] = {"points": [[0.0, 0.0, 0.0], [0.0, 0.0, -L]]}
    start = prescribed(0.0, 0.0, 0.0)
    ends: Mapping = {"start": start, "end": "free", "riser": riser, "gravity": g}
    return riser_scene(dynamic(1.2, time_step), pipe=pipe, length=L, elements=elements, **ends)


def peaks(elements: int, time_step: float) -> tuple[float, float, float]:
    """Largest tension at the weight and anywhere [N], and the most energy above that of the start [J]."""
    assembly = build(scene_from_mapping(dropped(elements, time_step)), MPI.COMM_SELF)
    tension, energy = list[tuple[float, float]](), list[float]()

    def watch(stepper: TimeStepper, step: AcceptedStep) -> None:
        tensions = riser_record(assembly.riser, stepper).effective_tension
        tension.append((float(tensions[-1]), float(tensions.max())))
        energy.append(stepper.energy.total)

    watcher = Watcher(watch)
    run_stage(assembly, assembly.scene.stages[0], State.at_rest(0.0, assembly.size), watcher, Timer.new())
    at_weight, anywhere = np.array(tension).max(axis=0)
    return at_weight, anywhere, max(energy) - watcher.energy_at_start.total


@pytest.mark.parametrize(
    ("elements", "time_step"),
    [
        (40, 4e-3),
        pytest.param(80, 4e-3, marks=pytest.mark.verify),
        pytest.param(40, 1e-2, marks=pytest.mark.verify),
        pytest.param(80, 2e-3, marks=pytest.mark.verify),
        pytest.param(80, 1e-3, marks=pytest.mark.verify),
    ],
)
def test_no_more_than_the_fall_gives(elements: int, time_step: float) -> None:
    """The slack that bends takes some 7 % of the peak."""
    at_weight, anywhere, created = peaks(elements, time_step)
    print(f"{elements} elements, {time_step} s: {at_weight / PEAK:.4f}, {anywhere / PEAK:.4f} of it; {created} J")
    assert 0.9 * PEAK < at_weight <= anywhere < PEAK
    assert created < 0.05 * WEIGHT * SLACK


def wire(time_step: float) -> Mapping:
    """100 kg on 10 m of wire of 1 g/m, whose elements can't be pushed, hung as an arc with a chord of 95 %."""
    radius, half = arc_of(10.0, 0.5)
    angle = np.linspace(-half, half, 41)
    aside, along = radius * (np.cos(angle) - np.cos(half)), radius * (np.sin(angle) + np.sin(half))
    points = [[float(x), 0.0, -float(z)] for x, z in zip(aside, along, strict=True)]
    pipe = {"EA": 1e6, "EI": 1e-4, "mass": 0.001, "outer_diameter": 0.001}
    riser = {"attachments": [{"at": 10.0, "mass": 100.0}], "initial": {"points": points}}
    ends: Mapping = {"start": prescribed(*points[0]), "end": "free", "riser": riser, "gravity": g}
    return riser_scene(dynamic(0.8, time_step), pipe=pipe, length=10.0, elements=10, **ends)


@pytest.mark.parametrize("time_step", [0.002, 0.001])
def test_a_wire_that_flies_slack_takes_steps_of_its_own(time_step: float, tmp_path: Path) -> None:
    """The elements of a wire that goes slack whip about: steps in which one swings by 0.2 rad and more are cut. What
    such steps made of the tension's energy once folded the wire. Peak as of a mass on a spring that falls by 0.5 m.
    """
    run(scene_from_mapping(wire(time_step)), tmp_path)
    (stage,) = Run(tmp_path).summary["stages"]
    peak = 981.0 + np.sqrt(981.0**2 + 2.0 * 1e5 * 981.0 * 0.5)
    assert stage["extremes"]["min_effective_tension"]["max"] == pytest.approx(peak, rel=0.01)
    assert stage["step_cuts"] > 0
    assert Run(tmp_path).summary["finished"]
