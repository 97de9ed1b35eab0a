"""The page of accuracies asked, docs/asked_accuracy.md: what scenes reach, and what it costs, one by one."""

from __future__ import annotations

import datetime
import os
import platform
from collections.abc import Callable, Iterable
from pathlib import Path
from statistics import median

from benchmarks.asked_accuracy import random_soils
from benchmarks.asked_accuracy.asked import (
    AskedScene,
    HandCost,
    Outcome,
    costs,
    median_error,
    share_of_all,
    share_of_claims,
)
from benchmarks.asked_accuracy.true_errors import ACCURACY, CERTAIN, ON_SOIL
from benchmarks.error_bars.calibration import JudgedScene, share_inside
from demos.page import csv_table, table
from riser_soil import __version__

PAGE = Path("docs") / "asked_accuracy.md"
FIGURES = "asked accuracy"  # block of the page that others quote
DEAR = 2.0  # times the best by hand

TEXT = """# Accuracy asked: whether runs reach it, and what that costs

Written by `make asked`: riser-soil {version}, {date}, Python {python}, {cores} cores.

With `accuracy: {accuracy:g} %` in a scene the run chooses elements, time steps, soil mesh and penalty
([scenes](scenes/accuracy_asked.md#accuracy)). Here {count} scenes of the [error bars'
calibration](error_bars.md) ask for it, without the settings that they have there, so some become the same scene.
The true error of a key result is that
against its reference, over its scale. A scene reaches the accuracy if all its key results do; {left_out} of them,
whose reference is not certain to
{certain:g} %, are left out.

<!-- {block} -->
{figures}
<!-- end of {block} -->

The best by hand is the cheapest setting that truly reaches the accuracy, of elements and time steps 1/4 to 4 times as
fine as the calibration's and penalties 1 to 16 times as large. It is not
compared where none of these reaches it, or where more than a third of the key results are left out. Seconds are of
the processor, files included, without compilation.

Scene by scene, with settings and seconds: [asked_accuracy_scenes.csv](asked_accuracy_scenes.csv). Why some are not
reached, here and below, as the runs report it: [asked_accuracy_not_reached.csv](asked_accuracy_not_reached.csv).

## Scenes that have chosen no factor

{count_of_others} more scenes are drawn at random, always the same: the calibration's kinds in other spans, depths,
pipes, motions and seabeds.

{figures_of_others}

Scene by scene: [asked_accuracy_random.csv](asked_accuracy_random.csv).

## On soil

The calibration's {count_on_soil} scenes on soil, elastic and yielding, ask for {accuracy_on_soil:g} %; block and law
stay as they are. Key results whose reference is not certain to {certain_on_soil:g} % are left out.

{figures_on_soil}

Scene by scene: [asked_accuracy_on_soil.csv](asked_accuracy_on_soil.csv).

The [random scenes on soil](error_bars.md#how-often-they-are-right) ask for {accuracy_of_random:g} %:

{figures_of_random}

[Scene by scene](asked_accuracy_random_soil.csv), by `python -m benchmarks.asked_accuracy.random_soils`.

`python -m benchmarks.asked_accuracy --by-hand` looks for the best settings anew, `--references` computes the random
scenes' references anew; each takes some ten minutes.
"""


def page(
    scenes: list[AskedScene], others: list[AskedScene], judged: list[JudgedScene], soil: list[AskedScene]
) -> str:
    """scenes: the calibration's. others: those drawn at random. judged: their error bars. soil: scenes on soil."""
    return TEXT.format(
        version=__version__,
        date=datetime.date.today().isoformat(),
        python=platform.python_version(),
        cores=os.cpu_count(),
        accuracy=100.0 * ACCURACY,
        certain=100.0 * CERTAIN * ACCURACY,
        block=FIGURES,
        count=len(scenes),
        left_out=sum(each.errors.left_out for each in scenes if each.errors is not None),
        figures=_figures(scenes),
        count_of_others=len(others),
        figures_of_others=_figures_of_others(others, judged),
        count_on_soil=len(soil),
        accuracy_on_soil=100.0 * ON_SOIL,
        certain_on_soil=100.0 * CERTAIN * ON_SOIL,
        figures_on_soil=table(["on soil", ""], _shares(soil)),
        accuracy_of_random=100.0 * random_soils.ACCURACY,
        figures_of_random=random_soils.figures(),
    )


