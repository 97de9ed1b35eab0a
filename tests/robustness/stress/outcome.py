"""Outcome of a stressed scene: its verdict, errors against its answers, what it cost; and tables of many."""

from __future__ import annotations

import json
import os
import platform
import re
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from datetime import date
from importlib.metadata import version
from pathlib import Path
from typing import Any

import riser_soil
from riser_soil.results.read import Run
from riser_soil.results.summary import plain_json
from tests.robustness.limited_process import Ending
from tests.robustness.stress.bounds import ENERGY, Answer, worst_residual

PASSED, REPORTED, WRONG, BROKEN, LONG = "passed", "reported", "QUIETLY WRONG", "broken", "out of time"
HEAD = ("case", "worst of its answers", "error", "energy residual", "Newton iterations", "cuts", "CPU s", "verdict")


@dataclass(frozen=True)
class StressOutcome:
    """One row of the table.

    verdict: passed, told plainly (an error of the program's own, or a warning that says what is wrong with the answer),
    QUIETLY WRONG, broken (a traceback, a crash), or out of the time that it may take. as_hoped: whether that is how
    this scene is to end. answer: the one that is nearest to its bounds, or beyond; error: relative, None without an
    answer. residual: of the energy, relative, the largest of all stages. seconds: of CPU.
    """

    name: str
    about: str
    verdict: str
    as_hoped: bool
    answer: str
    error: float | None
    residual: float | None
    iterations: int
    cuts: int
    seconds: float
    message: str

    def as_json(self) -> dict[str, Any]:
        plain: dict[str, Any] = plain_json(asdict(self))
        return plain


def outcome(
    name: str,
    about: str,
    ending: Ending,
    runs: Sequence[Run],
    answers: Iterable[Answer],
    *,
    may_tell: str | None = None,
) -> StressOutcome:
    """Judge a scene, or several that belong together, that ended.

    answers: of a finished run, looked at only then. may_tell: pattern of a message that counts as an answer: of the
    error, or of the warning about an answer that does not hold. Without it any error of the program's own is told
    plainly, and no warning makes up for a wrong answer.
    """
    results = list(answers) if ending.finished else []
    worst = max(results, key=lambda answer: answer.severity, default=None)
    verdict = _verdict(ending, results, may_tell)
    hoped = verdict == PASSED or (verdict == REPORTED and may_tell is not None and _says(ending, may_tell))
    stages = [stage for run in runs for stage in run.summary["stages"]]
    residuals = [worst_residual(stage) for stage in stages if stage["kind"] == "dynamic"]
    return StressOutcome(
        name=name,
        about=about,
        verdict=verdict,
        as_hoped=hoped,
        answer="" if worst is None else str(worst),
        error=None if worst is None else worst.error,
        residual=max(residuals, default=None),
        iterations=sum(stage["newton_iterations"] for stage in stages),
        cuts=sum(stage["step_cuts"] for stage in stages),
        seconds=ending.seconds,
        message="" if verdict == PASSED else _message(ending, may_tell),
    )


def _verdict(ending: Ending, answers: Sequence[Answer], may_tell: str | None) -> str:
    if not ending.well:
        return LONG if ending.word == "hang" else BROKEN
    if not ending.finished:
        return REPORTED
    wrong = [answer for answer in answers if not answer.holds]
    if not wrong:
        return PASSED
    if all(ENERGY in answer.what for answer in wrong) and _says(ending, "the energy balance is"):
        return REPORTED
    return REPORTED if may_tell is not None and _says(ending, may_tell) else WRONG


def _says(ending: Ending, pattern: str) -> bool:
    return re.search(pattern, ending.output, re.DOTALL) is not None


def _message(ending: Ending, pattern: str | None) -> str:
    """The line that tells what was wrong: the one that matches, else the last; "" where a finished run told nothing."""
    if ending.finished and pattern is None:
        return ""
    lines = [line.strip() for line in ending.output.strip().splitlines() if line.strip()]
    matching = [line for line in lines if pattern is not None and re.search(pattern, line)]
    if ending.finished:
        return matching[0] if matching else ""
    return matching[0] if matching else (lines or ["no message"])[-1]


def runs_in(place: Path, names: Iterable[str]) -> list[Run]:
    """The runs in a folder, finished or not, that have a summary."""
    return [Run(place / name) for name in names if (place / name / "summary.json").is_file()]


def line_of(row: StressOutcome) -> str:
    """One row on the screen, with its messages beneath it."""
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
    content = {"made": circumstances(command), "cases": [row.as_json() for row in rows]}
    return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
