"""Stages of a scene taken through the time loop without files, and what is seen of them step by step."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from mpi4py import MPI

from riser_soil.assembly import build
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.snapshot import Record
from riser_soil.core.system import System, Timer
from riser_soil.results.riser_record import riser_record
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import Stage
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import StatelessObserver, run_stage
from tests.support.driven_stage import Watcher, built, take
from tests.support.scenes import Mapping


@dataclass
class StageHistory:
    """A stage, step by step: end times, steps [s], energies [J], node positions (nn, 3), the riser at the last step."""

    t: list[float] = field(default_factory=list)
    dt: list[float] = field(default_factory=list)
    cuts: list[int] = field(default_factory=list)
    energy: list[float] = field(default_factory=list)
    work: list[float] = field(default_factory=list)
    position: list[Array] = field(default_factory=list)
    last: Record | None = None

    @property
    def end(self) -> Record:
        assert self.last is not None
        return self.last


def stage_histories(scene: Mapping | Scene) -> list[StageHistory]:
    """Take all stages of a scene without files."""
    assembly = build(scene if isinstance(scene, Scene) else scene_from_mapping(scene), MPI.COMM_SELF)
    before, histories = State.at_rest(0.0, assembly.size), list[StageHistory]()
    for stage in assembly.scene.stages:
        now = StageHistory()

        def watch(stepper: TimeStepper, step: AcceptedStep, now: StageHistory = now) -> None:
            now.t.append(step.t)
            now.dt.append(step.dt)
            now.cuts.append(step.cuts)
            now.energy.append(step.energy.total)
            now.work.append(step.work - step.dissipated)
            now.position.append(assembly.riser.line.positions3(stepper.now))
            now.last = riser_record(assembly.riser, stepper)

        before = run_stage(assembly, stage, before, Watcher(watch), Timer.new())
        histories.append(now)
    return histories


def distance(a: Array, b: Array) -> float:
    """Largest distance of a point in one array (…, 3) from its mate in the other [m]."""
    return float(np.linalg.norm(a - b, axis=-1).max())


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

    @property
    def steps(self) -> int:
        return len(self._rows)

    @property
    def gain(self) -> Array:
        """Gain of stored energy since the start beyond the work put in."""
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


@dataclass
class HeavedSoil:
    """A riser laid on soil, then heaved. By step of the heave: time [s], energy lost in the soil [J], iterations."""

    scene: Mapping
    times: list[float] = field(default_factory=list)
    lost: list[float] = field(default_factory=list)
    iterations: list[int] = field(default_factory=list)

    def __post_init__(self) -> None:
        assembly = built(self.scene)
        assert assembly.soil is not None
        lay, heave = assembly.scene.stages
        take(assembly, heave, take(assembly, lay), self._watch)
        self.plastic_strain = float(assembly.soil.whole.output_fields().plastic_strain.max())

    def _watch(self, system: System, step: AcceptedStep) -> None:
        self.times.append(step.t)
        self.lost.append(step.turned["soil"].dissipated)
        self.iterations.append(step.solution.iterations)
