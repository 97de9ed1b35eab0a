"""Results that a reviewer asks for, of each case and load step, in units of the field; which case governs each."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, Literal

from riser_soil.core import outputs
from riser_soil.core.output import Figure
from riser_soil.plots.scales import shown
from riser_soil.report.extremes import error_bars
from riser_soil.report.sources import LoadCase
from riser_soil.report.tables import NOTHING, number, value_at

Which = Literal["max", "min"]
Bars = Mapping[tuple[str, str], float | None]
_ROUND_OFF = 1e-4  # of a result: differences that are smaller are none, where no error bar is known


@dataclass(frozen=True)
class ResultKind:
    """A kind of result: the summary's figure with its place there, words, unit, how many of it are one of SI, and
    whether its maximum or minimum is asked for. use: figure of the utilisation that belongs to it; check: whether it is
    itself the utilisation of a check, with the limit 1. turned: whether it is an angle that counts from the vertical.
    """

    figure: str
    words: str
    unit: str
    scale: float
    which: Which
    use: str = ""
    check: bool = False
    turned: bool = False

    @property
    def key(self) -> str:
        return f"{self.which} {self.figure}"


@dataclass(frozen=True)
class Result:
    """A kind of result in one load step of a case: value and error bar in its unit, arc length [m], time [s]."""

    kind: ResultKind
    case: LoadCase
    stage: str
    static: bool
    value: float
    arc: float | None = None
    time: float | None = None
    bar: float | None = None

    @property
    def text(self) -> str:
        return number(self.value, 4)


_UPPER = "upper"  # stands for the end that hangs off
NAMED: tuple[ResultKind, ...] = (
    ResultKind(f"{_UPPER}.effective_tension", "maximum effective tension at the hang-off", "kN", 1e-3, "max",
         "max_tension_utilisation"),
    ResultKind("min_effective_tension", "minimum effective tension", "kN", 1e-3, "min"),
    ResultKind("max_wall_tension", "maximum true wall tension", "kN", 1e-3, "max"),
    ResultKind("max_bending_moment", "maximum bending moment", "kN m", 1e-3, "max"),
    ResultKind("min_bend_radius", "minimum bend radius (MBR)", "m", 1.0, "min", "max_bend_utilisation"),
    ResultKind("max_wall_von_mises_stress", "maximum von Mises stress in the wall", "MPa", 1e-6, "max",
         "max_stress_utilisation"),
    ResultKind(f"{_UPPER}.angle_deg", "minimum hang-off angle from the vertical", "°", 1.0, "min", turned=True),
    ResultKind(f"{_UPPER}.angle_deg", "maximum hang-off angle from the vertical", "°", 1.0, "max", turned=True),
    ResultKind("touchdown_arc", "minimum arc length of the TDP", "m", 1.0, "min"),
    ResultKind("touchdown_arc", "maximum arc length of the TDP", "m", 1.0, "max"),
    ResultKind("contact_force", "maximum vertical force of the seabed", "kN", 1e-3, "max"),
    ResultKind("max_embedment", "maximum embedment", "mm", 1e3, "max"),
    ResultKind("soil.max_settlement", "maximum settlement of the soil", "mm", 1e3, "max"),
)  # fmt: skip
_USES = {
    "max_stress_utilisation": "von Mises stress over the allowable stress",
    "max_bend_utilisation": "allowable over actual bend radius",
    "max_tension_utilisation": "effective tension over the allowable tension",
}


@cache
def kinds() -> list[ResultKind]:
    """All kinds of results: those above, and every utilisation in the table of outputs, code checks among them."""
    known = [
        ResultKind(figure.name, _words(figure), "-", 1.0, "max", figure.name, check=True)
        for _, figure in outputs.figures(())
        if "utilisation" in figure.name and len(figure.path) == 1
    ]
    return [*NAMED, *known]


def _words(figure: Figure) -> str:
    """Name of a utilisation: by the code check's row on the screen where it is one."""
    if figure.name in _USES:
        return _USES[figure.name]
    row = figure.row.words if figure.row is not None else figure.name.replace("_", " ")
    return row.replace("code: ", "code check: ")


@cache  # chapters ask for them again and again
def results_of(case: LoadCase) -> tuple[Result, ...]:
    """All results of a case, load step by load step."""
    results = []
    for stage in case.stages:
        bars = error_bars(case.run.summary, stage["name"])
        results += [result for kind in kinds() for result in _of_stage(case, stage, kind, bars)]
    return tuple(results)


def of_stage(case: LoadCase, stage: str) -> dict[str, Result]:
    """Results of one load step by the keys of their kinds."""
    return {result.kind.key: result for result in results_of(case) if result.stage == stage}


def governing(cases: Iterable[LoadCase]) -> dict[str, Result]:
    """The largest or least of each kind over cases and load steps, by the keys of kinds; of equal ones that of the
    first case, in its last load step.
    """
    best: dict[str, Result] = {}
    for case in cases:
        for result in results_of(case):
            known = best.get(result.kind.key)
            later = known is not None and result.case is known.case and result.value == known.value
            if known is None or later or _beats(result, known):
                best[result.kind.key] = result
    return {kind.key: best[kind.key] for kind in kinds() if kind.key in best}


