"""Risers over a block of soil that they touch late or never: what they do, and how often what is asked for it.

As a command: figures of a scene as JSON from rank 0.
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI
from petsc4py import PETSc

from riser_soil.assembly import build
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.soil.von_mises import PerfectlyPlastic
from riser_soil.solve.riser_above_soil import RiserAboveSoil
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import run_stage
from tests.support.driven_stage import Watcher
from tests.support.scenes import CLAY, LAY, Mapping, falling_on_soil, heave, touchdown

FACTORISING = ("MatLUFactorNum", "MatCholFctrNum")  # PETSc's names of numeric factorisations


def hanging(linear: str = "auto") -> Mapping:
    """A riser that hangs 10 m over clay, from both ends, one of which heaves."""
    given = touchdown(LAY, heave(0.5))
    for end in ("start", "end"):
        given["riser"][end]["position"][2] += 15.0
    return given | {"contact": {"method": "surface"}, "solver": {"linear": linear}}


def bouncing(linear: str = "auto") -> Mapping:
    """A pipe that falls on clay, which yields, strikes after 0.32 s, is thrown off and strikes again.

    At small strain: nodes that move leave a balance behind that the next step finds with the soil.
    """
    given = falling_on_soil(1e7, 0.02, CLAY | {"su": 2e4}, duration=0.7)
    given["soil"]["strain"] = "small"
    return given | {"solver": given["solver"] | {"linear": linear}}


SCENES = {"hanging": hanging, "bouncing": bouncing}


@dataclass
class Counts:
    """Counts by step: choices of the linear solver (True: the riser alone), evaluations of the law, factorisations by
    PETSc; places of the riser's nodes, largest displacement of this rank's soil [m].
    """

    alone: list[list[bool]] = field(default_factory=list)
    laws: list[int] = field(default_factory=list)
    factorisations: list[int] = field(default_factory=list)
    places: list[list[float]] = field(default_factory=list)
    settled: list[float] = field(default_factory=list)


class Counting:
    """Counts of calls since they were read last."""

    def __init__(self) -> None:
        self.alone: list[bool] = []
        self.laws = 0
        self._made = 0

    def read(self) -> tuple[list[bool], int, int]:
        made, self._made = self._made, _factorisations()
        read = self.alone, self.laws, self._made - made
        self.alone, self.laws = [], 0
        return read


def _factorisations() -> int:
    return sum(PETSc.Log.Event(name).getPerfInfo()["count"] for name in FACTORISING)


@contextmanager
def counted(coupled: bool) -> Iterator[Counting]:
    """coupled: solve for riser and soil together always, as long as the block lasts."""
    PETSc.Log.begin()
    counting, suits, update = Counting(), RiserAboveSoil.suits, PerfectlyPlastic.update

    def chosen(self: RiserAboveSoil, f: Array, negligible: float) -> bool:
        suitable = not coupled and suits(self, f, negligible)
        counting.alone.append(suitable)
        return suitable

    def updated(self: PerfectlyPlastic, *given: Any, **more: Any) -> Any:
        counting.laws += 1
        return update(self, *given, **more)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(RiserAboveSoil, "suits", chosen)
        patch.setattr(PerfectlyPlastic, "update", updated)
        counting.read()
        yield counting


def counted_run(scene: Mapping, coupled: bool = False, comm: Any = MPI.COMM_SELF) -> Counts:
    """All stages of a scene."""
    assembly, counts = build(scene_from_mapping(scene), comm), Counts()
    assert assembly.soil is not None
    total, line = assembly.soil.whole.field, assembly.riser.line
    with counted(coupled) as counting:

        def watch(stepper: TimeStepper, step: AcceptedStep) -> None:
            alone, laws, factorisations = counting.read()
            counts.alone.append(alone)
            counts.laws.append(laws)
            counts.factorisations.append(factorisations)
            counts.places.append(line.x.ravel().tolist())
            counts.settled.append(float(np.abs(total.total).max(initial=0.0)))

        before = State.at_rest(0.0, assembly.size)
        for stage in assembly.scene.stages:
            before = run_stage(assembly, stage, before, Watcher(watch), Timer.new())
    return counts


def changes(counts: Counts) -> Counter[tuple[bool, bool]]:
    """How often one linear solver follows another within a step."""
    return Counter(pair for step in counts.alone for pair in pairwise(step))


if __name__ == "__main__":
    name, linear = sys.argv[1:]
    result = counted_run(SCENES[name](linear), comm=MPI.COMM_WORLD)
    same = MPI.COMM_WORLD.allgather(result.alone)
    result.settled = [max(each) for each in zip(*MPI.COMM_WORLD.allgather(result.settled), strict=True)]
    if MPI.COMM_WORLD.rank == 0:
        assert all(each == result.alone for each in same), "ranks have chosen unlike each other"
        print(json.dumps(asdict(result)))
