"""Run of a scene with error bars: the run, its comparison runs, the bars in the summary and on the screen."""

from __future__ import annotations

from itertools import groupby
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from riser_soil.accuracy.chain import bars_of, comparison_runs, run_values
from riser_soil.accuracy.error_bars import SOURCES, ErrorBar, RunValues
from riser_soil.assembly.packages import communicator_of
from riser_soil.core import compiled
from riser_soil.interruption import handling_signals, interrupted
from riser_soil.results.peaks import RunPeaks
from riser_soil.results.summary import add_to_summary
from riser_soil.scene.scene import Scene
from riser_soil.variants.key_results import key_results_in
from riser_soil.whole_run import run

INTERRUPTED = "while its error bars were computed; {} has the whole run, without them"


def run_with_error_bars(scene: Scene, folder: Path | str, force: bool = False, restart: bool = False) -> None:
    """Run a scene, then compute and print error bars of its key results; collective.

    Where a comparison run fails, the run itself stays as it is.
    """
    folder, comm, peaks = Path(folder), communicator_of(scene), RunPeaks()
    began = compiled.seconds_of_work()
    run(scene, folder, force, peaks, restart)
    seconds = compiled.seconds_of_work() - began
    bars = _bars(scene, folder, peaks, comm)
    if comm.rank == 0:
        extra = compiled.seconds_of_work() - began - seconds
        write_bars(folder, bars, {"run": seconds, "comparison_runs": extra})
        print_bars(bars, extra / seconds)


def _bars(scene: Scene, folder: Path, peaks: RunPeaks, comm: Any) -> list[ErrorBar]:
    with interrupted(INTERRUPTED.format(folder)), handling_signals():
        chain = comparison_runs(scene, comm)
    if comm.rank != 0:
        return []
    return bars_of(scene, values_of_run(folder, peaks), chain)


def values_of_run(folder: Path, peaks: RunPeaks) -> RunValues:
    """Values of a finished run. peaks: gathered while it ran."""
    return run_values(key_results_in(folder), peaks)


def write_bars(folder: Path, bars: list[ErrorBar], seconds: dict[str, float], **more: Any) -> None:
    """Add error bars to the summary of a finished run. more: other blocks that are added."""
    error_bars = {"seconds": seconds, "quantities": [_as_entry(bar) for bar in bars]}
    add_to_summary(folder, {"error_bars": error_bars} | more)


def _as_entry(bar: ErrorBar) -> dict[str, Any]:
    key_result = bar.key_result
    entry: dict[str, Any] = {"stage": key_result.stage, "name": key_result.name, "unit": key_result.unit}
    entry |= {"value": key_result.value, "bar": bar.bar, "by_source": dict(bar.by_source)}
    entry |= {"reason": bar.reason} if bar.reason else {}
    return entry | ({"of": key_result.of} if key_result.of else {})


def print_bars(bars: list[ErrorBar], share: float, console: Console | None = None, what: str = "error bars") -> None:
    """Print tables of error bars. share: seconds of `what`, over those of the run."""
    console = console or Console(force_jupyter=False)
    for stage, of_stage in groupby(bars, key=lambda bar: bar.key_result.stage):
        console.print(_table(stage, list(of_stage)))
    for reason in sorted({bar.reason for bar in bars if bar.reason}):
        console.print(f"warning: no error bar where a source is not known: {reason}", soft_wrap=True, markup=False)
    console.print(f"{what} took {share:.0%} of the run's time in addition", markup=False)


def _table(stage: str, bars: list[ErrorBar]) -> Table:
    sources = [source for source in SOURCES.values() if any(source in bar.by_source for bar in bars)]
    table = Table(title=f"{stage}: error bars", title_justify="left", min_width=72)
    for words in ("quantity", "value", "±", *sources):
        table.add_column(words, justify="left" if words == "quantity" else "right")
    for bar in bars:
        shares = (f"{bar.by_source[source]:.2g}" if source in bar.by_source else "-" for source in sources)
        whole = "not known" if bar.bar is None else f"{bar.bar:.2g}"
        key_result = bar.key_result
        table.add_row(f"{key_result.label}, {key_result.unit}", f"{key_result.value:.6g}", whole, *shares)
    return table
