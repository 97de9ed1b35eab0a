"""Commands about the soil alone: riser-soil material | calibrate."""

from pathlib import Path
from typing import Annotated

import typer

from riser_soil.commands.exit_status import expected_errors
from riser_soil.commands.scenes import Overrides, SceneFile, placed, read
from riser_soil.core.environment import rank


def material(
    scene: SceneFile,
    path: Annotated[
        Path | None,
        typer.Option(
            metavar="CSV",
            help=r"strains or stresses by rows, e.g. columns gamma_xz [-], sigma_zz \[kPa]; else cycles of shear",
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
    with expected_errors():
        checked = read(scene, overrides)
        if rank() > 0:
            return
        from riser_soil.material.study import study

        with placed(scene, overrides):
            message = study(checked, output or Path(f"{Path(scene).stem}_material"), path, depth, force)
        typer.echo(message)


def calibrate(
    data: Annotated[
        Path,
        typer.Argument(metavar="DATA.csv", help=r"what was measured: columns w \[m], V [N/m], in the order of time"),
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
        bool, typer.Option("--relative", help="the errors of V grow with V; by default they are of one size")
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="overwrite a calibration, which is refused otherwise")] = False,
    overrides: Overrides = None,
) -> None:
    """Find numbers of a pipe segment's scene, such as su, from measured resistance by penetration."""
    with expected_errors():
        from riser_soil.calibration.calibrate import calibrate as find
        from riser_soil.calibration.report import result_lines

        folder = output or Path(f"{Path(scene).stem}-calibrated")
        read(scene, overrides)
        with placed(scene, overrides):
            also = overrides or ()
            fit = find(data, scene, wanted, folder, overrides=also, step=step, relative=relative, force=force)
        typer.echo("\n".join([*result_lines(fit), f"calibrated scene, fit and picture are in {folder}"]))
