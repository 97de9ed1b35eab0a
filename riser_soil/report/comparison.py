"""Several runs side by side: what their scenes differ in, headline quantities with differences."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from riser_soil.accuracy.headlines import headlines
from riser_soil.report.extremes import READ_IN
from riser_soil.report.tables import NOTHING, ReportTable, number
from riser_soil.results import Run

_MISSING = object()


def differences_table(runs: Mapping[str, Run]) -> ReportTable:
    """Keys of the scenes that are not the same in all runs; runs by their labels."""
    flat = {label: dict(_flattened(run.scene, "")) for label, run in runs.items()}
    keys = dict.fromkeys(key for each in flat.values() for key in each)
    rows = []
    for key in keys:
        values = [each.get(key, _MISSING) for each in flat.values()]
        if any(value != values[0] for value in values):
            rows.append([key, *(NOTHING if value is _MISSING else str(value) for value in values)])
    return ReportTable(("key", *runs), rows)


def headlines_table(runs: Mapping[str, Run]) -> ReportTable:
    """Headline quantities, and by how much they differ from the first run's: relative to their scale."""
    known = [headlines(run.summary) for run in runs.values()]
    first, *others = known
    rows = []
    for key in dict.fromkeys(key for each in known for key in each):
        one = next(each[key] for each in known if key in each)
        unit, scale = READ_IN.get(one.unit, (one.unit, 1.0))
        values = [number(each[key].value * scale) if key in each else NOTHING for each in known]
        row = [key, unit, values[0]]
        for value, each in zip(values[1:], others, strict=True):
            row += [value, _difference(first, each, key)]
        rows.append(row)
    labels = [*runs]
    heads = [head for label in labels[1:] for head in (label, f"differs from {labels[0]} by [%]")]
    note = (
        "Of static stages at their end, of others the extremes. A difference is relative to the first run's "
        "size; of forces to a tenth of the stage's largest at least, of touchdown arcs to the distance of the ends."
    )
    return ReportTable(("quantity", "unit", labels[0], *heads), rows, note)


def _difference(first: Mapping[str, Any], other: Mapping[str, Any], key: str) -> str:
    if key not in first or key not in other:
        return NOTHING
    share = first[key].relative(other[key].value - first[key].value)
    signed = share if other[key].value >= first[key].value else -share
    return f"{100.0 * signed:+.3g}"


def _flattened(value: Any, path: str) -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict) and value:
        for key, inner in value.items():
            yield from _flattened(inner, f"{path}.{key}" if path else str(key))
    elif isinstance(value, list) and any(isinstance(item, dict) for item in value):
        for n, inner in enumerate(value):
            yield from _flattened(inner, f"{path}.{n}")
    else:
        yield path, value
