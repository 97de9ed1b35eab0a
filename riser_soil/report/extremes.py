"""Tables of a stage: figures at its end and their extremes, with times, places and error bars."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from riser_soil.accuracy.key_results import key_results
from riser_soil.core import outputs
from riser_soil.core.arrays import Array
from riser_soil.core.output import Figure, OutputQuantity, Row
from riser_soil.plots.scales import shown
from riser_soil.report.tables import NOTHING, ReportTable, compact, found, number

READ_IN = {"N": ("kN", 1e-3), "N.m": ("kN m", 1e-3)}  # units of key results, as they are read
_AT_THE_END = ("quantity", "unit", "value", "at arc [m]", "±")
_OVER_THE_STAGE = (
    *("quantity", "unit", "at the end", "min", "at t [s]", "at arc [m]", "±"),
    *("max", "at t [s]", "at arc [m]", "±"),
)
_AXES, _ALL = ("x", "y", "z"), ", x, y, z"
_NOTE = "Times are those of the run, arc lengths count from the riser's start. "
_LEFT_OUT = "Components that stay 0 are left out. "
_SPOKEN = {"bodies": "body", "joints": "joint", "clearance": "clearance"}
_OF_HUNG = {  # of bodies, joints and clearances
    "bodies": {
        "position": Row("position", "m"),
        "rotation": Row("rotation", "°", math.degrees(1.0)),
        "contact_force": Row("force of the seabed", "kN", 1e-3),
    },
    "joints": {"force": Row("force", "kN", 1e-3), "moment": Row("moment", "kN m", 1e-3)},
    "clearance": {"distance": Row("least distance", "m")},
}
_ROUND_OFF = 1e-9  # of the largest component, or of the largest bending moment


def extremes_table(summary: Mapping[str, Any], stage: Mapping[str, Any]) -> ReportTable:
    """The figures of a stage that an engineer reads first: those of the screen, with places and error bars."""
    return _table(stage, key_result=True, bars=error_bars(summary, stage["name"]))


def ends_table(stage: Mapping[str, Any]) -> ReportTable:
    """Positions of the ends, forces and moments of their supports, by component."""
    return _table(stage, key_result=False, bars={})


def hung_table(summary: Mapping[str, Any]) -> ReportTable:
    """Where bodies are in each stage, what acts in joints, and how near lines come to each other."""
    rows = [
        [stage["name"], *row]
        for stage in summary["stages"]
        for group, named in _OF_HUNG.items()
        for name, found_here in stage.get(group, {}).items()
        for row in _hung_rows(stage["kind"], f"{_SPOKEN[group]} {name}", named, found_here)
    ]
    head = ("stage", "of", "quantity", "unit", "at the end", "min", "at t [s]", "max", "at t [s]")
    note = (
        "Vectors are (x, y, z), their min and max those of each component. Forces are those of the first point on "
        "the second; moments that are zero are left out. Of static stages the end is told."
    )
    return compact(ReportTable(head, rows, note))


def _hung_rows(kind: str, of: str, named: Mapping[str, Row], known: Mapping[str, Any]) -> Iterator[list[str]]:
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
    """That of a number; a vector's components have one each."""
    return NOTHING if t.ndim else number(float(t), 4)


def error_bars(summary: Mapping[str, Any], stage: str) -> dict[tuple[str, str], float | None]:
    """Error bars of SI by figure and min or max; empty where none were asked for."""
    known = key_results(summary)
    reported = found(summary, ("error_bars", "quantities")) or []
    names = {f"{each['stage']}: {each['name']}": each["bar"] for each in reported if each["stage"] == stage}
    return {(known[key].figure, known[key].which): bar for key, bar in names.items() if key in known}


def key_results_table(summary: Mapping[str, Any]) -> ReportTable:
    """What is read first: key results stage by stage, and their error bars if there are any."""
    bars = {f"{each['stage']}: {each['name']}": each for each in found(summary, ("error_bars", "quantities")) or []}
    sources = list(dict.fromkeys(source for each in bars.values() for source in each["by_source"]))
    rows = []
    for key, each in key_results(summary).items():
        unit, scale = READ_IN.get(each.unit, (each.unit, 1.0))
        bar = bars.get(key, {})
        shares = (_bar(bar.get("by_source", {}).get(source), scale) for source in sources)
        rows.append([each.stage, each.name, unit, number(each.value * scale), _whole_bar(bar, scale), *shares])
    head = ("stage", "quantity", "unit", "value", "±", *(f"by {source}" for source in sources))
    note = "Of static stages at their end, of others the extremes over the stage."
    return compact(ReportTable(head, rows, note))


