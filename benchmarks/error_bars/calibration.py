"""Error bars against true errors: each scene computed with its comparison runs, and compared with its reference."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable
from dataclasses import dataclass

from mpi4py import MPI

from benchmarks.error_bars.references import Reference
from benchmarks.error_bars.scenes import Mapping
from riser_soil.accuracy.chain import bars_of, comparison_runs, peaks_of, run_values
from riser_soil.accuracy.error_bars import SMALLEST, ErrorBar
from riser_soil.accuracy.key_results import key_results
from riser_soil.core import compiled
from riser_soil.scene.reader import scene_from_mapping

CERTAIN = 0.1  # of the bar, or of the true error where that is larger: what the reference may be off
UNKNOWN = math.nan, math.inf  # reference that could not be computed


@dataclass(frozen=True)
class Judged:
    """A bar beside the true error and its uncertainty; all in the quantity's unit."""

    scene: str
    bar: ErrorBar
    error: float
    uncertainty: float

    @property
    def inside(self) -> bool:
        return self.bar.bar is not None and self.error <= self.bar.bar

    @property
    def decided(self) -> bool:
        """Whether the reference tells on which side of its bar the error is."""
        return self.bar.bar is not None and abs(self.error - self.bar.bar) >= self.uncertainty

    @property
    def ratio(self) -> float | None:
        """Bar over error; None for errors that the reference does not tell, or below the smallest bar."""
        if self.bar.bar is None or self.error <= SMALLEST * self.bar.key_result.scale:
            return None
        certain = self.uncertainty <= CERTAIN * max(self.error, self.bar.bar)
        return self.bar.bar / self.error if certain else None


@dataclass(frozen=True)
class JudgedScene:
    """seconds: of the processor, for the scene and for its comparison runs."""

    name: str
    judged: list[Judged]
    not_known: list[ErrorBar]
    seconds: tuple[float, float]


def judge(name: str, mapping: Mapping, reference: Reference) -> JudgedScene:
    """Compute a scene with its comparison runs, and compare it with its reference."""
    scene, began = scene_from_mapping(mapping), _processor_time()
    peaks = peaks_of(scene, MPI.COMM_WORLD)
    done = _processor_time()
    chain = comparison_runs(scene, MPI.COMM_WORLD)
    run = run_values(key_results(peaks.reported("sampled")), peaks)
    found = bars_of(scene, run, chain)
    seconds = done - began, _processor_time() - done
    judged = [_judged(name, bar, *reference.get(bar.key_result.key, UNKNOWN)) for bar in found if bar.bar is not None]
    return JudgedScene(name, judged, [bar for bar in found if bar.bar is None], seconds)


def _judged(name: str, bar: ErrorBar, true: float, uncertainty: float) -> Judged:
    return Judged(name, bar, abs(bar.key_result.value - true), uncertainty)


def _processor_time() -> float:
    """Without the compilation of kernels [s]."""
    return time.process_time() - compiled.seconds_compiling()


def decided(judged: Iterable[Judged]) -> list[Judged]:
    return [each for each in judged if each.decided]


def share_inside(judged: Iterable[Judged]) -> float:
    found = [each.inside for each in decided(judged)]
    return sum(found) / len(found)


def ratios(judged: Iterable[Judged], above: float = SMALLEST) -> list[float]:
    """Bars over errors, of those above a share of their quantity's scale."""
    larger = (each for each in judged if each.error > above * each.bar.key_result.scale)
    return [each.ratio for each in larger if each.ratio is not None]
