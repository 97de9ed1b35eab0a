"""The page of the calibration, docs/error_bars.md: what was found in it, out of sample, and scene by scene."""

from __future__ import annotations

import datetime
import math
import os
import platform
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from statistics import median

from benchmarks.error_bars.calibration import (
    CERTAIN,
    Judged,
    JudgedScene,
    decided,
    ratios,
    share_inside,
)
from benchmarks.error_bars.random_risers import CALIBRATION, GROUNDS, OUT_OF_SAMPLE
from benchmarks.error_bars.scenes import SCENES
from demos.page import table
from riser_soil import __version__
from riser_soil.accuracy.error_bars import LARGE, ON_PATH, SAFETY, SMALLEST

PAGE = Path("docs") / "error_bars.md"
FIGURES, OUT = "error bars", "error bars out of sample"  # blocks of the page that others quote
ALL = CALIBRATION | OUT_OF_SAMPLE
FACTORS = 0.5, 0.7, 0.85, 1.0, 1.2, 1.5, 2.0  # times those of safety
TELLING = 1e-4  # errors over the scale that an engineer might still ask for

TEXT = """# Error bars: how they are found, and how often they are right

Written by `make bars`: riser-soil {version}, {date}, Python {python}, {cores} cores.

`riser-soil run SCENE --error-bars`, or `error_bars: true` in the scene, computes companions of the scene after the run,
in the same process and without files: one with steps two to four times as long (as long as the shortest period keeps
20), then one that has twice the elements, too, and on a rigid floor 16 times the penalty. Each difference has one
source. A finer mesh tells the mesh's error whatever its order is, so that bars hold where elements are far too long;
finer steps would cost more than the run.

A difference between two runs is the root mean square of those in the extreme itself and in the windows of time, of 16,
in which the quantity comes within a fifth of its range to the extreme: two runs may agree in one extreme by chance.
Where windows meet, between two steps, their value is on the line between these, so that long steps miss no part of one.
A difference over |fineness^−order − 1| is the error by Richardson's extrapolation: order 2 for elements and time steps;
in a contact force on a rigid floor, of which an end held on it bears what lies beside it, 1. Where longer steps make a
large difference, half way at {large:.0%} of the scale, the divisor falls to 1. What falls between nodes and between
steps, by the parabola through three samples, is added to mesh and time, and what rings from step to step to the time;
largest moments and curvatures are told between nodes, by a cubic whose error is of the elements' own order, so that
nothing is added. Then there is a factor of safety: {factors}.
Different sources add up as squares do. The smallest bar is {smallest:g} of the quantity's scale
([headlines.py](../riser_soil/accuracy/headlines.py)).

On soil the chain is another: cells √2 times as large, then twice as large again, then steps five times as long, half
the elements, a quarter of the penalty. Orders are 1 for the soil's cells and ¾ for the penalty, the factor for cells is
{on_path:g} for soil whose law depends on its path, and of the two soils the one that tells more counts.
[error_bars.py](../riser_soil/accuracy/error_bars.py) has all of it, [chain.py](../riser_soil/accuracy/chain.py) the
companions.

The factors are chosen so that over {scenes} scenes of known answers the bars hold what they say. {drawn} of them are
[random risers](../benchmarks/error_bars/random_risers.py): steel and flexible pipes between 12 and 2000 m of water,
hanging or laid on a rigid floor, springs or hysteretic clay, level and sloping, half of them moving, with 25 to 120
elements and 30 to 150 steps to a period. References ([references.py](../benchmarks/error_bars/references.py)) have 16
or 64 times the elements of static scenes and 16 times those of moving ones with a tenth of the step; a quarter as many
tell how uncertain they are. Quantities are left out whose reference is so uncertain that the error may be on either
side of its bar; and of the median, those whose reference is not certain to {certain:.0%} of bar or error, the larger of
them, and errors below {smallest:g} of the scale, which all bars are larger than. Factors are such that static and
dynamic stages of the calibration each hold 95 %.

<!-- {figures_block} -->
{figures}
<!-- end of {figures_block} -->

## Out of sample

{out_scenes} more risers of the same generator, {each} on each ground, have chosen nothing: neither a factor nor a way
to find a bar.

<!-- {out_block} -->
{out_figures}
<!-- end of {out_block} -->

{out_quantities}

{out_grounds}

{out_stages}

Bars out of sample that were missed, with the true error over the bar:

{out_missed}

With all factors of safety smaller or larger:

{factors_tried}

## In the calibration

{quantities}

{grounds}

{stages}

What a run's companions take beside all of it, start-up and files included, the run itself tells at its end.

The width on which a pipe touches soil grows cell by cell, so that errors fall with the cells' size in jumps, by which
two meshes may agree by chance. A mesh that is near the run's, √2 times as coarse, tells such jumps far better than one
twice as coarse. On ladders of meshes, 4 to 48 cells to the diameter, of such scenes as are pressed and resting below,
the soil's share alone holds 95 % of 103 errors (elastic 96 %, clay 94 %), at a median of 4.0 times the error (elastic
4.7, clay 2.9); with a factor of 1 on all it would be 87 % (clay 79 %), at 3.0. By a mesh twice as coarse alone a factor
of 6.5 would hold 95 %, at a median of 10. On elastic soil bars are wider than they need be, as errors there fall faster
than by the first order.

Where the answer hangs on a sudden load that excites all modes, or steps are so long that longer ones resolve nothing,
bars are least reliable; in the latter case they are far too wide more often than too narrow. Bars tell nothing of what
is not varied: the model itself, a block of soil that is too small, a pipe modelled with wrong numbers.

{rows}

Bars that were missed, with the true error over the bar:

{missed}

`python -m benchmarks.error_bars --references` computes the references anew, in about an hour.
"""

