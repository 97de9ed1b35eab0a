"""The page of the calibration, docs/error_bars.md: what was found in it, out of sample, and scene by scene."""

from __future__ import annotations

import datetime
import math
import os
import platform
from collections.abc import Callable, Iterable, Mapping
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
from benchmarks.error_bars.soil_page import OF_ALL_ERRORS
from benchmarks.error_bars.soil_page import ON_SOIL as SOIL_BLOCK
from demos.page import csv_table, filled, table
from riser_soil import __version__
from riser_soil.accuracy.chain import ALL_COARSER, COARSER_SOIL
from riser_soil.accuracy.error_bars import (
    AT_REST,
    BY_SLICE,
    IN_MOTION,
    LARGE,
    MOST_ENLARGED,
    ON_PATH,
    ON_SOIL,
    SAFETY,
    SLICE,
    SMALLEST,
    SMALLEST_ON_SOIL,
)

PAGE = Path("docs") / "error_bars.md"
EVERY_SCENE, EVERY_MISSED = (PAGE.with_name(f"error_bars_{name}.csv") for name in ("scenes", "missed"))
FIGURES, OUT = "error bars", "error bars out of sample"  # blocks of the page that others quote
ALL = CALIBRATION | OUT_OF_SAMPLE
FACTORS = 0.5, 1.0, 2.0  # times those of safety
MISSED = "scene and quantity", "error over bar"

TEXT = """# Error bars: how they are found, and how often they are right

Written by `make bars`: riser-soil {version}, {date}, Python {python}, {cores} cores.

`riser-soil run SCENE --error-bars`, or `error_bars: true` in the scene, computes coarser and finer runs of the scene
after the run. This page calls them coarser runs.

| coarser run | elements, steps, penalty |
| --- | --- |
| 1 | steps two to four times as long, as long as the shortest period keeps 20 |
| 2 | the same, twice the elements, on a rigid floor 16 times the penalty |
| on soil | cells and elements {all_cells:g} times as long, steps {all_steps:.2g} times, a quarter of the penalty |
| on a block, then | the run's own steps on those cells |
| on soil of fewer than three slices: 1, 2 | cells {cells:.2g} times as large, each time |
| 3, 4 | steps as above; twice the elements, four times the penalty |

A finer mesh shows the mesh's error whatever its order is, so bars hold where elements are far too long. Finer steps
would cost more than the run.

**On soil** a pipe is pressed into one [slice](../riser_soil/accuracy/fine_slice.py) of the run's cells as deep as the
riser settled, and by the same load into one of cells that resolve what touches, half of the run's at most. A
settlement's bar is {slice:g} times that change and, as squares add up, {at_rest:g} times the coarser run's
difference, in motion {in_motion:g}. Other bars are {by_slice:g} times that difference, up to
{most:g} times as much where the slice changes by more.

1. **Difference.** The root mean square of the differences in the extreme itself and in those of 16 windows of time in
   which the quantity comes within a fifth of its range to the extreme: two runs may agree in one extreme by chance.
2. **Order.** The difference over |fineness^−order − 1| is the error by Richardson's extrapolation. The order is 2 for
   elements and time steps, 1 for contact forces on a rigid floor (an end held on it bears what lies beside it), 1 for
   the soil's cells and ¾ for the penalty on soil. Where longer steps make a large difference, half way at {large:.0%}
   of the scale, the divisor falls to 1.
3. **Between samples.** What falls between nodes and between steps, by the parabola through three samples, is added to
   mesh and time; what rings from step to step to the time. Largest moments and curvatures are taken between nodes by
   a cubic of the elements' own order, and need no addition.
4. **Factor of safety.** {factors}; on soil
   {on_soil_factors}, and for a few slices of soil whose law depends on its path {on_path:g}.
5. **Sum.** Different sources add up as squares do. The smallest bar is {smallest:g} of the quantity's scale
   ([key_results.py](../riser_soil/variants/key_results.py)), on soil {smallest_on_soil:g}.

The code: [error_bars.py](../riser_soil/accuracy/error_bars.py), [chain.py](../riser_soil/accuracy/chain.py).

## How often they are right

The factors are chosen over {scenes} scenes of known answers, the calibration, such that its static and dynamic stages
each hold 95 %. {drawn} of the scenes are [random risers](../benchmarks/error_bars/random_risers.py): steel and
flexible pipes in 12 to 2000 m of water, hanging or laid on a rigid floor, springs or hysteretic clay, level and
sloping, half of them moving. {out_scenes} more risers of the
same generator, {each} on each ground, have chosen nothing: neither a factor nor a way to find a bar. They are out of
sample.

References ([references.py](../benchmarks/error_bars/references.py)) have 16 or 64 times the elements of static
scenes, and 16 times those of moving ones with a tenth of the step; a quarter as many show how uncertain they are.
Quantities are excluded whose reference is too uncertain to tell on which side of its bar the error lies. The first
median of bar over true error excludes errors that the reference does not give to {certain:.0%}, and those below
{smallest:g} of the scale. No quantity is dropped because of the size of its bar, as that would favour wide bars. The
second median is of all errors.

<!-- {out_block} -->
{out_figures}
<!-- end of {out_block} -->

<!-- {figures_block} -->
{figures}
<!-- end of {figures_block} -->

[Random scenes on soil](../benchmarks/error_bars/random_soils.py): risers laid on sections and blocks, heaved, pipes
pressed in; elastic, plastic and cyclic. References have cells of a quarter or a third of the size, and more load steps.
Both halves of the first seed have chosen the way and its factors; those out of sample, of another seed, nothing.

<!-- {soil_block} -->
{on_soil}
<!-- end of {soil_block} -->

With all factors of safety smaller or larger:

{factors_tried}

## By quantity, ground and stage

{kinds}

Scene by scene in the calibration: [error_bars_scenes.csv](error_bars_scenes.csv). Bars that were missed, in either:
[error_bars_missed.csv](error_bars_missed.csv).

## Limits

- Bars do not cover what is not varied: the model itself, a block of soil that is too small, a pipe with wrong
  properties.
- They are least reliable where a sudden load excites all modes; where longer steps resolve nothing they are far too
  wide more often than too narrow.
- The width on which a pipe touches soil grows cell by cell, so errors fall in jumps, by which two meshes may agree by
  chance, in the touchdown point above all.

`python -m benchmarks.error_bars --references` computes the references anew, which takes long.
"""

