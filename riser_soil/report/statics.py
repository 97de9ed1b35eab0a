"""Chapter on the static configuration: the line at rest, near, mean and far."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial

from riser_soil.errors import ResultsError
from riser_soil.plots.album import pictures
from riser_soil.plots.curves import Curves
from riser_soil.plots.side_by_side import recorded_by_all, static_shapes, static_tensions
from riser_soil.report.captions import in_caption
from riser_soil.report.document import Block, Paragraph, PictureBlock, ReportSection, TableBlock, ref
from riser_soil.report.extremes import reactions_table
from riser_soil.report.governing import Result, of_stage
from riser_soil.report.sources import TABLE, LoadCase, Sources, is_seed
from riser_soil.report.tables import NOTHING, ReportTable, compact, number
from riser_soil.results.stage_records import StageRecords, stage_records

MOST_CURVES = 8
_SAME = 1e-6  # of a result: static configurations that differ less are one
_COLUMNS = (  # key of a kind, head
    ("max upper.effective_tension", "tension at hang-off [kN]"),
    ("max upper.angle_deg", "hang-off angle from the vertical [°]"),
    ("min min_effective_tension", "minimum effective tension [kN]"),
    ("max touchdown_arc", "arc length of the TDP [m]"),
    ("max max_bending_moment", "maximum bending moment [kN m]"),
    ("min min_bend_radius", "MBR [m]"),
    ("max max_stress_utilisation", "von Mises over allowable stress [-]"),
)


def chapter(sources: Sources) -> ReportSection:
    return ReportSection("Static configuration", [*_blocks(sources)])


def static_stage(case: LoadCase) -> str | None:
    """Name of the last static load step before anything moves; None where there is none."""
    name = None
    for stage in case.stages:
        if stage["kind"] != "static":
            break
        name = stage["name"]
    return None if name is None else str(name)


def different(sources: Sources) -> dict[str, LoadCase]:
    """Cases whose static configurations differ, by what those that share one have in common."""
    sharing: list[tuple[dict[str, Result], list[LoadCase]]] = []
    for case in sources.cases:
        stage = static_stage(case)
        if stage is None:
            continue
        results = of_stage(case, stage)
        known = next((cases for each, cases in sharing if _alike(each, results)), None)
        if known is None:
            sharing.append((results, [case]))
        else:
            known.append(case)
    distinct: dict[str, LoadCase] = {}
    for _, cases in sharing:
        name = _common(cases, len(sharing))
        distinct[name if name not in distinct else cases[0].name] = cases[0]
    return distinct


def _alike(one: Mapping[str, Result], other: Mapping[str, Result]) -> bool:
    keys = [key for key, _ in _COLUMNS if key in one or key in other]
    return all(
        key in one
        and key in other
        and abs(one[key].value - other[key].value) <= _SAME * max(abs(one[key].value), abs(other[key].value))
        for key in keys
    )


def _common(cases: Sequence[LoadCase], count: int) -> str:
    """Values of the axes that all cases share; of a single case, its name."""
    first = cases[0]
    if len(cases) == 1:
        return first.name
    if count == 1:
        return "all load cases"
    shared = {
        name: value
        for name, value in first.axes.items()
        if not is_seed(name) and name != TABLE and all(case.axes.get(name) == value for case in cases)
    }
    if shared and all("." not in name for name in shared):
        return ", ".join(shared.values())
    parts = [part for part in first.name.split("-") if all(part in case.name.split("-") for case in cases)]
    return "-".join(parts) or first.name


def _blocks(sources: Sources) -> Iterator[Block]:
    cases = different(sources)
    if not cases:
        return
    yield TableBlock("Static configuration", _table(cases), key="static")
    yield Paragraph(
        f"{ref('static')} is at the end of the last static load step, with weight, current and the vessel's offset. "
        "Angles count from the vertical."
    )
    stages = {name: _records(case) for name, case in cases.items()}
    drawn = {name: stage for name, stage in stages.items() if stage is not None}
    if len(drawn) == 1:
        (stage,) = drawn.values()
        yield TableBlock("Support reactions, static", reactions_table(stage.summary), key="static reactions")
        for each in pictures(stage):
            if each.group == "shape" or each.name in ("range_effective_tension", "range_bending_moment"):
                yield PictureBlock(f"{in_caption(each)}, static", Curves(each.bare))
    elif drawn:
        few = dict([*drawn.items()][:MOST_CURVES])
        yield PictureBlock("Static shapes; triangles mark the TDP", Curves(partial(static_shapes, few)))
        if there := recorded_by_all(few):
            words = " and ".join(name.replace("_", " ") for name in there).capitalize()
            yield PictureBlock(f"{words}, static", Curves(partial(static_tensions, few)))


def _records(case: LoadCase) -> StageRecords | None:
    try:
        return stage_records(case.run, static_stage(case))
    except ResultsError:
        return None


def _table(cases: Mapping[str, LoadCase]) -> ReportTable:
    rows = []
    for name, case in cases.items():
        stage = static_stage(case)
        assert stage is not None
        results = of_stage(case, stage)
        values = [results[key].text if key in results else NOTHING for key, _ in _COLUMNS]
        rows.append([name, _offset(case), *values])
    return compact(ReportTable(("case", "offset x, y [m]", *(head for _, head in _COLUMNS)), rows))


def _offset(case: LoadCase) -> str:
    vessel = case.run.summary.get("vessel")
    return NOTHING if vessel is None else ", ".join(number(value + 0.0) for value in vessel["offset"][:2])