def is_check(kind: ResultKind) -> bool:
    """Whether it is a utilisation by a code, and not by an allowable value of the scene."""
    return kind.check and kind.figure not in _USES


def uses(results: Mapping[str, Result]) -> list[Result]:
    """The utilisations among results, the largest one first."""
    return sorted((each for each in results.values() if each.kind.check), key=lambda each: -each.value)


def used(result: Result, results: Mapping[str, Result]) -> Result | None:
    """The utilisation that belongs to a result."""
    return results.get(f"max {result.kind.use}") if result.kind.use else None


def bar_shares(cases: Iterable[LoadCase]) -> dict[tuple[str, str], float]:
    """Error bars over values by kind and load step, the largest among the cases that have some: what stands for the
    others, which have the same mesh and time step.
    """
    shares: dict[tuple[str, str], float] = {}
    for result in (each for case in cases for each in results_of(case)):
        if result.bar is not None and result.value:
            key = (result.kind.key, result.stage)
            shares[key] = max(shares.get(key, 0.0), result.bar / abs(result.value))
    return shares


def difference(value: Result, reference: Result, shares: Mapping[tuple[str, str], float]) -> float | None:
    """Amount by which a result exceeds another of its kind; None where that is less than their error bars, or than
    those of other cases, `bar_shares`.
    """
    apart = value.value - reference.value
    bars = [each.bar for each in (value, reference) if each.bar is not None]
    share = shares.get((reference.kind.key, reference.stage), _ROUND_OFF)
    least = max(bars, default=share * max(abs(value.value), abs(reference.value)))
    return None if abs(apart) <= least else apart


def signed(value: float | None, digits: int = 3) -> str:
    """A difference with its sign; a dash for none."""
    return NOTHING if value is None else f"{'+' if value > 0.0 else '−'}{number(abs(value), digits)}"


def _beats(one: Result, other: Result) -> bool:
    return one.value > other.value if one.kind.which == "max" else one.value < other.value


def _of_stage(case: LoadCase, stage: Mapping[str, Any], kind: ResultKind, bars: Bars) -> Iterator[Result]:
    if kind.figure.startswith("soil."):
        largest = value_at(stage, kind.figure.split("."))
        if largest is not None and largest["value"] is not None:
            static = stage["kind"] == "static"
            time = None if static else largest["time"]
            yield Result(kind, case, stage["name"], static, kind.scale * largest["value"], time=time)
        return
    path = [outputs.upper_end(stage["final"]) if part == _UPPER else part for part in kind.figure.split(".")]
    if kind.turned and not _hangs(stage["final"], path[0]):
        return
    if kind.figure == "contact_force" and not _touches(stage):
        return
    for result in (_static if stage["kind"] == "static" else _moving)(case, stage, kind, path):
        which = _side(kind) if not result.static else kind.which
        bar = bars.get((".".join(path), which))
        yield result if bar is None else replace(result, bar=kind.scale * bar)


def _touches(stage: Mapping[str, Any]) -> bool:
    """Whether the ground bears anything."""
    values = (value_at(stage["final"], ("contact_force",)), value_at(stage["extremes"], ("contact_force", "max")))
    return any(values)


def _hangs(final: Mapping[str, Any], end: str) -> bool:
    """Whether the end lies above the other."""
    heights = [value_at(final, (each, "position"))[2] for each in (end, "start" if end == "end" else "end")]
    return bool(heights[0] > heights[1])


def _static(case: LoadCase, stage: Mapping[str, Any], kind: ResultKind, path: Sequence[str]) -> Iterator[Result]:
    value, arc = value_at(stage["final"], path), None
    if isinstance(value, Mapping):
        value, arc = value["value"], value.get("arc")
    if value is not None:
        yield Result(kind, case, stage["name"], True, _shown(kind, value), arc)


def _moving(case: LoadCase, stage: Mapping[str, Any], kind: ResultKind, path: Sequence[str]) -> Iterator[Result]:
    extremes = value_at(stage["extremes"], path)
    which = _side(kind)
    if extremes is not None and extremes.get(which) is not None:
        arc, time = extremes.get(f"arc_{which}"), extremes.get(f"t_{which}")
        yield Result(kind, case, stage["name"], False, _shown(kind, extremes[which]), arc, time)


def _side(kind: ResultKind) -> Which:
    """The summary's extreme that a kind of result is: the steeper a line, the less it leans."""
    if not kind.turned:
        return kind.which
    return "min" if kind.which == "max" else "max"


def _shown(kind: ResultKind, value: float) -> float:
    return 90.0 - abs(value) if kind.turned else kind.scale * value


def unit_of(units: str) -> tuple[str, float]:
    """The unit shown for one of a table of cases or statistics (N, N.m), and how many of it are one of SI."""
    return shown(units.replace(".", " "))
