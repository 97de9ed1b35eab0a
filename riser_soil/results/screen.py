"""What a finished run tells on the screen."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

Row = tuple[str, str]


def print_summary(
    summary: dict[str, Any], settlement: float | None = None, console: Console | None = None
) -> None:
    """Prints one table of results for each stage, and the seconds by part.

    summary: what goes into summary.json. settlement: m, deepest of the soil at the end; None without soil.
    """
    console = console or Console()
    for stage in summary["stages"]:
        if stage["final"] is not None:
            console.print(_table(_stage_title(stage), _stage_rows(stage)))
        for warning in stage["warnings"]:
            console.print(f"warning: {stage['name']}: {warning}", soft_wrap=True, markup=False)
    console.print(_table(_title(summary), [*_run_rows(summary, settlement)]))


def _table(title: str, rows: list[Row]) -> Table:
    table = Table(title=title, title_justify="left", show_header=False, min_width=72)
    table.add_column()
    table.add_column(justify="right")
    for row in rows:
        table.add_row(*row)
    return table


def _stage_title(stage: dict[str, Any]) -> str:
    ranges = " (range over the stage)" if stage["kind"] == "dynamic" else ""
    return f"{stage['name']} ({stage['kind']}), at its end{ranges}"


def _title(summary: dict[str, Any]) -> str:
    return f"{summary['title']}: {'finished' if summary['finished'] else 'NOT finished'}"


def _stage_rows(stage: dict[str, Any]) -> list[Row]:
    final, extremes = stage["final"], stage["extremes"]
    return [
        (
            "top tension",
            _span(final["end"]["effective_tension"], extremes["end"]["effective_tension"], "kN", 1e-3),
        ),
        ("least effective tension", _at("min_effective_tension", stage, "kN", 1e-3)),
        *_wall_rows(stage),
        ("largest bending moment", _at("max_bending_moment", stage, "kN.m", 1e-3)),
        ("largest curvature", _at("max_curvature", stage, "1/m")),
        ("smallest bend radius", _at("min_bend_radius", stage, "m")),
        *_bend_rows(stage),
        ("touchdown arc length", _span(final["touchdown_arc"], extremes["touchdown_arc"], "m")),
        ("touchdown point, x, y, z", _place(final["touchdown_position"])),
        ("touchdown points", _span(final["touchdown_points"], extremes["touchdown_points"], "")),
        ("contact force", _span(final["contact_force"], extremes["contact_force"], "kN", 1e-3)),
        ("deepest penetration", _span(final["max_penetration"], extremes["max_penetration"], "mm", 1e3)),
        *_embedment_rows(stage),
        ("steps, cut", f"{stage['steps']}, {stage['step_cuts']}"),
        ("Newton iterations per step", _newton(stage)),
        *([("found by", stage["method"])] if stage["method"] not in (None, "newton") else []),
        *_energy_rows(stage),
    ]


def _wall_rows(stage: dict[str, Any]) -> list[Row]:
    if "max_wall_tension" not in stage["final"]:
        return []
    return [("greatest wall tension", _at("max_wall_tension", stage, "kN", 1e-3))]


def _bend_rows(stage: dict[str, Any]) -> list[Row]:
    if "max_bend_utilisation" not in stage["final"]:
        return []
    return [("allowed over actual bend radius", _at("max_bend_utilisation", stage, ""))]


def _embedment_rows(stage: dict[str, Any]) -> list[Row]:
    if "max_embedment" not in stage["final"]:
        return []
    return [("deepest embedment", _at("max_embedment", stage, "mm", 1e3))]


def _place(position: list[float]) -> str:
    return "-" if np.isnan(position[0]) else f"{', '.join(f'{x:.5g}' for x in position)} m"


def _run_rows(summary: dict[str, Any], settlement: float | None) -> Iterator[Row]:
    if settlement is not None:
        yield "deepest soil settlement", f"{settlement * 1e3:.4g} mm"
    yield "unknowns, riser and soil", f"{summary['dofs']['riser']} and {summary['dofs']['soil']}"
    for part, seconds in summary["seconds"].items():
        yield f"time in {part}", f"{seconds:.2f} s"


def _newton(stage: dict[str, Any]) -> str:
    mean = stage["newton_iterations"] / max(1, stage["steps"])
    return f"{mean:.2f} on average, at most {stage['most_newton_iterations']}"


def _energy_rows(stage: dict[str, Any]) -> list[Row]:
    energy, share = stage["energy"], 100.0 / max(stage["energy"]["turned_over"], 1e-300)
    if stage["kind"] == "static":
        return [("energy residual", "not balanced in statics")]
    worst = energy["worst_residual"]
    at = f", at most {worst['value'] * share:.2g} % at {worst['time']:.4g} s" if worst["value"] else ""
    residual = f"{energy['residual'] * share:.2g} % of {energy['turned_over']:.3g} J{at}"
    return [
        ("energy residual", residual),
        ("energy taken out by the time scheme", f"{energy['numerical'] * share:.2g} %"),
    ]


def _span(value: float | None, extremes: dict[str, float | None], unit: str, scale: float = 1.0) -> str:
    """The final value, and the range over the stage where there is one."""
    return _number(value, unit, scale) + _range(extremes, scale)


def _at(name: str, stage: dict[str, Any], unit: str, scale: float = 1.0) -> str:
    """The final value of what sits somewhere on the riser, its place, and the range over the stage."""
    final = stage["final"][name]
    place = f" at {final['arc']:.5g} m"
    return _number(final["value"], unit, scale) + place + _range(stage["extremes"][name], scale)


def _range(extremes: dict[str, float | None], scale: float) -> str:
    least, most = extremes["min"], extremes["max"]
    if least is None or most is None or not most > least:
        return ""
    return f"  ({least * scale:.5g} to {most * scale:.5g})"


def _number(value: float | None, unit: str, scale: float) -> str:
    return "-" if value is None or np.isnan(value) else f"{value * scale:.5g} {unit}".rstrip()
