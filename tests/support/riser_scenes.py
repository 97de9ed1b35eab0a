"""Scenes of a riser alone as mappings, and what is seen of them step by step through the time loop."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from mpi4py import MPI

from riser_soil.assembly import build
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.snapshot import RiserSnapshot
from riser_soil.core.system import Timer
from riser_soil.results.riser_snapshot import riser_snapshot
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from tests.support.coupled_scenes import Mapping
from tests.support.driven_stage import Watcher

AVERAGE = {"newmark": {"beta": 0.25, "gamma": 0.5}}


def riser_scene(
    *stages: Mapping, pipe: Mapping, length: float, elements: int, start: Any, end: Any, **more: Any
) -> Mapping:
    """A riser of one line type without gravity; `more` adds sections to the scene, and keys to its riser section."""
    scene: Mapping = {"title": "A riser alone", "gravity": 0.0, "line_types": {"pipe": dict(pipe)}}
    segments = [{"line_type": "pipe", "length": length, "elements": elements}]
    riser = {"segments": segments, "start": start, "end": end} | more.pop("riser", {})
    scene |= {"riser": riser, "stages": list(stages)} | deepcopy(more)
    return scene


def prescribed(*position: float, rotation: Any = "free") -> Mapping:
    return {"position": list(position), "rotation": rotation}


def static(name: str = "static", **more: Any) -> Mapping:
    return {"name": name, "kind": "static", **more}


def dynamic(duration: float, time_step: float, name: str = "dynamic", **more: Any) -> Mapping:
    return {"name": name, "kind": "dynamic", "duration": duration, "time_step": time_step, **more}


def quasi_static(duration: float, name: str = "quasi-static", **more: Any) -> Mapping:
    return {"name": name, "kind": "quasi-static", "duration": duration, **more}


IN_WAVES: Mapping = {"EA": 1.0e6, "EI": 2.0e3, "outer_diameter": 0.3, "mass": 120.0}
IN_WAVES |= {"drag": {"normal": 1.1, "tangential": 0.05}, "added_mass": {"normal": 1.0, "tangential": 0.2}}


def in_waves(time_step: float, top: float, rho_inf: float = 0.8) -> Mapping:
    """A hanging riser in waves and a sheared current, its top at a height below or above the surface at 20 m."""
    water: Mapping = {"surface_level": 20.0, "depth": 60.0}
    water |= {"current": {"profile": [[0.0, 0.1, 0.0], [20.0, 0.8, 0.0]]}}
    water |= {"waves": {"airy": {"height": 2.0, "period": 5.0}, "ramp": 2.0}}
    return riser_scene(
        static("hang"),
        dynamic(4.0, time_step, scheme={"generalized_alpha": {"rho_inf": rho_inf}}),
        pipe=IN_WAVES,
        length=26.0,
        elements=8,
        start=prescribed(0.0, 0.0, 3.0),
        end=prescribed(14.0, 0.0, top),
        water=water,
        gravity=9.81,
        solver={"tolerance": 1e-10},
    )


@dataclass
class StageHistory:
    """A stage, step by step: end times, steps [s], energies [J], node positions (nn, 3), the riser at the last step."""

    t: list[float] = field(default_factory=list)
    dt: list[float] = field(default_factory=list)
    cuts: list[int] = field(default_factory=list)
    energy: list[float] = field(default_factory=list)
    work: list[float] = field(default_factory=list)
    position: list[Array] = field(default_factory=list)
    last: RiserSnapshot | None = None

    @property
    def end(self) -> RiserSnapshot:
        assert self.last is not None
        return self.last


def stage_histories(scene: Mapping | Scene) -> list[StageHistory]:
    """Take all stages of a scene without files."""
    assembly = build(scene if isinstance(scene, Scene) else scene_from_mapping(scene), MPI.COMM_SELF)
    before, reported = State.at_rest(0.0, assembly.size), list[StageHistory]()
    for stage in assembly.scene.stages:
        now = StageHistory()

        def watch(stepper: TimeStepper, step: AcceptedStep, now: StageHistory = now) -> None:
            now.t.append(step.t)
            now.dt.append(step.dt)
            now.cuts.append(step.cuts)
            now.energy.append(step.energy.total)
            now.work.append(step.work - step.dissipated)
            now.position.append(assembly.line.positions3(stepper.now))
            now.last = riser_snapshot(assembly, stepper)

        before = run_stage(assembly, stage, before, Watcher(watch), Timer.new())
        reported.append(now)
    return reported


def distance(a: Array, b: Array) -> float:
    """Largest distance of a point in one array (…, 3) from its mate in the other [m]."""
    return float(np.linalg.norm(a - b, axis=-1).max())
