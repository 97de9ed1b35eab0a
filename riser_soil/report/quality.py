"""Chapter on numerical quality, in plain words: error bars, energy, convergence, warnings."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from riser_soil.report import health
from riser_soil.report.document import Block, Paragraph, Points, ReportSection, TableBlock
from riser_soil.report.extremes import key_results_table
from riser_soil.report.response import governing_case
from riser_soil.report.sources import LoadCase, Sources
from riser_soil.report.tables import number, value_at, without_paths

GOOD_BALANCE = 1.0  # % of the largest energy: a residual that is less needs no remark
_MOST_WARNINGS = 40


def chapter(sources: Sources) -> ReportSection:
    return ReportSection(
        "Numerical quality",
        [
            ReportSection("Error bars", [*_bars(sources)]),
            ReportSection("Energy balance and convergence", [*_energy(sources)]),
            ReportSection("Warnings", [*_warnings(sources)]),
        ],
    )


def _bars(sources: Sources) -> Iterator[Block]:
    barred = [case for case in sources.cases if value_at(case.run.summary, ("error_bars", "quantities"))]
    if not barred:
        yield Paragraph(
            "No error bars were asked for: how far mesh and time step move the results is not known from these runs."
        )
        return
    case = governing_case(sources)
    case = case if case in barred else barred[0]
    yield Paragraph(
        "Error bars are found by runs with other elements, time steps and ground settings. An error bar is the size of "
        f"the numerical error that is to be expected; it says nothing of the input. Those of {case.name}:"
    )
    yield TableBlock("Results with their error bars", key_results_table(case.run.summary), words=3, key="bars")


def _energy(sources: Sources) -> Iterator[Block]:
    unfinished = [case.name for case in sources.cases if not case.run.summary["finished"]]
    if unfinished:
        names = ", ".join(unfinished)
        yield Paragraph(f"Not finished, with results up to where they ended: {names}.", "warning")
    worst = max(((*_residual(case), case) for case in sources.cases), key=lambda each: each[0])
    if worst[1]:
        share, stage, case = worst
        judged = "which is small" if share <= GOOD_BALANCE else "which is large: results of this load step are in doubt"
        yield Paragraph(
            "In each time step the energies of line, ground and water are added up; what appears or vanishes without a "
            f"cause is the residual. The largest one is {number(share, 2)} % of the largest energy that was moved, "
            f"{judged} (load step {stage} of {case.name}).",
            "" if share <= GOOD_BALANCE else "warning",
        )
    cut = sum(stage["step_cuts"] for case in sources.cases for stage in case.stages)
    steps = sum(stage["steps"] for case in sources.cases for stage in case.stages)
    yield Paragraph(
        f"All {steps} load and time steps converged; {cut} of them had to be divided." if cut else
        f"All {steps} load and time steps converged as they were."
    )  # fmt: skip
    case = governing_case(sources)
    for each in [each for each in case.stages if each["kind"] == "dynamic"][-1:]:
        words = f"Energy balance of {case.name}, load step {each['name']}"
        yield TableBlock(words, health.energy_table(each), key="energy")
    yield TableBlock(f"Solution of {case.name}", health.solver_table(case.run.summary), words=2)


def _residual(case: LoadCase) -> tuple[float, str]:
    """Largest residual of the energy balance [% of the largest energy] and its load step; "" where there is none."""
    worst = (0.0, "")
    for stage in case.stages:
        energy: Mapping[str, Any] = stage.get("energy") or {}
        value, whole = value_at(energy, ("worst_residual", "value")), energy.get("turned_over")
        if stage["kind"] == "dynamic" and value is not None and whole:
            worst = max(worst, (100.0 * abs(value) / whole, stage["name"]))
    return worst


def _warnings(sources: Sources) -> Iterator[Block]:
    by_text: dict[str, list[str]] = {}
    for case in sources.cases:
        for text in health.warnings_of(case.run.summary):
            by_text.setdefault(without_paths(text), []).append(case.name)
    if not by_text:
        yield Paragraph("The program has no warnings on input or results.")
        return
    several = len(sources.cases) > 1
    shown = [f"{text} ({_of(names, len(sources.cases))})" if several else text for text, names in by_text.items()]
    more = len(shown) - _MOST_WARNINGS
    yield Points([*shown[:_MOST_WARNINGS], *([f"{more} more, in the summaries of the runs"] if more > 0 else [])],
                 "warning")  # fmt: skip


def _of(names: list[str], count: int) -> str:
    if len(names) == count:
        return "all load cases"
    return ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")
