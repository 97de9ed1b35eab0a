"""Command about the accuracy of a scene's answers: riser-soil study."""

from pathlib import Path
from typing import Annotated

import typer

from riser_soil.commands.arguments import Overrides, SceneFile
from riser_soil.commands.endings import expected_errors, rank
from riser_soil.commands.scenes import placed, read_solved
from riser_soil.errors import ResultsError


def study(
    scene: SceneFile,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FOLDER", help="folder; else the scene's name and -study"),
    ] = None,
    knob: Annotated[
        list[str] | None,
        typer.Option(
            "--knob",
            metavar="NAME",
            help="vary only this one: elements, time_step, soil_mesh or penalty; may be repeated",
        ),
    ] = None,
    rungs: Annotated[int, typer.Option("--rungs", help="runs of each knob's ladder, 3 to 9")] = 5,
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
        from riser_soil.accuracy.study import LEAST_RUNGS, MOST_RUNGS
        from riser_soil.accuracy.study import study as vary
        from riser_soil.accuracy.study_words import words

        if not LEAST_RUNGS <= rungs <= MOST_RUNGS:
            raise ResultsError(f"--rungs {rungs}: must be from {LEAST_RUNGS} to {MOST_RUNGS}")
        if jobs < 1:
            raise ResultsError(f"--jobs {jobs}: must be 1 or more")
        folder = output or Path(f"{Path(scene).stem}-study")
        with placed(scene, overrides):
            done = vary(checked, folder, knobs=knob or (), rungs=rungs, jobs=jobs, force=force, says=typer.echo)
        typer.echo("\n".join([*words(done), f"tables and plot are in {folder}: study.html, study.csv, study.json"]))
