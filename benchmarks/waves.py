"""What the sea's waves cost in a run: series about places against plain sums over the components at every station.

The storm of `demos/waves`, step by step, with both at the places of every trial in turn, so that a machine whose speed
drifts changes all figures alike. `python -m benchmarks.waves` prints the table alone.
"""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path
from typing import NamedTuple
from unittest.mock import patch

import numpy as np

from benchmarks.riser_only import timed
from benchmarks.stage import TimedStage, last_stage
from riser_soil.assembly.sea import water_of
from riser_soil.core.system import Timer
from riser_soil.riser import stations
from riser_soil.sea import wave_series
from riser_soil.sea.flows import Sea
from tests.support.summed_waves import SummedWaves

SCENE = Path(__file__).parent.parent / "demos" / "waves" / "scene.yaml"
COMPONENTS, RAMP, STEPS = (1, 100, 200, 400), 150, 60  # waves; steps until the sea has grown, steps of 0.2 s measured


class Cost(NamedTuple):
    """Seconds of a step, and of it those of the water's motion."""

    step: float
    water: float


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
    """Medians, of series and of plain sums, which take the place of the series in the same steps."""
    stage = last_stage(SCENE, (f"water.waves.jonswap.components={count}",), Timer.new())
    series = water_of(stage.assembly.scene, stage.stage)
    with patch("riser_soil.sea.waves.WaveField", PlainSums):
        summed = water_of(stage.assembly.scene, stage.stage)
    assert series is not None
    assert summed is not None
    sums = next(flow for flow in summed.flows if isinstance(flow, PlainSums))
    stage.walk(RAMP)
    found = [taken(stage, series, sums) for _ in range(STEPS)]
    stage.destroy()
    (step, *seconds) = np.median(np.array(found), axis=0)
    return Cost(step, seconds[0]), Cost(step - seconds[0] + seconds[1], seconds[1])


def taken(stage: TimedStage, *seas: Sea | PlainSums) -> list[float]:
    """Seconds of a step, and of the water's motion by each of the seas at its trials, whose places differ a little."""
    line, before = stage.assembly.line, stage.iterations
    step = timed(lambda: stage.walk(1))
    trials, state = stage.iterations - before + 1, stage.stepper.now
    N = stations.stations(line.length).N
    x = line.to_global(np.einsum("ega,eai->egi", N, line.trial(state).q)).reshape(-1, 3)

    def ask(sea: Sea | PlainSums) -> None:
        for k in range(trials):
            sea(state.t, x + 1e-6 * k)

    return [step, *(timed(partial(ask, sea)) for sea in seas)]


if __name__ == "__main__":
    argparse.ArgumentParser(prog="python -m benchmarks.waves", description=__doc__).parse_args()
    report()
