"""Run to an accuracy: mesh, steps, soil and penalty are chosen so that all key results reach it.

A short search comes first, without files (`search`). The run itself is as much finer as its error bars ask for. What
bars are left is predicted from the trial before, and measured by comparison runs of the run where that is doubtful
(`needed.doubtful`). Where they miss the accuracy, a finer run follows, unless the runs that are left would, too, or it
would take too long. A run that fails is replaced by one that goes half the way to its setting.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from riser_soil.accuracy.barred_run import LEFT, print_bars, values_of_run, write_bars
from riser_soil.accuracy.error_bars import SOURCES, ErrorBar, RunValues
from riser_soil.accuracy.needed import Factors, doubtful, expected, largest, needed, times_as_long, too_dear
from riser_soil.accuracy.search import TriedSetting, first_setting, measured, trial
from riser_soil.assembly.packages import communicator_of
from riser_soil.checks.limits import in_words
from riser_soil.core import compiled
from riser_soil.errors import AccuracyError, Interruption, MeshError, SceneError, SolveError
from riser_soil.interruption import handling_signals
from riser_soil.results.ownership import refuse_together
from riser_soil.results.peaks import RunPeaks
from riser_soil.scene.scene import Scene
from riser_soil.variants.settings import refined, settings_in_words, settings_of
from riser_soil.whole_run import run

RUNS = 4  # at most that are to reach the accuracy
LONGEST = 1800.0  # s of the processor, of a run that follows another: soil's price grows by the cube of its fineness
HALF_WAY = 0.5  # as a power of all factors
CLOSER = 0.7  # of what the run before aimed at, as its bars fell by less than their orders
SOUGHT = "while a setting for the accuracy was sought; nothing was written"


def run_to_accuracy(scene: Scene, folder: Path | str, force: bool = False) -> None:
    """Run a scene with a setting that reaches `scene.accuracy`; collective. AccuracyError where none was found: the
    finest run is in the folder then, with its error bars.
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
    with handling_signals():
        try:
            return trial(first_setting(scene), accuracy, comm)
        except Interruption as end:
            end.place = SOUGHT
            raise


def _run_until(accuracy: float, last: TriedSetting, folder: Path, force: bool, comm: Any) -> tuple[TriedSetting, str]:
    """The last run, and why there is no finer one where it can't be run."""
    for number in range(RUNS):
        _tell(last, accuracy, comm)
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
        if times := too_dear(last.bars, accuracy, RUNS - 1 - number):
            duration = in_words(times * last.seconds)
            return last, f"; to reach it would take at least {times:.0f} times as long, {duration}"
    return last, f"; after {RUNS} runs"


def _next_factors(last: TriedSetting, accuracy: float, number: int) -> tuple[Factors, float]:
    """How many times as fine the run of a number is, by source, and what it takes [s]: as much closer to what is asked
    as there is time for.
    """
    for closer in range(number, -1, -1):
        factors = needed(last.bars, CLOSER**closer * accuracy)
        seconds = last.seconds * times_as_long(factors)
        if seconds <= LONGEST:
            break
    return factors, seconds


def _next_run(
    last: TriedSetting, factors: Factors, accuracy: float, folder: Path, force: bool, comm: Any
) -> TriedSetting:
    """That which is so many times as fine by source; where it fails, one half the way to it."""
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
    """The scene of the last, so many times as fine by source."""
    names = {source: name for name, source in SOURCES.items()}
    scene = refined(last.scene, {names[source]: factor for source, factor in factors.items()})
    peaks, since = RunPeaks(), compiled.seconds_of_work()
    run(scene, folder, force, peaks)
    taken = compiled.seconds_of_work() - since
    values = values_of_run(folder, peaks) if comm.rank == 0 else None
    bars = comm.bcast(_predicted_bars(last, values, factors, accuracy))
    if bars is None:
        bars = _measured(scene, values, folder, comm)
    return TriedSetting(scene, values, bars, taken)


def _predicted_bars(
    last: TriedSetting, values: RunValues | None, factors: Factors, accuracy: float
) -> list[ErrorBar] | None:
    """The run's bars, from those of the one before; None where that is doubtful, and on other ranks. Finer cells of
    soil are: in them contact grows cell by cell.
    """
    if values is None or factors.get("soil", 1.0) > 1.0:
        return None
    assert last.values is not None
    left = expected(last.bars, last.values, values, factors)
    return None if doubtful(last.bars, last.values, values, left, accuracy) else left


def _measured(scene: Scene, values: RunValues | None, folder: Path, comm: Any) -> list[ErrorBar]:
    with handling_signals():
        try:
            return measured(scene, values, comm)
        except Interruption as end:
            end.place = LEFT.format(folder)
            raise


def _tell(last: TriedSetting, accuracy: float, comm: Any) -> None:
    if comm.rank == 0:
        off, key = largest(last.bars)
        print(f"accuracy {accuracy:.2%}: with {settings_in_words(last.scene)} it is {off:.2%} ({key})")


def _report(last: TriedSetting, accuracy: float, folder: Path, seconds: float) -> None:
    """seconds: of everything."""
    off, key = largest(last.bars)
    outcome = {"asked": accuracy, "reached": off <= accuracy, "largest_error": off, "of": key}
    settings = {setting.name: setting.in_words(last.scene) for setting in settings_of(last.scene)}
    taken = {"run": last.seconds, "search": seconds - last.seconds}
    write_bars(folder, last.bars, taken, accuracy=outcome | {"settings": settings})
    print_bars(last.bars, taken["search"] / taken["run"], what="the search for the accuracy")


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
