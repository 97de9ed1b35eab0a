"""Cost and memory of long risers in motion: they grow with the number of elements, and with nothing else."""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import time
import tracemalloc
from statistics import median

from benchmarks.riser_only import CATENARY, ELEMENTS
from benchmarks.stage import last_stage
from riser_soil.core.system import Timer

COUNTS = (100, 1000, 10000)
LENGTH, END = 10000.0, 4285.7  # m: the catenary of `demos/catenary`, 29 times as large
BEFORE, STEPS = 5, 20


def report() -> None:
    for dimension in (2, 3):
        print(f"a riser of 10 km, in {dimension} dimensions:")
        least = None
        for count in COUNTS:
            command = [sys.executable, "-m", "benchmarks.length", str(dimension), str(count)]
            found = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
            seconds, iterations, memory, passing, kept = (float(word) for word in found)
            least = memory if least is None else least
            print(
                f"  {count} elements: {1e3 * seconds:.2f} ms of processor time a step, {1e6 * seconds / count:.2f} us "
                f"an element, {iterations:.1f} iterations; {(memory - least) / 1e6:.0f} MB more than with {COUNTS[0]}; "
                f"a step allocates {passing / count:.0f} bytes an element in passing and leaves {kept:.0f} bytes in all"
            )


def measure(dimension: int, elements: int) -> tuple[float, float, float, float, float]:
    """Of a step: processor seconds, iterations; of the process: most memory in bytes; of a step again: bytes that it
    allocates at most at a time, and that it leaves behind.
    """
    sizes = f"riser.segments.0.length={LENGTH}", f"riser.end.position=[{END}, 0.0, {END}]"
    bending = () if dimension == 2 else ("line_types.flexible.GJ=2.0e4",)
    stage = last_stage(CATENARY, (f"dimension={dimension}", ELEMENTS.format(elements), *sizes, *bending), Timer.new())
    stage.walk(BEFORE)
    stage.iterations, taken = 0, list[float]()
    for _ in range(STEPS):
        began = time.process_time()
        stage.walk(1)
        taken.append(time.process_time() - began)
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
    return median(taken), iterations, most, float(peak - before), (after - before) / BEFORE


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m benchmarks.length", description=__doc__)
    parser.add_argument("dimension", type=int, nargs="?", help="with a count: that measurement alone, in numbers")
    parser.add_argument("elements", type=int, nargs="?")
    given = parser.parse_args()
    if given.elements is None:
        report()
    else:
        print(*measure(given.dimension, given.elements))
