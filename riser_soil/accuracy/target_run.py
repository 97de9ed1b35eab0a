"""Run to an accuracy: mesh, steps, soil and penalty are chosen so that all key results reach it.

A short search comes first, without files (`search`). The run itself is as much finer as the trial's error bars require.
Its own bars are predicted from the trial's, or measured by comparison runs where the prediction is unreliable
(`required_fineness.unreliable`). If they exceed the accuracy, a finer run follows, unless further runs would exceed it,
too, or take too long. A run that fails is replaced by one half the way to its setting.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from riser_soil.accuracy.barred_run import INTERRUPTED, print_bars, values_of_run, write_bars
from riser_soil.accuracy.error_bars import SOURCES, ErrorBar, RunValues
from riser_soil.accuracy.required_fineness import (
    Factors,
    cost_ratio,
    largest,
    out_of_reach,
    predicted_bars,
    required,
    unreliable,
)
from riser_soil.accuracy.search import TriedSetting, first_setting, measured, trial
from riser_soil.assembly.packages import communicator_of
from riser_soil.checks.limits import in_words
from riser_soil.core import compiled
from riser_soil.errors import AccuracyError, MeshError, SceneError, SolveError
from riser_soil.interruption import handling_signals, interrupted
from riser_soil.results.ownership import refuse_together
from riser_soil.results.peaks import RunPeaks
from riser_soil.scene.scene import Scene
from riser_soil.variants.settings import refined, settings_in_words, settings_of
from riser_soil.whole_run import run

RUNS = 4  # largest number of runs
LONGEST = 1800.0  # processor time of a run after the first [s]: the soil's cost grows by the cube of its fineness
HALF_WAY = 0.5  # exponent of all factors
CLOSER = 0.7  # aim over that of the run before, as its bars fell by less than their orders predict
SOUGHT = "while a setting for the accuracy was sought; nothing was written"


def run_to_accuracy(scene: Scene, folder: Path | str, force: bool = False) -> None:
    """Run a scene with a setting that reaches `scene.accuracy`; collective.

    AccuracyError where none was found: the folder has the finest run then, with its error bars.
    """
    folder, comm, began = Path(folder), communicator_of(scene), compiled.seconds_of_work()
    accuracy = scene.accuracy
    assert accuracy is not None
    refuse_together(folder, force, comm)
    last, limit = _run_until(accuracy, _sought(scene, accuracy, comm), folder, force, comm)
    if comm.rank == 0:
        _report(last, accuracy, folder, compiled.seconds_of_work() - began)
    if largest(last.bars)[0] > accuracy:
        raise AccuracyError(_missed(last, accuracy, folder, limit))


def _sought(scene: Scene, accuracy: float, comm: Any) -> TriedSetting:
    with interrupted(SOUGHT), handling_signals():
        return trial(first_setting(scene), accuracy, comm)


def _run_until(accuracy: float, last: TriedSetting, folder: Path, force: bool, comm: Any) -> tuple[TriedSetting, str]:
    """The last run, and in words why no finer one follows."""
    for number in range(RUNS):
        _print_largest(last, accuracy, comm)
        try:
            factors, seconds = comm.bcast(_next_factors(last, accuracy, number))
            if seconds > LONGEST:
                return last, f"; a finer run would take some {in_words(seconds)}, more than {in_words(LONGEST)}"
            last = _next_run(last, factors, accuracy, folder, force or number > 0, comm)
        except (SceneError, MeshError) as err:
            if number == 0:
                raise
            return last, f"; a finer one can't be run: {err}"
        if largest(last.bars)[0] <= accuracy or number == RUNS - 1:
            break
        if times := out_of_reach(last.bars, accuracy, RUNS - 1 - number):
            duration = in_words(times * last.seconds)
            return last, f"; to reach it would take at least {times:.0f} times as long, {duration}"
    return last, f"; after {RUNS} runs"


def _next_factors(last: TriedSetting, accuracy: float, number: int) -> tuple[Factors, float]:
    """Ratios of fineness of the run of a number by source, and its processor time [s].

    Each run aims closer than the one before, as far as there is time for.
    """
    for closer in range(number, -1, -1):
        factors = required(last.bars, CLOSER**closer * accuracy)
        seconds = last.seconds * cost_ratio(factors)
        if seconds <= LONGEST:
            break
    return factors, seconds


def _next_run(
    last: TriedSetting, factors: Factors, accuracy: float, folder: Path, force: bool, comm: Any
) -> TriedSetting:
    """A run that is finer by factors; where it fails, one half the way to it."""
    try:
        return _finer_run(last, factors, accuracy, folder, force, comm)
    except SolveError as err:
        if comm.rank == 0:
            reason = str(err).partition("\n")[0]
            print(f"a finer run fails: {reason}; one follows that goes half the way to its setting")
    nearer = {source: factor**HALF_WAY for source, factor in factors.items()}
    return _finer_run(last, nearer, accuracy, folder, True, comm)


def _finer_run(
    last: TriedSetting, factors: Factors, accuracy: float, folder: Path, force: bool, comm: Any
) -> TriedSetting:
    """A run of the last scene, finer by factors."""
    names = {source: name for name, source in SOURCES.items()}
    scene = refined(last.scene, {names[source]: factor for source, factor in factors.items()})
    peaks, since = RunPeaks(), compiled.seconds_of_work()
    run(scene, folder, force, peaks)
    seconds = compiled.seconds_of_work() - since
    values = values_of_run(folder, peaks) if comm.rank == 0 else None
    bars = comm.bcast(_predicted_bars(last, values, factors, accuracy))
    if bars is None:
        bars = _measured(scene, values, folder, comm)
    return TriedSetting(scene, values, bars, seconds)


def _predicted_bars(
    last: TriedSetting, values: RunValues | None, factors: Factors, accuracy: float
) -> list[ErrorBar] | None:
    """Error bars of a run by those of the run before, on rank 0; None where they are unreliable.

    They always are with finer cells of soil, as contact grows cell by cell.
    """
    if values is None or factors.get("soil", 1.0) > 1.0:
        return None
    assert last.values is not None
    bars = predicted_bars(last.bars, last.values, values, factors)
    return None if unreliable(last.bars, last.values, values, bars, accuracy) else bars


def _measured(scene: Scene, values: RunValues | None, folder: Path, comm: Any) -> list[ErrorBar]:
    with interrupted(INTERRUPTED.format(folder)), handling_signals():
        return measured(scene, values, comm)


def _print_largest(last: TriedSetting, accuracy: float, comm: Any) -> None:
    if comm.rank == 0:
        off, key = largest(last.bars)
        print(f"accuracy {accuracy:.2%}: with {settings_in_words(last.scene)} it is {off:.2%} ({key})")


def _report(last: TriedSetting, accuracy: float, folder: Path, seconds: float) -> None:
    """Write and print the error bars. seconds: processor time of run and search [s]."""
    off, key = largest(last.bars)
    outcome = {"asked": accuracy, "reached": off <= accuracy, "largest_error": off, "of": key}
    settings = {setting.name: setting.in_words(last.scene) for setting in settings_of(last.scene)}
    spent = {"run": last.seconds, "search": seconds - last.seconds}
    write_bars(folder, last.bars, spent, accuracy=outcome | {"settings": settings})
    print_bars(last.bars, spent["search"] / spent["run"], what="the search for the accuracy")


def _missed(last: TriedSetting, accuracy: float, folder: Path, limit: str) -> str:
    off, key = largest(last.bars)
    bar = next(bar for bar in last.bars if bar.key_result.key == key)
    return (
        f"accuracy: {accuracy:.2%} was not reached: with {settings_in_words(last.scene)}, {_limits(bar)} leaves {key} "
        "at "
        f"{off:.2%}{limit}; {folder} has that run, with its error bars: ask for less"
    )


def _limits(bar: ErrorBar) -> str:
    if bar.bar is None:
        return f"what is not known ({bar.reason})"
    return max(bar.by_source, key=lambda source: bar.by_source[source])
