"""What each part of a scene costs, and that it costs nothing where a scene lacks it.

    python -m benchmarks.parts [--page docs/parts.md]

One riser, with more and more around it; each scene in a process of its own, its stages taken as a run takes them.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from benchmarks.speed_page import machine
from demos.page import filled, table

SCENE = Path(__file__).parent.parent / "demos" / "first_scene.yaml"
STEPS = 100  # of 0.1 s, in heave
SHARED, LOOP = ("matrix", "linear_solve"), "line solver"
PAGE = Path(__file__).parent.parent / "docs" / "parts.md"
Scene = dict[str, Any]


def hanging() -> Scene:
    """The first scene's riser, dry, between two points and at rest; nothing else."""
    from riser_soil.scene.document import parse

    scene: Scene = parse(SCENE.read_text(encoding="utf-8"), str(SCENE)).data
    del scene["water"], scene["seabed"]
    line = scene["line_types"]["flexible"]
    del line["drag"], line["added_mass"]
    scene["riser"]["segments"] = [{"line_type": "flexible", "length": 148.0, "elements": 100}]
    scene["riser"]["end"]["position"] = [80.0, 0.0, 110.0]
    scene["stages"] = scene["stages"][:1]
    return scene


def heaving(scene: Scene) -> None:
    motion = {"end": {"harmonic": {"amplitude": [0.0, 0.0, 1.5], "period": 10.0, "ramp": 10.0}}}
    stage = {"name": "heave", "kind": "dynamic", "duration": 0.1 * STEPS, "time_step": 0.1, "motion": motion}
    scene["stages"].append(stage)


def in_water(scene: Scene) -> None:
    scene["water"] = {"density": 1025.0}
    scene["line_types"]["flexible"] |= {"drag": {"normal": 1.1}, "added_mass": {"normal": 1.0}}


def in_waves(scene: Scene) -> None:
    scene["water"] |= {"surface_level": 112.0, "depth": 112.0, "waves": {"airy": {"height": 4.0, "period": 9.0}}}


def damped(scene: Scene) -> None:
    scene["line_types"]["flexible"]["damping"] = {"ratio": 0.01, "frequency": 0.1}


def on_springs(scene: Scene) -> None:
    scene["riser"]["end"]["position"] = [80.0, 0.0, 100.0]
    scene["seabed"] = {"kind": "spring", "stiffness": 1.0e5}


def rubbing(scene: Scene) -> None:
    scene["contact"] = scene.get("contact", {}) | {"friction": {"axial": 0.5}}


def on_cyclic_springs(scene: Scene) -> None:
    law = {"kind": "randolph-quiggin", "su": 2.0e3, "su_gradient": 1.5e3}
    scene["seabed"] = {"kind": "hysteretic", "law": law}


def in_space(scene: Scene) -> None:
    scene["line_types"]["flexible"]["GJ"] = 4.0e4
    scene["dimension"] = 3


def on_soil(scene: Scene) -> None:
    scene["soil"] = {
        "block": {"x": [20.0, 36.0], "y": [-2.0, 2.0], "depth": 2.0},
        "mesh": {"kind": "hex", "size_at_riser": 0.5, "size_far": 1.0},
        "law": {"kind": "linear-elastic", "E": 1.0e6, "nu": 0.45},
    }


def on_clay(scene: Scene) -> None:
    scene["soil"]["law"] = {"kind": "von-mises", "su": 2.0e3, "su_gradient": 1.5e3, "E_over_su": 300.0, "nu": 0.49}


Edit = Callable[[Scene], None]
#: Scenes by name, as the edits that lead to them.
SCENES: dict[str, tuple[Edit, ...]] = {
    "hanging, at rest": (),
    "hanging, heaved": (heaving,),
    "and damped": (heaving, damped),
    "in water": (heaving, in_water),
    "in waves": (heaving, in_water, in_waves),
    "on springs": (heaving, in_water, on_springs),
    "with friction": (heaving, in_water, on_springs, rubbing),
    "on cyclic clay springs": (heaving, in_water, on_springs, on_cyclic_springs),
    "on springs, in space": (heaving, in_water, on_springs, in_space),
    "on elastic soil, at rest": (in_water, on_springs, on_soil),
    "on elastic soil": (heaving, in_water, on_springs, on_soil),
    "on plastic clay": (heaving, in_water, on_springs, on_soil, on_clay),
}


