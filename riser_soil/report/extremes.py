"""Tables of a stage: figures at its end and their extremes, with times, places and error bars."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from riser_soil.accuracy.key_results import key_results
from riser_soil.core import outputs
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
_ROUND_OFF = 1e-9  # of the largest component, or of the largest bending moment


def extremes_table(summary: Mapping[str, Any], stage: Mapping[str, Any]) -> ReportTable:
    """The figures of a stage that an engineer reads first: those of the screen, with places and error bars."""
    return _table(stage, key_result=True, bars=error_bars(summary, stage["name"]))


def ends_table(stage: Mapping[str, Any]) -> ReportTable:
    """Positions of the ends, forces and moments of their supports, by component."""
    return _table(stage, key_result=False, bars={})


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
