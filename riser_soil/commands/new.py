"""Command that writes a first scene: riser-soil new."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from riser_soil.commands.arguments import refuse_existing
from riser_soil.commands.endings import expected_errors, rank
from riser_soil.commands.scenes import placed, read
from riser_soil.errors import SceneError

if TYPE_CHECKING:
    from riser_soil.drafts.wishes import Wishes


def new(
    kind: Annotated[
        str | None,
        typer.Argument(
            metavar="[KIND]",
            help="steel-catenary, flexible, lazy-wave, top-tensioned or mooring; without it a terminal is asked",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="SCENE", help="scene file; by default the kind's name with .yaml, here"),
    ] = None,
    depth: Annotated[float | None, typer.Option(metavar="METRES", help="of the water")] = None,
    diameter: Annotated[float | None, typer.Option(metavar="METRES", help="outer; of chain that of its bar")] = None,
    wall: Annotated[float | None, typer.Option(metavar="METRES", help="thickness of the pipe's wall")] = None,
    mass: Annotated[float | None, typer.Option(metavar="KG/M", help="per length, empty, in air")] = None,
    hs: Annotated[float | None, typer.Option(metavar="METRES", help="significant wave height; 0: no waves")] = None,
    tp: Annotated[float | None, typer.Option(metavar="SECONDS", help="peak period; by default 4.3 sqrt(hs)")] = None,
    current: Annotated[
        float, typer.Option(metavar="M/S", help="at the surface, along x; falls to 0 at the seabed")
    ] = 0.0,
    ground: Annotated[
        str | None, typer.Option(metavar="KIND", help="spring (the default), rigid or hysteretic")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="overwrite a scene file, which is refused otherwise")] = False,
) -> None:
    """Write a first scene of a common line, with comments; check it; name the command that runs it."""
    with expected_errors():
        if rank() > 0:
            return
        from riser_soil.drafts.wishes import Wishes

        wishes = Wishes(depth, diameter, wall, mass, hs, tp, current, ground)
        if kind is None:
            kind, wishes = _asked(wishes)
        file = output or Path(f"{kind}.yaml")
        refuse_existing(file, force)
        _write(file, kind, wishes)
        from riser_soil.checks.check import describe

        with placed(str(file), None):
            typer.echo(describe(read(str(file), None)))
        typer.echo(f"{file}: written; next: riser-soil run {file}")


def _write(file: Path, kind: str, wishes: "Wishes") -> None:
    """Write the draft; SceneError where the wishes give no scene."""
    from riser_soil.drafts.draft import checked_draft
    from riser_soil.results.whole_file import written_whole

    text = checked_draft(kind, wishes, f"riser-soil {' '.join(sys.argv[1:])}")
    with written_whole(file) as part:
        part.write_text(text, encoding="utf-8")


def _asked(given: "Wishes") -> "tuple[str, Wishes]":
    """Kind and wishes as a terminal answers; what was given as an option is not asked for."""
    from riser_soil.drafts.questions import ask

    if not sys.stdin.isatty():
        from riser_soil.drafts.kinds import KINDS

        raise SceneError(f"new: the kind is missing; give one of {', '.join(KINDS)}")
    return ask(given, typer.prompt)
