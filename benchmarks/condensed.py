"""Elastic soil condensed to its surface: a time step beside one on springs, and beside one on the whole soil; laying
with the compliance that an earlier run has kept, and without.
"""

from __future__ import annotations

import os
import time

from benchmarks.coupled import SCENE
from benchmarks.speed_page import parser_of, tell
from benchmarks.stage import last_stage
from riser_soil.core.system import Timer
from riser_soil.soil.compliance import SWITCH

PLANE = ("dimension=2", "water={density: 1025.0}")  # without a current: a step on springs is a cheap one
SPRINGS = (*PLANE, "soil=null", "contact={}")
ELASTIC = (*PLANE, "soil.law={kind: linear-elastic, E: 2.0e6, nu: 0.4}")
MESHES = {  # cells along and across the riser, and far from it [m], by unknowns
    4_500: (1.0, 0.075, 0.75),
    22_000: (0.5, 0.05, 0.5),
}
STEPS = {"springs": 40, "condensed": 20, "whole": 4}


HEAD = (
    *("unknowns of the soil", "a step on springs [ms]", "on condensed soil [ms]", "on whole soil [ms]"),
    *("condensed over springs", "whole over condensed", "laid with kept compliance [s]", "without [s]"),
)


def report(page: bool = False) -> None:
    springs = step_seconds(SPRINGS, STEPS["springs"])
    tell("condensed", HEAD, (row(unknowns, springs) for unknowns in MESHES), page)


def row(unknowns: int, springs: float) -> list[str]:
    mesh = MESHES[unknowns]
    condensed, whole = (step_seconds(on_soil(mesh, soil), STEPS[soil]) for soil in ("condensed", "whole"))
    laid = laying_seconds(on_soil(mesh, "condensed"))
    return [
        f"{unknowns:,}", f"{1e3 * springs:.2f}", f"{1e3 * condensed:.1f}", f"{1e3 * whole:.0f}",
        f"{condensed / springs:.1f}", f"{whole / condensed:.0f}", *(f"{seconds:.1f}" for seconds in laid),
    ]  # fmt: skip


def laying_seconds(overrides: tuple[str, ...]) -> tuple[float, float]:
    """Processor time of set-up and all stages before the last [s]: with compliance that is kept, and without."""
    seconds = []
    for switch in ("", "", "off"):  # the first of them keeps it
        os.environ[SWITCH] = switch
        began = time.process_time()
        last_stage(SCENE, overrides, Timer.new()).destroy()
        seconds.append(time.process_time() - began)
    return seconds[1], seconds[2]


def on_soil(mesh: tuple[float, float, float], soil: str) -> tuple[str, ...]:
    along, across, far = mesh
    at_riser = f"{{along: {along}, across: {across}, strip: 0.15}}"
    return (*ELASTIC, f"soil.mesh={{kind: hex, size_at_riser: {at_riser}, size_far: {far}}}", f"solver.soil={soil}")


def step_seconds(overrides: tuple[str, ...], steps: int) -> float:
    """Processor time of a time step [s], the mean of some after two others."""
    stage = last_stage(SCENE, overrides, Timer.new())
    stage.walk(2)
    began = time.process_time()
    stage.walk(steps)
    elapsed = time.process_time() - began
    stage.destroy()
    return elapsed / steps


if __name__ == "__main__":
    report(parser_of("condensed", __doc__).parse_args().page)
