"""Case 3.1: the riser at rest beside the published values, by two paths, and in surge; tables and pictures.

Usage, in the project's folder: python -m demos.catenary.run [--results FOLDER] [--page]
Leaves runs, tables (*.md) and pictures in `results` beside this file; --page writes them where README.md shows them.
"""

from __future__ import annotations

from pathlib import Path

from demos.catenary.statics import COARSE, FINE, HERE, SCENE, WEIGHTS, hanging, paths_page, table1_page
from demos.compute import compute
from demos.page import publish, script
from riser_soil.plots.curves import along_arc, end_reactions, save, shapes, sheet
from riser_soil.results import Run

PAGE, PICTURES = HERE / "README.md", HERE.parents[1] / "docs"
RESOLVED = (
    "riser.segments.0.elements=140",
    "stages.1.time_step=0.05",
    "output.interval=0.05",
    "output.xdmf_interval=1.0",
)


def main(results: Path, page: bool) -> None:
    results.mkdir(parents=True, exist_ok=True)
    tables = {"table1": table1_page(results), "paths": paths_page(results)}
    publish(tables, results, PAGE if page else None)
    pictures = PICTURES if page else results
    surging = {
        f"{weight} N/m": compute(SCENE, results / f"surge_{weight}", *RESOLVED, *overrides)
        for weight, overrides in WEIGHTS.items()
    }
    draw_rest(results, pictures / "catenary_rest.png")
    draw_surge(surging, pictures / "catenary_surge.png")
    print(f"\ntables and runs are in {results}, catenary_rest.png and catenary_surge.png in {pictures}")


def draw_rest(results: Path, png: Path) -> None:
    """Shape and bending moment at rest with the implied weight (the paper's figures 1 and 2)."""
    figure, (left, right) = sheet(1, 2, height=4.0)
    fine = hanging(results, FINE, "364.2")
    shapes(left, fine, at=[0], labels=["at rest"])
    along_arc(right, fine, "bending_moment", at=0, label=f"{FINE} elements")
    dots = {"linestyle": "", "marker": "o", "markersize": 3}
    along_arc(right, hanging(results, COARSE, "364.2"), "bending_moment", at=0, label=f"{COARSE} elements", **dots)
    save(figure, png)


def draw_surge(runs: dict[str, Run], png: Path) -> None:
    """Reactions in time for both weights (the paper's figure 3)."""
    figure, panels = sheet(2, 2)
    end_reactions(panels, runs)
    save(figure, png)


if __name__ == "__main__":
    script(main, __doc__, HERE)
