"""Run to an accuracy: mesh, steps, soil and penalty are chosen so that all headline quantities reach it.

A short search comes first, without files (`search`). The run itself is as much finer as its error bars ask for. It is
compared with the trial before: where it is further away than the bars said, they grow; where they miss the accuracy, a
finer run follows.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mpi4py import MPI

from riser_soil.accuracy.barred_run import values_of_run, write_bars
from riser_soil.accuracy.error_bars import SOURCES, ErrorBar
from riser_soil.accuracy.first_setting import first_setting
from riser_soil.accuracy.knobs import knobs_of
from riser_soil.accuracy.needed import expected, largest, needed
from riser_soil.accuracy.screen import print_bars
from riser_soil.accuracy.search import TriedSetting, finer, trial
from riser_soil.errors import AccuracyError, Interruption
from riser_soil.interruption import handling_signals
from riser_soil.results.ownership import refuse_together
from riser_soil.results.peaks import RunPeaks
from riser_soil.run import run
from riser_soil.scene.scene import Scene

RUNS = 3  # at most that are to reach the accuracy
SOUGHT = "while a setting for the accuracy was sought; nothing was written"


def run_to_accuracy(scene: Scene, folder: Path | str, force: bool = False) -> None:
    """As `run`, with a setting that reaches `scene.accuracy`; collective. AccuracyError where none was found: the
    finest run is in the folder then, with its error bars.
    """
    folder, comm, began = Path(folder), MPI.COMM_WORLD, time.perf_counter()
    accuracy = scene.accuracy
    assert accuracy is not None
    refuse_together(folder, force, comm)
    with handling_signals():
        try:
            last = trial(first_setting(scene), accuracy, comm)
        except Interruption as end:
            end.place = SOUGHT
            raise
    for number in range(RUNS):
        _tell(last, accuracy, comm)
        since = time.perf_counter()
        last = _finer_run(last, accuracy, folder, force or number > 0, comm)
        if largest(last.bars)[0] <= accuracy:
            break
    if comm.rank == 0:
        taken = time.perf_counter() - since
        _report(last, accuracy, folder, {"run": taken, "search": since - began})
    if largest(last.bars)[0] > accuracy:
        raise AccuracyError(_missed(last, accuracy, folder))


def _finer_run(last: TriedSetting, accuracy: float, folder: Path, force: bool, comm: Any) -> TriedSetting:
    by_source = needed(last.bars, accuracy)
    names = {source: name for name, source in SOURCES.items()}
    scene, peaks = finer(last.scene, {names[source]: factor for source, factor in by_source.items()}), RunPeaks()
    run(scene, folder, force, peaks)
    if comm.rank != 0:
        return TriedSetting(scene, None, comm.bcast(None))
    assert last.values is not None
    values = values_of_run(folder, peaks)
    return TriedSetting(scene, values, comm.bcast(expected(last.bars, last.values, values, by_source)))


def _tell(last: TriedSetting, accuracy: float, comm: Any) -> None:
    if comm.rank == 0:
        off, key = largest(last.bars)
        print(f"accuracy {accuracy:.2%}: with {_setting(last.scene)} it is {off:.2%} ({key})")


def _setting(scene: Scene) -> str:
    return ", ".join(knob.told(scene) for knob in knobs_of(scene))


def _report(last: TriedSetting, accuracy: float, folder: Path, seconds: Mapping[str, float]) -> None:
    off, key = largest(last.bars)
    told = {"asked": accuracy, "reached": off <= accuracy, "largest_error": off, "of": key}
    settings = {knob.name: knob.told(last.scene) for knob in knobs_of(last.scene)}
    write_bars(folder, last.bars, dict(seconds), accuracy=told | {"settings": settings})
    print_bars(last.bars, seconds["search"] / seconds["run"])


def _missed(last: TriedSetting, accuracy: float, folder: Path) -> str:
    off, key = largest(last.bars)
    bar = next(bar for bar in last.bars if bar.headline.key == key)
    return (
        f"accuracy: {accuracy:.2%} was not reached: with {_setting(last.scene)}, {_limits(bar)} leaves {key} at "
        f"{off:.2%}; {folder} has that run, with its error bars: ask for less"
    )


def _limits(bar: ErrorBar) -> str:
    if bar.bar is None:
        return f"what is not known ({bar.reason})"
    return max(bar.by_source, key=lambda source: bar.by_source[source])
