"""Chapter on code checks: the largest utilisation of each check, and of the allowable values of the scene."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

from riser_soil.plots.curves import Curves
from riser_soil.plots.utilisations import utilisation_sheet
from riser_soil.report.document import Block, Paragraph, PictureBlock, ReportSection, TableBlock
from riser_soil.report.governing import governing, is_check, uses
from riser_soil.report.inputs import input_rows
from riser_soil.report.parameters import reference_of
from riser_soil.report.sources import LoadCase, Sources
from riser_soil.report.tables import NOTHING, ReportTable, compact, number
from riser_soil.results.stage_records import stage_records

NO_CHECK = "No code check is made: no load case asks for one."
_CODES = {
    "dnv-st-f201": "DNV-ST-F201",
    "api-std-2rd": "API STD 2RD",
    "api-rp-2rd": "API RP 2RD",
    "flexible-pipe": "limits of a flexible pipe",
    "capacity-curve": "a capacity curve",
}
_INPUT = ("quantity", "value", "unit")
_BY_VALUE = "Utilisations of allowable values"


def chapter(sources: Sources) -> ReportSection:
    return ReportSection("Code checks", [*_blocks(sources)])


def largest(sources: Sources) -> list[tuple[LoadCase, str, dict[str, Any]]]:
    """Each check of each line type with the case and load step in which its utilisation is largest."""
    worst: dict[tuple[str, ...], tuple[LoadCase, str, dict[str, Any]]] = {}
    for case in sources.cases:
        for stage in case.stages:
            for check in stage.get("code_check", ()):
                key = tuple(str(check[name]) for name in ("line_type", "code", "check", "limit_state"))
                known = worst.get(key)
                if check["utilisation"] is not None and (
                    known is None or check["utilisation"] > known[2]["utilisation"]
                ):
                    worst[key] = (case, stage["name"], check)
    return [*worst.values()]


def _blocks(sources: Sources) -> Iterator[Block]:
    checks = largest(sources)
    if checks:
        rows = [_row(case, stage, check) for case, stage, check in checks]
        of_checks = ("line type", "code", "check", "limit state", "safety class", "utilisation", "load case",
                     "load step", "arc length [m]", "time [s]")  # fmt: skip
        clauses = dict.fromkeys(f"{check['check']}: {check['clause']}" for _, _, check in checks if check.get("clause"))
        note = f"A utilisation above 1 means that the limit is exceeded. Clauses: {'; '.join(clauses)}."
        content = compact(ReportTable(of_checks, rows, note))
        yield TableBlock("Code checks, the largest utilisation of each", content, 5, "checks")
        beyond = [row for row, (*_, check) in zip(rows, checks, strict=True) if check["exceeded"]]
        if beyond:
            names = "; ".join(f"{row[2]} of {row[0]} by {row[1]}, {row[5]} in {row[6]}" for row in beyond)
            yield Paragraph(f"Exceeded: {names}.", "warning")
        else:
            yield Paragraph("All checks are fulfilled.")
        yield from _input(sources)
    else:
        yield Paragraph(NO_CHECK)
    own = [each for each in uses(governing(sources.cases)) if not is_check(each.kind)]
    if own:
        rows = [
            [each.kind.words, each.text, each.case.name, each.stage, number(each.arc), number(each.time, 4)]
            for each in own
        ]
        head = ("utilisation", "value [-]", "load case", "load step", "arc length [m]", "time [s]")
        note = "Allowable values are those of the line types; they are those of no code."
        yield TableBlock(_BY_VALUE, compact(ReportTable(head, rows, note)), key="allowable")
    yield from _pictures(sources)


def _input(sources: Sources) -> Iterator[Block]:
    """Input of the checks of the reference case."""
    scene = reference_of(sources).scene
    for check in () if scene is None else scene.code_check:
        names = f" of {', '.join(check.line_types)}" if check.line_types else ""
        rows = input_rows(check, skip=("kind", "line_types"))
        yield TableBlock(f"Input of the check by {_CODES[check.kind]}{names}", ReportTable(_INPUT, rows))


def _pictures(sources: Sources) -> Iterator[Block]:
    """Utilisations along the line of the case and load step in which the largest one is: of codes, of values."""
    every = uses(governing(sources.cases))
    for words, chosen in (
        ("code checks", [each for each in every if is_check(each.kind)]),
        ("allowable values", [each for each in every if not is_check(each.kind)]),
    ):
        if not chosen:
            continue
        case, stage = chosen[0].case, chosen[0].stage
        variables = {each.kind.figure.removeprefix("max_"): each.kind.words for each in chosen}
        there = {name: text.removeprefix("code check: ") for name, text in variables.items() if case.run.has(name)}
        if there:
            draw = partial(utilisation_sheet, stage_records(case.run, stage), there)
            caption = f"Utilisations of {words} along the line, maxima of {case.name} in the load step {stage}"
            yield PictureBlock(caption, Curves(draw))


def _row(case: LoadCase, stage: str, check: dict[str, Any]) -> list[str]:
    words = [str(check.get(name) or NOTHING) for name in ("line_type", "code", "check", "limit_state", "safety_class")]
    static = next(each["kind"] for each in case.stages if each["name"] == stage) == "static"
    time = NOTHING if static else number(check.get("time"), 4)
    return [*words, f"{check['utilisation']:.3f}", case.name, stage, number(check.get("arc")), time]
