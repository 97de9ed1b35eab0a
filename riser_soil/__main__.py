"""Command line interface: riser-soil run | check | material | calibrate | schema | stiffness | film.

Exit status 0 done, 2 bad input, 3 the solve failed, 4 the disk or standard output took no more, 128 + n for signal n.
"""

import os
import sys
import tempfile
import time
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from riser_soil import __version__
from riser_soil.errors import Interruption, MeshError, ResultsError, RiserSoilError, SceneError, WriteError, is_full
from riser_soil.interruption import default_signal_handlers, handling_signals, latest
from riser_soil.standard_output import failsafe_output

if TYPE_CHECKING:
    from riser_soil.scene.scene import Scene

# Seconds that a rank leaves to the first one to tell an error that both have met.
_PATIENCE = 5.0

app = typer.Typer(
    help="Static and dynamic analysis of a riser on the seabed.",
    epilog="Exit status: 0 done, 2 bad input, 3 the solve failed, 4 the disk or standard output took no more, "
    "130 Ctrl-C, 143 SIGTERM (what was computed until then is kept).",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

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
    float | None, typer.Option("--period", help="length of a cycle [s]; by default that of the stage's motion")
]


@app.command()
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
    restart: Annotated[bool, typer.Option("--restart", help="not supported yet")] = False,
    force: Annotated[
        bool, typer.Option("--force", help="overwrite a finished run, which is refused otherwise")
    ] = False,
    overrides: Overrides = None,
) -> None:
    """Compute a scene and leave its results in a folder."""
    with _expected_errors():
        if restart:
            raise SceneError("--restart: not supported yet; run the scene from its beginning")
        checked = _read(scene, overrides)
        folder = _result_folder(scene, checked, output, force)
        from riser_soil.run import run as compute

        with _placed(scene, overrides):
            compute(checked, folder, force)


@app.command()
def check(scene: SceneFile, overrides: Overrides = None) -> None:
    """Check a scene: tell what would be built, what is left out and why, what looks doubtful; solve nothing."""
    with _expected_errors():
        checked = _read(scene, overrides)
        from riser_soil.checks.check import describe

        with _placed(scene, overrides):
            text = describe(checked)
        if _rank() == 0:
            typer.echo(text)


@app.command()
def material(
    scene: SceneFile,
    path: Annotated[
        Path | None,
        typer.Option(
            metavar="CSV",
            help="strains or stresses by rows, e.g. columns gamma_xz [-], sigma_zz [kPa]; else cycles of shear",
        ),
    ] = None,
    depth: Annotated[
        float | None,
        typer.Option(metavar="METRES", help="of the point below the seabed; else 1 m, at most half the block's"),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FOLDER", help="result folder; else the scene's name and _material"),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="replace the files of an earlier call")] = False,
    overrides: Overrides = None,
) -> None:
    """Drive one point of the scene's soil along a path: stress by strain, secant modulus, damping."""
    with _expected_errors():
        checked = _read(scene, overrides)
        if _rank() > 0:
            return
        from riser_soil.material.study import study

        with _placed(scene, overrides):
            told = study(checked, output or Path(f"{Path(scene).stem}_material"), path, depth, force)
        typer.echo(told)


@app.command()
def calibrate(
    data: Annotated[
        Path, typer.Argument(metavar="DATA.csv", help="what was measured: columns w [m], V [N/m], in the order of time")
    ],
    scene: SceneFile,
    wanted: Annotated[
        list[str],
        typer.Option(
            "--fit",
            metavar="PATH=LOW:HIGH",
            help="a number of the scene to find, with its bounds, e.g. soil.law.su=1e3:10e3; may be repeated; the "
            "scene's own number is the first guess",
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FOLDER", help="folder; else the scene's name and -calibrated"),
    ] = None,
    step: Annotated[
        float, typer.Option("--step", metavar="PART", help="largest step of the pipe over its diameter")
    ] = 0.01,
    relative: Annotated[
        bool, typer.Option("--relative", help="the errors of V grow with V; else they are taken to be of one size")
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="overwrite a calibration, which is refused otherwise")] = False,
    overrides: Overrides = None,
) -> None:
    """Find numbers of a pipe segment's scene, such as su, from measured resistance by penetration."""
    with _expected_errors():
        from riser_soil.calibration.calibrate import calibrate as find
        from riser_soil.calibration.report import result_lines

        folder = output or Path(f"{Path(scene).stem}-calibrated")
        _read(scene, overrides)
        with _placed(scene, overrides):
            also = overrides or ()
            found = find(data, scene, wanted, folder, overrides=also, step=step, relative=relative, force=force)
        typer.echo("\n".join([*result_lines(found), f"calibrated scene, fit and picture are in {folder}"]))


@app.command()
def schema() -> None:
    """Print the JSON schema of scene files: every key with its meaning, unit and default; editors use it."""
    from riser_soil.scene.schema import schema_text

    typer.echo(schema_text())


@app.command()
def stiffness(
    folder: RunFolder,
    arc: Annotated[list[float], typer.Option("--arc", metavar="S", help="arc length [m]; may be repeated")],
    stage: StageName = None,
    period: Period = None,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE", help="CSV file; by default standard output")
    ] = None,
) -> None:
    """Print the ground's secant stiffness at arc lengths of a run, cycle by cycle, also over su, as CSV."""
    with _expected_errors():
        from riser_soil.results.read import Run
        from riser_soil.results.secant_stiffness import secant_stiffness, write_csv
        from riser_soil.results.whole_file import written_whole

        _positive("period", period)
        found = secant_stiffness(Run(folder), arc, stage, period)
        if output is None:
            write_csv(found, sys.stdout)
        else:
            with written_whole(output) as part, part.open("w", encoding="utf-8") as file:
                write_csv(found, file)


