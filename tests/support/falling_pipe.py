"""A pipe falls on the ground: scenes with much impact, and the energies of a stage as it is taken."""

from __future__ import annotations

from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.scene.stages import Stage
from riser_soil.solve.dynamic_relaxation import RelaxationResult
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import StatelessObserver
from tests.support.coupled_scenes import Mapping

WEIGHT, LENGTH, DROP = 700.0, 20.0, 1.0  # N/m, m, m
FALL = WEIGHT * LENGTH * DROP  # J, a measure of the energy in play
TILTED = {"points": [[0.0, 0.0, 0.0], [19.9, 0.0, 1.9974984]]}


def fall(seabed: str, start: Any, initial: Any, k: float, dt: float, duration: float = 3.0) -> Mapping:
    """A pipe of 20 m comes down by its weight on a floor 1 m below its start; k [N/m2]."""
    pipe = {"EA": 3e7, "EI": 5e4, "mass": 120.0, "outer_diameter": 0.3, "submerged_weight": WEIGHT}
    scene: Mapping = {
        "title": "A pipe falls on the ground",
        "gravity": 9.81,
        "dimension": 2,
        "line_types": {"pipe": pipe},
        "riser": {
            "segments": [{"line_type": "pipe", "length": LENGTH, "elements": 20}],
            "start": start,
            "end": "free",
            "initial": initial,
        },
        "seabed": {"kind": seabed, "level": -DROP},
        "stages": [{"name": "fall", "kind": "dynamic", "duration": duration, "time_step": dt}],
        "solver": {"tolerance": 1e-9},
    }
    scene["contact"] = {"smoothing": 1e-3}
    (scene["seabed"] if seabed == "spring" else scene["contact"])["stiffness"] = k
    return scene


def pinned(k: float, dt: float, duration: float = 3.0) -> Mapping:
    """Hinged at its start, the pipe swings down on springs."""
    return fall("spring", {"position": [0.0, 0.0, 0.0], "rotation": "free"}, TILTED, k, dt, duration)


def flat(k: float, dt: float, duration: float = 3.0) -> Mapping:
    """Free at both ends, level: all nodes strike a rigid floor at once."""
    return fall("rigid", "free", "straight", k, dt, duration)


def tilted(k: float, dt: float, duration: float = 3.0) -> Mapping:
    """Free at both ends, one end strikes a rigid floor first; on average the pipe falls 2 m."""
    return fall("rigid", "free", TILTED, k, dt, duration)


class Energies(StatelessObserver):
    """Energies of a stage [J], one entry a step; follows `riser_soil.stages.run_stage`."""

    def __init__(self) -> None:
        self._begun = 0.0
        self._rows: list[tuple[float, float, float, float]] = []
        self.cuts = 0

    def begin_stage(self, stage: Stage, stepper: TimeStepper) -> None:
        self._begun = stepper.energy.total

    def record(self, stepper: TimeStepper, step: AcceptedStep, last: bool) -> None:
        """A step just committed; its kinetic energy is that of the pipe as it moves."""
        taking = [step.turned[each] for each in ("seabed", "contact", "new mesh") if each in step.turned]
        by_contact = sum(work.dissipated for work in taking)
        self._rows.append((stepper.energy.total, step.work, step.dissipated, by_contact))
        self.cuts += step.cuts

    def relaxed(self, relaxed: RelaxationResult) -> None:
        """Dynamic stages know no relaxation."""

    @property
    def steps(self) -> int:
        return len(self._rows)

    @property
    def gain(self) -> Array:
        """Of stored energy since the start beyond the work put in."""
        stored, work = np.array(self._rows)[:, :2].T
        return np.asarray(stored - self._begun - np.cumsum(work))

    @property
    def appeared(self) -> Array:
        """The gain and what loads and contact dissipated: > 0 for energy from nowhere, < 0 where the scheme damps."""
        return np.asarray(self.gain + np.cumsum(np.array(self._rows)[:, 2]))

    @property
    def by_contact(self) -> Array:
        """What the contact dissipated in each step, with new meshes, which move the surface under it."""
        return np.array(self._rows)[:, 3]

    def report(self) -> str:
        return (
            f"gain at most {self.gain.max():+.2e} J, at the end {self.gain[-1]:+.4g} J; appeared at most "
            f"{self.appeared.max():+.2e} J; by contact {self.by_contact.sum():.4g} J; {self.cuts} cuts"
        )
