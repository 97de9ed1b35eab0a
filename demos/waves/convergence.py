"""The storm with other steps and elements: extremes, what they cost, and how far they are from the finest run's.

Usage, in the project's folder: python -m demos.waves.convergence [--page]. Some eight minutes; runs go to `results`.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from ruamel.yaml import YAML

from demos.compute import timed
from demos.page import publish, script, table
from demos.waves.run import HERE, PAGE, SCENE, SINCE
from riser_soil.results import Run
from riser_soil.results.stage_records import peak

# Elements shortened by this factor, and the time step [s]; the others are measured by the last.
CASES = ((0.5, 0.2), (1, 0.2), (1, 0.1), (1, 0.05), (2, 0.05))
# Where moments are looked for [m of arc]: around touchdown, over the wave's bends, below the turret.
ZONES = {"touchdown": (35.0, 60.0), "bends": (60.0, 200.0), "turret": (220.0, np.inf)}


def main(results: Path, page: bool) -> None:
    outcomes = {}
    for factor, time_step in CASES:
        overrides = (*shortened(factor), f"stages.1.time_step={time_step}")
        run, seconds = timed(SCENE, results / f"convergence_{factor}_{time_step}", *overrides)
        outcomes[factor, time_step] = (run.arc.size - 1, seconds, extremes(run))
        print(f"{run.arc.size - 1} elements, {time_step} s: {seconds:.0f} s", flush=True)
    publish({"extremes": as_table(outcomes)}, results, PAGE if page else None)


def shortened(factor: float) -> list[str]:
    """Overrides that divide the lengths of all elements."""
    segments = YAML(typ="safe").load(SCENE.read_text(encoding="utf-8"))["riser"]["segments"]
    lengths = [segment["element_length"] for segment in segments]
    shorter = [[x / factor for x in given] if isinstance(given, list) else given / factor for given in lengths]
    return [f"riser.segments.{n}.element_length={given}" for n, given in enumerate(shorter)]


def extremes(run: Run) -> dict[str, float]:
    """Extremes from SINCE on: tension at the turret [kN], moments by zone [kN m], touchdown arc [m]."""
    window = run.time >= SINCE
    tension, moment = 1e-3 * run["effective_tension"][window, -1], 1e-3 * run["bending_moment"][window]
    values = {"T min": -float(peak(run.time[window], -tension)), "T max": float(peak(run.time[window], tension))}
    for name, (first, last) in ZONES.items():
        zone = (run.arc >= first) & (run.arc <= last)
        values[f"M {name}"] = float(peak(run.time[window], moment[:, zone].max(axis=1)))
    touchdown = run["touchdown_arc"][window]
    return values | {"s min": float(touchdown.min()), "s max": float(touchdown.max())}


def as_table(results: Mapping[tuple[float, float], tuple[int, float, dict[str, float]]]) -> str:
    """The results as Markdown, with the largest error of tensions, of moments, and of the touchdown arc."""
    best = results[CASES[-1]][2]
    rows = []
    for (_, time_step), (elements, seconds, values) in results.items():
        apart = {kind: max(abs(values[k] / best[k] - 1.0) for k in best if k[0] == kind) for kind in "TMs"}
        errors = [f"{100.0 * value:.2f} %" for value in apart.values()]
        shown = [f"{value:.4g}" for value in values.values()]
        rows.append([str(elements), f"{time_step:g}", f"{seconds:.0f}", *shown, *errors])
    units = {"T": "kN", "M": "kN m", "s": "m"}
    head = ["elements", "step s", "run s", *(f"{name} {units[name[0]]}" for name in best)]
    return table([*head, "error of T", "of M", "of s"], rows)


if __name__ == "__main__":
    script(main, __doc__, HERE)