@app.command()
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
    with _expected_errors():
        from riser_soil.plots import film as draw

        for name, value in {"period": period, "magnify": magnify}.items():
            _positive(name, value)
        file = output or Path(f"{folder.resolve().name}.gif")
        typer.echo(draw(folder, file, stage=stage, period=period, field=field, magnify=magnify))


def _positive(name: str, value: float | None) -> None:
    if value is not None and not value > 0.0:
        raise ResultsError(f"--{name} {value:g}: must be greater than 0")


def _read(scene: str, overrides: list[str] | None) -> "Scene":
    from riser_soil.scene.reader import read_scene

    try:
        return read_scene(scene, overrides or ())
    except OSError as err:
        raise SceneError(f"{scene}: cannot be read: {err.strerror}") from err


def _result_folder(file: str, scene: "Scene", output: Path | None, force: bool) -> Path:
    """The folder for the results; a finished run in it is only overwritten by force."""
    from riser_soil.results.ownership import refuse

    folder = output or Path(scene.output.directory or Path(file).stem)
    if os.path.lexists(folder) and not folder.is_dir():
        raise SceneError(f"{folder}: is a file, not a folder; choose another result folder with -o FOLDER")
    if _rank() == 0:
        refuse(folder, force)
    return folder


@contextmanager
def _placed(file: str, overrides: list[str] | None) -> Iterator[None]:
    """Parts that find a scene impossible know its keys; file and line are added here."""
    try:
        yield
    except (SceneError, MeshError) as err:
        from riser_soil.scene.reader import with_place

        raise type(err)(with_place(str(err), file, overrides or ())) from err


@contextmanager
def _expected_errors() -> Iterator[None]:
    """Tell expected errors by their message alone and leave with their status."""
    try:
        yield
    except RiserSoilError as err:
        _tell_once(str(err))
        _end_other_ranks(err.exit_status)
        raise typer.Exit(err.exit_status) from err
    except Interruption as err:
        err.told = True
        if _rank() == 0 or not err.together:
            _tell_once(str(err))
        if not err.together:
            _leave_other_ranks(err.exit_status)
        raise typer.Exit(err.exit_status) from err
    except OSError as err:
        if not is_full(err):
            raise
        _tell_once(f"{err.filename or 'a file'}: cannot be written: {err.strerror}")
        _end_other_ranks(WriteError.exit_status)
        raise typer.Exit(WriteError.exit_status) from err
    except Exception:
        if _size() > 1:
            traceback.print_exc()
        _end_other_ranks(1)
        raise


def _rank() -> int:
    """This process's number under mpirun, without importing MPI; 0 alone."""
    return _from_environment("OMPI_COMM_WORLD_RANK", "PMI_RANK") or 0


def _size() -> int:
    """Number of processes under mpirun, without importing MPI; 1 alone."""
    return _from_environment("OMPI_COMM_WORLD_SIZE", "PMI_SIZE") or 1


def _from_environment(*names: str) -> int | None:
    return next((int(os.environ[name]) for name in names if os.environ.get(name, "").isdecimal()), None)


def _tell_once(message: str) -> None:
    """Print an error. As a rule all ranks meet it: the first tells it and ends the job, the others wait."""
    if _rank() > 0:
        default_signal_handlers()
        time.sleep(_PATIENCE)
    typer.echo(message, err=True)


def _end_other_ranks(status: int) -> None:
    """Ranks that wait in a collective call for this one would wait for ever."""
    mpi = sys.modules.get("mpi4py.MPI")
    if mpi is not None and _size() > 1:
        sys.stderr.flush()
        mpi.COMM_WORLD.Abort(status)


def _leave_other_ranks(status: int) -> None:
    """mpirun ends them, if it is not ending all of them already; an orderly end would wait for them."""
    if _size() > 1:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


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


def main() -> None:
    """Entry point of the console script."""
    os.environ["PETSC_OPTIONS"] = f"-no_signal_handler {os.environ.get('PETSC_OPTIONS', '')}"
    with failsafe_output() as told:
        status = _status()
    if told.failure is not None:
        with failsafe_output():
            print(f"standard output: cannot be written: {told.failure.strerror}", file=sys.stderr)
        status = status or WriteError.exit_status
    sys.exit(status)


def _status() -> int:
    status = 0
    try:
        with handling_signals():
            _replace_missing_tmpdir()
            app()
    except Interruption:
        pass
    except SystemExit as leave:
        status = int(leave.code or 0)
    end = latest()
    if end is not None and not end.told:
        print(end, file=sys.stderr)
        status = end.exit_status
    return status


def _replace_missing_tmpdir() -> None:
    """MPI and compilers end with pages of text where TMPDIR is no folder that can be written."""
    given = os.environ.get("TMPDIR")
    if given is not None and not os.access(given, os.W_OK | os.X_OK):
        del os.environ["TMPDIR"]
        if _rank() == 0:
            print(f"TMPDIR={given}: is no folder that can be written; {tempfile.gettempdir()} is used", file=sys.stderr)


if __name__ == "__main__":
    main()
