"""Command about fatigue of the pipe's wall: riser-soil fatigue."""

from pathlib import Path
from typing import Annotated

import typer

from riser_soil.commands.endings import expected_errors, rank


def fatigue(
    file: Annotated[
        Path,
        typer.Argument(metavar="FATIGUE", help="fatigue file (.yaml): S-N curve, runs with their shares of the year"),
    ],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FOLDER", help="folder; else the fatigue file's name and -damage"),
    ] = None,
    plot: Annotated[bool, typer.Option("--plot", help="draw damage along the pipe and in the touchdown zone")] = False,
    force: Annotated[bool, typer.Option("--force", help="overwrite an assessment, which is refused otherwise")] = False,
) -> None:
    """Damage in a year and life of a pipe's wall, by rainflow cycles of runs, an S-N curve and Miner's sum."""
    with expected_errors():
        if rank() > 0:
            return
        from riser_soil.fatigue.assessment import assess
        from riser_soil.fatigue.fatigue_file import read_fatigue_file
        from riser_soil.fatigue.report import refuse_folder, result_lines, write_folder

        folder = output or Path(f"{file.stem}-damage")
        given = read_fatigue_file(file)
        refuse_folder(folder, force)
        found = assess(file, given)
        write_folder(folder, found, plot)
        typer.echo("\n".join([*result_lines(found), f"tables are in {folder}"]))
