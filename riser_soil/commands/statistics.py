"""Commands about outputs in time: riser-soil statistics | histories."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from riser_soil.commands.exit_status import expected_errors, rank
from riser_soil.commands.scenes import RunFolder, StageName, positive
from riser_soil.errors import ResultsError

if TYPE_CHECKING:
    from riser_soil.results.read import Run
    from riser_soil.statistics.report import Place


Of = Annotated[
    list[str], typer.Option("--of", metavar="OUTPUT", help="e.g. effective_tension, end_force.x; may be repeated")
]
Arcs = Annotated[
    list[float] | None,
    typer.Option("--arc", metavar="METRES", help="arc length; may be repeated; by default all nodes"),
]
At = Annotated[
    list[str] | None, typer.Option("--at", metavar="END", help="start or end of the riser; may be repeated")
]
Since = Annotated[
    float, typer.Option("--since", metavar="SECONDS", help="of the stage that are cut off, its transient")
]


def statistics(
    folders: Annotated[list[Path], typer.Argument(metavar="RUN...", help="folders of runs, one for each seed")],
    of: Of,
    arc: Arcs = None,
    at: At = None,
    stage: StageName = None,
    since: Since = 0.0,
    duration: Annotated[
        float, typer.Option("--duration", metavar="SECONDS", help="duration that the extremes are for")
    ] = 10800.0,
    block: Annotated[
        float | None,
        typer.Option(
            "--block",
            metavar="SECONDS",
            help="blocks whose extremes Gumbel's fit takes; by default the shortest run",
        ),
    ] = None,
    minima: Annotated[bool, typer.Option("--minima", help="smallest values in the place of largest ones")] = False,
    above: Annotated[
        list[float] | None,
        typer.Option("--above", metavar="LEVEL", help="how often a level is passed; may be repeated"),
    ] = None,
    confidence: Annotated[float, typer.Option("--confidence", help="of the fits' intervals")] = 0.95,
    segment: Annotated[
        float | None,
        typer.Option(
            "--segment", metavar="SECONDS", help="pieces that spectra are averaged over; by default an eighth of a run"
        ),
    ] = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE", help="table as .csv, or with spectra as .json")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option("--plot", metavar="FILE", help="picture of spectra and extremes, .png")
    ] = None,
) -> None:
    """Statistics of outputs in time: deviation, period, spectra, most probable extremes by three distributions."""
    with expected_errors():
        if rank() > 0:
            return
        from riser_soil.results.read import Run
        from riser_soil.statistics.analysis import Wanted, statistics_of
        from riser_soil.statistics.records import records_of
        from riser_soil.statistics.report import Place, exceedance_table, refuse_ending, table, write

        for name, value in {"duration": duration, "block": block, "segment": segment}.items():
            positive(name, value)
        if not 0.0 < confidence < 1.0:
            raise ResultsError(f"--confidence {confidence:g}: must lie between 0 and 1")
        refuse_ending(output)
        runs, wanted = [Run(folder) for folder in folders], Wanted(duration, block, minima, confidence, segment)
        arcs = _arcs(runs, arc or [], at or [])
        places = [
            Place(records, float(where), result)
            for records in (records_of(runs, name, arcs, stage, since) for name in of)
            for where, result in zip(records.arc, statistics_of(records, wanted), strict=True)
        ]
        levels = above or []
        lines = [*table(places, wanted), *exceedance_table(places, levels, wanted)]
        if plot is not None:  # first: it refuses what it can't draw
            _draw(plot, places)
        if output is not None:
            write(output, places, levels, wanted)
        typer.echo("\n".join(lines))


def histories(
    folder: RunFolder,
    of: Of,
    arc: Arcs = None,
    at: At = None,
    stage: StageName = None,
    since: Since = 0.0,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE", help="CSV file; by default standard output")
    ] = None,
) -> None:
    """Print outputs of a run in time as CSV, time in the first column, as qats and pandas read it."""
    with expected_errors():
        if rank() > 0:
            return
        from riser_soil.results.read import Run
        from riser_soil.results.whole_file import written_whole
        from riser_soil.statistics.history_file import write_histories
        from riser_soil.statistics.records import records_of

        run = Run(folder)
        records = [records_of([run], name, _arcs([run], arc or [], at or []), stage, since) for name in of]
        if output is None:
            write_histories(records, sys.stdout)
        else:
            with written_whole(output) as part, part.open("w", encoding="utf-8") as file:
                write_histories(records, file)


def _arcs(runs: "list[Run]", arc: list[float], at: list[str]) -> list[float] | None:
    """Arc lengths asked for, None for all nodes."""
    ends = {"start": 0, "end": -1}
    wrong = [name for name in at if name not in ends]
    if wrong:
        raise ResultsError(f"--at {wrong[0]}: must be start or end; other places are given by --arc")
    arcs = [*arc, *(float(runs[0].arc[ends[name]]) for name in at)]
    return arcs or None


def _draw(png: Path, places: "list[Place]") -> None:
    from riser_soil.plots.extreme_values import MOST, draw_statistics
    from riser_soil.results.whole_file import written_whole

    if png.suffix != ".png":
        raise ResultsError(f"{png}: a picture is a .png file; change its ending")
    if len(places) > MOST:
        raise ResultsError(f"--plot {png}: {len(places)} places are more than {MOST} that a picture takes; give --arc")
    with written_whole(png) as part:
        draw_statistics(part, [(place.words, place.records.units, place.statistics) for place in places])
