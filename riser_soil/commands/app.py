"""The application: its commands in the order of its help, its own options."""

from typing import Annotated

import typer

from riser_soil import __version__
from riser_soil.commands.cases import cases, compile_, study
from riser_soil.commands.ground import calibrate, material
from riser_soil.commands.imports import export, import_, new
from riser_soil.commands.logging import logged
from riser_soil.commands.results import fatigue, film, plot, report, stiffness
from riser_soil.commands.run import check, modes, run, schema
from riser_soil.commands.statistics import histories, statistics

PRINTING = (schema, statistics, histories, stiffness)  # commands whose output is their result
app = typer.Typer(
    help="Static and dynamic analysis of a riser on the seabed.",
    epilog="Exit status: 0 done, 2 bad input, 3 the solve failed, 4 the disk or standard output took no more, "
    "130 Ctrl-C, 143 SIGTERM (what was computed until then is kept).",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)
OF_SCENES = (new, run, check, import_, export, cases, study, compile_, modes, material, calibrate, schema)
OF_RUNS = (statistics, histories, stiffness, fatigue, film, plot, report)
for command in (*OF_SCENES, *OF_RUNS):
    app.command(command.__name__.rstrip("_"))(command if command in PRINTING else logged(command))


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"riser-soil {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="print the version")
    ] = False,
) -> None:
    """Static and dynamic analysis of a riser on the seabed."""
