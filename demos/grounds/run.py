"""The riser of the touchdown demo on five grounds, from a rigid bed to a block of clay: figures, and what they cost.

Usage, in the project's folder: python -m demos.grounds.run [--results FOLDER] [--page]
FOLDER is by default `results` beside this file. --page writes the table into README.md.
"""

from __future__ import annotations

import math
from pathlib import Path

from demos.compute import compute, timed
from demos.figures import Texts
from demos.page import fill_pages, publish, script, table
from demos.touchdown_clay.run import SCENE
from riser_soil.results import Run

HERE = Path(__file__).parent
PAGE = HERE / "README.md"
CLAY = "law: {kind: randolph-quiggin, su: 2.0e3, su_gradient: 1.5e3}"
BED = "soil=null", "contact={}"
GROUNDS = {
    "rigid": (*BED, "seabed={kind: rigid}"),
    "springs": BED,
    "hysteretic": (*BED, f"seabed={{kind: hysteretic, {CLAY}}}"),
    "sections": ("soil.model=sections",),
    "block": (),
}
SHORT = "stages.1.duration=0.4"  # in which kernels are compiled, so that their seconds do not count
Found = dict[str, tuple[Run, float]]


def main(folder: Path, page: bool) -> None:
    results = runs(folder)
    publish({"grounds": figures(results)}, folder, PAGE if page else None)
    if page:
        fill_pages(sentences(results))


def runs(folder: Path) -> Found:
    """The runs by their grounds, and the processor time [s] of each."""
    results = dict[str, tuple[Run, float]]()
    for ground, overrides in GROUNDS.items():
        compute(SCENE, folder / "short", *overrides, SHORT)
        results[ground] = timed(SCENE, folder / ground, *overrides)
    return results


def figures(results: Found) -> str:
    """A row a ground: how deep the pipe lies at most, largest moment and touchdown point as laid and in motion."""
    rows = [row(ground, run, seconds) for ground, (run, seconds) in results.items()]
    head = "ground", "sinks in, laid [mm]", "in motion", "largest moment, laid [kN m]", "in motion"
    return table([*head, "touchdown arc, laid [m]", "in motion", "one core [s]"], rows)


def row(ground: str, run: Run, seconds: float) -> list[str]:
    """Figures of one run."""
    laid, motion = run.summary["stages"]
    ranges = motion["extremes"]
    deep = [1e3 * depth for depth in (laid["final"]["max_embedment"]["value"], ranges["max_embedment"]["max"])]
    moments = laid["final"]["max_bending_moment"]["value"], ranges["max_bending_moment"]["max"]
    arcs = laid["final"]["touchdown_arc"], *(ranges["touchdown_arc"][end] for end in ("min", "max"))
    return [
        ground,
        *(f"{each:.1f}" for each in deep),
        *(f"{1e-3 * each:.3f}" for each in moments),
        f"{arcs[0]:.2f}",
        f"{arcs[1]:.2f} to {arcs[2]:.2f}",
        f"{rounded(seconds):g}",
    ]


def sentences(results: Found) -> Texts:
    """Figures that pages tell: what sections differ by from the block, and the seconds of both."""
    (sections, cheap), (block, dear) = results["sections"], results["block"]
    (laid, moved), (its_laid, its_moved) = (run.summary["stages"] for run in (sections, block))
    settled, largest = "max_settlement", "max_bending_moment"
    return {
        "grounds settled laid": beside(laid["soil"][settled]["value"], its_laid["soil"][settled]["value"], 0),
        "grounds settled motion": beside(moved["soil"][settled]["value"], its_moved["soil"][settled]["value"], 0),
        "grounds moment": beside(moved["extremes"][largest]["max"], its_moved["extremes"][largest]["max"], 1),
        "grounds sections s": f"{rounded(cheap):g}",
        "grounds block s": f"{rounded(dear):g}",
    }


def beside(mine: float, its: float, digits: int) -> str:
    """Difference in per cent of a value from the block's."""
    return f"{100.0 * abs(mine / its - 1.0):.{digits}f}"


def rounded(seconds: float) -> float:
    """The number of two figures: what machines agree on, and no more."""
    return round(seconds, 1 - math.floor(math.log10(seconds)))


if __name__ == "__main__":
    script(main, __doc__, HERE)
