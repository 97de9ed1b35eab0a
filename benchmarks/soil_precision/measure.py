"""Runs, each a process of its own: their figures and what they cost, kept as JSON."""

from __future__ import annotations

import hashlib
import json
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.soil_precision.ladders import LADDERS
from benchmarks.soil_precision.scenes import DEPTHS
from riser_soil.core.arrays import Array
from riser_soil.core.environment import environment_alone
from riser_soil.results import Run
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.reader import scene_from_mapping

LONGEST = 400.0  # s of the wall clock, after which a run counts as failed
ARCS = np.linspace(4.5, 9.5, 101)  # m, of the laid riser, over the soil


@dataclass(frozen=True)
class Measured:
    """A run: processor seconds, single figures and curves by name; none where it failed, for a reason."""

    scene: str
    method: str
    n: int
    seconds: float
    figures: dict[str, float]
    curves: dict[str, list[float]]
    reason: str = ""


def measure(results: Path) -> list[Measured]:
    """All runs of all ladders, of which those that are there already are read."""
    results.mkdir(parents=True, exist_ok=True)
    rows = []
    for scene, ladder in LADDERS.items():
        steps = [(ladder.best, n) for n in ladder.reference]
        steps += [(method, n) for method, (_, sizes) in ladder.methods.items() for n in sizes]
        rows += [_one(scene, method, n, results) for method, n in dict.fromkeys(steps)]
    return rows


def _one(scene: str, method: str, n: int, results: Path) -> Measured:
    ladder = LADDERS[scene]
    given = dump_scene(scene_from_mapping(ladder.scene(n, ladder.methods[method][0])))
    file = results / f"{scene}_{n}_{hashlib.sha256(given.encode()).hexdigest()[:10]}.json"
    if file.exists():
        return Measured(**json.loads(file.read_text(encoding="utf-8")) | {"method": method})
    with TemporaryDirectory() as folder:
        measured = _run(scene, method, n, given, Path(folder))
    file.write_text(json.dumps(asdict(measured)), encoding="utf-8")
    print(f"{scene}, {method}, n = {n}: {measured.seconds:.1f} s {measured.reason}", flush=True)
    return measured


def _run(scene: str, method: str, n: int, given: str, folder: Path) -> Measured:
    (folder / "given.yaml").write_text(given, encoding="utf-8")
    command = [sys.executable, "-m", "riser_soil", "run", str(folder / "given.yaml"), "-o", str(folder), "--force"]
    alone = environment_alone() | {"OMP_NUM_THREADS": "1", "RISER_SOIL_COMPLIANCE": "off"}
    try:
        ended = subprocess.run(command, env=alone, timeout=LONGEST, capture_output=True, text=True)
    except subprocess.TimeoutExpired:
        return Measured(scene, method, n, LONGEST, {}, {}, "took too long")
    seconds = Run(folder).summary["processor_seconds"] if Run.is_there(folder) else 0.0
    if ended.returncode != 0:
        return Measured(scene, method, n, seconds, {}, {}, ended.stderr.partition("\n")[0])
    figures, curves = _of_pushed(Run(folder)) if scene == "pushed" else _of_laid(Run(folder))
    along = {name: list(map(float, at)) for name, at in curves.items()}
    return Measured(scene, method, n, seconds, figures, along)


Found = tuple[dict[str, float], dict[str, Array]]


def _of_pushed(run: Run) -> Found:
    """Load down by depth, the largest pressure in the soil, the trough across the pipe."""
    loads = np.array([stage["final"]["contact_force"] for stage in run.summary["stages"]])
    assert len(loads) == len(DEPTHS)
    stress = float(np.abs(run.soil_frame().fields["mean_stress"]).max())
    figures = {f"capacity at {DEPTHS[at]:g} D": float(loads[at]) for at in (0, -1)} | {"largest mean stress": stress}
    return figures, {"load": loads, "trough": run["settlement_across"][-1, 0]}


def _of_laid(run: Run) -> Found:
    """Settlement under the riser and the largest von Mises stress once it lies; the trench that heave leaves, and the
    largest moment in it.
    """
    under = [np.interp(ARCS, run.arc, run["soil_settlement"][at]) for at in (_last(run, "lay"), -1)]
    lay, heave = run.summary["stages"]
    single = {"largest stress": lay["soil"]["max_von_mises_stress"]["value"]}
    single["largest moment"] = heave["extremes"]["max_bending_moment"]["max"]
    bending = np.interp(ARCS, run.arc, run["bending_moment"][-1])
    single |= {"settlement": float(under[0].max()), "trench depth": float(under[1].max())}
    return single, {"settlement along": under[0], "trench along": under[1], "moment along": bending}


def _last(run: Run, stage: str) -> int:
    """Number of a stage's last record."""
    return max(at for at, name in enumerate(run.dataset["stage_name"].values) if name == stage)