def _whole_bar(bar: Mapping[str, Any], scale: float) -> str:
    return "not known" if "reason" in bar else _bar(bar.get("bar"), scale)


def _table(stage: Mapping[str, Any], key_result: bool, bars: Mapping[tuple[str, str], float | None]) -> ReportTable:
    head = _AT_THE_END if stage["kind"] == "static" else _OVER_THE_STAGE
    if stage["final"] is None:
        return ReportTable(head, [])
    rows: list[list[str]] = []
    signs: dict[str, list[str]] = {}
    for output, figure in outputs.figures(()):
        final, extremes = found(stage["final"], figure.path), found(stage["extremes"], figure.path)
        row = outputs.row_of(figure, stage["final"])
        if final is None or (row is not None) != key_result:
            continue
        words, unit, scale = _words(output, figure, row)
        bar = {which: bars.get((figure.name, which)) for which in ("min", "max")}
        if isinstance(final, list):
            final, extremes = _without_round_off(stage, output, final, extremes)
        reported_here = list(_rows(stage["kind"], (words, unit, scale), final, extremes, bar))
        rows += reported_here
        if output.sign and reported_here:
            signs.setdefault(output.sign, []).append(words.removesuffix(_ALL))
    reported = [f"{', '.join(words)}: {sign}." for sign, words in signs.items()]
    return compact(ReportTable(head, rows, _NOTE + ("" if key_result else _LEFT_OUT) + " ".join(reported)))


def _without_round_off(
    stage: Mapping[str, Any], output: OutputQuantity[Any], final: list[float], extremes: Mapping[str, Any] | None
) -> tuple[list[float], Mapping[str, Any] | None]:
    """A vector and its extremes with 0 for what is round-off beside its largest component, or the riser's moments."""
    sides = {which: (extremes or {}).get(which) for which in ("min", "max")}
    known = [abs(x) for values in (final, *sides.values()) for x in values or () if x is not None]
    if output.units == "N m":
        known.append(abs(found(stage["final"], ("max_bending_moment", "value")) or 0.0))
    least = _ROUND_OFF * max(known, default=0.0)

    def cleared(values: list[float]) -> list[float]:
        return [x if x is None or abs(x) > least else 0.0 for x in values]

    reported = {which: cleared(values) for which, values in sides.items() if values is not None}
    return cleared(final), extremes if extremes is None else {**extremes, **reported}


def _words(output: OutputQuantity[Any], figure: Figure, row: Row | None) -> tuple[str, str, float]:
    if row is not None:
        return row.words, row.unit, row.scale
    unit, scale = shown(output.units)
    end = f", {figure.path[0]}" if output.where == "nodes" and len(figure.path) > 1 else ""
    size = ", resultant" if "resultant" in figure.name else ""
    named = f"{output.text}{end}{size}"
    return (named if end or output.where != "nodes" else figure.name.replace("_", " ")), unit, scale


def _rows(
    kind: str,
    quantity: tuple[str, str, float],
    final: Any,
    extremes: Mapping[str, Any] | None,
    bars: Mapping[str, float | None],
) -> Iterator[list[str]]:
    words, unit, scale = quantity
    if isinstance(final, list):
        for n, axis in enumerate(_AXES):
            part = {key: values[n] for key, values in (extremes or {}).items() if isinstance(values, list)}
            if not (final[n] or part.get("min") or part.get("max")):
                continue
            yield from _rows(kind, (f"{words.removesuffix(_ALL)}, {axis}", unit, scale), final[n], part, bars)
        return
    arc = final.get("arc") if isinstance(final, dict) else None
    value = final["value"] if isinstance(final, dict) else final
    if kind == "static":
        yield [words, unit, _scaled(value, scale), number(arc), _bar(bars["max"] or bars["min"], scale)]
        return
    reported = extremes or {}
    sides = []
    for which in ("min", "max"):
        place = number(reported.get(f"arc_{which}"))
        sides += [
            _scaled(reported.get(which), scale),
            number(reported.get(f"t_{which}"), 4),
            place,
            _bar(bars[which], scale),
        ]
    yield [words, unit, _scaled(value, scale), *sides]


def _scaled(value: float | None, scale: float) -> str:
    return NOTHING if value is None else number(value * scale)


def _bar(bar: float | None, scale: float) -> str:
    return "" if bar is None else number(bar * scale, 2)
