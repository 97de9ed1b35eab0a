"""A storm digs a trench under a steel riser, and comes once more: depth of the trench, and fatigue of both storms.

Usage, in the project's folder: python -m demos.dug_trench.run [--results FOLDER] [--page]
Leaves the runs, their tables and a picture in `results` beside this file; --page writes them where README.md shows
them. A run that is finished there is not made again. All is computed twice: on the scenes' cells and steps, and, for
the error bars, on cells twice as wide and long with steps twice as long.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from demos.compute import compute
from demos.page import publish, script, table
from riser_soil.core.arrays import Array
from riser_soil.fatigue.assessment import YearlyDamage, assess
from riser_soil.fatigue.damage import YEAR
from riser_soil.fatigue.fatigue_file import DNVCurve, Fatigue, FatigueCase
from riser_soil.plots.curves import save, sheet
from riser_soil.results import Run

HERE = Path(__file__).parent
PAGE, PICTURES = HERE / "README.md", HERE.parents[1] / "docs"
SCENES = {"laid": HERE / "hang.yaml", "first": HERE / "storm.yaml", "second": HERE / "storm.yaml"}
COARSER = (
    "soil.mesh.size_at_riser={along: 5.0, across: 0.054, strip: 0.38}",
    "soil.mesh.size_far=2.4",
    "stages.0.time_step=0.4",
)
SKIP = 40.0  # s, in which waves and motion grow, and the riser settles into them
HOUR = 3600.0  # s
ZONE = (150.0, 300.0)  # m along the riser
STRETCHES = ((190.0, 200.0), (200.0, 210.0), (210.0, 220.0))  # m
SHOWN = (180.0, 250.0)


@dataclass(frozen=True)
class Storms:
    """The riser as laid, and the same storm twice over it."""

    runs: Mapping[str, Run]

    @cached_property
    def damage(self) -> YearlyDamage:
        """Damage by each storm, as if it blew all year."""
        storms = (str(self.runs[name].folder.resolve()) for name in ("first", "second"))
        cases = tuple(FatigueCase(run=folder, stage="storm", share=0.5) for folder in storms)
        curve = DNVCurve(dnv="D", environment="cathodic-protection")
        given = Fatigue(curve=curve, stress_concentration=1.2, skip=SKIP, arcs=ZONE, cases=cases)
        return assess(HERE / "run.py", given)

    def per_hour(self, storm: int) -> Array:
        """Greatest damage around each section in an hour of the storm."""
        case = self.damage.cases[storm]
        return case.per_year.max(axis=1) / (case.case.share * YEAR / HOUR)

    def largest(self, storm: int) -> float:
        """Damage in an hour of a storm [1e-6]."""
        return 1e6 * float(self.per_hour(storm).max())

    def gain(self) -> float:
        """Largest damage of the second storm over that of the first."""
        return self.largest(1) / self.largest(0)

    def gains(self) -> tuple[float, float]:
        """Least and greatest of the same at one section, where the first does more than a tenth of its largest."""
        first, second = self.per_hour(0), self.per_hour(1)
        gains = (second / first)[first > 0.1 * first.max()]
        return float(gains.min()), float(gains.max())

    def trench(self, name: str) -> Array:
        """Settlement under the riser at the end of a run [m]."""
        return self.runs[name]["soil_settlement"][-1]

    def depth(self, name: str, *stretch: float) -> float:
        """Mean depth on a stretch of the riser at the end of a run, greatest of all without one [mm]."""
        settled, arc = 1e3 * self.trench(name), self.runs[name].arc
        if not stretch:
            return float(np.nanmax(settled))
        return float(np.nanmean(settled[(arc >= stretch[0]) & (arc <= stretch[1])]))

    def touchdown(self, name: str) -> float:
        return float(self.runs[name].summary["stages"][-1]["final"]["touchdown_arc"])


def computed(folder: Path, *overrides: str) -> Storms:
    """Runs of the three scenes, each beginning with the one before."""
    runs: dict[str, Run] = {}
    for name, scene in SCENES.items():
        place, before = folder / name, [f"initial.from={run.folder.resolve()}" for run in list(runs.values())[-1:]]
        given = [each for each in overrides if name != "laid" or not each.startswith("stages")]
        there = (place / "summary.json").exists() and Run(place).finished
        runs[name] = Run(place) if there else compute(scene, place, *before, *given)
    return Storms(runs)


def main(results: Path, page: bool) -> None:
    both = Both(computed(results), computed(results / "coarser", *COARSER))
    blocks = {"depth": depths(both), "fatigue": fatigue(both), **effort(both.fine)}
    publish(blocks, results, PAGE if page else None)
    pictures = PICTURES if page else results
    draw(pictures / "dug_trench.png", both.fine)
    print(f"\nthe runs and tables are in {results}, the picture in {pictures}")


@dataclass(frozen=True)
class Both:
    """Computed on the scenes' cells and steps, and on coarser ones."""

    fine: Storms
    coarse: Storms

    def shown(self, quantity: Callable[..., float], *of: Any, digits: int = 1) -> str:
        """What a method of Storms finds, with a bar: the change from coarser cells, for an error of first order."""
        value, coarser = quantity(self.fine, *of), quantity(self.coarse, *of)
        return f"{value:.{digits}f} ± {abs(value - coarser):.{digits}f}"


