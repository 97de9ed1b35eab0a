"""Soil in sections: a Newton iteration of the demo on automatic cells, beside the block of the same cells."""

from __future__ import annotations

import argparse
import time

from benchmarks.coupled import SCENE
from benchmarks.stage import last_stage
from riser_soil.core.system import Timer

WAYS = {
    "block, kept factors": ("soil.model=block",),
    "sections, kept factors": ("soil.model=sections", "solver.linear=kept"),
    "sections, factorised": ("soil.model=sections", "solver.linear=direct"),
    "sections, by themselves": ("soil.model=sections",),
}
STEPS = 16


def report() -> None:
    """Processor time; that of the linear systems by their share of the time by the clock."""
    for way, overrides in WAYS.items():
        clock = Timer.new()
        stage = last_stage(SCENE, ("soil.mesh=auto", *overrides), clock)
        clock.seconds.clear()
        began = time.process_time()
        stage.walk(STEPS)
        each = 1e3 * (time.process_time() - began) / stage.iterations
        linear = each * clock.seconds["linear_solve"] / clock.total
        print(
            f"{way}: {stage.system.numbering.free} unknowns, {stage.iterations} Newton iterations of {each:.0f} ms, "
            f"of them {linear:.1f} ms linear systems",
            flush=True,
        )
        stage.destroy()


if __name__ == "__main__":
    argparse.ArgumentParser(prog="python -m benchmarks.sections", description=__doc__).parse_args()
    report()
