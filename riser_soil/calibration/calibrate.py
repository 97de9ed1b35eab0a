"""Calibration of a scene on measured resistance by penetration, from a file to a folder with results."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from riser_soil.calibration.least_squares import Fit, FitParameter, fit
from riser_soil.calibration.path import MeasuredResistance, path_through, read_resistance
from riser_soil.calibration.report import FILES, printed, write_folder
from riser_soil.calibration.segment import TABLE, PipeSegment, diameter, first_penetration, write_table
from riser_soil.core.arrays import Array
from riser_soil.core.communicator import world
from riser_soil.errors import SceneError
from riser_soil.interruption import handling_signals
from riser_soil.results.whole_file import refuse_folder
from riser_soil.scene.problem import NOTHING, shown, value_at
from riser_soil.scene.scene import Scene
from riser_soil.variants.variant import BaseScene

LARGEST_STEP = 0.01  # over the diameter


def calibrate(
    data: Path | str,
    scene: Path | str,
    wanted: Sequence[str],
    folder: Path | str,
    *,
    overrides: Sequence[str] = (),
    step: float = LARGEST_STEP,
    relative: bool = False,
    force: bool = False,
) -> Fit:
    """Fit numbers of a scene so that its pipe segment has the measured resistance, and leave results in a folder.

    data: CSV file with w [m], V [N/m]. wanted: `path=low:high`, the scene's own number being the first guess.
    step: largest step of the pipe over its diameter. relative: errors grow with V. SceneError, before anything is
    computed, for wrong input; the folder is made at the end.
    """
    folder = Path(folder)
    if world().size > 1:
        raise SceneError("calibrate runs on one process: start it without mpirun")
    if not 0.0 < step <= 0.5:
        raise SceneError(f"--step {step:g}: must lie between 0 and 0.5 diameters; 0.01 is usual")
    refuse_folder(folder, FILES, "a calibration", force)
    measured, base = read_resistance(Path(data)), BaseScene.read(scene, overrides)
    at_first = base.with_values({}, "")
    parameters = tuple(parameter(at_first, each) for each in wanted)
    refuse_twice([p.name for p in parameters])
    refuse_too_many(parameters, measured, data)
    start = first_penetration(at_first)
    refuse_too_deep(measured, diameter(at_first), data)
    path = path_through(measured.w, start, step * diameter(at_first))
    segment = PipeSegment(base)
    with handling_signals(), tempfile.TemporaryDirectory() as place:
        table = Path(place) / TABLE
        write_table(path, start, table)

        def resistance(values: Mapping[str, float]) -> Array:
            return path.at_points(segment.resistance(values, path, table))

        fitted = fit(resistance, measured.V, parameters, printed, relative=relative)
        write_folder(folder, Path(place), segment, path, measured, fitted, diameter(at_first))
    return fitted


def parameter(scene: Scene, wanted: str) -> FitParameter:
    """Parameter of an option --fit, as `soil.law.su=1e3:10e3`."""
    name, _, bounds = wanted.partition("=")
    low, colon, high = bounds.partition(":")
    try:
        ends = float(low), float(high)
    except ValueError:
        colon = ""
    if not colon or not name:
        raise SceneError(f"--fit {wanted}: must be path=low:high; write for example --fit soil.law.su=1e3:10e3")
    if not -1e30 < ends[0] < ends[1] < 1e30:
        raise SceneError(f"--fit {wanted}: bounds are below 1e30, the first smaller than the second; correct them")
    words = tuple(int(word) if word.isdecimal() else word for word in name.split("."))
    guess = value_at(scene.model_dump(mode="json", by_alias=True), words)
    if isinstance(guess, bool) or not isinstance(guess, int | float):
        given = "missing" if guess is NOTHING else f"value {shown(guess)}"
        raise SceneError(f"--fit {wanted}: {name}: {given}: only a number of the scene can be found; correct the path")
    if not ends[0] <= guess <= ends[1]:
        remedy = "the search begins there: widen the bounds, or --set it"
        raise SceneError(f"--fit {wanted}: {name}: value {guess:g}: {remedy}")
    return FitParameter(name, *ends, float(guess))


def refuse_twice(names: Sequence[str]) -> None:
    """SceneError where no parameter is named, or one is twice."""
    if not names:
        raise SceneError("--fit: missing: name at least one number of the scene, such as --fit soil.law.su=1e3:10e3")
    for name in names:
        if names.count(name) > 1:
            raise SceneError(f"--fit {name}: is given twice; leave one out")


def refuse_too_deep(measured: MeasuredResistance, diameter: float, data: Path | str) -> None:
    """SceneError for a penetration of more than a diameter."""
    deepest = float(measured.w.max())
    if deepest > diameter:
        allowed = f"w reaches {deepest:g} m, more than the pipe's diameter of {diameter:g} m"
        raise SceneError(f"{data}: {allowed}; check the unit of w, or leave these rows out")


def refuse_too_many(parameters: Sequence[FitParameter], measured: MeasuredResistance, data: Path | str) -> None:
    """SceneError for as many parameters as rows, or more."""
    if len(measured.w) <= len(parameters):
        allowed = f"{len(measured.w)} rows can't determine {len(parameters)} parameters"
        raise SceneError(f"{data}: {allowed}; measure more, or find fewer")
