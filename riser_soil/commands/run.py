"""Commands that take a scene as a whole: riser-soil run | check | schema | modes."""

from pathlib import Path
from typing import Annotated

import typer

from riser_soil.commands.exit_status import expected_errors
from riser_soil.commands.scenes import (
    Overrides,
    SceneFile,
    guessed,
    placed,
    read,
    read_solved,
    read_start,
    result_folder,
)
from riser_soil.core.environment import rank, size
from riser_soil.errors import SceneError
from riser_soil.interruption import handling_signals


def run(
    scene: SceneFile,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FOLDER",
            help="result folder; else output.directory of the scene, else the scene file's name without "
            "its ending, in the current folder",
        ),
    ] = None,
    restart: Annotated[
        bool, typer.Option("--restart", help="go on from the folder's last checkpoint; begin where there is none")
    ] = False,
    force: Annotated[
        bool, typer.Option("--force", help="overwrite a run that is finished or can go on, which is refused otherwise")
    ] = False,
    error_bars: Annotated[
        bool,
        typer.Option(
            "--error-bars", help="estimate by coarser runs how far its key results may be off"
        ),
    ] = False,
    overrides: Overrides = None,
) -> None:
    """Compute a scene and leave its results in a folder."""
    with expected_errors():
        checked = read(scene, overrides)
        folder = result_folder(scene, checked, output, force, restart)
        from riser_soil.accuracy.chosen_run import run_as_asked

        with placed(scene, overrides):
            run_as_asked(checked, folder, force, error_bars, restart)


def check(scene: SceneFile, overrides: Overrides = None) -> None:
    """Check a scene: tensions and touchdown by hand, warnings, cost, what the model has; solve nothing."""
    with expected_errors():
        checked = read_start(scene, overrides)
        from riser_soil.checks.check import describe

        with placed(scene, overrides):
            text = describe(guessed(checked))
        if rank() == 0:
            typer.echo(text)


def schema() -> None:
    """Print the JSON schema of scene files: every key with its meaning, unit and default; editors use it."""
    from riser_soil.scene.dump import schema_text

    typer.echo(schema_text())


def modes(
    scene: SceneFile,
    count: Annotated[int, typer.Option("--count", metavar="N", help="how many, the lowest first")] = 10,
    stage: Annotated[
        str | None,
        typer.Option("--stage", metavar="NAME", help="static stage to take; by default the last before a dynamic one"),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FOLDER", help="result folder; else the scene's name and -modes"),
    ] = None,
    plot: Annotated[bool, typer.Option("--plot", help="draw the shapes, too: modes.png")] = False,
    force: Annotated[bool, typer.Option("--force", help="replace the files of an earlier call")] = False,
    overrides: Overrides = None,
) -> None:
    """Natural frequencies and mode shapes of a scene's riser at rest in its water, on its seabed or soil."""
    with expected_errors():
        if size() > 1:
            raise SceneError("riser-soil modes: works on one rank; leave out mpirun")
        if count < 1:
            raise SceneError(f"--count {count}: must be at least 1")
        checked = read_solved(scene, overrides)
        from riser_soil.assembly.packages import FOR_SNES, require

        require("modes", FOR_SNES)
        from riser_soil.modes.modes import modes_of
        from riser_soil.modes.report import refuse_folder, table, write_folder

        folder = output or Path(f"{Path(scene).stem}-modes")
        refuse_folder(folder, force)
        with handling_signals(), placed(scene, overrides):
            shapes = modes_of(checked, count, stage)
            write_folder(folder, shapes, plot)
        if rank() == 0:
            typer.echo("\n".join([*table(shapes, count), f"shapes are in {folder}"]))
