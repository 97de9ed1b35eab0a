"""Commands that take the results of runs: riser-soil plot | report | stiffness | film | fatigue."""

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from riser_soil.commands.exit_status import expected_errors
from riser_soil.commands.scenes import Period, RunFolder, StageName, positive
from riser_soil.core.environment import rank
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
        stiffnesses = secant_stiffness(Run(folder), arc, stage, period)
        if output is None:
            write_csv(stiffnesses, sys.stdout)
        else:
            with written_whole(output) as part, part.open("w", encoding="utf-8") as file:
                write_csv(stiffnesses, file)


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
            draw(folder, file, stage=stage, period=period, field=field, magnify=magnify, on_progress=progress.show)
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
                for file, words in album(run, place, wanted, ending, stage, with_film, progress.show):
                    print(f"{file}: {words}" if file else words)  # not by click, which the bar can't keep apart


def report(
    sources: Annotated[
        list[Path],
        typer.Argument(
            metavar="REPORT|FOLDER…",
            help="report file (.yaml); or folders of runs, cases, fatigue and modes, known by their files",
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE", help="a .html, .pdf or .docx; by default report.html"),
    ] = None,
    stage: Annotated[
        str | None, typer.Option("--stage", metavar="NAME", help="load step that is drawn; by default the last in time")
    ] = None,
    title: Annotated[str | None, typer.Option("--title", help="on the cover; by default that of the first run")] = None,
    client: Annotated[str | None, typer.Option("--client", help="for whom it is written")] = None,
    document: Annotated[str | None, typer.Option("--document", help="document number")] = None,
    revision: Annotated[str | None, typer.Option("--revision", help="revision")] = None,
    author: Annotated[list[str] | None, typer.Option("--author", help="who prepared it; may be repeated")] = None,
    checked: Annotated[str | None, typer.Option("--checked", help="who checked it")] = None,
    approved: Annotated[str | None, typer.Option("--approved", help="who approved it")] = None,
    logo: Annotated[Path | None, typer.Option("--logo", metavar="FILE", help="picture for the cover")] = None,
    statistics: Annotated[
        list[Path] | None,
        typer.Option("--statistics", metavar="FILE", help=".json of riser-soil statistics; may be repeated"),
    ] = None,
    reference: Annotated[
        str | None, typer.Option("--reference", metavar="CASE", help="case that sensitivities count from")
    ] = None,
    required_life: Annotated[
        float | None, typer.Option("--required-life", metavar="YEARS", help="that the pipe must last")
    ] = None,
    design_fatigue_factor: Annotated[
        float | None, typer.Option("--design-fatigue-factor", help="DFF, on the required life")
    ] = None,
) -> None:
    """Write a design report of runs, load cases, fatigue, statistics and modes, as HTML, PDF or Word document."""
    with expected_errors(extra="report"):
        if rank() > 0:
            return
        from riser_soil.plots.progress import DrawingProgress
        from riser_soil.report.report import write_report
        from riser_soil.report.report_file import of_folders, read_report_file

        options: dict[str, Any] = {
            "title": title, "client": client, "document": document, "revision": revision, "authors": author,
            "checked": checked, "approved": approved, "logo": logo and str(logo),
            "statistics": statistics and [str(each) for each in statistics], "reference": reference,
            "required_life": required_life, "design_fatigue_factor": design_fatigue_factor, "stage": stage,
        }  # fmt: skip
        asked = {key: value for key, value in options.items() if value is not None}
        files = [each for each in sources if each.suffix in (".yaml", ".yml") and not each.is_dir()]
        if files and len(sources) > 1:
            raise ResultsError(f"{files[0]}: a report file is given alone; name the folders in it")
        given = read_report_file(files[0], asked) if files else of_folders(sources, asked)
        file = output or (files[0].with_suffix(".html") if files else Path("report.html"))
        with DrawingProgress() as progress:
            made = write_report(given, file, progress.show)
        typer.echo(made)


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
    with expected_errors(extra="fatigue"):
        if rank() > 0:
            return
        from riser_soil.fatigue.assessment import assess
        from riser_soil.fatigue.fatigue_file import read_fatigue_file
        from riser_soil.fatigue.report import FILES, result_lines, write_folder
        from riser_soil.results.whole_file import refuse_folder

        folder = output or Path(f"{file.stem}-damage")
        given = read_fatigue_file(file)
        refuse_folder(folder, FILES, "an assessment", force)
        damage = assess(file, given)
        write_folder(folder, damage, plot)
        typer.echo("\n".join([*result_lines(damage), f"tables are in {folder}"]))
