"""Runs of stressed scenes: what a limited process does in its folder."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from riser_soil.errors import RiserSoilError
from riser_soil.scene.reader import read_scene
from riser_soil.stress.limited_process import Job
from riser_soil.whole_run import run


def running(names: Sequence[str]) -> Job:
    """Run NAME.yaml in turn, results to folders NAME, up to the first that fails; its exit status."""

    def job() -> int:
        for name in names:
            try:
                run(read_scene(f"{name}.yaml"), Path(name), force=True)
            except RiserSoilError as err:
                print(err, file=sys.stderr)
                return err.exit_status
        return 0

    return job
