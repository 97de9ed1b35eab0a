"""Case 3.2: the hose in the tank swings on a rigid floor, as in the paper, and on two soft ones; tables and pictures.

Usage, in the project's folder: python -m demos.tank.run [--results FOLDER] [--page]
Leaves runs, tables (*.md) and pictures in `results` beside this file; --page writes them where README.md shows them.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from demos.compute import compute
from demos.page import publish, script, table
from demos.tank.statics import HERE, at_rest_blocks
from demos.tank.swing import EXTREMES, NEAR_TOUCHDOWN, SCENE, SINCE, extremes
from riser_soil.core.arrays import Array
from riser_soil.plots.curves import envelope, save, sheet
from riser_soil.results import Run

PAGE, PICTURES = HERE / "README.md", HERE.parents[1] / "docs"
CLAY = "{kind: randolph-quiggin, su: 1000.0, su_gradient: 1000.0}"
SEABEDS: Mapping[str, tuple[str, ...]] = {
    "rigid": (),
    "springs": ("seabed={kind: spring, level: 0.0, contact_at: axis, stiffness: 1.0e4}", "contact={}"),
    "clay": (f"seabed={{kind: hysteretic, level: 0.0, contact_at: axis, law: {CLAY}}}", "contact={}"),
}


def main(results: Path, page: bool) -> None:
    results.mkdir(parents=True, exist_ok=True)
    runs = {name: compute(SCENE, results / name, *overrides) for name, overrides in SEABEDS.items()}
    blocks = at_rest_blocks(results) | {"seabeds": seabeds_page(runs)}
    publish(blocks, results, PAGE if page else None)
    pictures = PICTURES if page else results
    draw_tensions(runs["rigid"], pictures / "tank_tensions.png")
    draw_positions(runs["rigid"], pictures / "tank_positions.png")
    draw_seabeds(runs, pictures / "tank_seabeds.png")
    print(f"\ntables and runs are in {results}, the pictures in {pictures}")


def seabeds_page(runs: Mapping[str, Run]) -> str:
    """At rest, and extremes over the last four periods."""
    head = ["seabed", "touchdown at rest m", "sunk at rest mm", *(f"{name} {_unit(name)}" for name in EXTREMES)]
    return table([*head, "deepest mm", "energy left in the seabed J"], (_row(*each) for each in runs.items()))


def _row(name: str, run: Run) -> list[str]:
    rest, moved = run.summary["stages"]
    depth = -1e3 * float(run["position"][0, run.arc.size // 4, 2])
    deepest = -1e3 * float(run["position"][..., 2].min())
    lost = moved["energy"]["dissipated_by"]["seabed"]
    values = [f"{value:.2f}" for value in extremes(run).values()]
    return [name, f"{rest['final']['touchdown_arc']:.2f}", f"{depth:.2f}", *values, f"{deepest:.2f}", f"{lost:.2f}"]


def _unit(name: str) -> str:
    return {"M": "N.m", "touchdown": "m"}.get(name.split()[0], "N")


def draw_tensions(run: Run, png: Path) -> None:
    """Tension at top and bottom end in time (the paper's figure 5)."""
    figure, panels = sheet(1, 2, height=3.8)
    tension = 1e-3 * run["effective_tension"]
    for axes, node, words in zip(panels, (-1, 0), ("top", "bottom end"), strict=True):
        axes.plot(run.time, tension[:, node], linewidth=1.0)
        axes.set(xlabel="time [s]", ylabel=f"tension at the {words} [kN], + pulls")
    save(figure, png)


def draw_positions(run: Run, png: Path) -> None:
    """Position of a point near the touchdown zone in time (the paper's figure 6)."""
    figure, panels = sheet(1, 2, height=3.8)
    position = near_touchdown(run)
    for axes, column, words in zip(panels, (0, 2), ("x", "z, upwards"), strict=True):
        axes.plot(run.time, position[:, column], linewidth=1.0)
        axes.set(xlabel="time [s]", ylabel=f"{words}, at arc {NEAR_TOUCHDOWN:g} m [m]")
        axes.ticklabel_format(useOffset=False)
    save(figure, png)


def near_touchdown(run: Run) -> Array:
    """Position (nt, 3) [m] of the node next to that arc."""
    return run["position"][:, abs(run.arc - NEAR_TOUCHDOWN).argmin()]


def draw_seabeds(runs: Mapping[str, Run], png: Path) -> None:
    """Rigid floor, springs and clay: tensions, touchdown arc, moment envelope over the last four periods."""
    figure, (top, bottom, touchdown, moment) = sheet(2, 2, height=3.6)
    for name, run in runs.items():
        tension = 1e-3 * run["effective_tension"]
        for axes, q in ((top, tension[:, -1]), (bottom, tension[:, 0]), (touchdown, run["touchdown_arc"])):
            axes.plot(run.time, q, label=name, linewidth=0.9)
        envelope(moment, run, "bending_moment", SINCE, label=name)
    words = ("tension at the top [kN]", "tension at the bottom end [kN]", "arc of the touchdown point [m]")
    for axes, text in zip((top, bottom, touchdown), words, strict=True):
        axes.set(xlabel="time [s]", ylabel=text)
    moment.set_xlim(18.0, 32.0)
    top.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(runs), frameon=False)
    save(figure, png)


if __name__ == "__main__":
    script(main, __doc__, HERE)
