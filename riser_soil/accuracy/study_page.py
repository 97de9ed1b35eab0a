"""Page of a study: words, the work-precision plot and tables, in one HTML file that needs no other."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

from riser_soil.accuracy.findings import TARGETS, Study
from riser_soil.accuracy.study_words import percent
from riser_soil.plots.work_precision import KnobLine, WorkPrecision, drawn_work_precision

STYLE = """
body { font: 15px/1.45 sans-serif; max-width: 70em; margin: 2em auto; padding: 0 1em; color: #222 }
table { border-collapse: collapse; margin: 1em 0; font-size: 13px }
th, td { border-bottom: 1px solid #ddd; padding: .25em .6em; text-align: right }
th:first-child, td:first-child { text-align: left }
th { vertical-align: bottom }
img { max-width: 100% }
.note { color: #555; font-size: 13px }
"""


def page(study: Study, told: Mapping[str, Any]) -> str:
    """told: the numbers of study.json."""
    machine = told["machine"]
    made = (
        f"riser-soil {told['version']}, {told['date']}; {machine['cores']} cores ({machine['processor']}), Python "
        f"{machine['python']}. Seconds are processor time of one core, without start-up."
    )
    title = f"Accuracy and cost of “{told['title']}”"
    return "\n".join(
        [
            '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">',
            f"<title>{escape(title)}</title><style>{STYLE}</style></head><body>",
            f"<h1>{escape(title)}</h1>",
            *_list(told["words"]),
            _image(study, told),
            '<p class="note">Error: the largest relative error among the headline quantities, each line with one knob '
            "turned and the others as in the scene. Below the dotted line errors are less than what the reference is "
            "known to. Hollow points ran beside others.</p>",
            "<h2>Headline quantities</h2>",
            _quantities(told),
            "<h2>Points</h2>",
            _points(told),
            f'<p class="note">{escape(made)}</p></body></html>',
            "",
        ]
    )


def _list(sentences: Iterable[str]) -> list[str]:
    return ["<ul>", *(f"<li>{escape(each[0].upper() + each[1:])}.</li>" for each in sentences), "</ul>"]


def _image(study: Study, told: Mapping[str, Any]) -> str:
    """Where no quantity can be judged, there are no errors to plot."""
    if not any(each["judged"] for each in told["quantities"].values()):
        return ""
    svg = base64.b64encode(drawn_work_precision(plotted(study, told)).encode()).decode()
    return f'<img alt="Error against processor time" src="data:image/svg+xml;base64,{svg}">'


def plotted(study: Study, told: Mapping[str, Any]) -> WorkPrecision:
    """What the plot shows; failed points have no place in it."""
    ladders = study.ladders
    places = {tuple(each["factors"].values()): each for each in told["points"] if each["status"] == 0}
    lines, seen = [], set()
    for number, knob in enumerate(ladders.knobs):
        points = [point for point in ladders.along(number) if point in places]
        seen.update(points)
        found = [places[point] for point in points]
        orders = [each["knobs"][knob.name]["order"] for each in told["quantities"].values() if each["judged"]]
        lines.append(KnobLine(knob.words, _order_s([each for each in orders if each is not None]), *_places(found)))
    others = [each for point, each in places.items() if point not in seen]
    front = [places[tuple(point)] for point in told["pareto_front"]]
    scene = places[ladders.base]
    doubts = [each["uncertainty"] / each["scale"] for each in told["quantities"].values() if each["judged"]]
    here, doubt = (scene["cpu"], scene["error"]), max(doubts, default=0.0)
    return WorkPrecision(lines, *_places(others)[:2], *_places(front)[:2], here, doubt, TARGETS)


def _places(points: Sequence[Mapping[str, Any]]) -> tuple[list[float], list[float], list[bool]]:
    return [p["cpu"] for p in points], [p["error"] for p in points], [p["timed_alone"] for p in points]


def _order_s(orders: Sequence[float]) -> str:
    """The range of the orders observed of the quantities."""
    if not orders:
        return "no order"
    low, high = min(orders), max(orders)
    return f"order {low:.1f}" if high - low < 0.1 else f"order {low:.1f} to {high:.1f}"


def _quantities(told: Mapping[str, Any]) -> str:
    head = ["quantity", "scene", "reference", "±", "unit", "error", *(f"by {name}, order" for name in told["knobs"])]
    rows = []
    for key, each in told["quantities"].items():
        shares = (f"{percent(knob['share'])}, {_order(knob['order'])}" for knob in each["knobs"].values())
        error = percent(each["error"]) if each["judged"] else "not told"
        numbers = (f"{each[name]:.5g}" for name in ("value", "reference"))
        rows.append([key, *numbers, f"{each['uncertainty']:.2g}", each["unit"], error, *shares])
    return _table(head, rows)


def _order(order: float | None) -> str:
    return "–" if order is None else f"{order:.1f}"


def _points(told: Mapping[str, Any]) -> str:
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
        for each in told["points"]
    ]
    return _table(head, rows)


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    def row(cells: Sequence[str], kind: str) -> str:
        return "<tr>" + "".join(f"<{kind}>{escape(cell)}</{kind}>" for cell in cells) + "</tr>"

    return "\n".join(["<table>", row(head, "th"), *(row(each, "td") for each in rows), "</table>"])
