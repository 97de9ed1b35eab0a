"""Screen output: a progress line during a run, and a table for each stage of a finished one."""

from __future__ import annotations

from collections.abc import Iterator
from types import TracebackType
from typing import Any, Self

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.progress import Progress as Bar
from rich.table import Table

from riser_soil.core import outputs

Row = tuple[str, str]

# Figures from above; what the table of outputs has beyond them comes below.
_ORDER = (
    "start.effective_tension",
    "end.effective_tension",
    "min_effective_tension",
    "max_wall_tension",
    "max_bending_moment",
    "max_curvature",
    "min_bend_radius",
    "max_bend_utilisation",
    "max_tension_utilisation",
    "max_wall_von_mises_stress",
    "max_stress_utilisation",
    "touchdown_arc",
    "touchdown_position",
    "touchdown_points",
    "contact_force",
    "max_penetration",
    "max_embedment",
)
_NOTHING = object()
SHOWN_SHARE = 0.1  # of the computing time, from which on a part's is shown; summary.json has all
_PARTS = {  # of the program, in an engineer's words
    "build": "setting up",
    "linear_solve": "linear systems",
    "line solver": "time steps",
    "output": "writing results",
}


def print_summary(summary: dict[str, Any], console: Console | None = None) -> None:
    """Prints one table of results for each stage, and the seconds by part.

    summary: what goes into summary.json.
    """
    console = console or Console(force_jupyter=False)
    for stage in summary["stages"]:
        if stage["final"] is not None:
            console.print(_table(_stage_title(stage), _stage_rows(stage)))
        for name, line in stage.get("lines", {}).items():
            if line["final"] is not None:
                rows = [*_figure_rows(line), *_soil_rows(stage | line)]
                console.print(_table(f"{name}: {_stage_title(stage)}", rows))
        if stage.get("lines") and stage["steps"]:
            console.print(_table(_stage_title(stage), [*_body_and_joint_rows(stage), *_step_rows(stage)]))
        for warning in stage["warnings"]:
            console.print(f"warning: {stage['name']}: {warning}", soft_wrap=True, markup=False)
    console.print(_table(_title(summary), [*_run_rows(summary)]))


def _table(title: str, rows: list[Row]) -> Table:
    table = Table(title=title, title_justify="left", show_header=False, min_width=72)
    table.add_column()
    table.add_column(justify="right")
    for row in rows:
        table.add_row(*row)
    return table


def _stage_title(stage: dict[str, Any]) -> str:
    ranges = "" if stage["kind"] == "static" else " (range over the load step)"
    return f"load step {stage['name']} ({stage['kind']}), at its end{ranges}"


def _title(summary: dict[str, Any]) -> str:
    return f"{summary['title']}: {'finished' if summary['finished'] else 'NOT finished'}"


def _stage_rows(stage: dict[str, Any]) -> list[Row]:
    return [
        *_figure_rows(stage),
        *_soil_rows(stage),
        *_step_rows(stage),
    ]


def _body_and_joint_rows(stage: dict[str, Any]) -> Iterator[Row]:
    """Rows of bodies, with their places, of forces of joints and of clearances."""
    for name, body in stage.get("bodies", {}).items():
        yield f"body {name}", _place(body["position"]["final"], "m", 1.0)
        if "contact_force" in body:
            sides = {side: body["contact_force"][side][2] for side in ("min", "max")}
            yield f"seabed under body {name}", _span(body["contact_force"]["final"][2], sides, "kN", 1e-3)
    for name, joint in stage.get("joints", {}).items():
        yield f"force in joint {name}", _number(float(np.linalg.norm(joint["force"]["final"])), "kN", 1e-3)
    for name, pair in stage.get("clearance", {}).items():
        distance = pair["distance"]
        yield f"clearance {name.replace('_', ' to ', 1)}", _span(distance["final"], distance, "m", 1.0)


def _step_rows(stage: dict[str, Any]) -> list[Row]:
    step = "load increment" if stage["kind"] == "static" else "step"
    return [
        (f"{step}s, shortened", f"{stage['steps']}, {stage['step_cuts']}"),
        (f"Newton iterations per {step}", _newton(stage)),
        *([("solved by", stage["method"])] if stage["method"] not in (None, "newton") else []),
        *_energy_rows(stage),
    ]


def _figure_rows(stage: dict[str, Any]) -> Iterator[Row]:
    """Rows of the known figures."""
    for _, figure in outputs.figures(_ORDER):
        final, extremes = (_entry(stage[key], figure.path) for key in ("final", "extremes"))
        row = outputs.row_of(figure, stage["final"])
        if row is None or final is _NOTHING:
            continue
        unit, scale = row.unit, row.scale
        if figure.size > 1:
            yield row.words, _place(final, unit, scale)
        elif figure.placed:
            yield row.words, _at(final, extremes, unit, scale)
        else:
            yield row.words, _span(final, extremes, unit, scale)


