"""A lazy wave in ten minutes of storm: the riser's motion, its checks and its pictures.

Usage, in the project's folder: python -m demos.waves.run [--results FOLDER] [--page]
Leaves runs, tables (*.md) and pictures in `results` beside this file; --page writes them where README.md shows them.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from demos.compute import compute, timed
from demos.page import publish, script
from demos.waves.checks import at_rest, in_waves, page
from riser_soil.plots.curves import along_arc, end_reactions, end_tension, envelope, instants, save, shapes, sheet
from riser_soil.results import Run

HERE = Path(__file__).parent
SCENE, PAGE, PICTURES = HERE / "scene.yaml", HERE / "README.md", HERE.parents[1] / "docs"
STILL = ("water.waves=null", "water.current=null", "stages.1.motion=null", "stages.1.duration=0.2")
SINCE = 52.0  # s, twice the ramp of waves and vessel


def main(results: Path, write_page: bool) -> None:
    storm, seconds = timed(SCENE, results / "storm")
    still = compute(SCENE, results / "still", *STILL)
    checks = page([*at_rest(still), *in_waves(storm, SINCE)])
    publish({"checks": checks}, results, PAGE if write_page else None)
    pictures = PICTURES if write_page else results
    draw_shapes(storm, pictures / "waves_shapes.png")
    draw_forces(storm, pictures / "waves_forces.png")
    print(f"\nten minutes of storm took {seconds:.0f} s; runs are in {results}, the pictures in {pictures}")


def draw_shapes(run: Run, png: Path) -> None:
    """Shapes over the highest crest-to-crest motion of the turret, and the moment's envelope along the arc."""
    figure, (left, right) = sheet(1, 2, width=11.0, height=4.5)
    heave = np.where(run.time >= SINCE, run["position"][:, -1, 2], -np.inf)
    middle = float(run.time[heave.argmax()])
    shapes(left, run, at=instants(run, middle - 6.0, middle + 6.0, 5), linewidth=0.8)
    left.axhline(120.0, color="tab:blue", linewidth=0.5)
    envelope(right, run, "bending_moment", SINCE, label="range in the storm")
    along_arc(right, run, "bending_moment", at=0, label="at rest in the current", linewidth=0.8)
    save(figure, png)


def draw_forces(run: Run, png: Path) -> None:
    figure, panels = sheet(3, 2, width=11.0, height=2.9)
    end_reactions(panels[:4], {"storm": run})
    end_tension(panels[4], run)
    panels[5].plot(run.time, run["touchdown_arc"], linewidth=0.8)
    panels[5].set(xlabel="time [s]", ylabel="arc of the touchdown point [m]")
    save(figure, png)


if __name__ == "__main__":
    script(main, __doc__, HERE)
