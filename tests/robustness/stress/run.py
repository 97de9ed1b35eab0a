"""Runs the stress cases, each in a process with limits, and publishes their table.

    python -m tests.robustness.stress.run --page

Ends with status 1 where a case does not end as it is to: quietly wrong, broken, out of time, or told where an answer is
known.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from importlib import import_module
from pathlib import Path

from tests.robustness.limited_process import FORKING, Limits, ended, import_all
from tests.robustness.stress.around import running
from tests.robustness.stress.bounds import Answer, bounds
from tests.robustness.stress.case import CASES, StressCase, Trial
from tests.robustness.stress.outcome import StressOutcome, line_of, outcome, runs_in
from tests.robustness.stress.page import publish

SUBJECTS = ("hanging", "lying", "beams", "moving", "falling", "at_sea", "in_soil")
for subject in SUBJECTS:
    import_module(f"tests.robustness.stress.{subject}")


def outcomes(cases: Iterable[StressCase], folder: Path, workers: int) -> Iterator[StressOutcome]:
    """Run cases, each in a folder of its own, in their order."""
    import_all()
    with ThreadPoolExecutor(workers) as pool:
        yield from pool.map(lambda case: judged(case, folder), cases)


def judged(case: StressCase, folder: Path) -> StressOutcome:
    """Run a case and judge it. Nothing is computed here while a process is forked: it would wait for a lock, as that of
    numba's compiler, which nobody opens in it.
    """
    place = folder / case.name.replace(" ", "_")
    with FORKING:
        trial = case.make()
    place.mkdir(parents=True, exist_ok=True)
    for name, scene in trial.scenes.items():
        (place / f"{name}.yaml").write_text(json.dumps(scene, indent=1), encoding="utf-8")
    for name, content in trial.files.items():
        (place / name).write_text(content, encoding="utf-8")
    ending = ended(running(list(trial.scenes)), place, Limits(cpu=case.cpu))
    about = " ".join(case.about.split())
    with FORKING:
        runs = runs_in(place, trial.scenes)
        return outcome(case.name, about, ending, runs, _answers(trial, place), may_tell=trial.may_tell)


def _answers(trial: Trial, place: Path) -> Iterator[Answer]:
    """Answers of the case, then the bounds that hold for all."""
    runs = dict(zip(trial.scenes, runs_in(place, trial.scenes), strict=True))
    yield from trial.answers(runs)
    for run in runs.values():
        yield from bounds(run)


def chosen(words: Iterable[str], quick: bool) -> list[StressCase]:
    """Cases whose names contain one of the words, all without any; quick: those of the normal suite alone."""
    words = list(words)
    some = [case for case in CASES.values() if not words or any(word in case.name for word in words)]
    return [case for case in some if case.quick or not quick]


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="only the cases whose names contain one of these")
    parser.add_argument("--quick", action="store_true", help="only those of the normal suite")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--page", action="store_true", help="write docs/stress.md and docs/stress.json")
    parser.add_argument("--keep", type=Path, help="leave scenes, output and results in this folder")
    asked = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as folder:
        all_outcomes = []
        for row in outcomes(chosen(asked.names, asked.quick), asked.keep or Path(folder), asked.workers):
            all_outcomes.append(row)
            print(line_of(row), flush=True)
    if asked.page:
        publish(all_outcomes)
    missed = [row.name for row in all_outcomes if not row.as_hoped]
    seconds = sum(row.seconds for row in all_outcomes)
    print(f"{len(all_outcomes)} cases, {seconds:.0f} s of CPU; not as they are to end: {missed or 'none'}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
