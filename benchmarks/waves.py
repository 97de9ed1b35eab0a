"""What the sea's waves cost in a run: series about places against plain sums over the components at every station.

The storm of `demos/waves`, twice, step by step in turn, so that a machine whose speed drifts changes all figures alike.
The plain sums are taken for every trial, as without `FlowAtStations`' memory. `python -m benchmarks.waves` prints the
table alone.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import NamedTuple
from unittest.mock import patch

import numpy as np

from benchmarks.riser_only import timed
from benchmarks.stage import TimedStage, last_stage
from riser_soil.core.system import Timer
from riser_soil.riser.trial import Trial
from riser_soil.sea import wave_series
from riser_soil.sea.moving_water import FlowAtStations
from riser_soil.sea.water import WaterMotion
from tests.support.summed_waves import SummedWaves

SCENE = Path(__file__).parent.parent / "demos" / "waves" / "scene.yaml"
COMPONENTS, RAMP, STEPS = (1, 100, 200, 400), 150, 60  # waves; steps until the sea has grown, steps of 0.2 s measured


class Cost(NamedTuple):
    """Seconds of a step, and of it those of the water's motion."""

    step: float
    water: float


class Clocked(FlowAtStations):
    """The water's motion, with the seconds that it takes."""

    seconds = 0.0

    def _find(self, trial: Trial) -> WaterMotion:
        began = time.perf_counter()
        found = self._motion_of(trial)
        Clocked.seconds += time.perf_counter() - began
        return found

    def _motion_of(self, trial: Trial) -> WaterMotion:
        return super()._find(trial)


class ForEveryTrial(Clocked):
    def _motion_of(self, trial: Trial) -> WaterMotion:
        return self._evaluate(trial.state.t, self.pipe.position(trial))


class PlainSums(SummedWaves):
    deepest = wave_series.DEEPEST


def report() -> None:
    print("the sea of demos/waves, by series about places and by plain sums, 441 stations:")
    for count in COMPONENTS:
        series, sums = measure(count)
        print(
            f"  {count} components: water {1e3 * series.water:.2f} and {1e3 * sums.water:.2f} ms a step, sums / series "
            f"{sums.water / series.water:.1f}; a whole step {1e3 * series.step:.1f} and {1e3 * sums.step:.1f} ms, "
            f"{sums.step / series.step:.2f}"
        )


def measure(count: int) -> tuple[Cost, Cost]:
    """Medians, of series and of plain sums."""
    stages = storm(count, Clocked), storm(count, ForEveryTrial)
    found = [[taken(stage) for stage in stages] for _ in range(STEPS)]
    for stage in stages:
        stage.destroy()
    series, sums = np.median(np.array(found), axis=0)
    return Cost(*series), Cost(*sums)


def storm(count: int, stream: type[Clocked]) -> TimedStage:
    """The storm, grown to its full height."""
    settings = (f"water.waves.jonswap.components={count}",)
    with patch("riser_soil.sea.moving_water.FlowAtStations", stream):
        if stream is Clocked:
            stage = last_stage(SCENE, settings, Timer.new())
        else:
            with patch("riser_soil.sea.wave_field.WaveField", PlainSums):
                stage = last_stage(SCENE, settings, Timer.new())
    stage.walk(RAMP)
    return stage


def taken(stage: TimedStage) -> Cost:
    before = Clocked.seconds
    step = timed(lambda: stage.walk(1))
    return Cost(step, Clocked.seconds - before)


if __name__ == "__main__":
    argparse.ArgumentParser(prog="python -m benchmarks.waves", description=__doc__).parse_args()
    report()
