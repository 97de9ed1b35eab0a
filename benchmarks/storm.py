"""A whole storm, results and their files counted: a steel riser of 2,500 m in waves on hysteretic clay.

`python -m benchmarks.storm` prints how many times as fast as real time it is computed, in processor time, and what the
steps and the results take of it.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import NamedTuple

from benchmarks.speed_page import parser_of, tell
from demos.compute import timed

SCENE = Path(__file__).parent / "storm.yaml"
SHORT = 1.0  # s of a run before, in which kernels are compiled, or read


class Cost(NamedTuple):
    """Cost of a storm: its steps and Newton iterations a step; processor seconds of all of it; shares of the time by
    the clock that go to the line solver, and to results.
    """

    steps: int
    iterations: float
    seconds: float
    loop: float
    results: float


HEAD = (
    *("storm [s]", "steps", "Newton iterations a step", "processor time [s]", "times as fast as real time"),
    *("in the line solver", "for results"),
)


def report(page: bool = False, duration: float = 600.0) -> None:
    cost = measure(duration)
    row = [
        f"{duration:g}", f"{cost.steps:,}", f"{cost.iterations:.2f}", f"{cost.seconds:.1f}",
        f"{duration / cost.seconds:.1f}", f"{cost.loop:.0%}", f"{cost.results:.0%}",
    ]  # fmt: skip
    tell("storm", HEAD, [row], page)


def measure(duration: float) -> Cost:
    """The whole run, set-up and static equilibrium included."""
    with tempfile.TemporaryDirectory() as folder:
        timed(SCENE, Path(folder) / "short", f"stages.1.duration={SHORT}")
        done, seconds = timed(SCENE, Path(folder) / "storm", f"stages.1.duration={duration}")
        stage, by_part = done.summary["stages"][-1], done.summary["seconds"]
        shares = (by_part[name] / sum(by_part.values()) for name in ("line solver", "output"))
        return Cost(stage["steps"], stage["newton_iterations"] / stage["steps"], seconds, *shares)


if __name__ == "__main__":
    parser = parser_of("storm", __doc__)
    parser.add_argument("--duration", type=float, default=600.0, metavar="SECONDS", help="of the storm")
    given = parser.parse_args()
    report(given.page, given.duration)