Kind = Callable[[Judged], str]


def page(calibration: list[JudgedScene], out: list[JudgedScene], on_soil: str) -> str:
    return TEXT.format(
        soil_block=SOIL_BLOCK,
        on_soil=on_soil,
        version=__version__,
        date=datetime.date.today().isoformat(),
        python=platform.python_version(),
        cores=os.cpu_count(),
        factors=_in_words(SAFETY),
        on_soil_factors=_in_words(ON_SOIL),
        on_path=ON_PATH["soil"],
        all_cells=1.0 / ALL_COARSER.factors["soil_mesh"],
        all_steps=1.0 / ALL_COARSER.factors["time_step"],
        slice=SLICE,
        at_rest=AT_REST,
        in_motion=IN_MOTION,
        by_slice=BY_SLICE["soil"],
        most=MOST_ENLARGED,
        smallest_on_soil=SMALLEST_ON_SOIL,
        cells=1.0 / COARSER_SOIL.factors["soil_mesh"],
        large=LARGE["time"],
        smallest=SMALLEST,
        certain=CERTAIN,
        scenes=len(calibration),
        drawn=sum(scene.name not in SCENES for scene in calibration),
        each=len(OUT_OF_SAMPLE) // len(GROUNDS),
        figures_block=FIGURES,
        figures=_figures(calibration, "in the calibration", CALIBRATION),
        kinds=_by_kind(out, calibration),
        out_scenes=len(out),
        out_block=OUT,
        out_figures=_figures(out, "out of sample", OUT_OF_SAMPLE),
        factors_tried=_with_other_factors(_all(calibration), _all(out)),
    )


def _in_words(factors: Mapping[str, float]) -> str:
    return ", ".join(f"{factor:g} for the {source}" for source, factor in factors.items())


def publish_on_soil(block: str) -> None:
    """Write the page's block on soil alone."""
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), {SOIL_BLOCK: block}), encoding="utf-8")


def publish(calibration: list[JudgedScene], out: list[JudgedScene], on_soil: str) -> None:
    """Write the page, and beside it the calibration scene by scene, and all bars that were missed."""
    PAGE.write_text(page(calibration, out, on_soil), encoding="utf-8")
    head = ["scene", "inside", "bar over true error, median", "coarser runs over scene"]
    EVERY_SCENE.write_text(csv_table(head, map(_row, calibration)), encoding="utf-8")
    EVERY_MISSED.write_text(csv_table(MISSED, _missed([*out, *calibration])), encoding="utf-8")


