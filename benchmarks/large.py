"""Large soils: the first load step of the demo's riser on ever finer blocks, by each linear solver.

Each in a process of its own. One block of so many thousand unknowns alone: --block, under mpirun on several ranks, of
which the slowest counts.
"""

from __future__ import annotations

import resource
import subprocess
import sys
import time

from mpi4py import MPI

from benchmarks.coupled import SCENE
from benchmarks.speed_page import parser_of, tell
from benchmarks.stage import TimedStage
from riser_soil.assembly import build, sized
from riser_soil.checks.estimate import size_of
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.scene.reader import read_scene
from riser_soil.stages import seat, settings_of

BLOCKS = {  # cells along and across the riser, and far from it [m], by thousands of unknowns
    5: (1.0, 0.075, 0.75),
    23: (0.5, 0.05, 0.5),
    45: (0.25, 0.05, 0.5),
    134: (0.25, 0.03, 0.25),
}
SOLVERS = ("kept", "direct", "iterative")


HEAD = (
    *("unknowns", "linear solver", "Newton iterations", "each takes [s]", "by the clock [s]", "memory [GB]"),
    "forecast [GB]",
)


def report(page: bool = False) -> None:
    tell("large", HEAD, (alone(block, linear) for block in BLOCKS for linear in SOLVERS), page)


def alone(block: int, linear: str) -> list[str]:
    """A row of the table, from a process of its own."""
    command = [sys.executable, "-m", "benchmarks.large", "--block", str(block), "--linear", linear]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()[0].split("; ")


def measure(block: int, linear: str) -> None:
    """Prints a row of the table and the parts of an iteration.

    Processor time and peak memory, each of the rank that takes most, all of this process so far included in the latter.
    """
    comm, clock, began = MPI.COMM_WORLD, Timer.new(), time.process_time()
    along, across, far = BLOCKS[block]
    mesh = f"{{kind: hex, size_at_riser: {{along: {along}, across: {across}, strip: 0.15}}, size_far: {far}}}"
    scene = sized(read_scene(SCENE, (f"soil.mesh={mesh}", f"solver.linear={linear}")))
    assembly, stage = build(scene, comm), scene.stages[0]
    seat(assembly, assembly.begin(stage), settings_of(assembly), Timer.new())
    timed = TimedStage(assembly, stage, State.at_rest(0.0, assembly.size), clock, linear_start=True)
    made, wall = time.process_time(), time.perf_counter()
    timed.walk(1)
    mine = made - began, time.process_time() - made, time.perf_counter() - wall, _peak()
    set_up, step, wall, memory = (max(values) for values in zip(*comm.allgather(mine), strict=True))
    foretold = size_of(scene).memory(comm.size) / comm.size
    if comm.rank == 0:
        each = (f"{seconds / timed.iterations:.2f}" for seconds in (step, wall))
        gigabytes = (f"{size / 1e9:.2f}" for size in (memory, foretold))
        print(f"{timed.system.numbering.free:,}", linear, timed.iterations, *each, *gigabytes, sep="; ")
        print(f"on {comm.size} ranks, set up in {set_up:.1f} s of processor time")
        for part, seconds in sorted(clock.seconds.items(), key=lambda item: -item[1])[:5]:
            print(f"  {part:14s} {seconds / timed.iterations:8.3f} s an iteration by the clock, on the first rank")
    timed.destroy()


def _peak() -> float:
    """Largest resident memory of this process [bytes]."""
    return 1024.0 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


if __name__ == "__main__":
    parser = parser_of("large", __doc__)
    parser.add_argument("--block", type=int, choices=BLOCKS)
    parser.add_argument("--linear", choices=SOLVERS, default="direct")
    given = parser.parse_args()
    if given.block is None:
        report(given.page)
    else:
        measure(given.block, given.linear)
