"""All programs' runs, one program after the other on each level: where a machine's speed drifts, all drift alike."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from itertools import zip_longest
from pathlib import Path

from benchmarks.peers.refinement import PROGRAMS, Program

ROOT = Path(__file__).parents[2]
THEIRS = ROOT / "build" / "peers" / "bin" / "python"
REPEATS, LONG = 2, 6.0  # a run of more than so many seconds is not repeated


class Worker:
    """A program in a process of its own."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process

    def run(self, case: str, elements: int, time_step: float, path: Path) -> float:
        """Seconds of the time loop. Raises RuntimeError with the program's words."""
        asked, answers = self._process.stdin, self._process.stdout
        assert asked is not None
        assert answers is not None
        if self._process.poll() is not None:
            raise RuntimeError("it has ended before")
        print(case, elements, repr(time_step), path, file=asked, flush=True)
        answer = answers.readline().strip()
        try:
            return float(answer)
        except ValueError:
            raise RuntimeError(answer or "it has ended in between") from None


def file_of(folder: Path, case: str, program: Program, elements: int, time_step: float) -> Path:
    return folder / f"{case}_{program.stem}_{elements}_{time_step:g}.npz"


def measure(cases: Sequence[str], folder: Path) -> None:
    """Measure the runs that are not yet in the folder; repeated runs keep the least time."""
    with ExitStack() as stack:
        workers = {program: stack.enter_context(_worker(number)) for number, program in enumerate(PROGRAMS)}
        for case in cases:
            for level in zip_longest(*(program.runs(case) for program in PROGRAMS)):
                _measure_level(workers, case, dict(zip(PROGRAMS, level, strict=True)), folder)


def _measure_level(
    workers: Mapping[Program, Worker], case: str, level: Mapping[Program, tuple[int, float] | None], folder: Path
) -> None:
    todo = {program: size for program, size in level.items() if size is not None}
    todo = {program: size for program, size in todo.items() if not file_of(folder, case, program, *size).exists()}
    for _ in range(REPEATS):
        for program, size in list(todo.items()):
            try:
                seconds = workers[program].run(case, *size, file_of(folder, case, program, *size))
            except RuntimeError as trouble:
                print(f"{program.name}, {case}, {size[0]} elements, {size[1]:g} s: {trouble}", file=sys.stderr)
                seconds = LONG
            if seconds >= LONG:
                del todo[program]


@contextmanager
def _worker(number: int) -> Iterator[Worker]:
    python = sys.executable if PROGRAMS[number].own or not THEIRS.exists() else str(THEIRS)
    command = [python, "-m", "benchmarks.peers.measure", str(number)]
    with (
        (ROOT / "build" / "peers.log").open("a", encoding="utf-8") as log,
        subprocess.Popen(
            command, cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=log, text=True
        ) as process,
    ):
        yield Worker(process)
