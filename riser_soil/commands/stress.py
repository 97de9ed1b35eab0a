"""Command about how a scene bears extremes: riser-soil stress."""

from pathlib import Path
from typing import Annotated

import typer

from riser_soil.commands.arguments import Overrides, SceneFile
from riser_soil.commands.endings import expected_errors, rank
from riser_soil.commands.scenes import placed, read_solved
from riser_soil.errors import ResultsError, SolveError


def stress(
    scene: SceneFile,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FOLDER", help="folder; else the scene's name and -stress"),
    ] = None,
    limit: Annotated[
        int, typer.Option("--limit", metavar="SECONDS", help="processor time that each run may take")
    ] = 120,
    jobs: Annotated[int, typer.Option("--jobs", help="runs at a time, each a process")] = 1,
    overrides: Overrides = None,
) -> None:
    """Run a scene's extremes: stiffnesses, penalty, steps, meshes, motions; tell which end quietly wrong."""
    with expected_errors():
        checked = read_solved(scene, overrides)
        if rank() > 0:
            return
        for name, value in (("limit", limit), ("jobs", jobs)):
            if value < 1:
                raise ResultsError(f"--{name} {value}: must be 1 or more")
        from riser_soil.stress.around import stress as around
        from riser_soil.stress.limited_process import Limits

        folder = output or Path(f"{Path(scene).stem}-stress")
        with placed(scene, overrides):
            rows = around(checked, folder, Limits(cpu=limit), jobs, f"riser-soil stress {scene}", typer.echo)
        bad = [row.name for row in rows if not row.as_hoped]
        typer.echo(f"{len(rows)} runs, {len(bad)} quietly wrong, broken or out of time; tables are in {folder}")
        if bad:
            raise SolveError(f"not borne: {'; '.join(bad)}")
