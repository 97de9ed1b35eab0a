"""Commands that show the results of runs: riser-soil plot | report."""

from pathlib import Path
from typing import Annotated

import typer

from riser_soil.commands.arguments import RunFolder
from riser_soil.commands.endings import expected_errors
from riser_soil.errors import ResultsError

AnyStage = Annotated[
    str | None, typer.Option("--stage", metavar="NAME", help="a stage; by default the last dynamic one, else the last")
]


def plot(
    folder: RunFolder,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FOLDER", help="folder of the pictures; by default RUN/plots"),
    ] = None,
    what: Annotated[
        list[str] | None,
        typer.Option(
            "--what",
            metavar="NAME,…",
            help="ranges, histories, shape, soil, energy, solver, touchdown, film, or a picture by the name of its "
            "file; may be repeated; by default all that the run has",
        ),
    ] = None,
    ending: Annotated[str, typer.Option("--format", metavar="png|svg|pdf", help="format of the curves")] = "png",
    stage: AnyStage = None,
) -> None:
    """Draw a run: ranges along the riser, histories, shapes through a cycle, soil, energy, touchdown zone, film."""
    with expected_errors():
        from riser_soil.plots.album import FORMATS, album
        from riser_soil.results.read import Run

        if ending not in FORMATS:
            raise ResultsError(f'--format "{ending}": must be one of {", ".join(FORMATS)}')
        wanted = [name for group in what or () for name in group.split(",") if name]
        for file, words in album(Run(folder), output or folder / "plots", wanted, ending, stage):
            typer.echo(f"{file}: {words}" if file else words)


def report(
    folders: Annotated[
        list[Path], typer.Argument(metavar="RUN…", help="folders of runs; several are put side by side")
    ],
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="FILE", help="the page; by default report.html")
    ] = Path("report.html"),
    stage: Annotated[
        str | None, typer.Option("--stage", metavar="NAME", help="the stage that is drawn; by default all dynamic ones")
    ] = None,
) -> None:
    """Report runs on one HTML page: scene, warnings, extremes, pictures, energy, solver, how to reproduce them."""
    with expected_errors():
        from riser_soil.report.report import write_report

        if output.suffix not in (".html", ".htm"):
            raise ResultsError(f"{output}: a report is an .html file; change its ending")
        typer.echo(write_report(folders, output, stage))
