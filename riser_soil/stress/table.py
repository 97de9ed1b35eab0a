"""Table of stressed scenes: on the screen, as a page in Markdown and as JSON."""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Iterable, Sequence
from datetime import date
from importlib.metadata import version
from typing import Any

import riser_soil
from riser_soil.stress.outcome import StressOutcome

HEAD = ("case", "worst of its answers", "error", "energy residual", "Newton iterations", "cuts", "CPU s", "verdict")


def told(row: StressOutcome) -> str:
    """One row on the screen, and what was told beneath it."""
    figures = f"{_number(row.error)} | {_number(row.residual)} | {row.iterations} | {row.cuts} | {row.seconds:.1f} s"
    mark = "" if row.as_hoped else " (!)"
    below = "".join(f"\n    {text}" for text in (row.answer, row.message) if text)
    return f"{row.verdict}{mark}: {row.name} | {figures}{below}"


def markdown(rows: Iterable[StressOutcome]) -> str:
    """The table, the first two columns to the left."""
    rule = ["---", "---", *["---:"] * (len(HEAD) - 3), "---"]
    lines = [HEAD, rule, *(_cells(row) for row in rows)]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


def _cells(row: StressOutcome) -> Sequence[str]:
    verdict = row.verdict if row.as_hoped else f"**{row.verdict}**"
    costs = (_number(row.error), _number(row.residual), str(row.iterations), str(row.cuts), f"{row.seconds:.1f}")
    return row.name, row.answer.replace("|", "/"), *costs, verdict


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.1e}"


def circumstances(command: str) -> dict[str, Any]:
    """When, with what and where a table was made."""
    packages = ("numpy", "scipy", "numba")
    return {
        "date": date.today().isoformat(),
        "command": command,
        "riser_soil": riser_soil.__version__,
        "python": platform.python_version(),
        **{name: version(name) for name in packages},
        "machine": f"{platform.machine()}, {os.cpu_count()} cores, {_memory():.0f} GB",
    }


def _memory() -> float:
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9


def as_json(rows: Iterable[StressOutcome], command: str) -> str:
    """Circumstances and all rows."""
    told = {"made": circumstances(command), "cases": [row.as_json() for row in rows]}
    return json.dumps(told, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
