"""References of the calibration's scenes: each computed much finer in all its knobs, and half as fine to judge that.

`references.json` has them: by scene and headline quantity the value of the finer run, and its uncertainty by how far
the two are apart: a quarter of it, as halving what is coarse leaves a quarter of a second-order error; all of it on
soil, whose errors are of first order.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path

from mpi4py import MPI

from benchmarks.error_bars.scenes import SCENES, Mapping
from riser_soil.accuracy.chain import values_of
from riser_soil.accuracy.companions import peaks_of
from riser_soil.accuracy.error_bars import Values
from riser_soil.accuracy.knobs import knobs_of, varied
from riser_soil.scene.reader import scene_from_mapping

FILE = Path(__file__).with_name("references.json")
LEFT, LEFT_ON_SOIL = 0.25, 1.0  # of the change between the two, in the finer one
Levels = tuple[dict[str, float], dict[str, float]]
# A rigid floor's penalty is much finer: what an end that is held on the floor bears falls with its fourth root.
RIGID = (1.6e3, 5.12e4)
STATIC: Levels = ({"elements": 8, "penalty": RIGID[0]}, {"elements": 16, "penalty": RIGID[1]})
DYNAMIC: Levels = (
    {"elements": 2, "time_step": 4, "penalty": RIGID[0]},
    {"elements": 4, "time_step": 10, "penalty": RIGID[1]},
)
SOIL: Levels = ({"elements": 2, "penalty": 6, "soil_mesh": 2}, {"elements": 4, "penalty": 32, "soil_mesh": 4})
Reference = dict[str, tuple[float, float]]


def write(names: Iterable[str], scenes: dict[str, Mapping] = SCENES, file: Path = FILE) -> None:
    """Compute the references of some of the scenes anew; those of the others stay."""
    known = read(file) if file.exists() else {}
    for name in names:
        known[name] = reference(scenes[name])
        print(f"reference of {name}", flush=True)
        in_order = {each: known[each] for each in scenes if each in known}
        file.write_text(json.dumps(in_order, indent=0) + "\n", encoding="utf-8")


def read(file: Path = FILE) -> dict[str, Reference]:
    told = json.loads(file.read_text(encoding="utf-8"))
    return {name: {key: (value, off) for key, (value, off) in of_scene.items()} for name, of_scene in told.items()}


def reference(scene: Mapping) -> Reference:
    """Value and uncertainty of each headline quantity."""
    fine, finer = (_values(scene, level) for level in _levels(scene))
    left = LEFT_ON_SOIL if "soil" in scene else LEFT
    return {key: (finer[key], left * abs(finer[key] - fine[key])) for key in finer if key in fine}


def _levels(scene: Mapping) -> Levels:
    if "soil" in scene:
        return SOIL
    return DYNAMIC if any(stage["kind"] == "dynamic" for stage in scene["stages"]) else STATIC


def _values(scene: Mapping, level: dict[str, float]) -> Values:
    now = scene_from_mapping(scene)
    for knob in knobs_of(now):
        now = varied(now, knob, level[knob.name])
    return values_of(peaks_of(now, MPI.COMM_WORLD), "peaks")
