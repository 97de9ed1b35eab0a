"""Runs mutated scenes, each in a process of its own with limits, and counts how they end.

    python -m tests.robustness.fuzz.run --count 600 --seed 1 --keep FOLDER

A scene ends well with the status of a finished run, of bad input, of a failed solve or of results that can't be
written, and without a traceback. A scene that needs more time than a process may take hangs, unless the program itself
said that it would be long. The processes are forked from this one, which has everything imported.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from tests.robustness.fuzz.mutations import SCENE, Case, cases
from tests.robustness.limited_process import Ending, Limits, ended, import_all

LIMITS = Limits(cpu=180, reported_long=5)  # a search for an equilibrium that there is none of may take two minutes


@dataclass(frozen=True)
class FuzzedScene:
    """One scene, by its number and what was done to it, and how it ended."""

    number: int
    changes: str
    ending: Ending


def endings(cases: Iterable[Case], folder: Path, workers: int) -> Iterator[FuzzedScene]:
    """Run all cases, each in a folder of its own."""
    import_all()
    with ThreadPoolExecutor(workers) as pool:
        yield from pool.map(lambda numbered: _ending(numbered[0], numbered[1], folder), enumerate(cases))


def _ending(number: int, case: Case, folder: Path) -> FuzzedScene:
    place = folder / f"{number:04d}"
    place.mkdir()
    for name, content in case.files.items():
        (place / name).write_bytes(content)
    return FuzzedScene(number, case.changes, ended(_run, place, LIMITS))


def _run() -> int:
    from riser_soil.__main__ import app

    return int(app(["run", SCENE, "-o", "out"], standalone_mode=False) or 0)


def report(scenes: Iterable[FuzzedScene]) -> bool:
    """Print what went wrong as it comes, then the counts; whether all ended well."""
    counts: Counter[str] = Counter()
    seconds, longest, well = 0.0, 0.0, True
    for scene in scenes:
        ending = scene.ending
        counts[ending.word] += 1
        seconds, longest, well = seconds + ending.seconds, max(longest, ending.seconds), well and ending.well
        if not ending.well:
            last = " | ".join(ending.output.strip().splitlines()[-3:])
            print(f"{scene.number:04d} {ending.word}: {scene.changes}\n     {last}", flush=True)
    print(", ".join(f"{number} {word}" for word, number in sorted(counts.items())))
    print(f"{sum(counts.values())} scenes, {seconds:.0f} s of CPU in all, {longest:.1f} s at most")
    return well


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=600)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--keep", type=Path, help="leave the scenes, their output and results in this folder")
    asked = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as folder:
        place = asked.keep or Path(folder)
        place.mkdir(parents=True, exist_ok=True)
        return 0 if report(endings(cases(asked.count, asked.seed), place, asked.workers)) else 1


if __name__ == "__main__":
    sys.exit(main())
