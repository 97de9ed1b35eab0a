"""One program at work, in its own environment: it computes what it is told, line by line.

Each line on standard input names a case, a number of elements, a time step and the file that the run goes to; each is
answered by a line: the seconds of the time loop, or what went wrong. A file is left as it is where it is there and its
run was cheaper.
"""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from dataclasses import asdict
from pathlib import Path

import numpy as np

from benchmarks.peers.case import CASES, Record
from benchmarks.peers.refinement import PROGRAMS, Program

SERIES = ("time", "held", "moved", "arc", "moment", "position")


def read(path: Path) -> Record:
    with np.load(path) as stored:
        return Record(seconds=float(stored["seconds"]), **{name: stored[name] for name in SERIES})


def measured(program: Program, case: str, elements: int, time_step: float, path: Path) -> str:
    """One run. Whatever goes wrong in another program must not end the comparison."""
    try:
        run = importlib.import_module(f"benchmarks.peers.{program.module}").run
        record = run(CASES[case], elements, time_step, **program.options)
    except Exception as trouble:
        return " ".join(f"{type(trouble).__name__}: {trouble}".split())
    if not path.exists() or record.seconds < read(path).seconds:
        np.savez(path, **asdict(record))
    return str(record.seconds)


def main(program: Program) -> None:
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what programs print is no answer
    for line in sys.stdin:
        case, elements, time_step, path = line.split()
        print(measured(program, case, int(elements), float(time_step), Path(path)), file=answers, flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m benchmarks.peers.measure", description=__doc__)
    parser.add_argument("program", type=int, metavar="NUMBER", help="the program's place in refinement.PROGRAMS")
    main(PROGRAMS[parser.parse_args().program])
