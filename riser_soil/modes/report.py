"""What `riser-soil modes` tells and leaves: a table, modes.nc, and where it is asked for modes.png."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray

from riser_soil.core.arrays import Array
from riser_soil.errors import SceneError
from riser_soil.modes.modes import DIRECTIONS, BodyShapes, LineShapes, Modes
from riser_soil.results.whole_file import refuse_file, written_together

NUMBERS, PICTURE = "modes.nc", "modes.png"
FILES = (NUMBERS, PICTURE)


def refuse_folder(folder: Path, force: bool) -> None:
    """SceneError for a folder with modes, unless by force."""
    refuse_file(folder)
    there = [name for name in FILES if (folder / name).exists()]
    if there and not force:
        raise SceneError(f"{folder / there[0]}: is there already; choose another folder (-o) or add --force")


def table(modes: Modes, asked: int) -> list[str]:
    """Lines of a table, one a mode, with notes on all of them below."""
    headings, several = " ".join(f"{words:>12}" for words in DIRECTIONS), "" not in modes.lines
    lines = [
        f'natural frequencies at rest after stage "{modes.stage}", without damping; shares of the squared '
        "displacement:",
        f"{'mode':>4} {'f [Hz]':>12} {'T [s]':>10}  {'direction':<12} {headings}{'  most of' if several else ''}",
    ]
    rows = zip(modes.frequency, modes.period, modes.direction, modes.share, modes.moving_most, strict=True)
    for n, (f, T, direction, share, name) in enumerate(rows, 1):
        share_columns = " ".join(f"{100.0 * part:10.1f} %" if np.isfinite(part) else f"{'-':>12}" for part in share)
        lines.append(f"{n:4d} {f:12.6g} {T:10.4g}  {direction:<12} {share_columns}{f'  {name}' if several else ''}")
    if len(modes.frequency) < asked:
        lines.append(f"no more than {len(modes.frequency)} were found: the riser has so few unknowns with mass")
    if modes.asymmetry > 0.0:
        lines.append(
            "the tangent's symmetric part is used; the rest would change these frequencies by at most "
            f"{modes.asymmetry:.1g} of them"
        )
    return lines


def write_folder(folder: Path, modes: Modes, plot: bool) -> None:
    """All files together, none of them by halves."""
    with written_together(folder, FILES if plot else (NUMBERS,)) as made:
        for group, dataset in datasets(modes).items():
            dataset.to_netcdf(made / NUMBERS, mode="w" if group == "/" else "a", group=group, engine="h5netcdf")
        if plot:
            from riser_soil.plots.mode_shapes import draw_modes

            drawn = modes.lines.items()
            draw_modes(made / PICTURE, {n: (each.arc, each.position, each.shape) for n, each in drawn}, titles(modes))


def titles(modes: Modes) -> list[str]:
    rows = zip(modes.frequency, modes.period, modes.direction, strict=True)
    return [f"mode {n}: {f:.4g} Hz, {T:.4g} s, {direction}" for n, (f, T, direction) in enumerate(rows, 1)]


def datasets(modes: Modes) -> dict[str, xarray.Dataset]:
    """Datasets of modes.nc by group, "/" the whole: units, signs and places with each variable."""
    groups = {"/": _of_all(modes)}
    for name, own in modes.lines.items():
        groups[name or "/"] = _of_line(own) if name else groups["/"].merge(_of_line(own))
    return groups | {f"bodies/{name}": _of_body(own) for name, own in modes.bodies.items()}


def _of_all(modes: Modes) -> xarray.Dataset:
    dataset = xarray.Dataset(
        {
            "frequency": _named(("mode",), modes.frequency, "Hz", "natural frequency, without damping"),
            "period": _named(("mode",), modes.period, "s", "natural period"),
            "share": _named(
                ("mode", "direction"), modes.share, "1",
                "share of the squared displacement along the riser: across it in the vertical plane from start to end, "
                "across it out of this plane, along it, of its surface in twist",
            ),
        },
        {"mode": np.arange(1, len(modes.frequency) + 1), "direction": list(DIRECTIONS)},
    )  # fmt: skip
    dataset.attrs = {"stage": modes.stage, "asymmetry": modes.asymmetry, "Conventions": "CF-1.11"}
    return dataset


SHAPE = "displacement of the {} over the mode's largest displacement; global axes, z up"
TURN = "rotation about {} over the mode's largest displacement; right-hand rule, {}"


def _of_line(own: LineShapes) -> xarray.Dataset:
    turn = TURN.format("the pipe's axis", "towards the end")
    return xarray.Dataset(
        {
            "shape": _named(("mode", "arc", "component"), own.shape, "1", SHAPE.format("riser's axis")),
            "twist": _named(("mode", "arc"), own.twist, "rad m-1", turn),
            "position": _named(
                ("arc", "component"), own.position, "m", "position of the riser's axis at rest; global axes, z up"
            ),
        },
        {
            "arc": _named(("arc",), own.arc, "m", "unstressed arc length from the start"),
            "component": ["x", "y", "z"],
        },
    )


def _of_body(own: BodyShapes) -> xarray.Dataset:
    axes, turn = SHAPE.format("origin of the body's axes"), TURN.format("the global axes", "z up")
    return xarray.Dataset(
        {
            "shape": _named(("mode", "component"), own.shape, "1", axes),
            "rotation": _named(("mode", "component"), own.rotation, "rad m-1", turn),
        },
        {"component": ["x", "y", "z"]},
    )


Named = tuple[tuple[str, ...], Array, dict[str, str]]


def _named(dims: tuple[str, ...], values: Array, units: str, long_name: str) -> Named:
    return dims, values, {"units": units, "long_name": long_name}
