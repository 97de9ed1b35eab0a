"""Error bars against true errors: each scene computed with its companions, and compared with its reference."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import dataclass
from statistics import median

from mpi4py import MPI

from benchmarks.error_bars.references import Reference
from benchmarks.error_bars.scenes import Mapping
from riser_soil.accuracy.chain import bars_of, companions, run_values
from riser_soil.accuracy.companions import peaks_of
from riser_soil.accuracy.error_bars import SMALLEST, ErrorBar
from riser_soil.accuracy.headlines import headlines
from riser_soil.scene.reader import scene_from_mapping

CERTAIN = 0.3  # of the true error, or of the smallest bar: what its reference may be off


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
    def certain(self) -> bool:
        """Whether the reference tells the error."""
        return self.uncertainty <= CERTAIN * max(self.error, SMALLEST * self.bar.headline.scale)

    @property
    def ratio(self) -> float | None:
        """Bar over error; None for errors below the smallest bar."""
        below = self.error <= SMALLEST * self.bar.headline.scale
        return None if below or self.bar.bar is None else self.bar.bar / self.error


@dataclass(frozen=True)
class JudgedScene:
    """seconds: of the processor, for the scene and for its companions."""

    name: str
    judged: list[Judged]
    not_known: list[ErrorBar]
    seconds: tuple[float, float]


def judge(name: str, mapping: Mapping, reference: Reference) -> JudgedScene:
    """Compute a scene with its companions; quantities that the reference does not have are not judged."""
    scene, began = scene_from_mapping(mapping), time.process_time()
    peaks = peaks_of(scene, MPI.COMM_WORLD)
    taken = time.process_time() - began
    chain = companions(scene, MPI.COMM_WORLD)
    extra = time.process_time() - began - taken
    run = run_values(headlines(peaks.told("sampled")), peaks)
    found = bars_of(scene, run, chain)
    bars = [bar for bar in found if bar.headline.key in reference]
    judged = [_judged(name, bar, *reference[bar.headline.key]) for bar in bars if bar.bar is not None]
    return JudgedScene(name, judged, [bar for bar in bars if bar.bar is None], (taken, extra))


def _judged(name: str, bar: ErrorBar, true: float, uncertainty: float) -> Judged:
    return Judged(name, bar, abs(bar.headline.value - true), uncertainty)


def share_inside(judged: Iterable[Judged]) -> float:
    found = [each.inside for each in judged if each.certain]
    return sum(found) / len(found)


def median_ratio(judged: Iterable[Judged]) -> float:
    return median(each.ratio for each in judged if each.certain and each.ratio is not None)
