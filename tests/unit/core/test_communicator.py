"""What ranks do together."""

from __future__ import annotations

from pathlib import Path

from tests.support.on_ranks import mpirun

LATE = 1.0  # s
WAITING = f"""
import time
from mpi4py import MPI
from riser_soil.core.communicator import wait_asleep

comm = MPI.COMM_WORLD
comm.Barrier()
began, busy = time.monotonic(), time.process_time()
if comm.rank == 1:
    time.sleep({LATE})
wait_asleep(comm)
times = comm.gather((time.monotonic() - began, time.process_time() - busy))
if comm.rank == 0:
    print(*times[0])
"""


def test_ranks_wait_asleep_for_one_that_is_late(tmp_path: Path) -> None:
    script = tmp_path / "waiting.py"
    script.write_text(WAITING, encoding="utf-8")
    done = mpirun(2, str(script))
    assert done.returncode == 0, done.stderr
    waited, busy = map(float, done.stdout.split())
    assert waited > 0.9 * LATE
    assert busy < 0.3 * LATE