def publish(
    scenes: list[AskedScene], others: list[AskedScene], judged: list[JudgedScene], soil: list[AskedScene]
) -> None:
    """Write the page, and beside it what each scene reaches; arguments as of page."""
    PAGE.write_text(page(scenes, others, judged, soil), encoding="utf-8")
    missed = not_reached([*scenes, *others, *soil])
    tables = {"scenes": rows_page(scenes), "random": random_page(others, judged), "on_soil": soil_page(soil)}
    for name, text in {**tables, "not_reached": missed, "random_soil": random_soils.rows_page()}.items():
        PAGE.with_name(f"{PAGE.stem}_{name}.csv").write_text(text, encoding="utf-8")


def _figures(scenes: list[AskedScene]) -> str:
    compared = costs(scenes)
    chosen = [each.chosen / each.by_hand for each in compared]
    rows = [
        *_shares(scenes),
        ["processor time of the chosen setting's run over the best by hand, median", f"{median(chosen):.2f}"],
        [f"of it at most {DEAR:g} times the best by hand", f"{_share(chosen, lambda x: x <= DEAR):.0%}"],
        ["everything, search included, over the best by hand, median", f"{_everything(compared):.2f}"],
        ["scenes compared with the best by hand", str(len(compared))],
    ]
    return table(["accuracy asked", ""], rows)


def _shares(scenes: list[AskedScene]) -> list[list[str]]:
    unreached = sum(each.outcome is Outcome.REPORTED for each in scenes)
    return [
        ["scenes that truly reach what they ask, of those that claim it", f"{share_of_claims(scenes):.1%}"],
        [f"of all {len(scenes)} scenes ({unreached} say that they do not reach it)", f"{share_of_all(scenes):.1%}"],
        ["largest true error over the accuracy asked, median", f"{median_error(scenes):.2f}"],
    ]


def _share(values: list[float], kept: Callable[[float], bool]) -> float:
    return sum(map(kept, values)) / len(values)


def _everything(compared: list[HandCost]) -> float:
    return median(each.everything / each.by_hand for each in compared)


def rows_page(scenes: Iterable[AskedScene]) -> str:
    head = ["scene", "outcome", "true error", "setting", "its run s", "everything s", "by hand s", "over by hand"]
    return csv_table(head, [[*_reported(each), *_seconds(each.cost)] for each in scenes])


def _reported(each: AskedScene) -> list[str]:
    error = f"{each.errors.largest[0]:.2%}" if each.errors is not None else "no run"
    return [each.name, each.outcome.value, error, each.setting]


def _seconds(cost: HandCost | None) -> list[str]:
    if cost is None:
        return ["", "", "", "not compared"]
    return [
        *(f"{seconds:.2f}" for seconds in (cost.chosen, cost.everything, cost.by_hand)),
        f"{cost.chosen / cost.by_hand:.2f}",
    ]


def not_reached(scenes: Iterable[AskedScene]) -> str:
    rows = [[each.name, _why(each)] for each in scenes if each.outcome is not Outcome.REACHED]
    return csv_table(["scene", "reason"], rows)


def _why(each: AskedScene) -> str:
    if each.said or each.errors is None:
        return each.said
    error, key = each.errors.largest
    return f"missed, {error:.2%} in {key}"


def soil_page(scenes: Iterable[AskedScene]) -> str:
    """Table of scenes on soil, with the seconds of all runs taken for them, and how many quantities could not be
    judged.
    """
    head = ["scene", "outcome", "true error", "setting", "everything s", "not judged"]
    return csv_table(head, [[*_reported(each), f"{each.seconds:.1f}", _left_out(each)] for each in scenes])


def _left_out(each: AskedScene) -> str:
    errors = each.errors
    return "" if errors is None else f"{errors.left_out} of {errors.left_out + len(errors.by_key)}"


def _figures_of_others(others: list[AskedScene], judged: list[JudgedScene]) -> str:
    bars = [each for scene in judged for each in scene.judged]
    inside = f"{share_inside(bars):.1%} of {sum(each.decided for each in bars)}"
    return table(["random scenes", ""], [["true error inside its error bar", inside], *_shares(others)])


def random_page(others: list[AskedScene], judged: list[JudgedScene]) -> str:
    inside = {scene.name: [each.inside for each in scene.judged if each.decided] for scene in judged}
    rows = [[*_reported(each), f"{sum(inside[each.name])} of {len(inside[each.name])}"] for each in others]
    return csv_table(["scene", "outcome", "true error", "setting", "error bars inside"], rows)
