"""A riser that touches down in a trench, beside the same riser on level soil.

Usage, in the project's folder: python -m demos.trench.run [--results FOLDER] [--page]
Leaves both runs, a table (trench.md) and a picture in `results` beside this file; --page writes them where README.md
shows them.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from demos.compute import compute
from demos.figures import shown
from demos.page import fill_pages, publish, script, table
from riser_soil.core.arrays import Array
from riser_soil.plots.curves import save, sheet
from riser_soil.results import Run

HERE = Path(__file__).parent
SCENE, PAGE, PICTURES = HERE / "scene.yaml", HERE / "README.md", HERE.parents[1] / "docs"
LEVEL = "soil.block.trench=null"
EDGE, FLOOR = (8.0, 16.0), (18.0, 23.0)  # m along the riser, around where it goes down and where the floor begins


def main(results: Path, page: bool) -> None:
    runs = {"trench": compute(SCENE, results / "trench"), "level soil": compute(SCENE, results / "level", LEVEL)}
    publish({"trench": comparison(runs)}, results, PAGE if page else None)
    texts = {**edges(runs["trench"]), **effort(runs)}
    print(shown(texts))
    if page:
        fill_pages(texts)
    pictures = PICTURES if page else results
    draw(pictures / "trench.png", runs)
    print(f"\nthe runs and the table are in {results}, the picture in {pictures}")


def comparison(runs: dict[str, Run]) -> str:
    """Both runs at the end of their static stage, and the ranges while the floater moves."""
    tables = [rows(run.summary["stages"]) for run in runs.values()]
    return table(["", *runs], ([name, *(column[name] for column in tables)] for name in tables[0]))


def rows(stages: list[dict[str, Any]]) -> dict[str, str]:
    final, moment = stages[0]["final"], stages[0]["final"]["max_bending_moment"]
    values = {
        "at rest: touchdown arc length [m]": f"{final['touchdown_arc']:.2f}",
        "stretches that touch": f"{final['touchdown_points']:.0f}",
        "largest bending moment [kN m]": f"{moment['value'] / 1e3:.3f}",
        "at arc length [m]": f"{moment['arc']:.1f}",
        "contact force [kN]": f"{final['contact_force'] / 1e3:.2f}",
    }
    for stage in stages[1:]:
        touchdown, bent = (stage["extremes"][key] for key in ("touchdown_arc", "max_bending_moment"))
        values["in heave: touchdown arc length [m]"] = f"{touchdown['min']:.2f} to {touchdown['max']:.2f}"
        values["largest bending moment, in heave [kN m]"] = f"{bent['min'] / 1e3:.3f} to {bent['max'] / 1e3:.3f}"
    return values


def edges(run: Run) -> dict[str, str]:
    """At rest, what the trench's edge bears and bends the riser by, and the bend where its floor begins."""
    force, moment = at_rest(run, "contact_force"), abs(at_rest(run, "bending_moment"))
    edge, floor = ((run.arc > first) & (run.arc < last) for first, last in (EDGE, FLOOR))
    return {
        "edge force": f"{force[edge].max() / 1e3:.1f}",
        "edge moment": f"{moment[edge].max() / 1e3:.1f}",
        "floor moment": f"{moment[floor].max() / 1e3:.1f}",
    }


def effort(runs: dict[str, Run]) -> dict[str, str]:
    """Load steps and Newton iterations of both, and the energy balance in heave."""
    (laid, heave), (level, _) = (run.summary["stages"] for run in runs.values())
    energy = heave["energy"]
    return {
        "trench load steps": f"{laid['steps']}",
        "trench load iterations": f"{laid['newton_iterations'] / laid['steps']:.1f}",
        "level load steps": f"{level['steps']}",
        "level load iterations": f"{level['newton_iterations'] / level['steps']:.1f}",
        "heave iterations": f"{heave['newton_iterations'] / heave['steps']:.1f}",
        "heave most iterations": f"{heave['most_newton_iterations']}",
        "heave cuts": f"{heave['step_cuts']}",
        "heave residual": f"{100.0 * abs(energy['worst_residual']['value']) / energy['turned_over']:.2g}",
    }


def at_rest(run: Run, name: str) -> Array:
    """A series at the end of the static stage."""
    return run[name][0]


def draw(png: Path, runs: dict[str, Run]) -> None:
    """Height of the riser's underside, contact force and bending moment along it, at rest."""
    figure, axes = sheet(1, 3, width=14.0, height=4.2)
    for name, run in runs.items():
        near = run.arc <= 45.0
        heights = at_rest(run, "position")[:, 2] - 0.15
        curves = (heights, at_rest(run, "contact_force"), at_rest(run, "bending_moment") / 1e3)
        for axis, values in zip(axes, curves, strict=True):
            axis.plot(run.arc[near], values[near], label=name)
    axes[0].set(ylabel="height of the underside [m]", ylim=(-0.4, 1.0))
    axes[1].set(ylabel="contact force [N/m]")
    axes[2].set(ylabel="bending moment [kN m]")
    for axis in axes:
        axis.set(xlabel="arc length [m]")
        axis.legend()
    save(figure, png)


if __name__ == "__main__":
    script(main, __doc__, HERE)
