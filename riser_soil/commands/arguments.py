"""Arguments and options that commands share."""

from pathlib import Path
from typing import Annotated

import typer

from riser_soil.errors import ResultsError, SceneError

SceneFile = Annotated[str, typer.Argument(metavar="SCENE", help="scene file (.yaml)")]
Overrides = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="PATH=VALUE",
        help="override a value of the scene, e.g. riser.segments.0.elements=70; may be repeated; "
        "list items are counted from 0",
    ),
]

RunFolder = Annotated[Path, typer.Argument(metavar="RUN", help="folder of a run's results")]
StageName = Annotated[
    str | None, typer.Option("--stage", metavar="NAME", help="a dynamic stage; by default the last one")
]
Period = Annotated[
    float | None,
    typer.Option("--period", metavar="SECONDS", help="length of a cycle; by default that of the stage's motion"),
]


def positive(name: str, value: float | None) -> None:
    """ResultsError where an option is given and not greater than 0."""
    if value is not None and not value > 0.0:
        raise ResultsError(f"--{name} {value:g}: must be greater than 0")


def refuse_existing(file: Path, force: bool) -> None:
    """SceneError where a command would overwrite a file without being asked to."""
    if file.exists() and not force:
        raise SceneError(f"{file}: is there already; choose another with -o, or overwrite it with --force")
