"""References of the calibration's scenes: each computed much finer in all its settings, and half-way there to judge
that.

The static stages that a scene begins with are computed alone, with 16 and 64 times the elements, on a rigid floor with
8 and 32 times. With dynamic ones it is computed with 4 and 16 times the elements and steps of a quarter and a tenth.
The penalty of a rigid floor grows by the fourth power of the elements: the length in which a riser sinks in beside an
end, (4 EI/k)^(1/4), falls with their length.

On soil cells are half and a quarter of the size, where that is dear two thirds and a third; along the riser, where they
matter less, not quite that short. Load steps are two and four times as many.

`references.json` has them: by scene and key result the value of the finer run, and its uncertainty by how far
the two are apart: a third of it, as that is left of a first-order error on elements of a quarter of the length; all of
it on soil. A quantity that one of the two lacks, as where it fails, has none.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path

from mpi4py import MPI

from benchmarks.error_bars.scenes import Mapping
from riser_soil.accuracy.chain import values_of
from riser_soil.accuracy.error_bars import Values
from riser_soil.accuracy.search import first_statics
from riser_soil.assembly import build, sized
from riser_soil.errors import MemoryShortageError, MeshError, SolveError
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.scene.soil import CellSizes, GeneratedMesh
from riser_soil.scene.stages import DynamicStage
from riser_soil.stages import LAID_IN
from riser_soil.variants.peaks import peaks_of
from riser_soil.variants.settings import refined, settings_of

FILE, ON_SOIL = (Path(__file__).with_name(f"references{more}.json") for more in ("", "_on_soil"))
LEFT, LEFT_ON_SOIL = 1.0 / 3.0, 1.0  # of the change between the two, in the finer one
Level = dict[str, float]  # of fineness, by setting; along: of cells along the riser; load_steps: how many
SOIL: list[Level] = [
    {"elements": 2, "penalty": 6, "soil_mesh": 2, "along": 2**0.5, "load_steps": 2 * LAID_IN},
    {"elements": 4, "penalty": 32, "soil_mesh": 4, "along": 2, "load_steps": 4 * LAID_IN},
]
DEAR: list[Level] = [
    {"elements": 2, "penalty": 4, "soil_mesh": 1.5, "along": 1.25, "load_steps": 1.5 * LAID_IN, "time_step": 1.5},
    {"elements": 3, "penalty": 16, "soil_mesh": 3, "along": 1.5, "load_steps": 3 * LAID_IN, "time_step": 2},
]
CHEAP = 3000  # unknowns of clay that a riser is laid on; three times that of elastic soil
PRESSED = 2  # times as many load steps of a pipe that is pressed in
STATIC: list[Level] = [{"elements": n} for n in (16, 64)]
RIGID: list[Level] = [{"elements": n, "penalty": n**4} for n in (8, 32)]
DYNAMIC: list[Level] = [{"elements": n, "penalty": n**4, "time_step": t} for n, t in ((4, 4), (16, 10))]
Reference = dict[str, tuple[float, float]]


def write(names: Iterable[str], scenes: dict[str, Mapping], file: Path = FILE) -> None:
    """Compute the references of some of the scenes anew; those of the others stay."""
    known = read(file) if file.exists() else {}
    for name in names:
        known[name] = reference(scenes[name])
        print(f"reference of {name}", flush=True)
        in_order = {each: known[each] for each in scenes if each in known}
        file.write_text(_text(in_order), encoding="utf-8")


def _text(references: dict[str, Reference]) -> str:
    """A line a scene."""
    return "{\n" + ",\n".join(f"{json.dumps(name)}: {json.dumps(each)}" for name, each in references.items()) + "\n}\n"


def read(file: Path = FILE) -> dict[str, Reference]:
    data = json.loads(file.read_text(encoding="utf-8"))
    return {name: {key: (value, off) for key, (value, off) in of_scene.items()} for name, of_scene in data.items()}


def reference(mapping: Mapping) -> Reference:
    """Value and uncertainty of each key result."""
    scene = scene_from_mapping(mapping)
    if scene.soil is not None:
        return _of_two(scene, DEAR if _is_dear(scene) else SOIL, LEFT_ON_SOIL)
    statics, reference_values = first_statics(scene), dict[str, tuple[float, float]]()
    if len(statics) < len(scene.stages):
        reference_values = _of_two(scene, DYNAMIC)
    if statics:
        rigid = any(setting.name == "penalty" for setting in settings_of(scene))
        reference_values |= _of_two(scene.model_copy(update={"stages": statics}), RIGID if rigid else STATIC)
    return reference_values


def _of_two(scene: Scene, levels: list[Level], left: float = LEFT) -> Reference:
    half_way, fine = (_values(scene, level) for level in levels)
    return {key: (fine[key], left * abs(fine[key] - half_way[key])) for key in fine if key in half_way}


def _is_dear(scene: Scene) -> bool:
    """Whether finer cells cost too much: in blocks that yield or that a riser is laid on, in motion, and of many
    unknowns.
    """
    yields, moves = scene.has_path_dependent_soil, any(isinstance(stage, DynamicStage) for stage in scene.stages)
    soil = build(sized(scene), MPI.COMM_WORLD).soil
    assert scene.soil is not None
    assert soil is not None
    in_block = scene.soil.model == "block" and (yields or _is_laid(scene))
    return moves or in_block or soil.whole.field.size > (CHEAP if yields else 3 * CHEAP)


def _is_laid(scene: Scene) -> bool:
    """Whether a riser comes down on the soil; else a length of pipe is pressed into it."""
    return scene.line.initial != "straight"


def _values(scene: Scene, level: Level) -> Values:
    scene = refined(scene, level)
    if scene.soil is not None:
        scene = _loaded_in(_along(scene, level), level["load_steps"])
    try:
        return values_of(peaks_of(scene, MPI.COMM_WORLD), "peaks")
    except (SolveError, MeshError, MemoryShortageError) as err:
        print(f"  no reference with {level}: {str(err).partition(chr(10))[0]}", flush=True)
        return {}


def _along(scene: Scene, level: Level) -> Scene:
    """The scene with cells along the riser that are finer than at first by less than across it."""
    soil = scene.soil
    assert soil is not None
    assert isinstance(soil.mesh, GeneratedMesh)
    at = soil.mesh.size_at_riser
    if not isinstance(at, CellSizes):
        return scene
    longer = at.model_copy(update={"along": at.along * level["soil_mesh"] / level["along"]})
    mesh = soil.mesh.model_copy(update={"size_at_riser": longer})
    return scene.model_copy(update={"soil": soil.model_copy(update={"mesh": mesh})})


def _loaded_in(scene: Scene, steps: float) -> Scene:
    count = round(steps if _is_laid(scene) else PRESSED * steps)
    return scene.model_copy(update={"solver": scene.solver.model_copy(update={"load_steps": count})})
