"""A whole storm, results and their files counted: a steel riser of 2,500 m in waves on hysteretic clay.

`python -m benchmarks.storm` prints how many times as fast as real time it is computed, in processor time, and what the
steps and the results take of it.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from typing import NamedTuple

from demos.compute import timed

SCENE = Path(__file__).parent / "storm.yaml"
SHORT = 1.0  # s of a run before, in which kernels are compiled, or read


class Cost(NamedTuple):
    """Of a storm: its steps and Newton iterations a step; processor seconds of all of it; shares of the time by the
    clock that go to the compiled loop, and to results.
    """

    steps: int
    iterations: float
    seconds: float
    loop: float
    results: float


def report(duration: float = 600.0) -> None:
    cost = measure(duration)
    print(
        f"a storm of {duration:g} s, {cost.steps} steps of {cost.iterations:.2f} iterations: {cost.seconds:.1f} s of "
        f"processor time, {duration / cost.seconds:.1f} times as fast as real time; {cost.loop:.0%} of it in the "
        f"compiled loop, {cost.results:.0%} for results"
    )


def measure(duration: float) -> Cost:
    """The whole run, set-up and static equilibrium included."""
    with tempfile.TemporaryDirectory() as folder:
        timed(SCENE, Path(folder) / "short", f"stages.1.duration={SHORT}")
        done, seconds = timed(SCENE, Path(folder) / "storm", f"stages.1.duration={duration}")
        stage, by_part = done.summary["stages"][-1], done.summary["seconds"]
        shares = (by_part[name] / sum(by_part.values()) for name in ("compiled loop", "output"))
        return Cost(stage["steps"], stage["newton_iterations"] / stage["steps"], seconds, *shares)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m benchmarks.storm", description=__doc__)
    parser.add_argument("--duration", type=float, default=600.0, metavar="SECONDS", help="of the storm")
    report(parser.parse_args().duration)
