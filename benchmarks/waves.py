"""What the sea's waves cost in a run: series about places against plain sums over the components at every station.

The storm of `demos/waves`, step by step, with both at the places of every trial in turn, so that a machine whose speed
drifts changes all figures alike. `python -m benchmarks.waves` prints the table alone.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import NamedTuple
from unittest.mock import patch

import numpy as np

from benchmarks.riser_only import timed
from benchmarks.speed_page import parser_of, tell
from benchmarks.stage import TimedStage, last_stage
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


HEAD = (
    *("wave components", "waves of a step, by series [ms]", "by plain sums [ms]", "sums over series"),
    *("the whole step, by series [ms]", "by plain sums [ms]", "sums over series"),
)


def report(page: bool = False) -> None:
    tell("waves", HEAD, (row(count, *measure(count)) for count in COMPONENTS), page)


def row(count: int, series: Cost, sums: Cost) -> list[str]:
    pairs = ((series.water, sums.water), (series.step, sums.step))
    return [f"{count}", *(cell for a, b in pairs for cell in (f"{1e3 * a:.2f}", f"{1e3 * b:.2f}", f"{b / a:.1f}"))]


def measure(count: int) -> tuple[Cost, Cost]:
    """Medians, of series and of plain sums, which take the place of the series in the same steps."""
    stage = last_stage(SCENE, (f"water.waves.jonswap.components={count}",), Timer.new())
    sea = stage.assembly.sea
    assert sea is not None
    series = sea.in_stage(stage.stage).flow
    with patch("riser_soil.assembly.waves.linear_waves", PlainSums):
        summed = sea.in_stage(stage.stage).flow
    assert series is not None
    assert summed is not None
    sums = next(flow for flow in summed.flows if isinstance(flow, PlainSums))
    stage.walk(RAMP)
    times = [step_seconds(stage, series, sums) for _ in range(STEPS)]
    stage.destroy()
    (step, *seconds) = np.median(np.array(times), axis=0)
    return Cost(step, seconds[0]), Cost(step - seconds[0] + seconds[1], seconds[1])


def step_seconds(stage: TimedStage, *seas: Sea | PlainSums) -> list[float]:
    """Seconds of a step, and of the water's motion by each of the seas at its trials, whose places differ a little."""
    line, before = stage.assembly.riser.line, stage.iterations
    step = timed(lambda: stage.walk(1))
    trials, state = stage.iterations - before + 1, stage.stepper.now
    N = stations.stations(line.length).N
    x = line.to_global(np.einsum("ega,eai->egi", N, line.trial(state).q)).reshape(-1, 3)

    def ask(sea: Sea | PlainSums) -> None:
        for k in range(trials):
            sea(state.t, x + 1e-6 * k)

    return [step, *(timed(partial(ask, sea)) for sea in seas)]


if __name__ == "__main__":
    report(parser_of("waves", __doc__).parse_args().page)
