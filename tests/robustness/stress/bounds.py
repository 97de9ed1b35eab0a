"""Answers that a stressed run is judged by: exact ones with what may be missed, bounds that every run keeps."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from riser_soil.assembly.riser import attachments_of, elements_of
from riser_soil.results.read import Run
from riser_soil.results.stage_tally import DOUBTFUL
from riser_soil.scene.lines import ENDS, by_line
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage, loads_in

BALANCE = 1e-3  # of the largest force: what an equilibrium may miss
ENERGY = "energy residual"  # in the name of that bound, of which runs have a warning of their own
_ALONG_RISER = ("position", "effective_tension", "bending_moment")


def bounds(run: Run) -> Iterator[Answer]:
    """All that apply to a finished run."""
    scene = run.read_scene()
    fields = [name for name in _ALONG_RISER if name in ("position", *scene.output.fields)]
    lines, views = run.of_lines, by_line(scene)
    wrong = sum(int((~np.isfinite(own[name])).sum()) for own in lines.values() for name in fields)
    yield between("numbers that are none", wrong, 0, 0)
    tied = {point.line for joint in scene.joints.values() for point in joint.between if point.at not in ENDS}
    for n, stage in enumerate(scene.stages):
        if isinstance(stage, DynamicStage):
            yield from _energy(run.summary["stages"][n])
            continue
        for name in (each for each in views if each not in tied):
            yield from _balance(views[name], views[name].stages[n], lines[name].summary["stages"][n], name)


def worst_residual(stage: dict[str, Any]) -> float:
    """Largest residual of a stage's energy balance over the energy turned over; 0 where none is."""
    energy = stage["energy"]
    worst, turned = energy["worst_residual"]["value"], energy["turned_over"]
    return abs(worst) / turned if worst is not None and turned else 0.0


def _energy(stage: dict[str, Any]) -> Iterator[Answer]:
    yield between(f"{stage['name']}: {ENERGY} [-]", worst_residual(stage), 0.0, DOUBTFUL)


def _balance(scene: Scene, stage: Stage, stage_summary: dict[str, Any], line: str) -> Iterator[Answer]:
    """Vertical forces on a line at the stage's end: what holds its ends, contact, loads and weight; and no tension
    beyond their sum. line: its name, "" of the only one.
    """
    if not _still_and_submerged(scene):
        return
    final, weight, load = stage_summary["final"], _weight(scene), _loads(scene, stage)
    up = [final["start"]["force"][2], final["end"]["force"][2], final["contact_force"], float(load[2]), -weight]
    forces = [*final["start"]["force"], *final["end"]["force"], *up]
    bending = final["max_bending_moment"]["value"] / scene.line.length
    largest = max(bending, *(abs(x) for x in forces))
    if largest == 0.0:
        return
    missed, where = abs(sum(up)) / largest, f"{stage.name}: {line}".rstrip(": ") + ":"
    yield between(f"{where} vertical forces out of balance, of the largest [-]", missed, 0.0, BALANCE)
    most = 2.0 * bending + sum(abs(x) for x in forces) + float(np.abs(load).sum())
    tension = max(abs(final[end]["effective_tension"]) for end in ("start", "end"))
    yield between(f"{where} tension at an end [N]", tension, 0.0, most)


def _still_and_submerged(scene: Scene) -> bool:
    """Whether weight and buoyancy are all that acts along the riser, but for loads and a ground without friction."""
    water, contact = scene.water, scene.contact
    still = water is None or (water.surface_level is None and water.current is None)
    return still and (contact is None or contact.friction is None)


def _weight(scene: Scene) -> float:
    """Less buoyancy, downwards [N], attachments included."""
    elements = elements_of(scene)
    along = float(elements.weight @ np.diff(elements.arc))
    return along + sum(each.net_weight for each in attachments_of(scene))


def _loads(scene: Scene, stage: Stage) -> np.ndarray:
    """Sum of a stage's loads at its end (3,) [N], with what tensioners pull."""
    tensioners = (getattr(end, "tensioner", None) for end in (scene.line.start, scene.line.end))
    total = np.array([0.0, 0.0, sum(each.tension for each in tensioners if each is not None)])
    for load in loads_in(scene.stages, stage):
        factor = 1.0 if load.history is None else load.history[-1][1]
        total += factor * np.asarray(load.force or (0.0, 0.0, 0.0))
        total += factor * scene.line.length * np.asarray(load.distributed or (0.0, 0.0, 0.0))
    return total


@dataclass(frozen=True)
class Answer:
    """A quantity with its unit, what a run found for it, and what it may be. exact: None where there are bounds
    only.
    """

    what: str
    value: float
    low: float
    high: float
    exact: float | None = None

    @property
    def holds(self) -> bool:
        return self.low <= self.value <= self.high

    @property
    def error(self) -> float:
        """Relative to the exact answer, or how far beyond the bounds relative to them; inf for what is no number."""
        if not math.isfinite(self.value):
            return math.inf
        if self.exact is not None:
            return abs(self.value - self.exact) / (abs(self.exact) or max(self.high - self.low, math.ulp(0.0)))
        beyond = max(self.low - self.value, self.value - self.high, 0.0)
        return beyond / max(*(abs(x) for x in (self.low, self.high) if math.isfinite(x)), math.ulp(1.0))

    @property
    def severity(self) -> tuple[bool, bool, float]:
        """Key by which the worst of several answers is found: one that does not hold, else an exact one, else a bound.
        """
        if not math.isfinite(self.value):
            return True, True, math.inf
        if self.exact is not None:
            room = self.high - self.low
            return not self.holds, True, abs(self.value - self.exact) / max(room, math.ulp(0.0))
        bound = self.high if 0.0 < self.high < math.inf else math.inf
        return not self.holds, False, self.error if self.error else self.value / bound

    def __str__(self) -> str:
        if self.exact is not None:
            return f"{self.what}: {self.value:.6g}, exactly {self.exact:.6g}"
        return f"{self.what}: {self.value:.6g}, within {self.low:.6g} and {self.high:.6g}"


def near(what: str, value: float, exact: float, *, rel: float = 0.0, within: float = 0.0) -> Answer:
    """An exact answer, missed by at most a share `rel` of it and `within`, in its unit."""
    missed = rel * abs(exact) + within
    return Answer(what, float(value), float(exact - missed), float(exact + missed), float(exact))


def between(what: str, value: float, low: float = -math.inf, high: float = math.inf) -> Answer:
    """An answer known by its bounds."""
    return Answer(what, float(value), float(low), float(high))
