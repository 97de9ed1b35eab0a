"""Commands that take the results of a run: riser-soil stiffness | film."""

import sys
from pathlib import Path
from typing import Annotated

import typer

from riser_soil.commands.arguments import Period, RunFolder, StageName, positive
from riser_soil.commands.endings import expected_errors


def stiffness(
    folder: RunFolder,
    arc: Annotated[list[float], typer.Option("--arc", metavar="METRES", help="arc length; may be repeated")],
    stage: StageName = None,
    period: Period = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE", help="CSV file; by default standard output")
    ] = None,
) -> None:
    """Print the ground's secant stiffness at arc lengths of a run, cycle by cycle, also over su, as CSV."""
    with expected_errors():
        from riser_soil.results.read import Run
        from riser_soil.results.secant_stiffness import secant_stiffness, write_csv
        from riser_soil.results.whole_file import written_whole

        positive("period", period)
        found = secant_stiffness(Run(folder), arc, stage, period)
        if output is None:
            write_csv(found, sys.stdout)
        else:
            with written_whole(output) as part, part.open("w", encoding="utf-8") as file:
                write_csv(found, file)


def film(
    folder: RunFolder,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE", help="a .gif, or .mp4 where ffmpeg is; by default RUN.gif"),
    ] = None,
    stage: StageName = None,
    period: Period = None,
    field: Annotated[
        str | None,
        typer.Option(
            "--field",
            help="what colours the soil: settlement (the default), strength_used, plastic_strain or von_mises_stress",
        ),
    ] = None,
    magnify: Annotated[
        float | None, typer.Option("--magnify", help="factor on the soil's displacement; visible by default")
    ] = None,
) -> None:
    """Film the last cycle of a run's dynamic stage: the riser over the soil, which a field colours."""
    with expected_errors():
        from riser_soil.plots import film as draw

        for name, value in {"period": period, "magnify": magnify}.items():
            positive(name, value)
        file = output or Path(f"{folder.resolve().name}.gif")
        typer.echo(draw(folder, file, stage=stage, period=period, field=field, magnify=magnify))
