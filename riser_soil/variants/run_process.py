"""Process of one run: `riser-soil run`, ended by the system when the thread that began it ends.

python -m riser_soil.variants.run_process PARENT SCENE FOLDER, PARENT being the process id of the one that began it.
"""

from __future__ import annotations

import argparse
import ctypes
import os
import signal
import sys

_PR_SET_PDEATHSIG = 1  # Linux's prctl(2); it outlives execve(2)


def die_with(parent: int) -> None:
    """Have this process killed when its parent ends, however that comes; it leaves nothing that counts."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:  # it ended before
        sys.exit(128 + signal.SIGKILL)


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description="a run, which ends with the process that began it")
    arguments.add_argument("parent", type=int, help="process id of the one that began it")
    arguments.add_argument("scene", help="scene file")
    arguments.add_argument("folder", help="folder for its results")
    given = arguments.parse_args()
    die_with(given.parent)
    run = [sys.executable, "-m", "riser_soil", "run", given.scene, "-o", given.folder, "--force"]
    os.execv(sys.executable, run)
