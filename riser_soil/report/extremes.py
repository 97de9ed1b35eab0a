"""Tables of a load step: reactions of the ends, bodies and joints, key results with error bars."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.output import Row
from riser_soil.report.tables import NOTHING, ReportTable, compact, number, value_at
from riser_soil.variants.key_results import key_results

READ_IN = {"N": ("kN", 1e-3), "N.m": ("kN m", 1e-3)}  # units of key results, as they are read
_ENDS = {"start": "A", "end": "B"}
_REACTIONS = (  # path below an end, words, unit, how many of it are one of SI
    ("effective_tension", "effective tension", "kN", 1e-3),
    ("resultant_force", "force, resultant", "kN", 1e-3),
    ("force", "force", "kN", 1e-3),
    ("moment", "moment", "kN m", 1e-3),
    ("angle_deg", "angle from the vertical", "°", 1.0),
)
_SPOKEN = {"bodies": "body", "joints": "joint", "clearance": "clearance"}
_OF_BODIES_AND_JOINTS = {  # rows of bodies, joints and clearances
    "bodies": {
        "position": Row("position", "m"),
        "rotation": Row("rotation", "°", math.degrees(1.0)),
        "contact_force": Row("force of the seabed", "kN", 1e-3),
    },
    "joints": {"force": Row("force", "kN", 1e-3), "moment": Row("moment", "kN m", 1e-3)},
    "clearance": {"distance": Row("least distance", "m")},
}
_REACTIONS_NOTE = (
    "Forces and moments of the supports on the line; global axes, z upwards. Components below 1e-9 of the force and "
    "1e-4 of the maximum bending moment have no row."
)
_SMALL = 1e-4  # of the largest bending moment: moments of supports that are less have no row
_FIELD_WORDS = {
    "top tension": "tension at the hang-off",
    "force at end": "force at end B",
    "force at start": "force at end A",
    "least effective tension": "minimum effective tension",
    "touchdown arc": "arc length of the TDP",
    "largest": "maximum",
    "least": "minimum",
}
_ROUND_OFF = 1e-9  # of the largest component, or of the largest bending moment


def reactions_table(stage: Mapping[str, Any]) -> ReportTable:
    """Forces and moments of the supports at both ends by component, tension and angle there."""
    static = stage["kind"] == "static"
    least = _SMALL * abs(value_at(stage["final"], ("max_bending_moment", "value")) or 0.0)
    rows = [
        row
        for end, name in _ENDS.items()
        for key, words, unit, scale in _REACTIONS
        for row in _reaction(stage, (end, key), f"end {name}: {words}", (unit, scale), least * (key == "moment"))
    ]
    head = ("reaction", "unit", "at the end", *(() if static else ("min.", "at t [s]", "max.", "at t [s]")))
    return ReportTable(head, rows, _REACTIONS_NOTE)


def _reaction(
    stage: Mapping[str, Any], path: tuple[str, str], words: str, unit: tuple[str, float], least: float
) -> Iterator[list[str]]:
    """A row, of a vector one for each component that is more than round-off."""
    final, extremes = value_at(stage["final"], path), value_at(stage["extremes"], path)
    if final is None or extremes is None:
        return
    if not isinstance(final, list):
        if path[1] == "angle_deg":  # the steeper the line, the less it leans
            final, extremes = _from_the_vertical(final, extremes)
        yield [words, unit[0], number(final * unit[1], 4), *_sides(stage, extremes, unit[1])]
        return
    least = max(least, _ROUND_OFF * max(abs(x) for side in (final, extremes["min"], extremes["max"]) for x in side))
    for n, axis in enumerate("xyz"):
        own = {key: values[n] for key, values in extremes.items()}
        if max(abs(final[n]), abs(own["min"]), abs(own["max"])) > least:
            yield [f"{words}, {axis}", unit[0], number(final[n] * unit[1], 4), *_sides(stage, own, unit[1])]


def _from_the_vertical(final: float, extremes: Mapping[str, float]) -> tuple[float, dict[str, float]]:
    low, high = sorted((90.0 - abs(extremes[side]), extremes[f"t_{side}"]) for side in ("min", "max"))
    return 90.0 - abs(final), {"min": low[0], "t_min": low[1], "max": high[0], "t_max": high[1]}


def _sides(stage: Mapping[str, Any], extremes: Mapping[str, float], scale: float) -> list[str]:
    if stage["kind"] == "static":
        return []
    return [
        text
        for which in ("min", "max")
        for text in (number(extremes[which] * scale, 4), number(extremes[f"t_{which}"], 4))
    ]


def bodies_and_joints_table(summary: Mapping[str, Any]) -> ReportTable:
    """Where bodies are in each stage, what acts in joints, and how near lines come to each other."""
    rows = [
        [stage["name"], *row]
        for stage in summary["stages"]
        for group, named in _OF_BODIES_AND_JOINTS.items()
        for name, found_here in stage.get(group, {}).items()
        for row in _body_and_joint_rows(stage["kind"], f"{_SPOKEN[group]} {name}", named, found_here)
    ]
    head = ("load step", "of", "quantity", "unit", "at the end", "min", "at t [s]", "max", "at t [s]")
    note = (
        "Vectors are (x, y, z), their min and max those of each component. Forces are those of the first point on "
        "the second; moments that are zero have no row. Static load steps have the values at their end alone."
    )
    return compact(ReportTable(head, rows, note))


def _body_and_joint_rows(
    kind: str, of: str, named: Mapping[str, Row], known: Mapping[str, Any]
) -> Iterator[list[str]]:
    for key, row in named.items():
        if key not in known:
            continue
        of_stage = {name: np.array(value, dtype=float) for name, value in known[key].items()}
        largest = np.fmax.reduce([np.abs(of_stage[name]).max() for name in ("final", "min", "max")])
        if key == "moment" and largest <= _ROUND_OFF:
            continue
        least = _ROUND_OFF * np.fmax(1.0, largest)
        final, low, high = (_components(of_stage[name], row.scale, least) for name in ("final", "min", "max"))
        sides = [low, _instant(of_stage["t_min"]), high, _instant(of_stage["t_max"])]
        yield [of, row.words, row.unit, final, *(sides if kind != "static" else [NOTHING] * len(sides))]


def _components(value: Array, scale: float, least: float) -> str:
    """A number, or a vector's components, with 0 for round-off."""
    words = [number(scale * float(x) if not abs(x) <= least else 0.0) for x in np.atleast_1d(value)]
    return f"({', '.join(words)})" if value.ndim else words[0]