def _soil_rows(stage: dict[str, Any]) -> Iterator[Row]:
    """Largest values in the soil, with place and time."""
    extremes = stage.get("soil", {})
    for figure in (figure for output in outputs.OF_SOIL for figure in output.figures):
        largest = extremes.get(figure.name, {"value": 0.0})
        if figure.row is None or not largest["value"]:
            continue
        place = ", ".join(f"{round(x, 3) + 0.0:.4g}" for x in largest["position"])
        when = "" if stage["kind"] == "static" else f", {largest['time']:.4g} s"
        value = _number(largest["value"], figure.row.unit, figure.row.scale)
        yield figure.row.words, f"{value} at ({place}) m{when}"


def _entry(nested: dict[str, Any], path: tuple[str, ...]) -> Any:
    """The summary's entry at a place, or _NOTHING."""
    value: Any = nested
    for key in path:
        value = value.get(key, _NOTHING) if isinstance(value, dict) else _NOTHING
    return value


def _place(vector: list[float], unit: str, scale: float) -> str:
    return "-" if np.isnan(vector[0]) else f"{', '.join(f'{x * scale:.5g}' for x in vector)} {unit}".rstrip()


def _run_rows(summary: dict[str, Any]) -> Iterator[Row]:
    yield "unknowns, riser and soil", f"{summary['dofs']['riser']} and {summary['dofs']['soil']}"
    total = sum(summary["seconds"].values())
    yield "computing time", f"{total:.2f} s"
    for part, seconds in summary["seconds"].items():
        if seconds > SHOWN_SHARE * total:
            yield f"  of which {_PARTS.get(part, part)}", f"{seconds:.2f} s"


def _newton(stage: dict[str, Any]) -> str:
    mean = stage["newton_iterations"] / max(1, stage["steps"])
    return f"{mean:.2f} on average, at most {stage['most_newton_iterations']}"


def _energy_rows(stage: dict[str, Any]) -> list[Row]:
    energy, share = stage["energy"], 100.0 / max(stage["energy"]["turned_over"], 1e-300)
    if stage["kind"] != "dynamic":
        return [("energy residual", "not balanced in statics")]
    worst = energy["worst_residual"]
    at = f", at most {worst['value'] * share:.2g} % at {worst['time']:.4g} s" if worst["value"] else ""
    residual = f"{energy['residual'] * share:.2g} % of {energy['turned_over']:.3g} J{at}"
    return [
        ("energy residual", residual),
        ("numerical damping of the time scheme", f"{energy['made'] * share:.2g} %"),
    ]


def _span(value: float | None, extremes: dict[str, float | None], unit: str, scale: float) -> str:
    """The final value, and the range over the stage where there is one."""
    return _number(value, unit, scale) + _range(extremes, scale)


def _at(final: dict[str, Any], extremes: dict[str, float | None], unit: str, scale: float) -> str:
    """The final value of what sits somewhere on the riser, its place, and the range over the stage."""
    return _number(final["value"], unit, scale) + f" at {final['arc']:.5g} m" + _range(extremes, scale)


def _range(extremes: dict[str, float | None], scale: float) -> str:
    least, most = extremes["min"], extremes["max"]
    if least is None or most is None or not most > least:
        return ""
    return f"  ({least * scale:.5g} to {most * scale:.5g})"


def _number(value: float | None, unit: str, scale: float) -> str:
    return "-" if value is None or np.isnan(value) else f"{value * scale:.5g} {unit}".rstrip()


class Progress:
    """Stage, per cent of it, time and end time, time step, Newton iterations and seconds left; silent unless enabled
    and on a terminal.

    Goes to standard error, so that what the command prints can be piped. Use in a `with` statement.
    """

    def __init__(self, enabled: bool, console: Console | None = None) -> None:
        console = console or Console(stderr=True)
        self._bar = Bar(
            TextColumn("[bold]{task.description}"),
            BarColumn(),
            TaskProgressColumn(),
            TextColumn("{task.fields[state]}"),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
            console=console,
            disable=not (enabled and console.is_terminal),
            refresh_per_second=4,
        )
        self._task = self._bar.add_task("", total=None, state="", visible=False)
        self._kind, self._end = "static", 1.0

    def __enter__(self) -> Self:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()

    def begin_stage(self, name: str, kind: str, end: float = 1.0) -> None:
        """kind: `static`, `quasi-static` or `dynamic`. end: t at the stage's end; in a static stage the load factor."""
        self._kind, self._end = kind, end
        self._bar.reset(self._task, total=end, description=name, state="", visible=True)

    def update(self, t: float, time_step: float, newton_iterations: int) -> None:
        """t: s since the stage began (static: load factor); time_step: of the step just accepted."""
        if self._bar.disable:
            return
        label = "load" if self._kind == "static" else "t"
        unit = "" if self._kind == "static" else " s"
        state = f"{label} {t:.4g} of {self._end:.6g}{unit}  step {time_step:.3g}{unit}  Newton {newton_iterations}"
        self._bar.update(self._task, completed=t, state=state)
