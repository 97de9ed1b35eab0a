"""The touchdown demo with half its cells' sizes, direction by direction, and half its steps: what that changes.

Usage, in the project's folder: python -m demos.touchdown_clay.convergence [--results FOLDER] [--page]
FOLDER is by default `results` beside this file; runs in its folder `halved` are taken as they are. All take about an
hour of one core. --page writes the table into README.md.
"""

from __future__ import annotations

from pathlib import Path

from demos.compute import compute
from demos.page import publish, script, table
from demos.touchdown_clay.run import HERE, PAGE, SCENE
from riser_soil.assembly.soil_sizes import with_sizes
from riser_soil.results import Run
from riser_soil.scene.reader import read_scene
from riser_soil.scene.soil import CellSizes, GeneratedMesh


def main(folder: Path, page: bool) -> None:
    ways = halved()
    runs = {name: run_in(folder / "halved" / f"{n}", *ways[name]) for n, name in enumerate(ways)}
    publish({"halved": changes(runs)}, folder, PAGE if page else None)


def run_in(folder: Path, *overrides: str) -> Run:
    """The run of the scene with these overrides."""
    return Run(folder) if Run.is_there(folder) else compute(SCENE, folder, *overrides)


def halved() -> dict[str, tuple[str, ...]]:
    """What is halved, with the overrides that do so; the first is the scene as it is."""
    scene = read_scene(SCENE)
    assert scene.soil is not None
    mesh = with_sizes(scene, scene.soil).mesh
    assert isinstance(mesh, GeneratedMesh)
    sizes = mesh.size_at_riser
    assert isinstance(sizes, CellSizes)
    shorter = mesh.model_copy(update={"size_at_riser": sizes.model_copy(update={"along": 0.5 * sizes.along})})
    narrow = {"size_at_riser": sizes.model_copy(update={"across": 0.5 * sizes.across}), "size_far": 0.5 * mesh.size_far}
    return {
        "as it is": (),
        "steps half as long": ("stages.1.time_step=0.1",),
        "cells half as long": (as_override(shorter),),
        "cells half as wide and high": (as_override(mesh.model_copy(update=narrow)),),
    }


def as_override(mesh: GeneratedMesh) -> str:
    """A mesh as --set takes it."""
    return f"soil.mesh={mesh.model_dump_json()}"


def changes(runs: dict[str, Run]) -> str:
    """A row a figure: its value, and what each refinement changes of it."""
    values = {name: figures(run) for name, run in runs.items()}
    first, *others = values
    rows = (
        [key, f"{value:.2f}", *(f"{100.0 * (values[name][key] / value - 1.0):+.1f} %" for name in others)]
        for key, value in values[first].items()
    )
    return table(["", *values], rows).replace("-0.0 %", "0.0 %").replace("+0.0 %", "0.0 %")


def figures(run: Run) -> dict[str, float]:
    """What the page's first table shows of a run, but the plastic strain."""
    static, motion = run.summary["stages"]
    ranges = motion["extremes"]
    return {
        "laid: settlement [mm]": 1e3 * static["soil"]["max_settlement"]["value"],
        "in motion": 1e3 * motion["soil"]["max_settlement"]["value"],
        "laid: largest moment [kN m]": 1e-3 * static["final"]["max_bending_moment"]["value"],
        "in motion, largest": 1e-3 * ranges["max_bending_moment"]["max"],
        "in motion, least of the largest": 1e-3 * ranges["max_bending_moment"]["min"],
        "laid: touchdown arc [m]": static["final"]["touchdown_arc"],
        "in motion, from": ranges["touchdown_arc"]["min"],
        "in motion, to": ranges["touchdown_arc"]["max"],
        "von Mises stress [kPa], in motion": 1e-3 * motion["soil"]["max_von_mises_stress"]["value"],
        "dissipated by the clay [J]": motion["energy"]["dissipated_by"]["soil_plasticity"],
    }


if __name__ == "__main__":
    script(main, __doc__, HERE)
