"""A run with its files, every accepted step of it looked at before it is committed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

from riser_soil.arrays import Array
from riser_soil.build import World
from riser_soil.march import Accepted
from riser_soil.observe import Observer, Seen
from riser_soil.part import State
from riser_soil.run import run
from riser_soil.scene.scene import Scene
from riser_soil.system import System


@dataclass(frozen=True)
class StepFacts:
    """One accepted step; J, N. dissipated: by contact and by the soil in this step."""

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
    usual = Observer.look

    def look(observer: Observer, system: System, step: Accepted) -> Seen | None:
        if at_each is not None:
            at_each()
        else:
            watched.steps.append(_facts(observer._world, system, step))
        return usual(observer, system, step)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Observer, "look", look)
        run(scene, folder)
    return watched


def _facts(world: World, system: System, step: Accepted) -> StepFacts:
    after = step.solution.state
    before = State.at_rest(0.0, after.u.size)
    turned = {p.name: p.work(before, after) for p in system.model.parts if p.name in ("contact", "soil")}
    return StepFacts(
        static=not after.a.any(),
        t=step.t,
        iterations=step.solution.iterations,
        cuts=step.cuts,
        total_energy=step.energy.total,
        work=step.work,
        dissipated={name: work.dissipated for name, work in turned.items()},
        on_riser=np.zeros(3) if world.contact is None else world.contact.force_on_riser(after),
    )