def _instant(t: Array) -> str:
    """Time and place of a number's extreme; a vector's components have one each."""
    return NOTHING if t.ndim else number(float(t), 4)


def error_bars(summary: Mapping[str, Any], stage: str) -> dict[tuple[str, str], float | None]:
    """Error bars of SI by figure and min or max; empty where none were asked for."""
    known = key_results(summary)
    bars = value_at(summary, ("error_bars", "quantities")) or []
    names = {f"{each['stage']}: {each['name']}": each["bar"] for each in bars if each["stage"] == stage}
    return {(known[key].figure, known[key].which): bar for key, bar in names.items() if key in known}


def key_results_table(summary: Mapping[str, Any]) -> ReportTable:
    """Key results, the first table to read: key results stage by stage, and their error bars if there are any."""
    bars = {f"{each['stage']}: {each['name']}": each for each in value_at(summary, ("error_bars", "quantities")) or []}
    sources = list(dict.fromkeys(source for each in bars.values() for source in each["by_source"]))
    rows = []
    for key, each in key_results(summary).items():
        unit, scale = READ_IN.get(each.unit, (each.unit, 1.0))
        bar = bars.get(key, {})
        shares = (_bar(bar.get("by_source", {}).get(source), scale) for source in sources)
        value = number(each.value * scale)
        rows.append([each.stage, in_field_words(each.name), unit, value, _whole_bar(bar, scale), *shares])
    head = ("load step", "quantity", "unit", "value", "±", *(f"by {source}" for source in sources))
    note = "Static load steps: values at their end; others: extremes over the load step. ±: error bar, and its parts."
    return compact(ReportTable(head, rows, note))


def in_field_words(name: str) -> str:
    """A key result as reports call it."""
    for old, new in _FIELD_WORDS.items():
        name = name.replace(old, new)
    return name


def _whole_bar(bar: Mapping[str, Any], scale: float) -> str:
    return "not known" if "reason" in bar else _bar(bar.get("bar"), scale)


def _bar(bar: float | None, scale: float) -> str:
    return "" if bar is None else number(bar * scale, 2)
