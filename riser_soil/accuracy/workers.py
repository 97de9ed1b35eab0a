"""Points of a study computed one after the other, or several at a time; what has been computed is not run again."""

from __future__ import annotations

import subprocess
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor

from riser_soil.accuracy.study_points import PointOutcome, StudyPoint

Told = Callable[[PointOutcome, bool], None]
"""Is told of each point as it ends, and whether it was there before."""


def compute(points: Sequence[StudyPoint], jobs: int, told: Told) -> list[PointOutcome]:
    """What became of the points, `jobs` of them at a time. No process outlives the call, however it ends."""
    workers = _Workers(jobs, told)
    pool = ThreadPoolExecutor(max_workers=jobs)
    try:
        return list(pool.map(workers.outcome, points))
    finally:
        workers.stop()
        pool.shutdown(cancel_futures=True)


class _Workers:
    """Processes that are computing points."""

    def __init__(self, jobs: int, told: Told) -> None:
        self._alone, self._told = jobs == 1, told
        self._running: set[subprocess.Popen[bytes]] = set()
        self._lock, self._stopped = threading.Lock(), False

    def outcome(self, point: StudyPoint) -> PointOutcome:
        known = point.found()
        outcome = known if known is not None else self._computed(point)
        self._told(outcome, known is not None)
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
