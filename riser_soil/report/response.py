"""Chapter on extremes: load cases side by side, characteristic values over seeds, the governing case in pictures."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from statistics import fmean, stdev
from typing import Any

from riser_soil.errors import ResultsError
from riser_soil.plots.album import Picture as Sheet
from riser_soil.plots.album import TouchdownView, pictures
from riser_soil.plots.curves import Curves
from riser_soil.plots.side_by_side import sheets
from riser_soil.report import health
from riser_soil.report.captions import in_caption
from riser_soil.report.document import Block, Paragraph, PictureBlock, ReportSection, TableBlock, ref
from riser_soil.report.extremes import bodies_and_joints_table, in_field_words, reactions_table
from riser_soil.report.governing import governing, of_stage, unit_of, uses
from riser_soil.report.sources import LoadCase, Sources, is_seed
from riser_soil.report.statics import MOST_CURVES, static_stage
from riser_soil.report.tables import NOTHING, ReportTable, compact, number, without_paths
from riser_soil.results.stage_records import StageRecords, stage_records

MOST_ROWS = 60  # load cases in the table side by side
_SCATTERS = 1e-3  # of a result: cases or seeds that differ less are alike
_COLUMNS = (  # key of a kind, head
    ("max upper.effective_tension", "max. tension at hang-off [kN]"),
    ("min min_effective_tension", "min. effective tension [kN]"),
    ("max max_bending_moment", "max. bending moment [kN m]"),
    ("min min_bend_radius", "MBR [m]"),
    ("max max_stress_utilisation", "von Mises over allowable [-]"),
    ("max max_code_utilisation", "code check [-]"),
    ("min touchdown_arc", "min. TDP arc [m]"),
    ("max touchdown_arc", "max. TDP arc [m]"),
)
_OF_SEEDS = "Other results, and those that do not scatter, are in characteristic.csv of the cases' folder."
_MAIN = ("top tension", "largest bending moment", "least effective tension", "touchdown arc", "stress utilisation",
         "bend utilisation", "tension utilisation", "code utilisation", "combined loading utilisation",
         "capacity curve utilisation")  # fmt: skip
_DRAWN = ("effective_tension", "wall_tension", "bending_moment", "curvature", "wall_von_mises_stress", "contact_force",
          "soil_settlement")  # fmt: skip


def moving(case: LoadCase, stage: str | None) -> str | None:
    """The load step that counts: the one named where the case has it, else the last one along time; None for none."""
    timed = [each["name"] for each in case.stages if each["kind"] != "static"]
    if stage in timed:
        return stage
    return timed[-1] if timed else None


def governing_case(sources: Sources) -> LoadCase:
    """The case with the largest utilisation that differs among cases; without one, that with the largest moment."""
    timed = [case for case in sources.cases if moving(case, sources.given.stage)] or [*sources.cases]
    best = governing(timed)
    for most in uses(best):
        each = [governing([case]).get(most.kind.key) for case in timed]
        known = [result.value for result in each if result is not None]
        if len(timed) == 1 or max(known) - min(known) > _SCATTERS * abs(max(known)):
            return most.case
    moment = best.get("max max_bending_moment")
    return moment.case if moment is not None else timed[0]


def chapter(sources: Sources) -> ReportSection:
    """Nothing of runs in which nothing goes along time: their results are those of the static configuration."""
    if not any(moving(case, None) for case in sources.cases):
        only = ReportSection("Bodies, joints and clearance", [*_bodies_and_joints(sources)])
        return ReportSection("Extremes", [only])
    return ReportSection(
        "Extremes",
        [
            ReportSection("Load cases side by side", [*_side_by_side(sources)]),
            ReportSection("Characteristic extremes", [*_characteristic(sources)]),
            ReportSection("Governing load case", [*_governing(sources)]),
            ReportSection("Bodies, joints and clearance", [*_bodies_and_joints(sources)]),
            ReportSection("Comparison of load cases", [*_compared(sources)]),
        ],
    )


def _side_by_side(sources: Sources) -> Iterator[Block]:
    if len(sources.cases) == 1:
        return
    rows, shown = [], sources.cases[:MOST_ROWS]
    for case in shown:
        stage = moving(case, sources.given.stage)
        if stage is not None:
            results = of_stage(case, stage)
            rows.append([case.name, stage, *(results[key].text if key in results else NOTHING for key, _ in _COLUMNS)])
    if not rows:
        return
    same = len({row[1] for row in rows}) == 1
    head = ("load case", "load step", *(head for _, head in _COLUMNS))
    if same:
        head, rows = (head[0], *head[2:]), [[row[0], *row[2:]] for row in rows]
    more = len(sources.cases) - len(shown)
    note = "Extremes over the whole load step and along the whole line, between nodes and between records too."
    note += f" {more} more cases are in the tables of the cases' folder." if more > 0 else ""
    yield TableBlock("Extremes of the load cases", compact(ReportTable(head, rows, note)), key="extremes")


def _characteristic(sources: Sources) -> Iterator[Block]:
    if sources.characteristic:
        yield from _characteristic_tables(sources.characteristic)
    else:
        yield from _over_seeds(sources)
    if sources.statistics:
        yield from _statistics(sources.statistics)


def _characteristic_tables(rows: Sequence[Mapping[str, str]]) -> Iterator[Block]:
    """Tables of riser-soil cases: Gumbel's distribution over the maxima of seeds."""
    table = []
    for row in rows:
        if not _counts(row):
            continue
        unit, scale = unit_of(row["unit"])
        values = [_scaled(row.get(name, ""), scale) for name in ("mean", "of seeds", "characteristic", "low", "high")]
        quantity = row["quantity"].rpartition(": ")[2]
        table.append([row["group"], in_field_words(quantity), unit, row["seeds"], *values])
    known = next((row for row in rows if row.get("fractile")), None)
    note = _OF_SEEDS
    if known is not None:
        note = (
            f"Gumbel's distribution is fitted to the extremes of the seeds; the characteristic value is its "
            f"{100.0 * float(known['fractile']):.3g} % fractile for {_hours(known['duration [s]'])}, the interval that "
            f"of {100.0 * float(known['confidence']):.3g} % confidence. Without it there are fewer than three seeds. "
            f"{_OF_SEEDS}"
        )
    head = ("case", "quantity", "unit", "seeds", "mean", "extreme of seeds", "characteristic", "from", "to")
    yield TableBlock("Characteristic extremes over seeds", compact(ReportTable(head, table, note)), 2, "characteristic")


