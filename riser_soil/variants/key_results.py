"""Key results of a run by stages, and the scales of their errors.

In a static stage they are the values at its end, in others the extremes over the stage. The soil's settlement is the
largest in the records of either.

Errors are relative to a scale. It is the value's size, but at least a floor, as a quantity that passes through zero has
no relative error:

| quantity | floor of its scale |
|---|---|
| forces | 0.1 of the line's largest force in the stage; with several lines at least 1e-3 of all lines' |
| arc length of the touchdown point, place of a body | the distance of the line's ends, as their origin is arbitrary |
| bending moment | 1e-9 of that largest force times that distance, to be above round-off |
| curvature, settlement | 1e-6 over that distance, 1e-7 of that distance, for the same reason |
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from riser_soil.core.outputs import upper_end
from riser_soil.results.folder import SUMMARY

FORCE_FLOOR = 0.1  # of the largest force among the key results
OF_ALL_LINES = 0.01  # least of a line's largest force, over that of all lines: free ends have round-off alone
MOMENT_FLOOR, CURVATURE_FLOOR, SETTLEMENT_FLOOR = 1e-9, 1e-6, 1e-7

SETTLEMENT, TOUCHDOWN = "soil settlement", "touchdown arc"  # the latter least or largest in stages that move

SummaryPart = Mapping[str, Any]
Value = tuple[str, str, float, str, str]  # name, unit, value, figure, which


@dataclass(frozen=True)
class KeyResult:
    """A key result of one stage: value and floor of its scale in `unit` (SI).

    figure: its name in the summary. which: whether it is the figure's min or max; in a static stage it is the value at
    the end. of: the line or body, if there are several.
    """

    stage: str
    name: str
    unit: str
    value: float
    floor: float
    figure: str = ""
    which: str = ""
    of: str = ""

    @property
    def scale(self) -> float:
        """Size to which errors are relative, in `unit`."""
        return max(abs(self.value), self.floor)

    @property
    def key(self) -> str:
        """Name among the key results of a run."""
        return f"{self.stage}: {self.label}"

    @property
    def label(self) -> str:
        """Name among the key results of a stage."""
        return f"{self.of} {self.name}".strip()

    def error(self, other: KeyResult) -> float:
        """Relative difference of another run's result, this one being the reference; inf where there is no scale."""
        return self.relative(other.value - self.value)

    def relative(self, difference: float) -> float:
        """Size of a difference in `unit` over the scale; inf where the scale is zero, but 0 for no difference."""
        if difference == 0.0:
            return 0.0
        return abs(difference) / self.scale if self.scale > 0.0 else math.inf


def key_results_in(folder: Path) -> dict[str, KeyResult]:
    """Key results by their keys of the run in a folder."""
    return key_results(json.loads((folder / SUMMARY).read_text(encoding="utf-8")))


def key_results(summary: SummaryPart) -> dict[str, KeyResult]:
    """Key results by their keys, stage by stage, in a summary.json's content."""
    return {each.key: each for stage in summary["stages"] for each in _of_whole_stage(stage)}


def _of_whole_stage(stage: SummaryPart) -> Iterator[KeyResult]:
    lines = {line: own for line, own in _by_line(stage).items() if own["final"] is not None}
    least = OF_ALL_LINES * max((_largest_force(list(_values(own))) for own in lines.values()), default=0.0)
    for line, own in lines.items():
        yield from _of_stage(own, line, least)
    length = max((_span(own["final"]) for own in lines.values()), default=0.0)
    for name, body in stage.get("bodies", {}).items():
        yield from _of_body(stage, name, body["position"], length)


def _of_body(stage: SummaryPart, body: str, position: SummaryPart, length: float) -> Iterator[KeyResult]:
    """Coordinates of a body at the end of a static stage, else their extremes. length: floor of their scale [m]."""
    sides = {"": "final"} if stage["kind"] == "static" else {"least ": "min", "largest ": "max"}
    for words, key in sides.items():
        for axis, value in zip("xyz", position[key], strict=True):
            yield KeyResult(stage["name"], f"{words}{axis}", "m", value, length, of=body)


def _by_line(stage: SummaryPart) -> dict[str, SummaryPart]:
    """Summary of a stage by lines; that of the only line by ""."""
    return {line: {**stage, **own} for line, own in stage.get("lines", {"": {}}).items()}


def _of_stage(stage: SummaryPart, line: str, least: float) -> list[KeyResult]:
    """Key results of a line. least: for its largest force in floors of scales [N]."""
    values, length = list(_values(stage)), _span(stage["final"])
    force = max(_largest_force(values), least)
    floors = {"N": FORCE_FLOOR * force, "N.m": MOMENT_FLOOR * force * length, "m": SETTLEMENT_FLOOR * length}
    floors["1/m"] = CURVATURE_FLOOR / length if length > 0.0 else 0.0

    def floor(name: str, unit: str) -> float:
        return length if name.endswith(TOUCHDOWN) else floors[unit]

    return [
        KeyResult(stage["name"], name, unit, value, floor(name, unit), figure, which, line)
        for name, unit, value, figure, which in values
    ]


def _largest_force(values: Sequence[Value]) -> float:
    return max((abs(value) for _, unit, value, *_ in values if unit == "N"), default=0.0)


def _span(final: SummaryPart) -> float:
    """Distance of a line's ends [m]."""
    return math.dist(final["start"]["position"], final["end"]["position"])


def _values(stage: SummaryPart) -> Iterator[Value]:
    """Values of a stage that are known."""
    upper = upper_end(stage["final"])
    for name, unit, path, which in (
        ("top tension", "N", (upper, "effective_tension"), "max"),
        ("force at start", "N", ("start", "resultant_force"), "max"),
        ("force at end", "N", ("end", "resultant_force"), "max"),
        ("largest bending moment", "N.m", ("max_bending_moment",), "max"),
        ("largest curvature", "1/m", ("max_curvature",), "max"),
        ("least effective tension", "N", ("min_effective_tension",), "min"),
    ):
        yield from _known(name, unit, _value(stage, path, which), ".".join(path), which)
    yield from _contact(stage)


def _contact(stage: SummaryPart) -> Iterator[Value]:
    """Values by contact; a riser that never touches has no touchdown point, and a contact force of 0."""
    if stage["kind"] == "static":
        yield from _known(TOUCHDOWN, "m", _value(stage, ("touchdown_arc",), "max"), "touchdown_arc", "max")
    else:
        for which, word in (("min", "least"), ("max", "largest")):
            value = _value(stage, ("touchdown_arc",), which)
            yield from _known(f"{word} {TOUCHDOWN}", "m", value, "touchdown_arc", which)
    force = _value(stage, ("contact_force",), "max")
    yield from _known("largest contact force", "N", force if force else None, "contact_force", "max")
    settled = stage.get("soil", {}).get("max_settlement", {}).get("value")
    yield from _known(SETTLEMENT, "m", settled, "max_settlement", "max")


def _known(name: str, unit: str, value: float | None, figure: str, which: str) -> Iterator[Value]:
    if value is not None and math.isfinite(value):
        yield name, unit, value, figure, which


def _value(stage: SummaryPart, path: tuple[str, ...], which: str) -> float | None:
    """A figure at the end of a static stage, or its min or max in another; None where there is none."""
    static = stage["kind"] == "static"
    value: Any = stage["final" if static else "extremes"]
    for key in path:
        value = value.get(key) if value is not None else None
    if isinstance(value, dict):
        value = value["value" if static else which]
    return value
