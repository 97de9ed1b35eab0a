"""Files of a study: study.csv, a row for each point; study.json, all numbers; study.html, a page for reading."""

from __future__ import annotations

import csv
import json
import os
import platform
from collections.abc import Iterator
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np

from riser_soil import __version__
from riser_soil.accuracy.assessment import MOST_UNCERTAIN, AssessedQuantity
from riser_soil.accuracy.findings import TARGETS, Study
from riser_soil.accuracy.study_page import page, words
from riser_soil.accuracy.study_points import PointOutcome
from riser_soil.results.summary import plain_json
from riser_soil.results.whole_file import written_together

TABLE, NUMBERS, PAGE = "study.csv", "study.json", "study.html"


def write_files(study: Study) -> None:
    """All three together."""
    numbers = as_dict(study)
    with written_together(study.folder, (TABLE, NUMBERS, PAGE)) as made:
        _write_table(study, made / TABLE)
        (made / NUMBERS).write_text(json.dumps(plain_json(numbers), indent=1) + "\n", encoding="utf-8")
        (made / PAGE).write_text(page(study, numbers), encoding="utf-8")


def as_dict(study: Study) -> dict[str, Any]:
    """The numbers of study.json, before nan and inf become null. Errors are relative."""
    quantities, front = study.quantities(), study.front()
    reaching = {f"{target:g}": study.reaching(target) for target in TARGETS}
    return {
        "title": study.refinements.scene.title,
        "version": __version__,
        "date": date.today().isoformat(),
        "machine": {"cores": os.cpu_count(), "processor": platform.machine(), "python": platform.python_version()},
        "knobs": [setting.name for setting in study.refinements.settings],
        "words": words(study),
        "quantities": {key: _quantity(study, each) for key, each in quantities.items()},
        "cheapest": {target: list(cheapest.factors) if cheapest else None for target, cheapest in reaching.items()},
        "pareto_front": [list(each.factors) for each in front],
        "points": [_point(study, outcome, outcome in front) for outcome in _in_order(study)],
    }


def _in_order(study: Study) -> list[PointOutcome]:
    """The scene, the refinement series from coarse to fine, then the rest."""
    refinements = study.refinements
    along = [point for number in range(len(refinements.settings)) for point in refinements.along(number)]
    order = dict.fromkeys([refinements.base, *along, *study.outcomes])
    return [study.outcomes[point] for point in order if point in study.outcomes]


def _quantity(study: Study, each: AssessedQuantity) -> dict[str, Any]:
    limits = zip(study.refinements.settings, each.limits, strict=True)
    return {
        "unit": each.scene.unit,
        "value": each.scene.value,
        "reference": each.reference.value,
        "uncertainty": each.uncertainty,
        "scale": each.reference.scale,
        "judged": each.relative_uncertainty <= MOST_UNCERTAIN,
        "error": each.error,
        "knobs": {
            setting.name: {
                "share": each.share(n),
                "order": lim.order,
                "limit": lim.value,
                "uncertainty": lim.uncertainty,
            }
            for n, (setting, lim) in enumerate(limits)
        },
    }


def _point(study: Study, outcome: PointOutcome, on_front: bool) -> dict[str, Any]:
    error, key = study.error(outcome) if outcome.done else (np.nan, "")
    names = [setting.name for setting in study.refinements.settings]
    return {
        "factors": dict(zip(names, outcome.factors, strict=True)),
        "settings": study.refinements.in_words(outcome.factors),
        "status": outcome.status,
        "reason": outcome.reason,
        "cpu": outcome.cpu,
        "timed_alone": outcome.alone,
        "steps": outcome.steps,
        "error": error,
        "in": key,
        "pareto": on_front,
        "values": {key: each.value for key, each in outcome.key_results.items()},
    }


def _write_table(study: Study, file: Path) -> None:
    with file.open("w", newline="", encoding="utf-8") as opened:
        csv.writer(opened).writerows(_rows(study))


def _rows(study: Study) -> Iterator[list[str]]:
    """Head and points; the quantities' values and relative errors are the last columns."""
    quantities, front = study.quantities(), study.front()
    names = [f"{setting.name} [times as fine]" for setting in study.refinements.settings]
    values = [f"{key} [{each.scene.unit}]" for key, each in quantities.items()]
    headings = ["settings", "status", "reason", "cpu [s]", "timed alone", "steps", "largest error [-]", "in", "pareto"]
    yield [*names, *headings, *values, *(f"error of {key} [-]" for key in quantities)]
    for outcome in _in_order(study):
        point = _point(study, outcome, outcome in front)
        cells = [point[name] for name in ("settings", "status", "reason", "cpu", "timed_alone", "steps", "error", "in")]
        results = outcome.key_results
        yield [
            *(f"{factor:.4g}" for factor in outcome.factors),
            *(_cell(cell) for cell in (*cells, point["pareto"])),
            *(f"{results[key].value:.8g}" if key in results else "" for key in quantities),
            *(f"{each.error_of(results[key]):.4g}" if key in results else "" for key, each in quantities.items()),
        ]


def _cell(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return "" if np.isnan(value) else f"{value:.4g}"
    return " ".join(str(value).split())
