"""Time that `check` predicts for blocks of soil beside what their runs take."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

from benchmarks.speed_page import parser_of, tell
from demos.compute import compute, timed
from demos.touchdown_clay.run import SCENE
from riser_soil.checks.estimate import size_of
from riser_soil.scene.reader import read_scene

CLAY = "su: 2.0e3, su_gradient: 1.5e3, E_over_su: 300.0, nu: 0.49"
ANEW, SHORT = "stages.1.duration=3.0", "stages.1.duration=0.2"
BLOCKS = {
    "the demo's first 3 s": (),
    "the same, perfectly plastic": (f"soil.law={{kind: von-mises, {CLAY}}}",),
    "kinematic-hardening, not symmetric": (f"soil.law={{kind: kinematic-hardening, {CLAY}, elastic_share: 0.1}}",),
    "cells twice as wide": (
        "soil.mesh={kind: hex, size_at_riser: {along: 0.84, across: 0.035, strip: 0.18}, size_far: 0.9}",
    ),
    "all of it, not half": ("soil.symmetry=whole",),
    "elastic, not condensed": ("soil.law={kind: linear-elastic, E: 6.0e5, nu: 0.49}", "solver.soil=whole"),
}
HEAD = ("block", "unknowns", "forecast [s]", "took [s]", "took over forecast")


def report(page: bool = False) -> None:
    tell("forecasts", HEAD, rows(), page)


def rows() -> Iterator[list[str]]:
    """Processor time of whole runs; kernels are compiled in a shorter one before."""
    with tempfile.TemporaryDirectory() as place:
        for block, overrides in BLOCKS.items():
            compute(SCENE, Path(place) / "short", *overrides, SHORT)
            run, took = timed(SCENE, Path(place) / "run", *overrides, ANEW)
            forecast = size_of(read_scene(SCENE, (*overrides, ANEW))).seconds
            unknowns = run.summary["dofs"]["soil"]
            yield [block, f"{unknowns:,}", f"{forecast:.0f}", f"{took:.0f}", f"{took / forecast:.2f}"]


if __name__ == "__main__":
    report(parser_of("forecasts", __doc__).parse_args().page)
