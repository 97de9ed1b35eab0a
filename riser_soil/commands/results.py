"""Commands that take the results of runs: riser-soil plot | report | stiffness | film | fatigue."""

import sys
from pathlib import Path
from typing import Annotated

import typer

from riser_soil.commands.exit_status import expected_errors, rank
from riser_soil.commands.scenes import Period, RunFolder, StageName, positive
from riser_soil.errors import ResultsError

AnyStage = Annotated[
    str | None, typer.Option("--stage", metavar="NAME", help="a stage; by default the last dynamic one, else the last")
]


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
        from riser_soil.results.cycles import secant_stiffness, write_csv
        from riser_soil.results.read import Run
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
        from riser_soil.plots.progress import DrawingProgress

        for name, value in {"period": period, "magnify": magnify}.items():
            positive(name, value)
        file = output or Path(f"{folder.resolve().name}.gif")
        with DrawingProgress() as progress:
            draw(folder, file, stage=stage, period=period, field=field, magnify=magnify, tell=progress.tell)
        typer.echo(file)


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
            "file; may be repeated; by default all that the run has but the film",
        ),
    ] = None,
    with_film: Annotated[bool, typer.Option("--film", help="draw the film, too; it takes a minute or two")] = False,
    ending: Annotated[str, typer.Option("--format", metavar="png|svg|pdf", help="format of the curves")] = "png",
    stage: AnyStage = None,
) -> None:
    """Draw a run: ranges along the riser, histories, shapes of a cycle, soil, energy, touchdown zone; and a film."""
    with expected_errors():
        from riser_soil.plots.album import FORMATS, album
        from riser_soil.plots.progress import DrawingProgress
        from riser_soil.results.read import Run

        if ending not in FORMATS:
            raise ResultsError(f'--format "{ending}": must be one of {", ".join(FORMATS)}')
        wanted = [name for group in what or () for name in group.split(",") if name]
        with DrawingProgress() as progress:
            for name, run in Run(folder).of_lines.items():
                place = (output or folder / "plots") / name
                for file, words in album(run, place, wanted, ending, stage, with_film, progress.tell):
                    print(f"{file}: {words}" if file else words)  # not by click, which the bar can't keep apart


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
        from riser_soil.plots.progress import DrawingProgress
        from riser_soil.report.report import write_report

        if output.suffix not in (".html", ".htm"):
            raise ResultsError(f"{output}: a report is an .html file; change its ending")
        with DrawingProgress() as progress:
            page = write_report(folders, output, stage, progress.tell)
        typer.echo(page)


def fatigue(
    file: Annotated[
        Path,
        typer.Argument(metavar="FATIGUE", help="fatigue file (.yaml): S-N curve, runs with their shares of the year"),
    ],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FOLDER", help="folder; else the fatigue file's name and -damage"),
    ] = None,
    plot: Annotated[bool, typer.Option("--plot", help="draw damage along the pipe and in the touchdown zone")] = False,
    force: Annotated[bool, typer.Option("--force", help="overwrite an assessment, which is refused otherwise")] = False,
) -> None:
    """Damage in a year and life of a pipe's wall, by rainflow cycles of runs, an S-N curve and Miner's sum."""
    with expected_errors():
        if rank() > 0:
            return
        from riser_soil.fatigue.assessment import assess
        from riser_soil.fatigue.fatigue_file import read_fatigue_file
        from riser_soil.fatigue.report import refuse_folder, result_lines, write_folder

        folder = output or Path(f"{file.stem}-damage")
        given = read_fatigue_file(file)
        refuse_folder(folder, force)
        found = assess(file, given)
        write_folder(folder, found, plot)
        typer.echo("\n".join([*result_lines(found), f"tables are in {folder}"]))