def _figures(scenes: list[JudgedScene], where: str, of: Iterable[str]) -> str:
    judged, seconds = _all(scenes), [sum(scene.seconds[n] for scene in scenes) for n in (0, 1)]
    bars, ratio = decided(judged), ratios(judged)
    rows = [
        ["scenes, key results judged", f"{len(scenes)}, {len(bars)}"],
        ["true error inside its bar", f"{share_inside(judged):.1%}"],
        [f"bar over true error, median, of the {len(ratio)} errors above {SMALLEST:g}", f"{median(ratio):.2f}"],
        [OF_ALL_ERRORS, f"{median(ratios(judged, math.inf)):.2f}"],
        ["not computed", _failed(scenes, of)],
        ["excluded, as the reference does not decide", str(len(judged) - len(bars))],
        ["bars not given, as a coarser run failed", str(sum(len(scene.not_known) for scene in scenes))],
        ["coarser runs' processor time over the scenes', without start-up",
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
        counts = (
            text for judged in both for text in (f"{share_inside(judged):.1%}", f"{median(ratios(judged)):.2f}")
        )
        rows.append([f"{factor:g}", *counts])
    return table(["times", "inside, in the calibration", "median", "inside, out of sample", "median"], rows)


def _scaled(each: Judged, factor: float) -> Judged:
    whole = factor * math.hypot(*each.bar.by_source.values()) + SMALLEST * each.bar.key_result.scale
    return replace(each, bar=replace(each.bar, bar=whole))


def _by_kind(out: list[JudgedScene], calibration: list[JudgedScene]) -> str:
    """Share inside and median ratio by quantity, ground and stage, each in the order of their names."""
    head = ["", "judged, out of sample", "inside", "bar over true error, median"]
    kinds: tuple[Kind, ...] = (lambda each: each.bar.key_result.name, _ground, _stage)
    rows = [row for kind in kinds for row in _rows_of_kind(out, calibration, kind)]
    return table([*head, "judged, in the calibration", "inside", "median"], rows)


def _rows_of_kind(out: list[JudgedScene], calibration: list[JudgedScene], kind: Kind) -> list[list[str]]:
    by_kind: list[dict[str, list[Judged]]] = [{}, {}]
    for groups, scenes in zip(by_kind, (out, calibration), strict=True):
        for each in decided(_all(scenes)):
            groups.setdefault(kind(each), []).append(each)
    names = sorted(by_kind[0].keys() | by_kind[1].keys())
    return [[name, *(cell for groups in by_kind for cell in _cells(groups.get(name)))] for name in names]


def _cells(own: list[Judged] | None) -> list[str]:
    return ["", "", ""] if own is None else [str(len(own)), f"{share_inside(own):.1%}", _median(own)]


def _ground(each: Judged) -> str:
    mapping = ALL[each.scene]
    if "soil" in mapping:
        return "block of soil"
    seabed = mapping.get("seabed")
    if seabed is None:
        return "no ground"
    return str(seabed["law"]["kind"] if seabed["kind"] == "hysteretic" else seabed["kind"])


def _stage(each: Judged) -> str:
    kinds = {stage["name"]: stage["kind"] for stage in ALL[each.scene]["stages"]}
    return str(kinds[each.bar.key_result.stage])


def _all(scenes: Iterable[JudgedScene]) -> list[Judged]:
    return [each for scene in scenes for each in scene.judged]


def _median(judged: list[Judged]) -> str:
    values = ratios(judged)
    return f"{median(values):.2g}" if values else "all below the smallest bar"


def _row(scene: JudgedScene) -> list[str]:
    bars, (run_seconds, extra) = decided(scene.judged), scene.seconds
    inside = f"{sum(each.inside for each in bars)} of {len(bars)}"
    return [scene.name, inside, _median(bars), f"{extra / run_seconds:.0%}"]


def _missed(scenes: list[JudgedScene]) -> list[list[str]]:
    off = [each for each in decided(_all(scenes)) if not each.inside]
    return [[f"{each.scene}: {each.bar.key_result.key}", f"{each.error / (each.bar.bar or 1.0):.2f}"] for each in off]
