"""Python commands under mpirun, for tests of what several ranks do together."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
ENVIRONMENT = {
    "OMP_NUM_THREADS": "1",
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_mpi_yield_when_idle": "1",
    "PYTHONPATH": str(ROOT),
}


def mpirun(
    ranks: int, *command: str, folder: Path = ROOT, seconds: int = 120
) -> subprocess.CompletedProcess[str]:
    """Run `python COMMAND` on this many ranks from a folder; ended after this many seconds, with status 124.

    The program `timeout` ends mpirun in a way that lets it end its ranks.
    """
    ended = ["timeout", str(seconds)]
    launch = ["mpirun", "-n", str(ranks), "--bind-to", "none", sys.executable, *command]
    return subprocess.run(
        [*ended, *launch], cwd=folder, env=os.environ | ENVIRONMENT, capture_output=True, text=True, check=False
    )
