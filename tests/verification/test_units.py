"""Nothing hangs on the unit of length: the same riser, smaller and larger, under the same gravity.

Lengths go with s, times with its root, forces with s^3, forces per length with s^2, stresses and contact stiffness with
s, EI with s^5.
"""

from __future__ import annotations

from copy import deepcopy
from functools import cache
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.assembly import build
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.results.riser_record import riser_record
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from tests.support.contact_along import touchdown_at
from tests.support.driven_stage import Watcher
from tests.support.scenes import LAY, Mapping, dynamic, prescribed, riser_scene, static, touchdown
from tests.support.scenes import heave as heaved

SCALES = (1e-6, 1e-3, 1e3, 1e6)
ON_SOIL: dict[str, float] = {"outer_diameter": 1, "inner_diameter": 1, "mass": 2, "EA": 3, "EI": 5, "GJ": 5}
ON_SOIL |= {"position": 1, "length": 1}
ON_SOIL |= {"stiffness": 1, "x": 1, "y": 1, "depth": 1, "size_at_riser": 1, "size_far": 1, "su": 1, "amplitude": 1}
ON_SOIL |= {"duration": 0.5, "time_step": 0.5, "period": 0.5, "ramp": 0.5}
SEABEDS: dict[str, Mapping] = {
    "rigid": {"kind": "rigid"},
    "springs": {"kind": "spring", "stiffness": 1.0e4},
    "clay": {"kind": "hysteretic", "law": {"kind": "randolph-quiggin", "su": 1.5e3, "su_gradient": 1.5e3}},
    "slope": {"kind": "rigid", "slope_deg": 2.0},
}


def hose(s: float, seabed: str, dimension: int, time_step: float | str) -> Mapping:
    """The hose of a tank, its end moved up and down; friction and automatic contact, s times as long."""
    pipe: Mapping = {"outer_diameter": 0.15 * s, "mass": 33.113 * s**2, "submerged_weight": 147.1 * s**2}
    pipe |= {"EA": 1.0e6 * s**3, "EI": 1.0e3 * s**5, "GJ": 8.0e2 * s**5}
    pipe |= {"drag": {"normal": 1.2}, "added_mass": {"normal": 1.0}}
    ground = deepcopy(SEABEDS[seabed])
    if "stiffness" in ground:
        ground["stiffness"] *= s
    for name, power in (("su", 1), ("su_gradient", 0)):
        if "law" in ground:
            ground["law"][name] *= s**power
    heave = {"harmonic": {"amplitude": [0.0, 0.0, 0.5 * s], "period": 4.0 * s**0.5, "ramp": 2.0 * s**0.5}}
    step = {"time_step": time_step if time_step == "auto" else float(time_step) * s**0.5}
    return riser_scene(
        static("lay"),
        dynamic(0.6 * s**0.5, 0.1, "heave", motion={"end": heave}) | step,
        pipe=pipe,
        length=40.0 * s,
        elements=60,
        start=prescribed(0.0, 0.0, 0.075 * s),
        end=prescribed(28.0 * s, 0.0, 15.0 * s),
        seabed=ground,
        contact={"friction": {"axial": 0.4}},
        water={"density": 1025.0},
        gravity=9.81,
        dimension=dimension,
        output={"interval": 0.1 * s**0.5},
    )


def figures_of(s: float, seabed: str, dimension: int = 2, time_step: float | str = 0.1) -> Array:
    """By step, without units: time; H and top tension, largest moment, touchdown arc, lowest node; iterations."""
    return reported_of(hose(s, seabed, dimension, time_step), s)


def reported_of(scene: Mapping, s: float) -> Array:
    assembly = build(scene_from_mapping(scene), MPI.COMM_SELF)
    rows = list[list[float]]()

    def watch(stepper: TimeStepper, step: AcceptedStep) -> None:
        riser, contact = riser_record(assembly.riser, stepper), assembly.contacts[0]
        forces = [riser.start_force[0] / s**3, riser.effective_tension[-1] / s**3, riser.bending_moment.max() / s**4]
        places = [touchdown_at(contact, stepper.now) / s, float(riser.position[:, 2].min()) / s]
        time = 0.0 if len(rows) == 0 else step.t / s**0.5
        rows.append([time, *forces, *places, step.solution.iterations])

    before = State.at_rest(0.0, assembly.size)
    for stage in assembly.scene.stages:
        before = run_stage(assembly, stage, before, Watcher(watch), Timer.new())
    return np.array(rows)


@cache
def usual(seabed: str, dimension: int = 2, time_step: float | str = 0.1) -> Array:
    return figures_of(1.0, seabed, dimension, time_step)


@pytest.mark.parametrize("s", SCALES)
@pytest.mark.parametrize("seabed", SEABEDS)
def test_same_hose_in_any_size(seabed: str, s: float) -> None:
    """To round-off, as each iteration is the same."""
    np.testing.assert_allclose(figures_of(s, seabed), usual(seabed), rtol=1e-6, atol=1e-9)


@pytest.mark.verify
@pytest.mark.parametrize("s", SCALES)
def test_same_hose_in_space(s: float) -> None:
    np.testing.assert_allclose(figures_of(s, "rigid", dimension=3), usual("rigid", 3), rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("s", SCALES)
def test_same_automatic_steps(s: float) -> None:
    np.testing.assert_allclose(
        figures_of(s, "springs", time_step="auto"), usual("springs", 2, "auto"), rtol=1e-5, atol=1e-9
    )


def on_soil(s: float, kind: str) -> Mapping:
    """A riser that comes down on a small block of clay that yields, and heaves, s times as long."""
    scene = touchdown(LAY, heaved(0.2), kind=kind)
    if kind == "tet":
        scene["soil"]["law"] |= {"su": 0.0, "su_gradient": 2.0e3}
    scaled: Mapping = _scaled(scene, s)
    return scaled


def _scaled(value: Any, s: float, power: float = 0.0) -> Any:
    """Lengths, times, forces of a scene and what is made of them by the powers of s that their keys have."""
    if isinstance(value, dict):
        return {key: _scaled(each, s, ON_SOIL.get(key, 0.0)) for key, each in value.items()}
    if isinstance(value, list):
        return [_scaled(each, s, power) for each in value]
    return value * s**power if isinstance(value, float) else value


@pytest.mark.parametrize("s", [1e-6, *(pytest.param(s, marks=pytest.mark.verify) for s in SCALES[1:])])
@pytest.mark.parametrize("kind", ["hex", pytest.param("tet", marks=pytest.mark.verify)])
def test_same_riser_on_soil(kind: str, s: float) -> None:
    """Cells, too: gmsh works in lengths of order one. Of hexahedra on clay with, of tetrahedra without strength at the
    seabed.
    """
    scaled, usual = (rows[-2:, :-1] for rows in (reported_of(on_soil(s, kind), s), usual_on_soil(kind)))
    np.testing.assert_allclose(scaled, usual, rtol=1e-6, atol=1e-9)


@cache
def usual_on_soil(kind: str) -> Array:
    return reported_of(on_soil(1.0, kind), 1.0)
