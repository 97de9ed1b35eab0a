"""Large soils: the first load step of the demo's riser on ever finer blocks, by each linear solver.

On several ranks under mpirun: what the slowest takes. One block of so many thousand unknowns: --block.
"""

from __future__ import annotations

import argparse
import resource
import time

from mpi4py import MPI

from benchmarks.coupled import SCENE
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


def report(block: int, linear: str) -> None:
    """Processor time and peak memory, each of the rank that takes most, all of this process so far included in the
    latter.
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
        print(
            f"{timed.system.numbering.free} unknowns on {comm.size} ranks, {linear}: set-up {set_up:.1f} s, "
            f"{timed.iterations} Newton iterations of {step / timed.iterations:.2f} s of processor time "
            f"({wall / timed.iterations:.2f} s by the clock), {memory:.0f} MB ({foretold / 1e6:.0f} foretold)"
        )
        for part, seconds in sorted(clock.seconds.items(), key=lambda item: -item[1])[:5]:
            print(f"  {part:14s} {seconds / timed.iterations:8.3f} s an iteration by the clock, on the first rank")
    timed.destroy()


def _peak() -> float:
    """Largest resident memory of this process [MB]."""
    return 1024e-6 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="python -m benchmarks.large", description=__doc__)
    parser.add_argument("--block", type=int, choices=BLOCKS, default=23)
    parser.add_argument("--linear", choices=("kept", "direct", "iterative"), default="direct")
    given = parser.parse_args()
    report(given.block, given.linear)
