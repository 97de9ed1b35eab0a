"""What the demos share: a scene computed with overrides, its own summary kept in a file instead of on the screen."""

from __future__ import annotations

import time
from contextlib import redirect_stdout
from pathlib import Path

from riser_soil.results import Run
from riser_soil.scene.reader import read_scene
from riser_soil.whole_run import run


def compute(scene: Path, folder: Path, *overrides: str) -> Run:
    """The run of a scene file with values overridden as by --set; what a run prints goes to said.txt in its folder."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "said.txt").open("w", encoding="utf-8") as said, redirect_stdout(said):
        run(read_scene(scene, overrides), folder, force=True)
    return Run(folder)


def timed(scene: Path, folder: Path, *overrides: str) -> tuple[Run, float]:
    """The run, and the processor time [s] that it took: set-up, solution and output, without compiling kernels."""
    began = time.process_time()
    done = compute(scene, folder, *overrides)
    return done, time.process_time() - began
