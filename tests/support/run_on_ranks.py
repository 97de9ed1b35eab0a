"""Whole runs of small scenes on any number of ranks, for tests of solvers that have to find the same."""

from __future__ import annotations

import json
from pathlib import Path

from riser_soil.results import Run
from tests.support.on_ranks import mpirun
from tests.support.scenes import Mapping

COMPARED = ("position", "effective_tension", "bending_moment", "contact_force", "end_force")


def ran(scene: Mapping, folder: Path, ranks: int = 1) -> Run:
    """A run of the scene in a folder of its own."""
    folder.mkdir()
    (folder / "scene.yaml").write_text(json.dumps(scene), encoding="utf-8")
    done = mpirun(ranks, "-m", "riser_soil", "run", "scene.yaml", "-o", "out", folder=folder)
    assert done.returncode == 0, done.stderr
    return Run(folder / "out")
