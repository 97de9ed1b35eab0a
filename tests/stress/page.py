"""Page of the stress cases, docs/stress.md, and their figures, docs/stress.json: written by `make stress`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from riser_soil.stress.outcome import PASSED, StressOutcome
from riser_soil.stress.table import as_json, circumstances, markdown

DOCS = Path(__file__).parents[2] / "docs"
COMMAND = "make stress"
INTRODUCTION = """\
# Stiff and extreme

Scenes that are stiff or extreme, each with an answer that is exact or bounded, and what became of it. This page is
written by `make stress`; the cases are in `tests/stress/`, each with its derivation. Each runs in a process of its own
with limits on processor time and memory. `riser-soil stress SCENE` does the same [around a scene of
yours](command_line.md#stress).

A case has **passed** where the run finished and all its answers hold: those of the case, and for every run that
numbers are finite, that at the end of a static stage reactions, contact, loads and weight are in balance, and that the
energy balance is within 1 % of the energy turned over. It was **told plainly** where the program refused the scene,
named why no solution was found, or warned of what is wrong with the answer. It is **QUIETLY WRONG** where a run
finished, an answer does not hold and nothing was told. In bold: what does not end as it is to.

Shown are of each case the answer that is nearest to what it may miss, its error relative to the exact value (of bounds:
how far beyond them), the largest energy residual of its dynamic stages over the energy turned over, Newton iterations,
steps that were cut, and processor time, compilation of kernels included.
"""


def page(rows: Sequence[StressOutcome]) -> str:
    """The whole page in Markdown."""
    counts = Counter(row.verdict for row in rows)
    told = ", ".join(f"{number} {verdict}" for verdict, number in sorted(counts.items()))
    made = ", ".join(f"{name} {value}" for name, value in circumstances(COMMAND).items())
    seconds = sum(row.seconds for row in rows)
    summary = f"{len(rows)} cases in {seconds:.0f} s of processor time: {told}.\n\nMade: {made}."
    parts = [INTRODUCTION, summary, "", "## Outcome", "", markdown(rows), "", *_messages(rows), *_derivations(rows)]
    return "\n".join(parts).rstrip() + "\n"


def _messages(rows: Sequence[StressOutcome]) -> list[str]:
    told = [f"- **{row.name}**: {row.message}" for row in rows if row.verdict != PASSED and row.message]
    return ["## What was told", "", *told, ""]


def _derivations(rows: Sequence[StressOutcome]) -> list[str]:
    return ["## What is extreme, and the answer", "", *(f"- **{row.name}**: {row.about}" for row in rows)]


def publish(rows: Sequence[StressOutcome]) -> None:
    """Write both files."""
    (DOCS / "stress.md").write_text(page(rows), encoding="utf-8")
    (DOCS / "stress.json").write_text(as_json(rows, COMMAND), encoding="utf-8")
