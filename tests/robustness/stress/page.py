"""Page of the stress cases, docs/stress.md, and their figures, docs/stress.json: written by `make stress`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from demos.page import table
from tests.robustness.stress.outcome import PASSED, StressOutcome, as_json, circumstances

DOCS = Path(__file__).parents[3] / "docs"
COMMAND = "make stress"
INTRODUCTION = """\
# Stiff and extreme

Scenes that are stiff or extreme, each with an answer that is exact or bounded, and what became of it. `make stress`
runs them, each in a process of its own with limits on processor time and memory, and writes this page.
`make around` does the same [around a scene](#around-a-scene).

| verdict | meaning |
| --- | --- |
| passed | the run finished and all its answers hold |
| reported | the program refused the scene, said why it found no solution, or warned of the wrong answer |
| QUIETLY WRONG | a run finished, an answer does not hold and no warning was given |

A case has answers of its own. For every run, moreover, numbers are finite, at the end of a static stage reactions,
contact, loads and weight are in balance, and the energy balance is within 1 % of the energy exchanged.

Shown is of each case the answer that is nearest to its limit, and its error relative to the exact value (of bounds: how
far beyond them). [stress.json](stress.json) has of each case what is extreme and how the answer follows, values, the
largest energy residual, Newton iterations, steps that were cut and processor time; the derivations stand with the cases
in `tests/robustness/stress/`.

## Around a scene

`make around SCENE=file.yaml` runs a scene as it is and with one property made extreme, as far as it has them: elements,
steps, cells of the soil, penalty, EI, EA, nu and su of the soil, harmonic motions, no gravity, three dimensions instead
of two. Each run is a process of its own, which may take 120 s of processor time and 6 GiB (`--limit`, `--jobs` of
`python -m tests.robustness.stress.around`).

A run must end in the program's own error, or in results whose bounds hold: those of every run above. Its forces must be
within 10 % of the scene's as it is (elements, steps, harder penalties), 2 % of the next extreme on the way to a limit
such as EI → 0, 10⁻⁴ in three dimensions, 10⁻³ at rest where nothing moves. What does not hold and is not warned of is
QUIETLY WRONG. A coarse setting may be. The folder gets the scenes, their results and output, `stress.md` and
`stress.json`. Exit status 1: at least one run gave a wrong result without a warning, crashed, or timed out.

## Cases
"""


def page(rows: Sequence[StressOutcome], made: Mapping[str, Any]) -> str:
    """The whole page in Markdown."""
    counts = Counter(row.verdict for row in rows)
    verdicts = ", ".join(f"{number} {verdict}" for verdict, number in sorted(counts.items()))
    seconds = sum(row.seconds for row in rows)
    summary = f"{len(rows)} cases in {seconds:.0f} s of processor time, compilation included: {verdicts}."
    circumstances = ", ".join(f"{name} {value}" for name, value in made.items())
    others = [row for row in rows if row.verdict != PASSED]
    parts = [INTRODUCTION, summary, "", f"Made: {circumstances}.", "", "## Passed", "", passed(rows), ""]
    return "\n".join([*parts, "## Others", "", *map(_reported, others)]).rstrip() + "\n"


def passed(rows: Sequence[StressOutcome]) -> str:
    """Table of cases that passed: what was judged, and its error."""
    cells = [[row.name, row.answer.split(":")[0], _error(row)] for row in rows if row.verdict == PASSED]
    return table(["case", "answer", "error"], cells)


def _error(row: StressOutcome) -> str:
    return "" if row.error is None else f"{row.error:.1e}"


def _reported(row: StressOutcome) -> str:
    """Bold where it is not as it is to end."""
    verdict = row.verdict if row.as_hoped else f"**{row.verdict}**"
    return f"- {row.name}, {verdict}: {'; '.join(text for text in (row.answer, row.message) if text)}"


def publish(rows: Sequence[StressOutcome]) -> None:
    """Write both files."""
    (DOCS / "stress.md").write_text(page(rows, circumstances(COMMAND)), encoding="utf-8")
    (DOCS / "stress.json").write_text(as_json(rows, COMMAND), encoding="utf-8")
