"""A steel catenary riser with its vessel near, mean and far: by its offset, by a stage that moves it, by hand.

Usage, in the project's folder: python -m demos.offsets.run [--results FOLDER] [--page]
Leaves runs and a table (offsets.md) in `results` beside this file; --page writes it where README.md and docs/cases.md
show it.
"""

from __future__ import annotations

from contextlib import redirect_stdout
from pathlib import Path
from typing import NamedTuple

from demos.offsets.by_hand import LaidCable, cable_of
from demos.page import fill_pages, publish, script, table
from riser_soil.accuracy.chosen_run import in_numbers, run_as_asked
from riser_soil.results import Run
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.scene import Scene

HERE = Path(__file__).parent
SCENE = HERE / "scene.yaml"
OFFSETS = {"near": -60.0, "mean": 0.0, "far": 60.0}  # m
HEAD = ("vessel", "top tension kN", "by hand", "touchdown arc m", "by hand", "moment at rest kN m", "by hand",
        "by `move` kN m", "in waves kN m", "by `move` kN m")  # fmt: skip


class Computed(NamedTuple):
    """At rest: top tension [N], arc length of the touchdown point [m], largest moment [N.m]; that in waves."""

    tension: float
    touchdown: float
    moment: float
    in_waves: float


def main(results: Path, write_page: bool) -> None:
    scene = read_scene(SCENE)
    cable = cable_of(scene)
    mean = cable.layback(cable.at_angle(12.0))
    hung, _ = in_numbers(scene)
    rows = []
    for name, offset in OFFSETS.items():
        result = computed(read_scene(SCENE, [f"vessel.offset.0={offset}"]), results / name)
        moved = computed(by_move(hung, offset), results / f"{name}_by_move")
        rows.append(_row(name, result, moved, cable, cable.at_layback(mean + offset)))
    blocks = {"offsets": table(HEAD, rows)}
    publish(blocks, results)
    if write_page:
        fill_pages(blocks)


def computed(scene: Scene, folder: Path) -> Computed:
    """What a run of the scene has at the end of its last static stage, and in its waves."""
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "said.txt").open("w", encoding="utf-8") as said, redirect_stdout(said):
        run_as_asked(scene, folder, force=True)
    *_, rest, waves = Run(folder).summary["stages"]
    final = rest["final"]
    tension, moment = final["end"]["effective_tension"], final["max_bending_moment"]["value"]
    return Computed(tension, final["touchdown_arc"], moment, waves["extremes"]["max_bending_moment"]["max"])


def by_move(hung: Scene, offset: float) -> Scene:
    """The scene, its hang-off found, with a stage that moves the end and a reference point where the vessel then is."""
    data = hung.model_dump(mode="json", by_alias=True)
    x, y, z = data["riser"]["end"]["position"]
    rest, waves = data["stages"]
    waves["motion"]["end"]["vessel"]["reference"][0] += offset
    tow = {"name": "tow", "kind": "static", "move": {"end": [x + offset, y, z]}}
    return scene_from_mapping(data | {"stages": [rest, tow, waves]})


def _row(name: str, result: Computed, moved: Computed, cable: LaidCable, H: float) -> list[str]:
    return [
        f"{name}, {OFFSETS[name]:+.0f} m",
        f"{1e-3 * result.tension:.1f}",
        f"{1e-3 * cable.top_tension(H):.1f}",
        f"{result.touchdown:.1f}",
        f"{cable.touchdown(H):.1f}",
        *(f"{1e-3 * moment:.2f}" for moment in (result.moment, cable.moment(H), moved.moment)),
        *(f"{1e-3 * moment:.2f}" for moment in (result.in_waves, moved.in_waves)),
    ]


if __name__ == "__main__":
    script(main, __doc__, HERE)
