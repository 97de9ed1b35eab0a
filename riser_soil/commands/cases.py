"""Commands about many runs: riser-soil cases | study | compile."""

from pathlib import Path
from typing import Annotated

import typer

from riser_soil.commands.exit_status import expected_errors
from riser_soil.commands.scenes import Overrides, SceneFile, at_least_one, placed, positive, read_solved, read_start
from riser_soil.core.environment import cores, rank
from riser_soil.errors import ResultsError, SolveError

_NAMED = 5


def cases(
    file: Annotated[
        Path, typer.Argument(metavar="CASES", help="case file (.yaml): base scene, and in what the cases differ")
    ],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FOLDER", help="folder; else the case file's name without its ending"),
    ] = None,
    jobs: Annotated[
        int | None, typer.Option("--jobs", help="cases at a time on this machine; by default one for each core")
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
    """Run load cases on many cores or machines: a folder for each, tables and extremes of all; call again to go on."""
    with expected_errors(extra="cases"):
        if rank() > 0:
            return
        positive("limit", limit)
        if jobs is not None and (jobs < 1 or scheduler is not None):
            raise ResultsError(f"--jobs {jobs}: must be 1 or more, and does not go with --scheduler")
        from rich.console import Console

        from riser_soil.cases.characteristic import governing_table, warnings_of
        from riser_soil.cases.sweep import run_cases
        from riser_soil.variants.pool import Workers

        folder = output or Path(file.stem)
        workers = Workers(jobs or cores(), scheduler)
        table, extremes = run_cases(file, folder, workers, overrides or (), limit, typer.echo)
        if extremes:
            Console(force_jupyter=False).print(governing_table(extremes))
        for warning in warnings_of(extremes, table.cases):
            typer.echo(warning)
        typer.echo(f"{len(table.cases) - len(table.failed)} of {len(table.cases)} cases done; tables are in {folder}")
        if failed := table.failed:
            names = ", ".join(outcome.name for outcome in failed[:_NAMED])
            more = f" and {len(failed) - _NAMED} more" if len(failed) > _NAMED else ""
            raise SolveError(f"failed: {names}{more}; reasons are in {folder / 'cases.csv'}")


def compile_(
    scenes: Annotated[
        list[str] | None, typer.Argument(metavar="SCENE...", help="scene files; by default the drafts of `new`")
    ] = None,
    jobs: Annotated[int | None, typer.Option("--jobs", help="scenes at a time; by default one for each core")] = None,
) -> None:
    """Compile what scenes are computed with, by a few steps of each, so that their first runs start at once."""
    with expected_errors():
        if rank() > 0:
            return
        at_least_one("jobs", jobs)
        from rich.console import Console
        from rich.progress import Progress

        from riser_soil.drafts.every_kind import drafted
        from riser_soil.variants.short_runs import compile_kernels

        asked = {file: read_start(file, None) for file in scenes or ()} or drafted()
        failed = []
        with Progress(console=Console(stderr=True, force_jupyter=False), transient=True) as progress:
            bar = progress.add_task("compiling kernels", total=len(asked))
            for outcome in compile_kernels(asked, jobs or cores()):
                progress.advance(bar)
                failed += [] if outcome.done else [f"{outcome.name}: {outcome.reason}"]
        if failed:
            raise SolveError("\n".join(failed))
        typer.echo(f"compiled what {len(asked)} scene{'s are' if len(asked) > 1 else ' is'} computed with")


def study(
    scene: SceneFile,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FOLDER", help="folder; else the scene's name and -study"),
    ] = None,
    setting: Annotated[
        list[str] | None,
        typer.Option(
            "--setting",
            "--knob",  # its former name
            metavar="NAME",
            help="vary only this one: elements, time_step, soil_mesh or penalty; may be repeated",
        ),
    ] = None,
    levels: Annotated[int, typer.Option("--levels", "--rungs", help="runs of each setting, 3 to 9")] = 5,
    jobs: Annotated[
        int, typer.Option("--jobs", help="processes at a time for the finest runs; the others are timed one at a time")
    ] = 1,
    force: Annotated[bool, typer.Option("--force", help="begin anew; else what was computed is kept")] = False,
    overrides: Overrides = None,
) -> None:
    """Vary elements, time step, soil mesh and penalty: the error of the answers against what they cost."""
    with expected_errors():
        checked = read_solved(scene, overrides)
        if rank() > 0:
            return
        from riser_soil.accuracy.study import LEAST_LEVELS, MOST_LEVELS
        from riser_soil.accuracy.study import study as vary
        from riser_soil.accuracy.study_page import words

        if not LEAST_LEVELS <= levels <= MOST_LEVELS:
            raise ResultsError(f"--levels {levels}: must be from {LEAST_LEVELS} to {MOST_LEVELS}")
        at_least_one("jobs", jobs)
        folder = output or Path(f"{Path(scene).stem}-study")
        with placed(scene, overrides):
            done = vary(checked, folder, settings=setting or (), levels=levels, jobs=jobs, force=force, echo=typer.echo)
        typer.echo("\n".join([*words(done), f"tables and plot are in {folder}: study.html, study.csv, study.json"]))
