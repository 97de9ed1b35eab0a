"""The hose swinging over the floor: simulated seconds per processor second, at the error of its convergence table."""

from __future__ import annotations

import tempfile
from pathlib import Path

from demos.tank.convergence import BEST, CHEAP
from demos.tank.swing import FORCES, MOMENT, UNTIL, Swing, error, swing


def report() -> None:
    with tempfile.TemporaryDirectory() as folder:
        best, *cheap = (swing(Path(folder) / str(n), *case) for n, case in enumerate((BEST, *CHEAP)))
        for run in (*cheap, best):
            print(row(run, best))


def row(run: Swing, best: Swing) -> str:
    forces, moment = (100.0 * error(run, best, names) for names in (FORCES, MOMENT))
    return (
        f"tank, {run.elements} elements, {run.time_step:g} s: {UNTIL / run.seconds:.1f} simulated seconds per "
        f"processor second, {run.stage['iterations']:.2f} iterations a step; errors {forces:.2f} % of tensions, "
        f"{moment:.3f} % of the moment"
    )
