"""Command about many runs of one scene: riser-soil cases."""

from pathlib import Path
from typing import Annotated

import typer

from riser_soil.commands.arguments import Overrides, positive
from riser_soil.commands.endings import expected_errors, rank
from riser_soil.errors import ResultsError, SolveError

_NAMED = 5


def cases(
    file: Annotated[Path, typer.Argument(metavar="CASES", help="case file (.yaml): base scene, table or product")],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FOLDER", help="folder; else the case file's name without its ending"),
    ] = None,
    jobs: Annotated[
        int | None, typer.Option("--jobs", help="worker processes on this machine; by default one for each core")
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option("--scheduler", metavar="ADDRESS", help="of a Dask scheduler, tcp://…, whose workers compute"),
    ] = None,
    limit: Annotated[
        float | None, typer.Option("--limit", metavar="SECONDS", help="time that one case may take; else any")
    ] = None,
    overrides: Overrides = None,
) -> None:
    """Run load cases on many cores or machines: a folder for each, a table and a plot of all; call again to go on."""
    with expected_errors():
        if rank() > 0:
            return
        positive("limit", limit)
        if jobs is not None and (jobs < 1 or scheduler is not None):
            raise ResultsError(f"--jobs {jobs}: must be 1 or more, and does not go with --scheduler")
        from riser_soil.cases.pool import cores
        from riser_soil.cases.sweep import Workers, run_cases

        folder = output or Path(file.stem)
        workers = Workers(jobs or cores(), scheduler, limit)
        table = run_cases(file, folder, workers, overrides or (), typer.echo)
        typer.echo(f"{len(table.cases) - len(table.failed)} of {len(table.cases)} cases done; tables are in {folder}")
        if failed := table.failed:
            names = ", ".join(outcome.name for outcome in failed[:_NAMED])
            more = f" and {len(failed) - _NAMED} more" if len(failed) > _NAMED else ""
            raise SolveError(f"failed: {names}{more}; reasons are in {folder / 'cases.csv'}")