Kind = Callable[[Judged], str]


def page(calibration: list[JudgedScene], out: list[JudgedScene]) -> str:
    return TEXT.format(
        version=__version__,
        date=datetime.date.today().isoformat(),
        python=platform.python_version(),
        cores=os.cpu_count(),
        factors=", ".join(f"{factor:g} for the {source}" for source, factor in SAFETY.items()),
        on_path=ON_PATH["soil"],
        large=LARGE["time"],
        smallest=SMALLEST,
        certain=CERTAIN,
        scenes=len(calibration),
        drawn=sum(scene.name not in SCENES for scene in calibration),
        each=len(OUT_OF_SAMPLE) // len(GROUNDS),
        figures_block=FIGURES,
        figures=_figures(calibration, "in the calibration", CALIBRATION),
        quantities=_by_kind(calibration, "quantity, in the calibration", lambda each: each.bar.headline.name),
        grounds=_by_kind(calibration, "ground, in the calibration", _ground),
        stages=_by_kind(calibration, "stage, in the calibration", _stage),
        rows=table(["scene", "inside", "bar over true error, median", "companions over scene"], map(_row, calibration)),
        missed=_missed(calibration),
        out_scenes=len(out),
        out_block=OUT,
        out_figures=_figures(out, "out of sample", OUT_OF_SAMPLE),
        out_quantities=_by_kind(out, "quantity, out of sample", lambda each: each.bar.headline.name),
        out_grounds=_by_kind(out, "ground, out of sample", _ground),
        out_stages=_by_kind(out, "stage, out of sample", _stage),
        out_missed=_missed(out),
        factors_tried=_with_other_factors(_all(calibration), _all(out)),
    )


def _figures(scenes: list[JudgedScene], where: str, of: Iterable[str]) -> str:
    judged, seconds = _all(scenes), [sum(scene.seconds[n] for scene in scenes) for n in (0, 1)]
    told, ratio = decided(judged), ratios(judged)
    rows = [
        ["scenes, headline quantities judged", f"{len(scenes)}, {len(told)}"],
        ["true error inside its bar", f"{share_inside(judged):.1%}"],
        [f"bar over true error, median, of the {len(ratio)} errors above {SMALLEST:g}", f"{median(ratio):.2f}"],
        [f"the same, of errors above {TELLING:g}", f"{median(ratios(judged, TELLING)):.2f}"],
        ["scenes that could not be computed", _failed(scenes, of)],
        ["left out, as the reference does not tell the side of the bar", str(len(judged) - len(told))],
        ["bars not given, as a companion failed", str(sum(len(scene.not_known) for scene in scenes))],
        ["processor time of the companions over that of the scenes, without start-up and files",
         f"{seconds[1] / seconds[0]:.0%}"],
    ]  # fmt: skip
    return table([where, ""], rows)


def _failed(scenes: list[JudgedScene], of: Iterable[str]) -> str:
    computed = {scene.name for scene in scenes}
    return ", ".join(name for name in of if name not in computed) or "none"


def _with_other_factors(calibration: list[Judged], out: list[Judged]) -> str:
    rows = []
    for factor in FACTORS:
        both = [[_scaled(each, factor) for each in judged] for judged in (calibration, out)]
        told = (text for judged in both for text in (f"{share_inside(judged):.1%}", f"{median(ratios(judged)):.2f}"))
        rows.append([f"{factor:g}", *told])
    return table(["times", "inside, in the calibration", "median", "inside, out of sample", "median"], rows)


def _scaled(each: Judged, factor: float) -> Judged:
    whole = factor * math.hypot(*each.bar.by_source.values()) + SMALLEST * each.bar.headline.scale
    return replace(each, bar=replace(each.bar, bar=whole))


def _by_kind(scenes: list[JudgedScene], head: str, kind: Kind) -> str:
    """Share inside and median ratio of each kind, in the order of their names."""
    found: dict[str, list[Judged]] = {}
    for each in decided(_all(scenes)):
        found.setdefault(kind(each), []).append(each)
    rows = [[name, str(len(own)), f"{share_inside(own):.1%}", _median(own)] for name, own in sorted(found.items())]
    return table([head, "judged", "inside", "bar over true error, median"], rows)


def _ground(each: Judged) -> str:
    mapping = ALL[each.scene]
    if "soil" in mapping:
        return "block of soil"
    seabed = mapping.get("seabed")
    if seabed is None:
        return "none"
    return str(seabed["law"]["kind"] if seabed["kind"] == "hysteretic" else seabed["kind"])


def _stage(each: Judged) -> str:
    kinds = {stage["name"]: stage["kind"] for stage in ALL[each.scene]["stages"]}
    return str(kinds[each.bar.headline.stage])


def _all(scenes: Iterable[JudgedScene]) -> list[Judged]:
    return [each for scene in scenes for each in scene.judged]


def _median(judged: list[Judged]) -> str:
    found = ratios(judged)
    return f"{median(found):.2g}" if found else "all below the smallest bar"


def _row(scene: JudgedScene) -> list[str]:
    told, (taken, extra) = decided(scene.judged), scene.seconds
    inside = f"{sum(each.inside for each in told)} of {len(told)}"
    return [scene.name, inside, _median(told), f"{extra / taken:.0%}"]


def _missed(scenes: list[JudgedScene]) -> str:
    found = [each for each in decided(_all(scenes)) if not each.inside]
    rows = [[f"{each.scene}: {each.bar.headline.key}", f"{each.error / (each.bar.bar or 1.0):.2f}"] for each in found]
    return table(["scene and quantity", "error over bar"], rows)