def effort(storms: Storms) -> dict[str, str]:
    """Newton iterations and cut steps of both storms, and the worst of their energy balances; the clay's heave."""
    first, second = (storms.runs[name].summary["stages"][0] for name in ("first", "second"))
    iterations = (stage["newton_iterations"] / stage["steps"] for stage in (first, second))
    worst = max(abs(s["energy"]["worst_residual"]["value"]) / s["energy"]["turned_over"] for s in (first, second))
    return {
        "dug heave": f"{-1e3 * float(np.nanmin(storms.runs['first']['settlement_across'][-1])):.0f}",
        "dug steps": f"{first['steps']:,}",
        "dug iterations": " and ".join(f"{each:.1f}" for each in iterations),
        "dug cuts": f"{first['step_cuts']} and {second['step_cuts']}",
        "dug residual": f"{100.0 * worst:.1g}",
    }


def depths(both: Both) -> str:
    """Depth of the trench under the riser in calm, and where the riser touches down."""
    rows = [["deepest [mm]", *(both.shown(Storms.depth, name) for name in SCENES)]]
    for low, high in STRETCHES:
        row = (both.shown(Storms.depth, name, low, high) for name in SCENES)
        rows.append([f"mean from {low:g} to {high:g} m [mm]", *row])
    row = (both.shown(Storms.touchdown, name, digits=2) for name in SCENES)
    rows.append(["touchdown arc length [m]", *row])
    return table(["under the riser, in calm", "laid", "after the first storm", "after the second"], rows)


def fatigue(both: Both) -> str:
    """Damage by both storms where it is largest; the second's over the first's, at all sections that matter."""
    rows, damage = [], both.fine.damage
    for storm, text in enumerate(("first, on clay as laid", "second, in the trench")):
        largest = both.shown(Storms.largest, storm, digits=2)
        place = f"{damage.arc[both.fine.per_hour(storm).argmax()]:.0f}"
        rows.append([text, largest, place, f"{damage.cases[storm].scatter:.0%}"])
    rows.append(["second over first", both.shown(Storms.gain, digits=3), "", ""])
    rows.append(["the same, section by section", "{:.2f} to {:.2f}".format(*both.fine.gains()), "", ""])
    return table(["storm", "largest damage in an hour [1e-6]", "at arc length [m]", "scatter of its quarters"], rows)


def draw(png: Path, storms: Storms) -> None:
    """The trench along and across the riser, its growth, and damage along the riser."""
    figure, (along, across, time, damage) = sheet(2, 2, width=11.0, height=3.6)
    words = {"laid": "laid", "first": "after the first storm", "second": "after the second"}
    for name, text in words.items():
        run = storms.runs[name]
        along.plot(run.arc, -1e3 * storms.trench(name), label=text)
    for name in ("first", "second"):
        run = storms.runs[name]
        middle = run["settlement_across"].shape[1] // 2
        across.plot(run.dataset["offset"], -1e3 * run["settlement_across"][-1, middle], label=words[name])
        time.plot(run.time, 1e3 * np.nanmax(run["soil_settlement"], axis=1), label=f"{name} storm")
    for storm, text in enumerate(("first storm", "second storm")):
        damage.plot(storms.damage.arc, 1e6 * storms.per_hour(storm), label=text)
    along.set(xlabel="arc length [m]", ylabel="soil under the riser [mm]", xlim=SHOWN)
    across.set(xlabel="offset across the riser at 204 m [m]", ylabel="soil's surface [mm]")
    time.set(xlabel="time [s]", ylabel="deepest settlement [mm]")
    damage.set(xlabel="arc length [m]", ylabel="damage in an hour [1e-6]")
    for axis, place in ((along, "lower right"), (across, "lower left"), (time, "lower right"), (damage, "upper right")):
        axis.legend(loc=place)
    save(figure, png)


if __name__ == "__main__":
    script(main, __doc__, HERE)
