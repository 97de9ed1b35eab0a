"""Runs mutated scenes, each in a process of its own with limits, and counts how they end.

    python -m tests.fuzz.run --count 600 --seed 1 --keep FOLDER

A scene ends well with the status of a finished run, of bad input, of a failed solve or of results that can't be
written, and without a traceback. A scene that needs more time than a process may take hangs, unless the program itself
said that it would be long. The processes are forked from this one, which has everything imported.
"""

from __future__ import annotations

import argparse
import os
import resource
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

from tests.fuzz.mutations import SCENE, Case, cases

CPU_SECONDS = 60
WALL_SECONDS = 900  # of one that waits for ever, on a machine with much else to do
TOLD_LONG_SECONDS = 5  # of a scene whose computation is long, as the program says
MEMORY = 6 * 2**30
STATUSES = {0: "done", 2: "bad input", 3: "solve failed", 4: "results not written"}
LONG = "this takes about"


@dataclass(frozen=True)
class Ending:
    """How one scene ended: a word for it, whether that is well, its CPU time [s], and what the program said."""

    number: int
    told: str
    word: str
    well: bool
    seconds: float
    output: str


def endings(cases: Iterable[Case], folder: Path, workers: int) -> Iterator[Ending]:
    """Run all cases, each in a folder of its own."""
    import_all()
    with ThreadPoolExecutor(workers) as pool:
        yield from pool.map(lambda numbered: _ending(numbered[0], numbered[1], folder), enumerate(cases))


def import_all() -> None:
    """What the processes then have already; MPI and the kernels' caches among it."""
    for name in ("riser_soil.checks.check", "riser_soil.run", "riser_soil.soil.soil"):
        import_module(name)


def _ending(number: int, case: Case, folder: Path) -> Ending:
    place = folder / f"{number:04d}"
    place.mkdir()
    for name, content in case.files.items():
        (place / name).write_bytes(content)
    process = os.fork()
    if process == 0:
        _child(place)
    status, seconds, long = _waited(process, place / "output")
    output = (place / "output").read_text(errors="replace")
    word, well = _judged(status, output, long)
    return Ending(number, case.told, word, well, seconds, output)


def _child(place: Path) -> None:
    """Never returns."""
    status = 1
    try:
        os.chdir(place)
        _limit()
        out = os.open("output", os.O_WRONLY | os.O_CREAT)
        for stream in (1, 2):
            os.dup2(out, stream)
        status = _run()
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def _limit() -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS + 5))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def _run() -> int:
    from riser_soil.__main__ import app

    return int(app(["run", SCENE, "-o", "out"], standalone_mode=False) or 0)


def _waited(process: int, output: Path) -> tuple[int, float, bool]:
    """Wait status, CPU seconds, and whether the process was told to be long and so got less time."""
    long, begun = False, time.monotonic()
    while True:
        done, status, usage = os.wait4(process, os.WNOHANG)
        if done:
            return status, usage.ru_utime + usage.ru_stime, long
        if not long and output.exists() and LONG in output.read_text(errors="replace"):
            long = True
            resource.prlimit(process, resource.RLIMIT_CPU, (TOLD_LONG_SECONDS, TOLD_LONG_SECONDS + 5))
        if time.monotonic() - begun > WALL_SECONDS:
            os.kill(process, signal.SIGKILL)
        time.sleep(0.02)


def _judged(status: int, output: str, long: bool) -> tuple[str, bool]:
    if "Traceback" in output:
        return "traceback", False
    if os.WIFSIGNALED(status):
        name = signal.Signals(os.WTERMSIG(status)).name
        if name in ("SIGXCPU", "SIGKILL"):
            return ("long, as told", True) if long else ("hang", False)
        return f"killed by {name}", False
    code = os.WEXITSTATUS(status)
    return STATUSES.get(code, f"status {code}"), code in STATUSES


def report(found: Iterable[Ending]) -> bool:
    """Print what went wrong as it comes, then the counts; whether all ended well."""
    counts: Counter[str] = Counter()
    seconds, longest, well = 0.0, 0.0, True
    for ending in found:
        counts[ending.word] += 1
        seconds, longest, well = seconds + ending.seconds, max(longest, ending.seconds), well and ending.well
        if not ending.well:
            last = " | ".join(ending.output.strip().splitlines()[-3:])
            print(f"{ending.number:04d} {ending.word}: {ending.told}\n     {last}", flush=True)
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
