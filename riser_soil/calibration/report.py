"""Results of a calibration: on the screen, and in its folder a scene, a table, numbers and a picture."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from riser_soil.calibration.least_squares import CONFIDENCE, Fit
from riser_soil.calibration.path import MeasuredResistance, PenetrationPath
from riser_soil.calibration.segment import TABLE, PipeSegment
from riser_soil.core.arrays import Array
from riser_soil.plots.soil_curves import draw_resistance
from riser_soil.results.whole_file import written_together
from riser_soil.scene.dump import dump_scene

SCENE, CURVE, NUMBERS, PICTURE = "calibrated.yaml", "fit.csv", "calibration.json", "fit.png"
COLUMNS = "w [m], V [N/m], fitted V [N/m]"
FILES = (SCENE, TABLE, CURVE, NUMBERS, PICTURE)


def printed(runs: int, misfit: float, parameters: Mapping[str, float]) -> None:
    """Print a step of the search."""
    values = ", ".join(f"{name} = {value:.5g}" for name, value in parameters.items())
    print(f"{runs:3d} runs, misfit {misfit:.4g} N/m: {values}", flush=True)


def result_lines(fit: Fit) -> list[str]:
    """Lines for the screen: misfit, a line a parameter, warnings."""
    lines = [f"misfit {fit.misfit:.4g} N/m (root mean square) after {fit.runs} runs"]
    for each in fit.parameters:
        low, high = each.interval
        known = f"{100 * CONFIDENCE:.0f} % within {low:.5g} to {high:.5g}" if each.known else "undetermined by the data"
        lines.append(f"{each.parameter.name} = {each.value:.6g}, {known}")
    bound = (each.parameter.name for each in fit.parameters if each.at_bound)
    lines += [f"warning: {name} is at its bound; widen --fit" for name in bound]
    if not fit.converged:
        lines.append("warning: the search was ended before it came to rest")
    return lines


def write_folder(
    folder: Path,
    place: Path,
    segment: PipeSegment,
    path: PenetrationPath,
    measured: MeasuredResistance,
    fit: Fit,
    diameter: float,
) -> None:
    """Write all files, together or none. place: folder of the table."""
    values = {each.parameter.name: each.value for each in fit.parameters}
    smooth = segment.resistance(values, path, place / TABLE)
    with written_together(folder, FILES) as made:
        (made / TABLE).write_bytes((place / TABLE).read_bytes())
        (made / SCENE).write_text(_scene_text(segment, values, path, place / TABLE), encoding="utf-8")
        np.savetxt(made / CURVE, _curve(measured, fit), "%.8g", ",", header=COLUMNS, comments="")
        (made / NUMBERS).write_text(json.dumps(as_dict(fit), indent=2) + "\n", encoding="utf-8")
        draw_resistance(made / PICTURE, (measured.w, measured.V), (path.w, smooth), result_lines(fit), diameter)


def as_dict(fit: Fit) -> dict[str, object]:
    """Content of calibration.json; the interval is null where the data do not determine it."""
    parameters = {
        each.parameter.name: {
            "value": each.value,
            "interval": list(each.interval) if each.known else None,
            "at_bound": each.at_bound,
        }
        for each in fit.parameters
    }
    facts = {"misfit": fit.misfit, "runs": fit.runs, "converged": fit.converged, "confidence": CONFIDENCE}
    return facts | {"parameters": parameters}


def _scene_text(segment: PipeSegment, values: Mapping[str, float], path: PenetrationPath, table: Path) -> str:
    """The calibrated scene, which follows the table beside it."""
    text = dump_scene(segment.scene(values, table, len(path.w) - 1))
    return text.replace(str(table), TABLE)


def _curve(measured: MeasuredResistance, fit: Fit) -> Array:
    return np.column_stack((measured.w, measured.V, fit.values))
