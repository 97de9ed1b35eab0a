"""Page of a study in one HTML file, and its words: how far the scene is off, which settings reach an accuracy."""

from __future__ import annotations

import base64
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from typing import Any

from riser_soil.accuracy.assessment import MOST_UNCERTAIN, AssessedQuantity
from riser_soil.accuracy.findings import TARGETS, Study
from riser_soil.plots.work_precision import SettingLine, WorkPrecision, drawn_work_precision

STYLE = """
body { font: 15px/1.45 sans-serif; max-width: 70em; margin: 2em auto; padding: 0 1em; color: #222 }
table { border-collapse: collapse; margin: 1em 0; font-size: 13px }
th, td { border-bottom: 1px solid #ddd; padding: .25em .6em; text-align: right }
th:first-child, td:first-child { text-align: left }
th { vertical-align: bottom }
img { max-width: 100% }
.note { color: #555; font-size: 13px }
"""
Quantities = dict[str, AssessedQuantity]


def page(study: Study, content: Mapping[str, Any]) -> str:
    """The page of a study. content: of study.json."""
    machine = content["machine"]
    made = (
        f"riser-soil {content['version']}, {content['date']}; {machine['cores']} cores ({machine['processor']}), "
        "Python "
        f"{machine['python']}. Seconds are processor time of one core, without start-up."
    )
    title = f"Accuracy and cost of “{content['title']}”"
    return "\n".join(
        [
            '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">',
            f"<title>{escape(title)}</title><style>{STYLE}</style></head><body>",
            f"<h1>{escape(title)}</h1>",
            *_list(content["words"]),
            _image(study, content),
            '<p class="note">Error: the largest relative error among the key results, each line with one setting '
            "varied and the others as in the scene. Below the dotted line errors are less than the uncertainty of the "
            "reference. Hollow points ran beside others.</p>",
            "<h2>Key results</h2>",
            _quantities(content),
            "<h2>Points</h2>",
            _points(content),
            f'<p class="note">{escape(made)}</p></body></html>',
            "",
        ]
    )


def _list(sentences: Iterable[str]) -> list[str]:
    return ["<ul>", *(f"<li>{escape(each[0].upper() + each[1:])}.</li>" for each in sentences), "</ul>"]


def _image(study: Study, content: Mapping[str, Any]) -> str:
    """Plot of the errors as a picture; none where no quantity can be judged."""
    if not any(each["judged"] for each in content["quantities"].values()):
        return ""
    svg = base64.b64encode(drawn_work_precision(plotted(study, content)).encode()).decode()
    return f'<img alt="Error against processor time" src="data:image/svg+xml;base64,{svg}">'


def plotted(study: Study, content: Mapping[str, Any]) -> WorkPrecision:
    """Data of the plot, without failed points."""
    refinements = study.refinements
    places = {tuple(each["factors"].values()): each for each in content["points"] if each["status"] == 0}
    lines, in_series = [], set()
    for number, setting in enumerate(refinements.settings):
        points = [point for point in refinements.along(number) if point in places]
        in_series.update(points)
        orders = [each["knobs"][setting.name]["order"] for each in content["quantities"].values() if each["judged"]]
        observed = _order_range([order for order in orders if order is not None])
        lines.append(SettingLine(setting.words, observed, *_columns([places[point] for point in points])))
    others = [each for point, each in places.items() if point not in in_series]
    front = [places[tuple(point)] for point in content["pareto_front"]]
    scene = places[refinements.base]
    uncertain = [each["uncertainty"] / each["scale"] for each in content["quantities"].values() if each["judged"]]
    here, uncertainty = (scene["cpu"], scene["error"]), max(uncertain, default=0.0)
    return WorkPrecision(lines, *_columns(others)[:2], *_columns(front)[:2], here, uncertainty, TARGETS)


def _columns(points: Sequence[Mapping[str, Any]]) -> tuple[list[float], list[float], list[bool]]:
    """Processor times [s], errors, and whether each was timed alone."""
    return [p["cpu"] for p in points], [p["error"] for p in points], [p["timed_alone"] for p in points]


def _order_range(orders: Sequence[float]) -> str:
    """The range of the orders observed of the quantities."""
    if not orders:
        return "no order"
    low, high = min(orders), max(orders)
    return f"order {low:.1f}" if high - low < 0.1 else f"order {low:.1f} to {high:.1f}"


def _quantities(content: Mapping[str, Any]) -> str:
    head = [
        "quantity",
        "scene",
        "reference",
        "±",
        "unit",
        "error",
        *(f"by {name}, order" for name in content["knobs"]),
    ]
    rows = []
    for key, each in content["quantities"].items():
        shares = (f"{percent(setting['share'])}, {_order(setting['order'])}" for setting in each["knobs"].values())
        error = percent(each["error"]) if each["judged"] else "unknown"
        numbers = (f"{each[name]:.5g}" for name in ("value", "reference"))
        rows.append([key, *numbers, f"{each['uncertainty']:.2g}", each["unit"], error, *shares])
    return _table(head, rows)


