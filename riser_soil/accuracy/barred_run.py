"""Run of a scene with error bars: the run, its companions, the bars in its summary and on the screen."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

from riser_soil.accuracy.chain import bars_of, companions, run_values
from riser_soil.accuracy.error_bars import ErrorBar, RunValues
from riser_soil.accuracy.headlines import headlines
from riser_soil.accuracy.screen import print_bars
from riser_soil.assembly.packages import communicator_of
from riser_soil.errors import Interruption
from riser_soil.interruption import handling_signals
from riser_soil.results.folder import SUMMARY
from riser_soil.results.peaks import RunPeaks
from riser_soil.results.summary import add_to_summary
from riser_soil.scene.scene import Scene
from riser_soil.whole_run import run

LEFT = "while its error bars were computed; {} has the whole run, without them"


def run_with_error_bars(scene: Scene, folder: Path | str, force: bool = False, restart: bool = False) -> None:
    """As `run`, then tell the error bars; collective. What goes wrong with a companion leaves the run as it is."""
    folder, comm, peaks = Path(folder), communicator_of(scene), RunPeaks()
    began = time.perf_counter()
    run(scene, folder, force, peaks, restart)
    taken = time.perf_counter() - began
    bars = _bars(scene, folder, peaks, comm)
    if comm.rank == 0:
        extra = time.perf_counter() - began - taken
        seconds = {"run": taken, "companions": extra}
        write_bars(folder, bars, seconds)
        print_bars(bars, extra / taken)


def _bars(scene: Scene, folder: Path, peaks: RunPeaks, comm: Any) -> list[ErrorBar]:
    with handling_signals():
        try:
            chain = companions(scene, comm)
        except Interruption as end:
            end.place = LEFT.format(folder)
            raise
    if comm.rank != 0:
        return []
    return bars_of(scene, values_of_run(folder, peaks), chain)


def values_of_run(folder: Path, peaks: RunPeaks) -> RunValues:
    """Of a finished run, with the peaks that were gathered on the way."""
    return run_values(headlines(json.loads((folder / SUMMARY).read_text(encoding="utf-8"))), peaks)


def write_bars(folder: Path, bars: list[ErrorBar], seconds: dict[str, float], **more: Any) -> None:
    """Into the summary of a finished run. more: blocks of the summary beside them."""
    told = {"seconds": seconds, "quantities": [_told(bar) for bar in bars]}
    add_to_summary(folder, {"error_bars": told} | more)


def _told(bar: ErrorBar) -> dict[str, Any]:
    headline = bar.headline
    told: dict[str, Any] = {"stage": headline.stage, "name": headline.name, "unit": headline.unit}
    told |= {"value": headline.value, "bar": bar.bar, "by_source": dict(bar.by_source)}
    return told | ({"reason": bar.reason} if bar.reason else {})
