"""Summary of a run, summary.json: what was built, how each stage ended, extremes and warnings."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, as_list
from riser_soil.core.saved_state import Saved, Stateful, gathered, packed, restore_all, under, unpacked, within
from riser_soil.core.snapshot import Ledger, Record, RunFacts, StepStatistics
from riser_soil.results.code_tally import CodeTally
from riser_soil.results.figures import Extremes, final_state
from riser_soil.results.folder import SUMMARY, FolderLock, write_atomically
from riser_soil.results.indicators import StageIndicators

_USED = ("tightest", "pulled", "stressed")
_PARTS = (
    *("lines", "hung", "last_instant", "extremes", "energy", "worst_residual"),
    *("implausible", "soil", "indicators", "code"),
)
_NOT_PLAIN = (*_USED, *_PARTS)
DOUBTFUL = 0.01  # share of the energy turned over above which what is wrong in its balance is a warning


@dataclass(frozen=True)
class TightestBend:
    """The tightest bend relative to the allowable radius: radius m, arc m, t s or load factor."""

    utilisation: float = 0.0
    radius: float = math.inf
    arc: float = math.nan
    t: float = math.nan

    def warnings(self, unit: str) -> Iterator[str]:
        if self.utilisation > 1.0:
            yield (
                f"the pipe is bent beyond its min_bend_radius: {self.utilisation:.4g} times the limit at arc "
                f"{self.arc:.5g} m and {self.t:.5g} {unit}, where the bend radius is {self.radius:.4g} m"
            )


@dataclass(frozen=True)
class MostUsed:
    """The largest utilisation of a tension or stress allowed, what it was, arc m, t s or load factor."""

    utilisation: float = 0.0
    actual: float = math.nan
    arc: float = math.nan
    t: float = math.nan

    def or_more(self, used: Array | None, actual: Array, arc: Array, times: Array) -> MostUsed:
        """At times (nt,); used (nt, nn): utilisation at the nodes, nan where there is none; actual: tension [N] or
        stress [Pa] there.
        """
        if used is None:
            return self
        k, n = np.unravel_index(np.nanargmax(used), used.shape)
        if not used[k, n] > self.utilisation:
            return self
        return MostUsed(float(used[k, n]), float(actual[k, n]), float(arc[n]), float(times[k]))

    def warnings(self, unit: str, what: str, actual: str) -> Iterator[str]:
        if self.utilisation > 1.0:
            yield (
                f"{what}: {self.utilisation:.4g} times the limit at arc {self.arc:.5g} m and {self.t:.5g} "
                f"{unit}, where {actual.format(self.actual)}"
            )


def energy_warnings(ledger: Ledger, worst: float, t: float) -> Iterator[str]:
    """worst: largest residual on the way [J], at time t [s]."""
    allowed = DOUBTFUL * ledger.turned_over
    if abs(worst) > allowed:
        yield (
            f"the energy balance is {worst:.3g} J off at {t:.5g} s, {abs(worst) / ledger.turned_over:.2%} of the "
            f"{ledger.turned_over:.3g} J exchanged, and {ledger.residual:.3g} J at the end: take a smaller time_step"
        )
    if abs(ledger.made) > allowed:
        done, own = ("removed" if ledger.made > 0.0 else "added"), abs(ledger.made)
        yield (
            f"the time scheme {done} {own:.3g} J, {own / ledger.turned_over:.2%} of the {ledger.turned_over:.3g} J "
            "exchanged: take a smaller time_step"
        )
    lost = ledger.dissipated_by.get("new_mesh", 0.0)
    if abs(lost) > allowed:
        yield (
            f"new meshes of the soil took {lost:.3g} J, {abs(lost) / ledger.turned_over:.2%} of the "
            f"{ledger.turned_over:.3g} J exchanged, as stress was transferred: take smaller cells under the riser"
        )
    given = -sum(ledger.dissipated_by.get(name, 0.0) for name in ("contact", "contact_time_scheme"))
    if given > allowed:
        yield (
            f"contact with the soil gave {given:.3g} J, {given / ledger.turned_over:.2%} of the "
            f"{ledger.turned_over:.3g} J exchanged: the pipe sank through the soil's surface, past its axis, or a "
            "step threw the soil aside; take contact.stiffness auto, and a time_step in which the pipe falls by less "
            "than its radius"
        )


@dataclass
class StageTally:
    """Statistics of one stage, gathered while it runs.

    time: s simulated in it (static: 0); last_instant: its last step, until the summary of its `final` state is made.
    lines: of several lines by name, what is each one's own. hung: figures of bodies, joints and clearances.
    """

    name: str
    kind: str
    time: float = 0.0
    steps: int = 0
    newton_iterations: int = 0
    most_newton_iterations: int = 0
    step_cuts: int = 0
    relaxations: int = 0
    settlings: int = 0
    branch_switches: int = 0
    last_instant: Record | None = None
    final: dict[str, Any] | None = None
    extremes: Extremes = field(default_factory=Extremes)
    energy: Ledger = field(default_factory=Ledger)
    tightest: TightestBend = field(default_factory=TightestBend)
    pulled: MostUsed = field(default_factory=MostUsed)
    stressed: MostUsed = field(default_factory=MostUsed)
    worst_residual: tuple[float, float] = (0.0, math.nan)  # of the energy balance [J], and its time [s]
    implausible: tuple[str, ...] = ()  # what is not plausible about the riser's shape, forces and surroundings
    indicators: StageIndicators = field(default_factory=StageIndicators)
    code: CodeTally = field(default_factory=CodeTally)
    soil: dict[str, Any] = field(default_factory=dict)  # largest values in the soil, see `figures`
    hung: dict[str, Any] = field(default_factory=dict)
    lines: dict[str, StageTally] = field(default_factory=dict)

    def of(self, line: str) -> StageTally:
        """What is a line's own, "" of the only one."""
        return self.lines[line] if line else self

    def balance(self, times: Sequence[float], ledgers: Sequence[Ledger]) -> None:
        """times: s, total simulated time, after steps in turn."""
        self.energy = ledgers[-1]
        for t, ledger in zip(times, ledgers, strict=True):
            if abs(ledger.residual) > abs(self.worst_residual[0]):
                self.worst_residual = ledger.residual, t

    def bend(self, times: Array, record: Record) -> None:
        """times (nt,): s (static stages: load factor), of the record's instants."""
        if "largest_bend_utilisation" not in record:
            return
        used, arc = record.largest_bend_utilisation, record.largest_bend_utilisation_arc
        rows = np.column_stack([used, record.tightest_radius, arc, times])
        most = TightestBend(*as_list(rows[np.argmax(np.nan_to_num(rows[:, 0], nan=-np.inf))]))
        if most.utilisation > self.tightest.utilisation:
            self.tightest = most

    def pull(self, times: Array, record: Record) -> None:
        """times (nt,): s (static stages: load factor), of the record's instants."""
        arc, tension = record.arc, record.effective_tension
        self.pulled = self.pulled.or_more(record.get("tension_utilisation"), tension, arc, times)
        if "most_used_stress" in record:
            self.stressed = self.stressed.or_more(record.stress_utilisation, record.most_used_stress, arc, times)

    def count(self, steps: Sequence[StepStatistics]) -> None:
        self.steps += len(steps)
        self.newton_iterations += sum(step.newton_iterations for step in steps)
        most = max(step.newton_iterations for step in steps)
        self.most_newton_iterations = max(self.most_newton_iterations, most)
        self.step_cuts += sum(step.step_cuts for step in steps)

    @property
    def method(self) -> str | None:
        """The method by which the equilibria of a stage without inertia were found."""
        if self.kind == "dynamic":
            return None
        if self.relaxations:
            return "relaxation"
        if self.settlings:
            return "settling"
        return "load steps" if self.step_cuts else "newton"

    def _finish(self) -> None:
        if self.last_instant is not None:
            self.final, self.last_instant = final_state(self.last_instant), None

    def as_dict(self) -> dict[str, Any]:
        self._finish()
        plain = {k: v for k, v in vars(self).items() if k not in _NOT_PLAIN}
        extremes = self.extremes.nested() if self.steps and not self.lines else None
        found = {"method": self.method, "extremes": extremes, "energy": self._energy, "warnings": self.warnings}
        indicators = self.indicators.of_steps if self.lines else self.indicators.as_dict
        found["indicators"] = indicators(self.kind == "dynamic")
        if self.lines:
            found["lines"] = {name: own._of_line(self.steps > 0) for name, own in self.lines.items()}
            found |= self.hung
        return plain | found | self._soil | self._code_check

    @property
    def _code_check(self) -> dict[str, Any]:
        found = self.code.as_list()
        return {"code_check": found} if found else {}

    @property
    def _soil(self) -> dict[str, Any]:
        return {"soil": self.soil} if self.soil else {}

    def _of_line(self, stepped: bool) -> dict[str, Any]:
        """One of several."""
        self._finish()
        extremes = self.extremes.nested() if stepped else None
        found = {"final": self.final, "extremes": extremes, "warnings": self._own_warnings}
        own = {"indicators": self.indicators.of_figures(self.kind == "dynamic")}
        return found | own | self._soil | self._code_check

    @property
    def _own_warnings(self) -> list[str]:
        """Those of one of several lines."""
        used = [*self._overused("of the load" if self.kind == "static" else "s"), *self.implausible]
        return [*used, *(self.indicators.warnings_of_extremes() if self.kind == "dynamic" else ())]

    @property
    def _energy(self) -> dict[str, Any]:
        worst, t = self.worst_residual
        worst_residual = {"value": worst if self.kind == "dynamic" else math.nan, "time": t}
        sums = {"made": self.energy.made, "relative_residual": self.energy.relative_residual}
        return asdict(self.energy) | sums | {"worst_residual": worst_residual}

    @property
    def warnings(self) -> list[str]:
        """Warnings about the stage's results, with numbers and a remedy."""
        used = [*self._overused("of the load" if self.kind == "static" else "s")]
        used += [f"{name}: {warning}" for name, own in self.lines.items() for warning in own._own_warnings]
        if self.kind != "dynamic":
            return [*used, *self.implausible]
        off = energy_warnings(self.energy, *self.worst_residual)
        return [*used, *self.implausible, *off, *self.indicators.warnings()]

    def _overused(self, unit: str) -> Iterator[str]:
        yield from self.tightest.warnings(unit)
        yield from self.pulled.warnings(
            unit, "the riser is pulled beyond its max_tension", "the effective tension is {:.4g} N"
        )
        yield from self.stressed.warnings(
            unit, "the wall is stressed beyond design_factor times yield_stress", "von Mises' stress is {:.4g} Pa"
        )
        yield from self.code.warnings(unit)

    def state(self) -> Saved:
        self._finish()
        own = ("last_instant", "extremes", "indicators", "code", "lines")
        plain = {name: value for name, value in vars(self).items() if name not in own}
        kept = plain | {name: asdict(vars(self)[name]) for name in _RECORDS} | {"lines": [*self.lines]}
        return gathered(self._followers) | {"told": packed(kept)}

    def restore(self, saved: Saved) -> None:
        vars(self).update(unpacked(saved["told"]))
        self.lines = {name: StageTally("", "") for name in self.lines}
        restore_all(self._followers, saved)
        vars(self).update({name: kind(**vars(self)[name]) for name, kind in _RECORDS.items()})
        worst, t = self.worst_residual
        self.worst_residual, self.implausible = (worst, t), tuple(self.implausible)

    @property
    def _followers(self) -> dict[str, Stateful]:
        found: dict[str, Stateful] = {"extremes": self.extremes, "indicators": self.indicators, "code": self.code}
        return found | {f"lines/{name}": own for name, own in self.lines.items()}


