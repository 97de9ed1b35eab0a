"""Resident memory [MB] at every accepted step of a run, as JSON: python memory_of_run.py SCENE.yaml FOLDER."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

from tests.support.watched_run import watched_run


def resident() -> float:
    """Resident memory of this process [MB]."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def main(scene: str, folder: Path) -> None:
    """Results go to disk often, so that what the first time costs, some MB, comes early on any machine."""
    from riser_soil.results import record
    from riser_soil.scene.reader import read_scene

    record._FLUSH_EVERY, record._FLUSH_SHARE = 0.02, 1.0
    peaks: list[float] = []
    watched_run(read_scene(scene), folder, lambda: peaks.append(resident()))
    (folder / "memory.json").write_text(json.dumps(peaks), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
