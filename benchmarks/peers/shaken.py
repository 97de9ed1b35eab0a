"""A riser shaken by its vortices, by riser_soil and by MoorDyn: table of docs/peers.md.

Usage: python -m benchmarks.peers.shaken [--results FOLDER] [--page]
"""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.peers import shaken_riser as case
from benchmarks.peers.in_turn import ROOT, THEIRS
from demos.compute import timed
from demos.page import publish, script, table

OURS = (40, 0.02), (80, 0.01)  # elements, step [s]
PEERS = (40, 0.001), (160, 0.00025)
SHORT = "stages.1.duration=0.02"


def by_us(elements: int, time_step: float, force: float) -> case.Shaken:
    """The seconds are those of the run less those of a short one."""
    with TemporaryDirectory() as name:
        scene, folder = Path(name) / "scene.yaml", Path(name)
        scene.write_text(json.dumps(case.scene_of(elements, time_step, force)), encoding="utf-8")
        short = min(timed(scene, folder / "short", SHORT)[1] for _ in range(2))
        done, seconds = timed(scene, folder / "run")
        moving = done["stage"] == 1
        return case.Shaken(done.time[moving], done["position"][moving], seconds - short)


def by_moordyn(elements: int, time_step: float, force: float) -> case.Shaken:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "run.npz"
        call = f"save({elements}, {time_step!r}, {force!r}, {str(path)!r})"
        command = [str(THEIRS), "-c", f"from benchmarks.peers.shaken_by_moordyn import save; {call}"]
        subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
        with np.load(path) as stored:
            return case.Shaken(stored["t"], stored["x"], float(stored["seconds"]))


def main(results: Path, page: bool) -> None:
    results.mkdir(parents=True, exist_ok=True)
    rows = list[list[str]]()
    programs = {"riser_soil": (by_us, OURS)} | ({"MoorDyn": (by_moordyn, PEERS)} if THEIRS.exists() else {})
    for program, (run, sizes) in programs.items():
        for elements, time_step in sizes:
            motion = run(elements, time_step, case.FORCE)
            swing, drag = case.swing(motion), case.sag(motion) / case.sag(run(elements, time_step, 0.0))
            cells = f"{swing.frequency:.3f}", f"{swing.largest:.3f}", f"{swing.mean:.3f}", f"{drag:.3f}"
            rows.append([f"{program}, {elements} elements, {time_step:g} s", *cells, f"{motion.seconds:.1f}"])
    head = ["", "Hz", "largest A/D", "A/D, all nodes", "sag over that without vortices", "processor s"]
    publish({"vortices": table(head, rows)}, results, ROOT / "docs" / "peers.md" if page else None)


if __name__ == "__main__":
    script(main, __doc__, ROOT)
