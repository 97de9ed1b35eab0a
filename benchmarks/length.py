"""Cost and memory of long risers in motion: they grow with the number of elements, and with nothing else."""

from __future__ import annotations

import resource
import subprocess
import sys
import time
import tracemalloc
from collections.abc import Iterator
from statistics import median

from benchmarks.riser_only import CATENARY, ELEMENTS
from benchmarks.speed_page import parser_of, tell
from benchmarks.stage import last_stage
from riser_soil.core.system import Timer

COUNTS = (100, 1000, 10000)
LENGTH, END = 10000.0, 4285.7  # m: the catenary of `demos/catenary`, 29 times as large
BEFORE, STEPS = 5, 20


HEAD = (
    *("riser of 10 km", "elements", "a step [ms]", "an element [µs]", "Newton iterations"),
    *(f"memory beyond that of {COUNTS[0]} elements [MB]", "bytes of an element in passing", "bytes that a step leaves"),
)


def report(page: bool = False) -> None:
    tell("length", HEAD, (each for dimension in (2, 3) for each in rows(dimension)), page)


def rows(dimension: int) -> Iterator[list[str]]:
    least = None
    for count in COUNTS:
        command = [sys.executable, "-m", "benchmarks.length", str(dimension), str(count)]
        output = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
        seconds, iterations, memory, passing, kept = (float(word) for word in output)
        least = memory if least is None else least
        yield [
            "in a plane" if dimension == 2 else "in space", f"{count:,}", f"{1e3 * seconds:.2f}",
            f"{1e6 * seconds / count:.2f}", f"{iterations:.1f}", f"{(memory - least) / 1e6:.0f}",
            f"{passing / count:.0f}", f"{kept:.0f}",
        ]  # fmt: skip


def measure(dimension: int, elements: int) -> tuple[float, float, float, float, float]:
    """Cost of a step: processor seconds, iterations, the process's largest memory in bytes, bytes that the step
    allocates at most at a time, and that it leaves behind.
    """
    sizes = f"riser.segments.0.length={LENGTH}", f"riser.end.position=[{END}, 0.0, {END}]"
    bending = () if dimension == 2 else ("line_types.flexible.GJ=2.0e4",)
    stage = last_stage(CATENARY, (f"dimension={dimension}", ELEMENTS.format(elements), *sizes, *bending), Timer.new())
    stage.walk(BEFORE)
    stage.iterations, seconds = 0, list[float]()
    for _ in range(STEPS):
        began = time.process_time()
        stage.walk(1)
        seconds.append(time.process_time() - began)
    most = 1024.0 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    iterations = stage.iterations / STEPS
    tracemalloc.start()
    stage.walk(BEFORE)
    before = tracemalloc.get_traced_memory()[0]
    tracemalloc.reset_peak()
    stage.walk(BEFORE)
    after, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    stage.destroy()
    return median(seconds), iterations, most, float(peak - before), (after - before) / BEFORE


if __name__ == "__main__":
    parser = parser_of("length", __doc__)
    parser.add_argument("dimension", type=int, nargs="?", help="with a count: that measurement alone, in numbers")
    parser.add_argument("elements", type=int, nargs="?")
    given = parser.parse_args()
    if given.elements is None:
        report(given.page)
    else:
        print(*measure(given.dimension, given.elements))
