"""Commands that take a scene as a whole: riser-soil run | check | schema."""

from pathlib import Path
from typing import Annotated

import typer

from riser_soil.commands.arguments import Overrides, SceneFile
from riser_soil.commands.endings import expected_errors, rank
from riser_soil.commands.scenes import guessed, placed, read, read_begun, result_folder


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
            "--error-bars", help="estimate by coarser companions how far its headline quantities may be off"
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
    """Check a scene: tell what would be built, what is left out and why, what looks doubtful; solve nothing."""
    with expected_errors():
        checked = guessed(read_begun(scene, overrides), scene, overrides)
        from riser_soil.checks.check import describe

        with placed(scene, overrides):
            text = describe(checked)
        if rank() == 0:
            typer.echo(text)


def schema() -> None:
    """Print the JSON schema of scene files: every key with its meaning, unit and default; editors use it."""
    from riser_soil.scene.schema import schema_text

    typer.echo(schema_text())
