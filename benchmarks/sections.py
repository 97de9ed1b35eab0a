"""Soil in sections: a Newton iteration of the demo on automatic cells, beside the block of the same cells."""

from __future__ import annotations

import time
from collections.abc import Iterator

from benchmarks.coupled import SCENE
from benchmarks.speed_page import parser_of, tell
from benchmarks.stage import last_stage
from riser_soil.core.system import Timer

WAYS = {
    "block, kept factors": ("soil.model=block",),
    "sections, kept factors": ("soil.model=sections", "solver.linear=kept"),
    "sections, factorised": ("soil.model=sections", "solver.linear=direct"),
    "sections, by themselves": ("soil.model=sections",),
}
STEPS = 16


HEAD = ("soil and solver", "unknowns", "Newton iterations", "each takes [ms]", "of it linear systems [ms]")


def report(page: bool = False) -> None:
    tell("sections", HEAD, rows(), page)


def rows() -> Iterator[list[str]]:
    """Processor time; that of the linear systems by their share of the time by the clock."""
    for way, overrides in WAYS.items():
        clock = Timer.new()
        stage = last_stage(SCENE, ("soil.mesh=auto", *overrides), clock)
        clock.seconds.clear()
        began = time.process_time()
        stage.walk(STEPS)
        each = 1e3 * (time.process_time() - began) / stage.iterations
        linear = each * clock.seconds["linear_solve"] / clock.total
        yield [way, f"{stage.system.numbering.free:,}", f"{stage.iterations}", f"{each:.0f}", f"{linear:.1f}"]
        stage.destroy()


if __name__ == "__main__":
    report(parser_of("sections", __doc__).parse_args().page)
