"""Values of one case: its key results, statistics of its last dynamic stage, and that stage's extremes as samples."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from riser_soil.core import outputs
from riser_soil.core.arrays import Array
from riser_soil.errors import ResultsError
from riser_soil.results.cycles import beginning
from riser_soil.results.read import Run
from riser_soil.variants.key_results import KeyResult, key_results

MEAN, DEVIATION = ", mean", ", standard deviation"
_USED = "_utilisation"
_SIGNS = {"tension": "positive in tension", "contact force": "positive where the ground pushes"}


class Sample(NamedTuple):
    """Extreme of a dynamic stage without its transient: a sample of one seed.

    value: in SI. least: whether it is the least value, else the largest. duration: time that it is the extreme of [s].
    """

    value: float
    least: bool
    duration: float


@dataclass(frozen=True)
class CaseValue:
    """Value of a quantity of a stage in one case, in its unit (SI).

    sample: for characteristic extremes, None where it has none.
    """

    stage: str
    name: str
    unit: str
    value: float
    sample: Sample | None = None

    @property
    def key(self) -> str:
        return f"{self.stage}: {self.name}"

    @property
    def in_time(self) -> bool:
        """Whether it is a statistic in time, and no extreme."""
        return self.name.endswith((MEAN, DEVIATION))

    @property
    def sign(self) -> str:
        """Meaning of its sign; empty for standard deviations, utilisations and magnitudes."""
        if self.name.endswith((DEVIATION, _spoken(_USED))):
            return ""
        return next((sign for word, sign in _SIGNS.items() if word in self.name), "")


def _spoken(figure: str) -> str:
    return figure.removeprefix("max_").replace("_", " ")


def case_values(folder: Path, since: float) -> list[CaseValue]:
    """Key results and statistics in a run's folder; with several lines and bodies their names come first.

    since: time of the last dynamic stage [s] from which on it counts in statistics and samples.
    """
    run = Run(folder)
    last = _LastDynamic.of(run, since)
    values = [
        CaseValue(each.stage, each.label, each.unit, each.value, last.sample(each) if last else None)
        for each in (*key_results(run.summary).values(), *_utilisations(run.summary["stages"]))
    ]
    each = ((line, value) for line, own in run.of_lines.items() for value in _statistics(own, since))
    return [*values, *(replace(value, name=f"{line} {value.name}".strip()) for line, value in each)]


def _utilisations(stages: Sequence[Mapping[str, Any]]) -> Iterator[KeyResult]:
    """Largest utilisations of each stage and line: of limits, of stress, and by codes."""
    known = [figure.name for _, figure in outputs.figures(()) if figure.name.endswith(_USED)]
    for stage in stages:
        place, side = ("final", "value") if stage["kind"] == "static" else ("extremes", "max")
        for line, own in stage.get("lines", {"": stage}).items():
            there = own[place] or {}
            for name in (name for name in known if name in there):
                yield KeyResult(stage["name"], _spoken(name), "1", there[name][side], 0.0, name, "max", line)


@dataclass(frozen=True, eq=False)
class _LastDynamic:
    """The last dynamic stage of a run, from a time on [s, of the stage]."""

    run: Run
    number: int
    since: float

    @classmethod
    def of(cls, run: Run, since: float) -> _LastDynamic | None:
        """The last dynamic stage of a run; None where it has none."""
        stages = run.summary["stages"]
        number = max((n for n, stage in enumerate(stages) if stage["kind"] == "dynamic"), default=None)
        return None if number is None else cls(run, number, since)

    @property
    def stage(self) -> Mapping[str, Any]:
        stage: Mapping[str, Any] = self.run.summary["stages"][self.number]
        return stage

    @property
    def records(self) -> Array:
        """Whether each of the run's records (nt,) counts."""
        start = beginning(self.run, self.number) + self.since
        return np.asarray((self.run["stage"] == self.number) & (self.run.time >= start))

    def sample(self, result: KeyResult) -> Sample | None:
        """Sample of a key result after the transient: its value at time steps, or, if that is within the transient, the
        extreme of the records.
        """
        duration = self.stage["time"] - self.since
        if result.stage != self.stage["name"] or result.which not in ("min", "max") or duration <= 0.0:
            return None
        least = result.which == "min"
        if self._time_of(result) >= self.since:
            return Sample(result.value, least, duration)
        recorded = self._recorded(result)
        if recorded is None or not np.isfinite(recorded).any():
            return Sample(math.nan, least, duration)
        return Sample(float((np.nanmin if least else np.nanmax)(recorded)), least, duration)

    def _time_of(self, result: KeyResult) -> float:
        """Time of an extreme in its stage [s]; the stage's end where no time is known."""
        own: Any = self.stage["lines"][result.of] if result.of in self.stage.get("lines", {}) else self.stage
        extremes = own["extremes"]
        for key in result.figure.split("."):
            extremes = extremes.get(key) if isinstance(extremes, Mapping) else None
        time = extremes.get(f"t_{result.which}") if isinstance(extremes, Mapping) else None
        return float(time) if isinstance(time, int | float) else math.inf

    def _recorded(self, result: KeyResult) -> Array | None:
        """The recorded series (nt,) of the figure that a key result is an extreme of; None where it isn't recorded."""
        own = self.run.of_lines.get(result.of)
        known = _RECORDED.get(result.figure)
        if own is None or known is None or not own.has(known[0]):
            return None
        return np.asarray(known[1](own[known[0]][self.records]))


_RECORDED: dict[str, tuple[str, Callable[[Any], Any]]] = {  # figures by what is recorded: extremes along are at nodes
    **{figure.name: (o.name, figure.of) for o, figure in outputs.figures(()) if o.where in ("nodes", "model")},
    "max_bending_moment": ("bending_moment", lambda along: along.max(axis=-1)),
    "max_curvature": ("curvature", lambda along: along.max(axis=-1)),
    "max_bend_utilisation": ("bend_utilisation", lambda along: np.nanmax(along, axis=-1)),
    "min_effective_tension": ("min_effective_tension", lambda least: least),
}


def _statistics(run: Run, since: float) -> Iterator[CaseValue]:
    """Mean and standard deviation of recorded series; nan, where nothing touches, does not count."""
    last = _LastDynamic.of(run, since)
    if last is None:
        return
    counted = last.records
    for name, unit, series in _series(run):
        values = series[counted]
        values = values[np.isfinite(values)]
        if values.size:
            yield CaseValue(last.stage["name"], name + MEAN, unit, float(values.mean()))
            yield CaseValue(last.stage["name"], name + DEVIATION, unit, float(values.std()))


def _series(run: Run) -> Iterator[tuple[str, str, Array]]:
    """Name, unit and records (nt,) of recorded series; moments are those at nodes."""
    height = run["position"][-1][:, 2]
    upper = 0 if height[0] > height[-1] else -1
    for name, unit, variable, of in (
        ("top tension", "N", "effective_tension", lambda T: T[:, upper]),
        ("least effective tension", "N", "effective_tension", lambda T: T.min(axis=1)),
        ("largest bending moment at nodes", "N.m", "bending_moment", lambda M: M.max(axis=1)),
        ("touchdown arc", "m", "touchdown_arc", lambda arc: arc),
        ("contact force", "N", "contact_force_sum", lambda F: F[:, 2]),
    ):
        try:
            values = run[variable]
        except ResultsError:  # not recorded
            continue
        yield name, unit, of(values)
