"""Figures that README.md and the pages in docs tell of quick scenes, from runs of these scenes.

Usage, in the project's folder: python -m demos.figures [FOLDER] [--page]
Runs that FOLDER has (by default build/figures) are taken as they are. --page writes the figures to their places in all
pages, with those that sentences take from tables; `make figures` does so afresh. Those of long scenes come from the
demos' own scripts.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from demos.from_tables import table_figures
from demos.page import ROOT, fill_pages, table
from riser_soil.results import Run

FIRST, STEEL = ROOT / "demos/first_scene.yaml", ROOT / "demos/steel_catenary.yaml"
EXPLAINED, TUTORIAL = ROOT / "docs/first_scene.md", ROOT / "docs/tutorial_riser.md"
QUICK = ("first ", "clay ", "steel ")  # how the names of their figures begin
NUMBERS = ("no", "one", "two", "three", "four")
Texts = dict[str, str]


def quick_figures(folder: Path) -> Texts:
    """All of them by their names; runs come to folder/results, where they are not there."""
    first, clay = run_in(folder, "first", FIRST), run_in(folder, "clay", clay_scene(folder))
    steel = run_in(folder, "steel_catenary", STEEL, "--error-bars")
    weight = matched(r"^  flexible .* (\S+) +\S+ +\S+$", command(folder, "check", str(FIRST)))[0]
    return {**of_first(first, float(weight)), **of_clay(clay), **of_steel(steel), **said_of_steel(folder)}


def run_in(folder: Path, name: str, scene: Path, *options: str) -> Run:
    """The run folder/results/name of a scene."""
    place = folder / "results" / name
    if not Run.is_there(place):
        command(folder, "run", str(scene), "-o", str(place), *options)
    return Run(place)


def command(folder: Path, *arguments: str) -> str:
    """What a command of riser-soil, called in the folder, prints."""
    call = [sys.executable, "-m", "riser_soil", *arguments]
    return subprocess.run(call, cwd=folder, check=True, stdout=subprocess.PIPE, text=True).stdout


def code(page: Path, begins: str) -> str:
    """The page's code block that begins with these words."""
    (text,) = re.findall(rf"^```\w+\n({re.escape(begins)}.*?)^```$", page.read_text("utf-8"), re.MULTILINE | re.DOTALL)
    return str(text)


def clay_scene(folder: Path) -> Path:
    """The first scene with the page's clay, at rest and for a step."""
    text = FIRST.read_text(encoding="utf-8") + code(EXPLAINED, "soil:")
    (folder / "clay.yaml").write_text(text.replace("duration: 20.0", "duration: 0.1"), encoding="utf-8")
    return folder / "clay.yaml"


def of_first(run: Run, weight: float) -> Texts:
    """Figures of demos/first_scene.yaml: what its stages give, and the check of the tension by hand, T = H + w h.

    weight: in water [N/m].
    """
    static, heave = run.summary["stages"]
    rows = [
        [name, f"{at_rest(static['final'], *path) * scale:.{digits}f}{unit}",
         " to ".join(f"{value * scale:.{digits}f}" for value in ends(heave["extremes"], *path)) + unit]
        for name, path, scale, digits, unit in ALONG
    ]  # fmt: skip
    end = static["final"]["end"]
    H, h = end["force"][0], end["position"][2] - run["position"][0, 0, 2]
    return {
        "first scene": table(["first scene", "static", "in 20 s of heave"], rows),
        "first weight": f"{weight:.4g}",
        **{"first H": f"{H / 1e3:.2f}", "first height": f"{h:.2f}", "first by hand": f"{(H + weight * h) / 1e3:.2f}"},
    }


ALONG: tuple[tuple[str, tuple[str, ...], float, int, str], ...] = (
    ("top tension", ("end", "effective_tension"), 1e-3, 2, " kN"),
    ("TDP, arc length", ("touchdown_arc",), 1.0, 2, " m"),
    ("largest bending moment", ("max_bending_moment",), 1e-3, 3, " kN m"),
)


def at_rest(final: Mapping[str, Any], *path: str) -> float:
    """A value at the end of a stage, whether it has a place or not."""
    value: Any = final
    for key in path:
        value = value[key]
    return float(value["value"] if isinstance(value, dict) else value)


