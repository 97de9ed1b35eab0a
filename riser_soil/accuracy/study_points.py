"""Points of a study: runs of a scene with settings varied, each in a process of its own, several at a time.

A point's folder is named by a digest of its scene and the program's version: what has been computed is found again.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from riser_soil import __version__
from riser_soil.accuracy.key_results import KeyResult, key_results
from riser_soil.core.environment import environment_alone
from riser_soil.errors import MeshError, SolveError
from riser_soil.results.folder import NAMES, SUMMARY
from riser_soil.results.folder import SCENE as RESOLVED
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.scene import Scene

POINTS, GIVEN, OUTCOME, COST, SAID = "points", "given.yaml", "outcome.json", "cost.json", "said.txt"
LASTING = (0, MeshError.exit_status, SolveError.exit_status)  # exit statuses that a repetition would have again

Factors = tuple[float, ...]


"""How many times as fine as the scene a point is, setting by setting."""


@dataclass(frozen=True)
class PointOutcome:
    """What became of a point.

    status: exit status; reason: why it failed. cpu: processor time [s], nan where it is not known. alone: whether no
    other point ran beside it. steps: time and load steps taken.
    """

    factors: Factors
    status: int
    reason: str
    cpu: float
    alone: bool
    steps: int = 0
    key_results: Mapping[str, KeyResult] = field(default_factory=dict)

    @property
    def done(self) -> bool:
        """Whether it has an answer."""
        return self.status == 0


@dataclass(frozen=True, eq=False)
class StudyPoint:
    """A run to be had: its scene, and the folder of all points."""

    factors: Factors
    scene: Scene
    points: Path

    @property
    def given(self) -> str:
        """Its scene as text; fields beside the positions are not recorded."""
        output = self.scene.output.model_copy(update={"fields": (), "directory": None})
        return dump_scene(self.scene.model_copy(update={"output": output}))

    @property
    def folder(self) -> Path:
        return self.points / hashlib.sha256(f"{__version__}\n{self.given}".encode()).hexdigest()[:12]

    def found(self) -> PointOutcome | None:
        """What became of it in an earlier study; None where it has not come to an end."""
        try:
            outcome: dict[str, Any] = json.loads((self.folder / OUTCOME).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        if outcome["status"] not in LASTING:
            return None
        known = {key: KeyResult(**each) for key, each in outcome.pop("headlines").items()}
        given = {"factors": self.factors, "key_results": known, "cpu": _number(outcome["cpu"])}
        return PointOutcome(**outcome | given)

    def start(self) -> subprocess.Popen[bytes]:
        """The process that computes it; what it says goes to a file in its folder."""
        self.folder.mkdir(parents=True, exist_ok=True)
        for name in (OUTCOME, COST):
            (self.folder / name).unlink(missing_ok=True)
        (self.folder / GIVEN).write_text(self.given, encoding="utf-8")
        with (self.folder / SAID).open("wb") as said:
            return subprocess.Popen(
                [sys.executable, "-m", "riser_soil.accuracy.point_run", str(self.folder / GIVEN), str(self.folder)],
                env=_environment(), stdin=subprocess.DEVNULL, stdout=said, stderr=subprocess.STDOUT,
            )  # fmt: skip

    def ended(self, status: int, alone: bool) -> PointOutcome:
        """What became of it, kept for later studies; of its results the summary stays, series and pictures go."""
        cost = self._cost(status)
        summary = self._summary()
        steps = sum(stage["steps"] for stage in summary["stages"])
        known = key_results(summary) if status == 0 else {}
        outcome = PointOutcome(self.factors, status, _line(cost["reason"]), cost["cpu"], alone, steps, known)
        for name in set(NAMES) - {SUMMARY, RESOLVED}:
            (self.folder / name).unlink(missing_ok=True)
        content = asdict(outcome) | {"cpu": None if math.isnan(outcome.cpu) else outcome.cpu}
        content["headlines"] = content.pop("key_results")  # as the file has it
        (self.folder / OUTCOME).write_text(json.dumps(content, indent=1), encoding="utf-8")
        return outcome

    def _cost(self, status: int) -> dict[str, Any]:
        try:
            cost: dict[str, Any] = json.loads((self.folder / COST).read_text(encoding="utf-8"))
            return cost
        except (OSError, ValueError):
            return {"reason": self._last_words(status), "cpu": math.nan}

    def _last_words(self, status: int) -> str:
        if status < 0:
            return f"killed by signal {-status}"
        said = (self.folder / SAID).read_text(encoding="utf-8", errors="replace").strip().splitlines()
        return said[-1] if said else f"ended with status {status}"

    def _summary(self) -> dict[str, Any]:
        try:
            summary: dict[str, Any] = json.loads((self.folder / SUMMARY).read_text(encoding="utf-8"))
            return summary
        except (OSError, ValueError):
            return {"stages": []}


def _environment() -> dict[str, str]:
    """One thread, so that processor time is the time of one core."""
    own = {"OMP_NUM_THREADS": "1", "PETSC_OPTIONS": f"-no_signal_handler {os.environ.get('PETSC_OPTIONS', '')}"}
    return environment_alone() | own


def _line(text: str) -> str:
    return " ".join(text.split())


def _number(value: float | None) -> float:
    return math.nan if value is None else value


OnEnd = Callable[[PointOutcome, bool], None]
"""Called as each point ends, with its outcome and whether that was there before."""


def compute(points: Sequence[StudyPoint], jobs: int, on_end: OnEnd) -> list[PointOutcome]:
    """What became of the points, `jobs` of them at a time. No process outlives the call, however it ends."""
    workers = _Workers(jobs, on_end)
    pool = ThreadPoolExecutor(max_workers=jobs)
    try:
        return list(pool.map(workers.outcome, points))
    finally:
        workers.stop()
        pool.shutdown(cancel_futures=True)


class _Workers:
    """Processes that are computing points."""

    def __init__(self, jobs: int, on_end: OnEnd) -> None:
        self._alone, self._on_end = jobs == 1, on_end
        self._running: set[subprocess.Popen[bytes]] = set()
        self._lock, self._stopped = threading.Lock(), False

    def outcome(self, point: StudyPoint) -> PointOutcome:
        known = point.found()
        outcome = known if known is not None else self._computed(point)
        self._on_end(outcome, known is not None)
        return outcome

    def stop(self) -> None:
        with self._lock:
            self._stopped = True
            for process in self._running:
                process.terminate()

    def _computed(self, point: StudyPoint) -> PointOutcome:
        with self._lock:
            if self._stopped:
                raise RuntimeError("the study has been stopped")
            process = point.start()
            self._running.add(process)
        status = process.wait()
        with self._lock:
            self._running.discard(process)
        return point.ended(status, self._alone)
