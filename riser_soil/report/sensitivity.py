"""Chapter on sensitivity: how much results change with each parameter that varies among cases, as table and tornado."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from statistics import fmean

from riser_soil.plots.curves import Curves
from riser_soil.plots.sensitivity import Bar, tornado
from riser_soil.report.document import Block, Paragraph, PictureBlock, ReportSection, TableBlock
from riser_soil.report.governing import Result, ResultKind, bar_shares, difference, results_of, signed
from riser_soil.report.parameters import Parameter, parameters, reference_of, seeds_of
from riser_soil.report.response import governing_case, moving
from riser_soil.report.sources import LoadCase, Sources
from riser_soil.report.tables import NOTHING, ReportTable, compact

_COLUMNS = (  # keys of kinds
    "max upper.effective_tension",
    "min min_effective_tension",
    "max max_bending_moment",
    "max max_stress_utilisation",
    "max max_bend_utilisation",
    "max max_code_utilisation",
    "min touchdown_arc",
)
_FIRST = (*_COLUMNS[5:2:-1], "max max_bending_moment")


def chapter(sources: Sources) -> ReportSection:
    return ReportSection("Sensitivity", [*_blocks(sources)])


def _blocks(sources: Sources) -> Iterator[Block]:
    names = parameters(sources.cases)
    if not names:
        return
    line = governing_case(sources).line
    sources = replace(sources, cases=[case for case in sources.cases if case.line == line])
    reference = reference_of(sources)
    base = {name.paths: name.of(reference) for name in names}
    alike = [case for case in sources.cases if all(name.of(case) == base[name.paths] for name in names)]
    own = _mean(alike, sources)
    kinds = [own[key].kind for key in _COLUMNS if key in own]
    rows = [["reference", "; ".join(name.label(base[name.paths]) for name in names), *(own[k.key].text for k in kinds)]]
    bars: dict[str, list[Bar]] = {}
    shares = bar_shares(sources.cases)
    for name in names:
        changes = dict(_changes(sources, alike, _varied(sources.cases, names, name, base)))
        for value, change in changes.items():
            each = (_change(shares, *change.get(kind.key, (None, None))) for kind in kinds)
            rows.append([name.words, name.label(value), *each])
        for kind in kinds:
            ends = [
                (name.label(value), own[kind.key].value + change[kind.key][0].value - change[kind.key][1].value)
                for value, change in changes.items()
                if kind.key in change
            ]
            if ends:
                bars.setdefault(kind.key, []).append(Bar(name.words, ends))
    if len(rows) == 1:
        return
    yield Paragraph(
        "Each parameter is varied alone; all others have the values of the reference. Extremes of cases that differ in "
        "their seed alone are averaged over the seeds, and compared with the reference of the same seeds."
    )
    head = ("parameter", "value", *(f"{_short(kind)} [{kind.unit}]" for kind in kinds))
    note = (
        f"First row: values of the reference; below: changes from them, of arc lengths in m. {NOTHING}: less than the "
        "error bar (of any case that has one), or less than 0.01 % where no error bar was asked for."
    )
    yield TableBlock("Sensitivity of the extremes", compact(ReportTable(head, rows, note)), words=2, key="sensitivity")
    first = (key for key in _FIRST if any(_differs(own[key], bar, shares) for bar in bars.get(key, ())))
    shown = next((own[key].kind for key in first), None)
    if shown is not None:
        at = own[shown.key]
        unit = "" if shown.unit == "-" else shown.unit
        words = f"Tornado: {shown.words}; the line is the reference, {at.text} {unit}".rstrip()
        yield PictureBlock(words, Curves(partial(tornado, shown.words, shown.unit, at.value, bars[shown.key])))


def _short(kind: ResultKind) -> str:
    return kind.words.replace("maximum", "max.").replace("minimum", "min.").replace(" at the hang-off", "")


def _varied(
    cases: Sequence[LoadCase], names: Sequence[Parameter], name: Parameter, base: Mapping[tuple[str, ...], str]
) -> dict[str, list[LoadCase]]:
    """Cases that differ from the base in one parameter alone, by its value."""
    varied: dict[str, list[LoadCase]] = {}
    for case in cases:
        others = all(other.of(case) == base[other.paths] for other in names if other is not name)
        if others and name.of(case) != base[name.paths]:
            varied.setdefault(name.of(case), []).append(case)
    return varied


def _mean(cases: Sequence[LoadCase], sources: Sources) -> dict[str, Result]:
    """Extremes of a load step, averaged over cases; of static runs those of the last one."""
    groups: dict[str, list[Result]] = {}
    for case in cases:
        stage = moving(case, sources.given.stage) or case.stages[-1]["name"]
        for result in results_of(case):
            if result.stage == stage:
                groups.setdefault(result.kind.key, []).append(result)
    return {key: _averaged(results) for key, results in groups.items()}


def _averaged(results: Sequence[Result]) -> Result:
    first = results[0]
    if len(results) == 1:
        return first
    return Result(first.kind, first.case, first.stage, first.static, fmean(each.value for each in results))


def _differs(own: Result, bar: Bar, shares: Mapping[tuple[str, str], float]) -> bool:
    """Whether a bar is longer than an error bar."""
    values = (replace(own, value=value) for _, value in bar.values)
    return any(difference(value, own, shares) is not None for value in values)


def _changes(
    sources: Sources, alike: Sequence[LoadCase], varied: Mapping[str, Sequence[LoadCase]]
) -> Iterator[tuple[str, dict[str, tuple[Result, Result]]]]:
    """Results of varied cases, each beside that of the reference with the same seeds, by value and kind."""
    for value, cases in varied.items():
        seeds = {seeds_of(case) for case in cases}
        own = _mean([case for case in alike if seeds_of(case) in seeds] or alike, sources)
        means = _mean(cases, sources)
        yield value, {key: (means[key], own[key]) for key in means if key in own}


def _change(shares: Mapping[tuple[str, str], float], result: Result | None, own: Result | None) -> str:
    if result is None or own is None:
        return NOTHING
    apart = difference(result, own, shares)
    if apart is None:
        return NOTHING
    if own.value == 0.0 or "touchdown" in own.kind.figure:
        return f"{signed(apart)} {own.kind.unit}"
    return f"{signed(100.0 * apart / abs(own.value))} %"