def ends(extremes: Mapping[str, Any], *path: str) -> tuple[float, float]:
    """Least and largest value over a stage."""
    value: Any = extremes
    for key in path:
        value = value[key]
    return float(value["min"]), float(value["max"])


def of_clay(run: Run) -> Texts:
    """Figures of the first scene with clay instead of springs."""
    arc = run.summary["stages"][0]["final"]["touchdown_arc"]
    return {"clay cells": f"{len(run.soil_frame().cells):,}", "clay touchdown": f"{arc:.2f}"}


def of_steel(run: Run) -> Texts:
    """Figures of demos/steel_catenary.yaml, with error bars."""
    hung, (static, heave) = run.summary["hang_off"], run.summary["stages"]
    bars = {each["name"]: each["bar"] for each in run.summary["error_bars"]["quantities"] if each["stage"] == "heave"}
    final, extremes = static["final"], heave["extremes"]
    top, arc = ends(extremes, "end", "effective_tension"), ends(extremes, "touchdown_arc")
    moment, stress = ends(extremes, "max_bending_moment")[1], ends(extremes, "max_stress_utilisation")[1]
    apart = max(bars["least touchdown arc"], bars["largest touchdown arc"])
    rows = [
        ["top tension", f"{at_rest(final, 'end', 'effective_tension') / 1e3:.1f} kN",
         f"{top[0] / 1e3:.1f} to {top[1] / 1e3:.1f} ± {bars['top tension'] / 1e3:.1f} kN"],
        ["largest bending moment", f"{at_rest(final, 'max_bending_moment') / 1e3:.2f} kN m",
         f"up to {moment / 1e3:.2f} ± {bars['largest bending moment'] / 1e3:.2f} kN m"],
        ["TDP, arc length", f"{at_rest(final, 'touchdown_arc'):.2f} m",
         f"{arc[0]:.2f} to {arc[1]:.2f} ± {apart:.2f} m"],
        ["stress utilisation", f"{at_rest(final, 'max_stress_utilisation'):.3f}", f"up to {stress:.3f}"],
    ]  # fmt: skip
    return {
        "steel catenary": table(["steel catenary riser", "at rest", "in heave of 1 m, 12 s"], rows),
        "steel layback": f"{hung['value']:.1f}",
        "steel solves": NUMBERS[hung["static_solves"]],
    }


def said_of_steel(folder: Path) -> Texts:
    """What check, fatigue and modes print of it."""
    (folder / "fatigue.yaml").write_text(code(TUTORIAL, "curve:"), encoding="utf-8")
    checked = matched(r"effective tension (\S+) kN; H \+ sum of w h = (.*) kN", command(folder, "check", str(STEEL)))
    worn = matched(
        r"largest damage (\S+) a year, life (\S+) years, at arc (\S+) m, (\S+) degrees",
        command(folder, "fatigue", "fatigue.yaml", "--force"),
    )
    period = matched(r"^ +1 +\S+ +(\S+)", command(folder, "modes", str(STEEL), "--force", "--count", "1"))[0]
    return {
        "steel cable": checked[0],
        "steel by hand": checked[1].replace("*", "·"),
        **dict(zip(("steel damage", "steel damage arc", "steel damage angle"), (worn[0], *worn[2:]), strict=True)),
        "steel life": f"{float(worn[1]):.0f}",
        "steel period": f"{float(period):.1f}",
    }


def matched(pattern: str, text: str) -> tuple[str, ...]:
    """The groups of a pattern in a text that has it."""
    match = re.search(pattern, text, re.MULTILINE)
    assert match, f"{pattern} is not in {text}"
    return match.groups()


def shown(texts: Texts) -> str:
    """Names and texts for the screen."""
    return "\n".join(f"{name}:\n{text}" if "\n" in text else f"{name}: {text}" for name, text in texts.items())


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?", default=ROOT / "build/figures", help="folder of the runs")
    parser.add_argument("--page", action="store_true", help="write the figures to their places in the pages, too")
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    texts = {**quick_figures(given.folder.resolve()), **table_figures()}
    print(shown(texts))
    if given.page:
        fill_pages(texts)
