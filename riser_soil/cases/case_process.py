"""Process of one case: `riser-soil run`, ended by the system when the thread of the worker that began it ends.

python -m riser_soil.cases.case_process WORKER SCENE FOLDER, WORKER being the process id of the worker.
"""

from __future__ import annotations

import argparse
import ctypes
import os
import signal
import sys

_PR_SET_PDEATHSIG = 1  # of Linux: prctl(2); what it sets outlives execve(2)


def die_with(worker: int) -> None:
    """From now on this process is killed when the worker ends, however that comes; it leaves nothing that counts."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != worker:  # it ended before
        sys.exit(128 + signal.SIGKILL)


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description="a case's run, which ends with its worker")
    arguments.add_argument("worker", type=int, help="process id of the worker")
    arguments.add_argument("scene", help="scene file")
    arguments.add_argument("folder", help="folder for its results")
    given = arguments.parse_args()
    die_with(given.worker)
    run = [sys.executable, "-m", "riser_soil", "run", given.scene, "-o", given.folder, "--force"]
    os.execv(sys.executable, run)
