"""A run with its files, every accepted step of it looked at before it is committed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from riser_soil.contact.contact import RiserContact
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import System
from riser_soil.scene.scene import Scene
from riser_soil.solve.time_stepper import AcceptedStep
from riser_soil.whole_run import run
from tests.support.driven_stage import before_commit


@dataclass(frozen=True)
class StepFacts:
    """One accepted step; J, N. dissipated: by contacts and by the soil in this step."""

    static: bool
    t: float
    iterations: int
    cuts: int
    total_energy: float
    work: float
    dissipated: dict[str, float]
    on_riser: Array


@dataclass
class WatchedRun:
    """folder: the run's results; steps: its accepted steps in their order."""

    folder: Path
    steps: list[StepFacts] = field(default_factory=list)

    def of_kind(self, static: bool) -> list[StepFacts]:
        return [s for s in self.steps if s.static == static]


def watched_run(scene: Scene, folder: Path, at_each: Callable[[], None] | None = None) -> WatchedRun:
    """Run a scene into a folder. at_each: called after every accepted step, instead of gathering its facts."""
    watched = WatchedRun(folder)

    def watch(system: System, step: AcceptedStep) -> None:
        if at_each is not None:
            at_each()
        else:
            watched.steps.append(_facts(system, step))

    with before_commit(watch):
        run(scene, folder)
    return watched


def _facts(system: System, step: AcceptedStep) -> StepFacts:
    after = step.solution.state
    before = State.at_rest(0.0, after.u.size)
    turned = {p.name: p.work(before, after) for p in system.model.parts if p.name in ("contact", "seabed", "soil")}
    contact = [p for p in system.model.parts if isinstance(p, RiserContact)]
    return StepFacts(
        static=not after.a.any(),
        t=step.t,
        iterations=step.solution.iterations,
        cuts=step.cuts,
        total_energy=step.energy.total,
        work=step.work,
        dissipated={name: work.dissipated for name, work in turned.items()},
        on_riser=np.sum([np.zeros(3), *(p.force_on_riser(after) for p in contact)], axis=0),
    )
