"""Error bars against true errors: each scene computed with its comparison runs, and compared with its reference."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from mpi4py import MPI

from benchmarks.error_bars.references import Reference
from benchmarks.error_bars.scenes import Mapping
from riser_soil.accuracy.chain import bars_of, comparison_runs, run_values
from riser_soil.accuracy.error_bars import SMALLEST, ErrorBar
from riser_soil.core.compiled import seconds_of_work
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.variants.key_results import key_results
from riser_soil.variants.peaks import peaks_of

CERTAIN = 0.25  # of the true error: what the reference may be off where a ratio is told
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

    def ratio(self, certain: float) -> float | None:
        """Bar over error; None for errors that the reference tells less well, or below the smallest bar.

        The bar itself has no say in it: if wide ones counted more often, their median would be theirs.
        """
        if self.bar.bar is None or not self.error > SMALLEST * self.bar.key_result.scale:
            return None
        return self.bar.bar / self.error if self.uncertainty <= certain * self.error else None


@dataclass(frozen=True)
class JudgedScene:
    """seconds: of the processor, for the scene and for its comparison runs."""

    name: str
    judged: list[Judged]
    not_known: list[ErrorBar]
    seconds: tuple[float, float]


def judge(name: str, mapping: Mapping, reference: Reference) -> JudgedScene:
    """Compute a scene with its comparison runs, and compare it with its reference."""
    scene, began = scene_from_mapping(mapping), seconds_of_work()
    peaks = peaks_of(scene, MPI.COMM_WORLD)
    done = seconds_of_work()
    chain = comparison_runs(scene, MPI.COMM_WORLD)
    run = run_values(key_results(peaks.as_summary("sampled")), peaks)
    bars = bars_of(scene, run, chain)
    seconds = done - began, seconds_of_work() - done
    judged = [_judged(name, bar, *reference.get(bar.key_result.key, UNKNOWN)) for bar in bars if bar.bar is not None]
    return JudgedScene(name, judged, [bar for bar in bars if bar.bar is None], seconds)


def _judged(name: str, bar: ErrorBar, true: float, uncertainty: float) -> Judged:
    return Judged(name, bar, abs(bar.key_result.value - true), uncertainty)


def decided(judged: Iterable[Judged]) -> list[Judged]:
    return [each for each in judged if each.decided]


def share_inside(judged: Iterable[Judged]) -> float:
    hits = [each.inside for each in decided(judged)]
    return sum(hits) / len(hits)


def ratios(judged: Iterable[Judged], certain: float = CERTAIN) -> list[float]:
    """Bars over errors that references tell to a share of them, of those above the smallest bar."""
    values = (each.ratio(certain) for each in judged)
    return [ratio for ratio in values if ratio is not None]