def _counts(row: Mapping[str, str]) -> bool:
    """Whether a row is of a main result that scatters among seeds."""
    scatter = abs(float(row["standard deviation"])) if row["standard deviation"] else math.inf
    quantity = row["quantity"].rpartition(": ")[2]
    return quantity.endswith(_MAIN) and scatter > _SCATTERS * abs(float(row["mean"] or 0.0))


def _hours(seconds: str) -> str:
    hours = float(seconds) / 3600.0
    return f"{hours:.3g} hours" if hours >= 1.0 else f"{float(seconds):.4g} s"


def _scaled(value: str, scale: float) -> str:
    return number(scale * float(value), 4) if value else NOTHING


def _over_seeds(sources: Sources) -> Iterator[Block]:
    """Mean, deviation and extreme of seeds, of cases that differ in their seed alone."""
    table = []
    for name, cases in sources.groups.items():
        if len(cases) < 2 or not any(is_seed(axis) for axis in cases[0].axes):
            continue
        rows = [
            of_stage(case, stage) for case in cases if (stage := moving(case, sources.given.stage)) is not None
        ]
        for key, _ in _COLUMNS:
            values = [each[key].value for each in rows if key in each]
            if len(values) >= 2:
                kind = rows[0][key].kind
                worst = max(values) if kind.which == "max" else min(values)
                numbers = [number(value, 4) for value in (fmean(values), stdev(values), worst)]
                table.append([name, kind.words, kind.unit, str(len(values)), *numbers])
    if table:
        head = ("case", "quantity", "unit", "seeds", "mean", "standard deviation", "extreme of seeds")
        note = "Extremes of each seed over its load step; no distribution is fitted."
        yield TableBlock("Extremes over seeds", ReportTable(head, table, note), words=2, key="seeds")


def _statistics(rows: Sequence[Mapping[str, Any]]) -> Iterator[Block]:
    """Tables of riser-soil statistics: most probable extremes at places along the line."""
    table = []
    for row in rows:
        unit, scale = unit_of(row["unit"])
        place = NOTHING if row["arc_m"] is None else number(row["arc_m"])
        values = [number(None if row[key] is None else scale * row[key], 4) for key in ("mean", "standard_deviation")]
        fits = [_interval(row, fit, scale) for fit in ("weibull", "gumbel")]
        rayleigh = number(None if row["rayleigh"] is None else scale * row["rayleigh"], 4)
        quantity = row["output"].replace("_", " ")
        table.append([quantity, place, unit, str(row["runs"]), *values, rayleigh, *fits])
    first = rows[0]
    note = (
        f"Most probable {first['extremes']} value in {_hours(str(first['duration_s']))} by three distributions; "
        f"brackets have the interval of {100.0 * first['confidence']:.3g} % confidence."
    )
    head = ("output", "arc length [m]", "unit", "runs", "mean", "st. dev.", "Rayleigh", "Weibull", "Gumbel")
    content = compact(ReportTable(head, table, note))
    yield TableBlock("Most probable extremes at places along the line", content, 1, "places")