def _order(order: float | None) -> str:
    return "–" if order is None else f"{order:.1f}"


def _points(content: Mapping[str, Any]) -> str:
    head = ["settings", "seconds", "steps", "largest error", "in", "Pareto front", "failed"]
    rows = [
        [
            each["settings"],
            f"{each['cpu']:.3g}" + ("" if each["timed_alone"] else " (beside others)"),
            str(each["steps"]),
            percent(each["error"]) if each["status"] == 0 else "",
            each["in"],
            "yes" if each["pareto"] else "",
            each["reason"],
        ]
        for each in content["points"]
    ]
    return _table(head, rows)


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    def row(cells: Sequence[str], kind: str) -> str:
        return "<tr>" + "".join(f"<{kind}>{escape(cell)}</{kind}>" for cell in cells) + "</tr>"

    return "\n".join(["<table>", row(head, "th"), *(row(each, "td") for each in rows), "</table>"])


def words(study: Study) -> list[str]:
    """Result of a study in sentences."""
    return [
        *_moved(study),
        *_unknown(study.quantities()),
        *_accuracy(study),
        *_limiting(study),
        *(sentence for target in TARGETS for sentence in _cheapest(study, target)),
        *_failed(study),
    ]


def _moved(study: Study) -> Iterator[str]:
    if study.failure:
        settings = study.refinements.in_words(study.refinements.base)
        yield f"the scene itself fails: {study.failure}; the study is around finer settings: {settings}"


def percent(part: float) -> str:
    """A part in percent, of three digits; one of inf or nan is unknown."""
    return f"{100.0 * part:.3g} %" if math.isfinite(part) else "unknown"


def _unknown(quantities: Quantities) -> Iterator[str]:
    unknown = _uncertain(quantities, MOST_UNCERTAIN)
    if unknown:
        yield (
            f"the error of {unknown} is unknown, as no refinement converges; what follows is without them"
        )


def _uncertain(quantities: Quantities, most: float) -> str:
    """Quantities whose reference has a larger relative uncertainty, in words."""
    uncertain = ((key, each.relative_uncertainty) for key, each in quantities.items())
    return ", ".join(f"{key} (± {percent(size)})" for key, size in uncertain if not size <= most)


def _off(quantities: Quantities, error: float, key: str) -> str:
    return f"{percent(error)} off at most (± {percent(quantities[key].relative_uncertainty)}), in {key}"


def _accuracy(study: Study) -> Iterator[str]:
    error, key = study.error(study.scene)
    if key:
        scene = "with these settings the scene" if study.failure else "as it is, the scene"
        yield f"{scene} takes {study.scene.cpu:.3g} s and is {_off(study.judged(), error, key)}"


def _limiting(study: Study) -> Iterator[str]:
    """Which setting has the largest share in an error."""
    quantities = study.judged()
    if not quantities:
        return
    shares = [(*_largest_share(quantities, n), setting.words) for n, setting in enumerate(study.refinements.settings)]
    largest = "; ".join(f"{setting} {percent(share)} ({key})" for share, key, setting in sorted(shares, reverse=True))
    most, key, setting = max(shares)
    if most <= quantities[key].relative_uncertainty:
        yield f"no setting limits the accuracy by more than the study resolves; largest shares of error: {largest}"
    else:
        yield f"what limits the accuracy is the {setting}; largest shares of error: {largest}"


def _largest_share(quantities: Quantities, number: int) -> tuple[float, str]:
    return max((each.share(number), key) for key, each in quantities.items())


def _cheapest(study: Study, target: float) -> Iterator[str]:
    quantities, reaching = study.judged(), study.reaching(target)
    if not quantities:
        return
    best = reaching if reaching is not None else study.front()[-1]
    error, key = study.error(best)
    settings, off = study.refinements.in_words(best.factors), _off(quantities, error, key)
    where = "" if len(quantities) == len(study.quantities()) else f" in {len(quantities)} quantities"
    if reaching is None:
        yield f"{percent(target)} is reached{where} by no setting that was run; the best, {settings}, is {off}"
        return
    at = f"at the least cost, {best.cpu:.3g} s, with {settings}: {off}"
    if error <= target:
        yield f"{percent(target)} is reached{where} {at}"
    else:
        yield f"{percent(target)} can't be judged{where}; the reference is reached as far as it is known {at}"
    beside = _uncertain(quantities, target)
    if beside:
        yield f"the reference is known less well than to {percent(target)} of {beside}"


def _failed(study: Study) -> Iterator[str]:
    failed = [each for each in study.outcomes.values() if not each.done]
    if failed:
        yield f"{len(failed)} of {len(study.outcomes)} points failed; study.csv has their reasons"
