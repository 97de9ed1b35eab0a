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
# A process that has started MPI alone hands these on to its children, in which mpirun then fails without a word.
OF_ANOTHER_JOB = ("PMIX_", "OMPI_", "ORTE_")


def environment() -> dict[str, str]:
    """This process's environment for a new MPI job or a process on its own."""
    mine = {name: value for name, value in os.environ.items() if not name.startswith(OF_ANOTHER_JOB)}
    return mine | ENVIRONMENT


def mpirun(
    ranks: int, *command: str, folder: Path = ROOT, seconds: int = 120
) -> subprocess.CompletedProcess[str]:
    """Run `python COMMAND` on this many ranks from a folder; ended after this many seconds, with status 124.

    The program `timeout` ends mpirun in a way that lets it end its ranks.
    """
    ended = ["timeout", str(seconds)]
    launch = ["mpirun", "-n", str(ranks), "--bind-to", "none", sys.executable, *command]
    return subprocess.run(
        [*ended, *launch], cwd=folder, env=environment(), capture_output=True, text=True, check=False
    )