def _interval(row: Mapping[str, Any], fit: str, scale: float) -> str:
    if row[fit] is None:
        return NOTHING
    low, high = (number(None if row[f"{fit}_{side}"] is None else scale * row[f"{fit}_{side}"], 4)
                 for side in ("low", "high"))  # fmt: skip
    return f"{number(scale * row[fit], 4)} ({low} to {high})"


def _governing(sources: Sources) -> Iterator[Block]:
    case = governing_case(sources)
    stage = moving(case, sources.given.stage)
    try:
        records = stage_records(case.run, stage)
    except ResultsError:
        return
    stage_summary = case.run.summary["stages"][records.number]
    several = len(sources.cases) > 1
    if several:
        yield Paragraph(
            f"The tables and pictures of this section are those of the load case {case.name}, which governs, in its "
            f"load step {records.name}."
        )
    yield TableBlock(f"Results of the load step {records.name}", _results(case, records.name), key="governing")
    reactions = reactions_table(stage_summary)
    if reactions:
        yield TableBlock("Support reactions", reactions, key="ends")
    soil = health.soil_table(stage_summary)
    if soil:
        yield TableBlock("Soil", soil, key="soil")
    for each in pictures(records):
        if each.name == "range_contact_force" and not records["contact_force"].any():
            continue
        if each.group in ("shape", "histories", "soil") or each.name.removeprefix("range_") in _DRAWN:
            yield _picture(each, records)
    if case.run.has_soil:
        view = TouchdownView(case.run)
        try:
            assert view.png
            yield PictureBlock("Touchdown zone and whole line at the end of the run", view)
        except ResultsError as err:
            yield Paragraph(f"No picture of the touchdown zone: {without_paths(str(err))}")


def _results(case: LoadCase, stage: str) -> ReportTable:
    """All results of a load step, beside those of the static load step before it."""
    before = static_stage(case)
    static = {} if before is None or before == stage else of_stage(case, before)
    rows = []
    for key, each in of_stage(case, stage).items():
        value = each.text if each.bar is None else f"{each.text} ± {number(each.bar, 2)}"
        rest = static[key].text if key in static else NOTHING
        rows.append([each.kind.words, each.kind.unit, rest, value, number(each.arc), number(each.time, 4)])
    head = ("result", "unit", "static", "value", "arc length [m]", "time [s]")
    return compact(ReportTable(head, rows))


def _picture(each: Sheet, records: StageRecords) -> PictureBlock:
    return PictureBlock(f"{in_caption(each)}, load step {records.name}", Curves(each.bare))


def _bodies_and_joints(sources: Sources) -> Iterator[Block]:
    for name, run in sources.whole.items():
        table = bodies_and_joints_table(run.summary)
        if table:
            yield TableBlock(f"Bodies, joints and clearance: {name}", table, words=3)


def _compared(sources: Sources) -> Iterator[Block]:
    """One curve a group, of its case with the largest bending moment."""
    groups = {name: _worst(cases) for name, cases in [*sources.groups.items()][:MOST_CURVES]}
    if len(groups) < 2:
        return
    stage = moving(next(iter(groups.values())), sources.given.stage)
    words = ["Values at the end of the load step."]
    if stage is not None:
        words = [f"Solid lines are maxima over the load step, dotted ones minima; values are in {ref('extremes')}."]
    if len(groups) < len(sources.groups):
        words.append(f"The first {len(groups)} groups of cases are drawn.")
    if len(sources.groups) < len(sources.cases):
        words.append("Of cases that differ in their seed alone, the one with the largest bending moment is drawn.")
    yield Paragraph(" ".join(words))
    for each in sheets({name: case.run for name, case in groups.items()}, stage):
        if each.name in ("", "effective_tension", "bending_moment", "curvature", "stress_utilisation",
                         "code_utilisation", "contact_force"):  # fmt: skip
            yield PictureBlock(f"{in_caption(each)}, load cases side by side", Curves(each.draw))


def _worst(cases: Sequence[LoadCase]) -> LoadCase:
    result = governing(cases).get("max max_bending_moment")
    return cases[0] if result is None else result.case
