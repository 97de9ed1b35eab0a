"""The command about vibrations: riser-soil modes."""

from pathlib import Path
from typing import Annotated

import typer

from riser_soil.commands.arguments import Overrides, SceneFile
from riser_soil.commands.endings import expected_errors, rank, size
from riser_soil.commands.scenes import placed, read_solved
from riser_soil.errors import SceneError


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
        from riser_soil.interruption import handling_signals
        from riser_soil.modes.modes import modes_of
        from riser_soil.modes.report import refuse_folder, table, write_folder

        folder = output or Path(f"{Path(scene).stem}-modes")
        refuse_folder(folder, force)
        with handling_signals(), placed(scene, overrides):
            found = modes_of(checked, count, stage)
            write_folder(folder, found, plot)
        if rank() == 0:
            typer.echo("\n".join([*table(found, count), f"shapes are in {folder}"]))
