"""Screen output of error bars: a table for each stage."""

from __future__ import annotations

from itertools import groupby

from rich.console import Console
from rich.table import Table

from riser_soil.accuracy.error_bars import SOURCES, ErrorBar


def print_bars(
    bars: list[ErrorBar], share: float, console: Console | None = None, what: str = "error bars"
) -> None:
    """share: of the run's seconds that companions, or `what` else, took in addition."""
    console = console or Console(force_jupyter=False)
    for stage, of_stage in groupby(bars, key=lambda bar: bar.headline.stage):
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
        headline = bar.headline
        table.add_row(f"{headline.name}, {headline.unit}", f"{headline.value:.6g}", whole, *shares)
    return table