_RECORDS = {"energy": Ledger, "tightest": TightestBend, "pulled": MostUsed, "stressed": MostUsed}


class Summary:
    """Keeps the whole summary and writes it."""

    def __init__(self, facts: RunFacts) -> None:
        self.finished = False
        self.laying: dict[str, float] | None = None  # how a slack riser was laid before the stages
        self.stages: list[StageTally] = []
        self.seconds: Counter[str] = Counter()
        self.processor_seconds = math.nan  # until the run ends
        self._facts = facts

    def as_dict(self) -> dict[str, Any]:
        """The summary as it goes into the file, before nan becomes null."""
        facts = self._facts
        return {
            "title": facts.title,
            "finished": self.finished,
            "version": facts.version,
            "versions": dict(facts.versions),
            "ranks": facts.ranks,
            "parts": {"built": list(facts.built), "left_out": dict(facts.left_out)},
            "dofs": {"riser": facts.riser_dofs, "soil": facts.soil_dofs},
            "warnings": list(facts.warnings),
            "stages": [stage.as_dict() for stage in self.stages],
            "seconds": dict(self.seconds),
            "processor_seconds": self.processor_seconds,
            **({"laying": self.laying} if self.laying is not None else {}),
        }

    def write(self, path: Path, lasting: bool = False) -> None:
        write_atomically(path, json.dumps(plain_json(self.as_dict()), indent=2, allow_nan=False) + "\n", lasting)

    def state(self) -> Saved:
        stages = gathered({str(n): stage for n, stage in enumerate(self.stages)})
        return under("stages", stages) | {"laying": packed(self.laying), "seconds": packed(self.seconds)}

    def restore(self, saved: Saved) -> None:
        self.laying, self.seconds = unpacked(saved["laying"]), Counter(unpacked(saved["seconds"]))
        stages = within(saved, "stages")
        self.stages = [StageTally("", "") for name in stages if name.count("/") == 1 and name.endswith("/told")]
        restore_all({str(n): stage for n, stage in enumerate(self.stages)}, stages)


def add_to_summary(folder: Path, blocks: Mapping[str, Any]) -> None:
    """Add blocks to the summary of a finished run."""
    summary = json.loads((folder / SUMMARY).read_text(encoding="utf-8")) | blocks
    with FolderLock(folder):
        write_atomically(folder / SUMMARY, json.dumps(plain_json(summary), indent=2, allow_nan=False) + "\n")


def plain_json(value: Any) -> Any:
    """A value in JSON's terms: plain numbers; null for nan and infinities, which JSON lacks."""
    if isinstance(value, Mapping):
        return {str(key): plain_json(v) for key, v in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [plain_json(v) for v in value]
    if isinstance(value, np.generic):
        return plain_json(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
