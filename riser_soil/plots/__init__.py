"""Plots of a run, drawn from the files in its folder.

They are drawn by a process of their own: VTK aborts where dolfinx was imported before it (their copies of
std::regex get mixed up), and a machine without means to draw must not bring a run down.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from riser_soil.errors import ResultsError

# A child that saw its parent's MPI rank in these would take itself for that rank.
_MPI = ("OMPI_", "PMIX_", "PMI_", "HYDRA_", "SLURM_")


def picture(folder: Path | str, png: Path | str, magnify: float | None = None) -> Path:
    """Draws the last recorded instant: the touchdown zone from close by, and the whole riser beside it.

    The riser is coloured by bending moment, the soil by von Mises stress. The soil is cut open along the
    riser, and its displacement is drawn `magnify` times (None: by a round factor that makes it visible); the
    riser sinks with it.
    Raises ResultsError when the folder holds nothing to draw, or drawing fails.
    """
    command = [sys.executable, "-m", "riser_soil.plots.touchdown", str(folder), str(png)]
    if magnify is not None:
        command.append(repr(float(magnify)))
    environment = {name: value for name, value in os.environ.items() if not name.startswith(_MPI)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        raise ResultsError(_reason(done))
    return Path(png)


def _reason(done: subprocess.CompletedProcess[str]) -> str:
    last = done.stderr.strip().splitlines()[-1:] or ["no message"]
    if done.returncode > 0:
        return last[0]
    return f"drawing was killed by signal {-done.returncode}; is EGL there (Debian: libegl1 libgl1-mesa-dri)?"
