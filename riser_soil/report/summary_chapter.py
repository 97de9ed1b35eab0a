"""First chapter: what was found, the governing case of each result and its utilisation."""

from __future__ import annotations

from collections.abc import Iterator

from riser_soil.report import code_checks
from riser_soil.report.document import Block, Paragraph, ReportSection, TableBlock, ref
from riser_soil.report.fatigue_chapter import fatigue_of, years
from riser_soil.report.governing import Result, governing, is_check, used, uses
from riser_soil.report.sources import Sources
from riser_soil.report.tables import NOTHING, ReportTable, compact, number

_NOT_ASSESSED = {"fatigue": "Fatigue is not assessed", "modes": "Natural periods are not computed"}  # by keys


def chapter(sources: Sources) -> ReportSection:
    return ReportSection("Summary", [*_blocks(sources)])


def _blocks(sources: Sources) -> Iterator[Block]:
    count, lines = sources.runs, len({case.line for case in sources.cases})
    cases = "one load case" if count == 1 else f"{count} load cases"
    of_lines = f" of {lines} lines" if lines > 1 else ""
    moves = any(stage["kind"] != "static" for case in sources.cases for stage in case.stages)
    how = "static and dynamic analysis in time" if moves else "static analysis"
    yield Paragraph(
        f"This report is on {sources.first.run.summary['title']}: {cases}{of_lines}, computed by {how}. "
        f"{ref('summary')} has the governing value of each result with the load case and load step in which it occurs. "
        "Lengths along the line count from end A."
    )
    best = governing(sources.cases)
    rows = [_row(result, best) for result in best.values() if not result.kind.check]
    rows += [_row(result, best) for result in best.values() if result.kind.check and _alone(result, best)]
    rows += _fatigue(sources)
    head = ("result", "value", "unit", "load case", "load step", "arc length [m]", "time [s]", "utilisation [-]")
    note = (
        "Extremes between nodes and between records count too. Utilisations above 1 exceed their limit. Without a time "
        "the value is that of a static load step."
    )
    yield TableBlock("Governing results", compact(ReportTable(head, rows, note)), key="summary")
    yield from _verdict(sources, best)


def _alone(result: Result, best: dict[str, Result]) -> bool:
    """Whether a utilisation has no row of the result that it belongs to."""
    return is_check(result.kind) or all(each.kind.use != result.kind.figure for each in best.values()
                                        if not each.kind.check)  # fmt: skip


def _row(result: Result, best: dict[str, Result]) -> list[str]:
    use = result if result.kind.check else used(result, best)
    time = NOTHING if result.static else number(result.time, 4)
    value = result.text if result.bar is None else f"{result.text} ± {number(result.bar, 2)}"
    shown = NOTHING if use is None else f"{use.value:.3f}"
    return [result.kind.words, value, result.kind.unit, result.case.name, result.stage, number(result.arc), time, shown]


def _fatigue(sources: Sources) -> Iterator[list[str]]:
    results = fatigue_of(sources)
    if results is None:
        return
    n, damage = results.damage.hotspot, results.damage.per_year.max()
    life = years(1.0 / float(damage)) if damage > 0.0 else "no damage"
    use = NOTHING if results.utilisation is None else f"{results.utilisation:.3f}"
    arc = number(results.damage.arc[n])
    yield ["shortest fatigue life", life, "years", "all sea states", NOTHING, arc, NOTHING, use]


def _verdict(sources: Sources, best: dict[str, Result]) -> Iterator[Block]:
    """Sentence on limits that are exceeded and checks that were not made."""
    beyond = [f"{each.kind.words}, {each.text} in {each.case.name}" for each in uses(best) if each.value > 1.0]
    results = fatigue_of(sources)
    if results is not None and (results.utilisation or 0.0) > 1.0:
        beyond.append(f"fatigue life, utilisation {number(results.utilisation, 3)}")
    if beyond:
        yield Paragraph(f"Exceeded: {'; '.join(beyond)}.", "warning")
    if not code_checks.largest(sources):
        yield Paragraph(code_checks.NO_CHECK)
    missing = [key for key in _NOT_ASSESSED if getattr(sources.given, key) is None]
    if missing:
        yield Paragraph(" ".join(_not_assessed(key, sources.given.not_assessed.get(key)) for key in missing))


def _not_assessed(key: str, reason: str | None) -> str:
    """What the report has no chapter on, and why where the report file says so."""
    return f"{_NOT_ASSESSED[key]}{'' if reason is None else f': {reason}'}.".replace("..", ".")