@dataclass(frozen=True)
class Cost:
    """Cost of a scene: parts of its last stage, modules imported, unknowns and nonzeros of the last stage's matrix,
    largest resident memory [MB]; CPU seconds of the process until the stages begin; Newton iterations, and seconds by
    part, of the last stage.
    """

    parts: Sequence[str]
    modules: int
    unknowns: int
    nonzeros: int
    memory: float
    start: float
    iterations: int
    seconds: Mapping[str, float]


def mapping(name: str) -> Scene:
    """A scene by its name."""
    scene = hanging()
    for edit in SCENES[name]:
        edit(scene)
    return scene


def cost(name: str) -> Cost:
    """Cost of a scene, taken in a process of its own; taken twice, as the first compiles what is not yet there."""
    call = [sys.executable, "-m", "benchmarks.parts", "--scene", name]
    for _ in range(2):
        output = subprocess.run(call, check=True, capture_output=True, text=True).stdout
    return Cost(**json.loads(output.splitlines()[-1]))


def measured(name: str) -> Cost:
    """Cost of a scene, in this process."""
    from mpi4py import MPI

    from benchmarks.iteration_counter import IterationCounter
    from riser_soil.assembly import build
    from riser_soil.core.part import State
    from riser_soil.core.system import System, Timer
    from riser_soil.scene.reader import scene_from_mapping
    from riser_soil.stages import run_stage

    scene = scene_from_mapping(mapping(name))
    assembly = build(scene, MPI.COMM_SELF)
    start, before = time.process_time(), State.at_rest(0.0, assembly.size)
    for stage in scene.stages:
        clock, watch = Timer.new(), IterationCounter()
        before = run_stage(assembly, stage, before, watch, clock)
    system = System(MPI.COMM_SELF, assembly.begin(scene.stages[-1]), Timer.new())
    matrix = system.matrix.mat
    return Cost(
        parts=[part.name for part in system.model.parts],
        modules=len(sys.modules),
        unknowns=matrix.getSize()[0],
        nonzeros=int(matrix.getInfo()["nz_used"]),
        memory=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
        start=start,
        iterations=watch.iterations,
        seconds=dict(clock.seconds),
    )


def row(name: str, costs: Cost) -> list[str]:
    """A scene's row of the table."""
    per_iteration = {part: 1e6 * seconds / costs.iterations for part, seconds in costs.seconds.items()}
    by_part = ", ".join(f"{part} {per_iteration[part]:.0f}" for part in costs.parts if part in per_iteration)
    shared = sum(per_iteration.get(part, 0.0) for part in SHARED)
    loop = f"{per_iteration[LOOP]:.0f}" if LOOP in per_iteration else "–"
    figures = [f"{n:,}" for n in (costs.modules, costs.unknowns, costs.nonzeros)]
    return [name, *figures, f"{costs.memory:.0f}", f"{costs.start:.1f}", loop, by_part, f"{shared:.0f}"]


HEAD = (
    *("scene", "modules", "unknowns", "nonzeros", "MB", "start s"),
    *("µs an iteration: line solver", "by part", "matrix and solve"),
)


def tables() -> dict[str, str]:
    """Blocks of the page."""
    rows = [row(name, cost(name)) for name in SCENES]
    return {"parts": table(HEAD, rows), "parts made": f"Made by `python -m benchmarks.parts --page` on {machine()}."}


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.parts", description=__doc__)
    parser.add_argument("--scene", choices=SCENES, help="this scene alone, in this process; its cost as JSON")
    parser.add_argument("--page", action="store_true", help=f"write the table into {PAGE.name}, too")
    given = parser.parse_args()
    if given.scene:
        print(json.dumps(asdict(measured(given.scene))))
        return
    blocks = tables()
    print(*blocks.values(), sep="\n\n")
    if given.page:
        PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), blocks), encoding="utf-8")


if __name__ == "__main__":
    main()
