"""The runs of one program for one case, each into a file; those that are there already are left.

    python -m benchmarks.peers.measure NUMBER CASE FOLDER      # the program's place in ladder.PROGRAMS

Runs in the program's own environment.
"""

from __future__ import annotations

import importlib
import sys
from dataclasses import asdict
from pathlib import Path

import numpy as np

from benchmarks.peers.case import CASES, Case, Record
from benchmarks.peers.ladder import PROGRAMS, Program

SERIES = ("time", "held", "moved", "arc", "moment", "position")
REPEATS, LONG = 3, 10.0  # a run of more than so many seconds is not repeated


def file_of(folder: Path, case: str, program: Program, elements: int, time_step: float) -> Path:
    return folder / f"{case}_{program.stem}_{elements}_{time_step:g}.npz"


def read(path: Path) -> Record:
    with np.load(path) as stored:
        return Record(seconds=float(stored["seconds"]), **{name: stored[name] for name in SERIES})


def measure(program: Program, case: Case, folder: Path) -> None:
    run = importlib.import_module(f"benchmarks.peers.{program.module}").run
    for elements, time_step in program.runs(case.name):
        path = file_of(folder, case.name, program, elements, time_step)
        if path.exists():
            continue
        record = run(case, elements, time_step, **program.options)
        for _ in range(REPEATS - 1 if record.seconds < LONG else 0):
            again = run(case, elements, time_step, **program.options)
            record = min(record, again, key=lambda each: each.seconds)
        np.savez(path, **asdict(record))
        told = f"{program.name}, {case.name}, {elements} elements, {time_step:g} s"
        print(f"{told}: {record.seconds / case.duration:.4f} s/s", file=sys.stderr, flush=True)


if __name__ == "__main__":
    number, name, results = sys.argv[1:]
    measure(PROGRAMS[int(number)], CASES[name], Path(results))
