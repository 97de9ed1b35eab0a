"""Outcome of a stressed scene: its verdict, errors against its answers, and what it cost."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from riser_soil.results.read import Run
from riser_soil.results.summary import plain_json
from riser_soil.stress.answers import Answer
from riser_soil.stress.bounds import ENERGY, worst_residual
from riser_soil.stress.limited_process import Ending

PASSED, TOLD, WRONG, BROKEN, LONG = "passed", "told plainly", "QUIETLY WRONG", "broken", "out of time"


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
    found = list(answers) if ending.finished else []
    worst = max(found, key=lambda answer: answer.severity, default=None)
    verdict = _verdict(ending, found, may_tell)
    hoped = verdict == PASSED or (verdict == TOLD and may_tell is not None and _says(ending, may_tell))
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
        return TOLD
    wrong = [answer for answer in answers if not answer.holds]
    if not wrong:
        return PASSED
    if all(ENERGY in answer.what for answer in wrong) and _says(ending, "the energy balance is"):
        return TOLD
    return TOLD if may_tell is not None and _says(ending, may_tell) else WRONG


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
    return matching[0] if matching else (lines or ["nothing was told"])[-1]


def runs_in(place: Path, names: Iterable[str]) -> list[Run]:
    """The runs in a folder, finished or not, that have a summary."""
    return [Run(place / name) for name in names if (place / name / "summary.json").is_file()]
