"""The page of the calibration, docs/error_bars.md: what was found, scene by scene."""

from __future__ import annotations

import datetime
import os
import platform
from pathlib import Path
from typing import Any

from benchmarks.error_bars.calibration import Judged, JudgedScene, median_ratio, share_inside
from benchmarks.error_bars.scenes import SCENES
from riser_soil import __version__
from riser_soil.accuracy.error_bars import ON_PATH, SAFETY, SMALLEST

PAGE = Path("docs") / "error_bars.md"

TEXT = """# Error bars: how they are found, and how often they are right

Written by `make bars`: riser-soil {version}, {date}, Python {python}, {cores} cores.

`riser-soil run SCENE --error-bars`, or `error_bars: true` in the scene, computes coarser companions of the scene
after the run, in the same process and without files: soil of cells √2 times as large, then twice as large again,
then steps five times as long too, then half the elements, then a quarter of the penalty, of these what the scene has.
Each difference has one source; of the two in soil the one that tells more counts. A difference over ratio^order − 1 is
the error by Richardson's extrapolation: order 4 for the elements of a riser that hangs, 2 for one that touches down, 2
for time steps, 1 for the soil's cells, ¾ for the penalty; in a contact force on a rigid floor, of which an end held on
it bears what lies beside it, 1 for the elements and ¼ for the penalty; less where the difference is large. What falls
between nodes and between steps, by the parabola through three samples, is added to mesh and time, and what rings from
step to step to the time; largest moments and curvatures are told between nodes, by a cubic whose error is of the
elements' own order, so that nothing is added. Then there is a factor of safety:
{factors}.
Different sources add up as squares do. The smallest bar is {smallest:g} of the quantity's scale
([headlines.py](../riser_soil/accuracy/headlines.py)).
[error_bars.py](../riser_soil/accuracy/error_bars.py) has all of it.

The factors are chosen so that over the {scenes} scenes below, of known answers (each computed with 4 to 16 times
the elements, a tenth of the step and 51200 times the penalty of a rigid floor; on soil with cells of a quarter
of the size and 32 times the penalty), the bars hold what they say:

| | |
|---|---:|
| scenes, headline quantities judged | {scenes}, {quantities} |
| true error inside its bar | {inside:.1%} |
| bar over true error, median, of the {larger} errors above the smallest bar | {ratio:.2f} |
| left out, as the reference is not certain to a third of the error | {uncertain} |
| bars not given, as a companion failed | {missing} |
| processor time of the companions over that of the scenes, without start-up and files | {cost:.0%} |

The same of the {on_soil} scenes on soil alone:

| | |
|---|---:|
| headline quantities judged | {soil_quantities} |
| true error inside its bar | {soil_inside:.1%} |
| bar over true error, median | {soil_ratio:.2f} |
| left out, as the reference is not certain to a third of the error | {soil_uncertain} |

What a run's companions take beside all of it, start-up and files included, the run itself tells at its end.

The width on which a pipe touches soil grows cell by cell, so that errors fall with the cells' size in jumps, by which
two meshes may agree by chance. A mesh that is near the run's, √2 times as coarse, tells such jumps far better than one
twice as coarse. On ladders of meshes, 4 to 48 cells to the diameter, of such scenes as are pressed and resting below,
the soil's share alone holds 95 % of 103 errors (elastic 96 %, clay 94 %), at a median of 4.0 times the error (elastic
4.7, clay 2.9); with a factor of 1 on all it would be 87 % (clay 79 %), at 3.0. By a mesh twice as coarse alone a factor
of 6.5 would hold 95 %, at a median of 10. On elastic soil bars are wider than they need be, as errors there fall faster
than by the first order.

The scenes chose the factors, so on other scenes a share a little lower is to be expected. Where the answer hangs on
a sudden load that excites all modes, or steps are so long that companions show no order, bars are least reliable.
Bars tell nothing of what is not varied: the model itself, a block of soil that is too small, a pipe modelled with
wrong numbers.

| scene | inside | bar over true error, median | companions over scene |
|---|---:|---:|---:|
{rows}

Bars that were missed, with the true error over the bar:

| scene | quantity | error over bar |
|---|---|---:|
{missed}

`python -m benchmarks.error_bars --references` computes the references anew, in about twenty minutes.
"""


def page(scenes: list[JudgedScene]) -> str:
    judged = [each for scene in scenes for each in scene.judged]
    certain = [each for each in judged if each.certain]
    seconds, extra = (sum(scene.seconds[n] for scene in scenes) for n in (0, 1))
    return TEXT.format(
        version=__version__,
        date=datetime.date.today().isoformat(),
        python=platform.python_version(),
        cores=os.cpu_count(),
        factors=_factors(),
        smallest=SMALLEST,
        scenes=len(SCENES),
        quantities=len(certain),
        inside=share_inside(judged),
        larger=sum(each.ratio is not None for each in certain),
        ratio=median_ratio(judged),
        uncertain=len(judged) - len(certain),
        missing=sum(len(scene.not_known) for scene in scenes),
        cost=extra / seconds,
        **_on_soil(scenes),
        rows="\n".join(_row(scene) for scene in scenes),
        missed="\n".join(_missed(each) for each in certain if not each.inside),
    )


def _factors() -> str:
    of_sources = ", ".join(f"{factor:g} for the {source}" for source, factor in SAFETY.items())
    return f"{of_sources}, and {ON_PATH['soil']:g} for soil whose law depends on its path"


def _on_soil(scenes: list[JudgedScene]) -> dict[str, Any]:
    """Figures of the scenes on soil."""
    found = [scene for scene in scenes if "soil" in SCENES[scene.name]]
    judged = [each for scene in found for each in scene.judged]
    certain = sum(each.certain for each in judged)
    return {
        "on_soil": len(found), "soil_quantities": certain, "soil_uncertain": len(judged) - certain,
        "soil_inside": share_inside(judged), "soil_ratio": median_ratio(judged),
    }  # fmt: skip


def _row(scene: JudgedScene) -> str:
    certain = [each for each in scene.judged if each.certain]
    ratios = sum(each.ratio is not None for each in certain)
    median = f"{median_ratio(certain):.2g}" if ratios else "all below the smallest bar"
    taken, extra = scene.seconds
    return f"| {scene.name} | {sum(e.inside for e in certain)} of {len(certain)} | {median} | {extra / taken:.0%} |"


def _missed(each: Judged) -> str:
    assert each.bar.bar is not None
    return f"| {each.scene} | {each.bar.headline.key} | {each.error / each.bar.bar:.2f} |"
