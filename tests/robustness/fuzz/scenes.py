"""Small good scenes, each with the files that it names: what the mutations begin with.

They have every section of the language between them. Stages are cut to a few steps and risers to some ten elements, so
that a scene which is still good after its mutation takes a second.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from riser_soil.scene.document import parse
from tests.support.bad_scenes import GOOD
from tests.support.scenes import IN_WAVES, LAY, dynamic, heave, in_waves, prescribed, riser_scene, static, touchdown

ROOT = Path(__file__).parents[3]
WRITTEN = (
    "demos/first_scene.yaml",
    "demos/catenary/scene.yaml",
    "demos/catenary/three_stages.yaml",
    "demos/tank/at_rest.yaml",
    "demos/tank/scene.yaml",
    "demos/touchdown_clay/scene.yaml",
    "demos/waves/scene.yaml",
    "tests/scenes/bend45.yaml",
    "tests/scenes/catenary-three-stages.yaml",
    "tests/scenes/hysteretic.yaml",
    "tests/scenes/touchdown_on_block.yaml",
)
STEPS, MOST_ELEMENTS = 3, 12
TABLE = "t [s], x [m], y [m], z [m], rx [deg]\n" + "".join(f"{0.1 * n:.1f}, 0, 0, {0.01 * n}, 0\n" for n in range(9))

Mapping = dict[str, Any]


@dataclass(frozen=True)
class Base:
    """A scene as data, and the text of the files that it names."""

    data: Mapping
    files: dict[str, bytes]


@cache
def bases() -> tuple[Base, ...]:
    """All scenes, cut short."""
    written = [Base(read(ROOT / name), _beside(ROOT / name)) for name in WRITTEN]
    files = {"motion.csv": TABLE.encode(), "block.msh": BOX.encode()}
    return tuple(Base(_short(base.data), base.files) for base in [*written, *(Base(s, files) for s in _others())])


def read(file: Path) -> Mapping:
    data: Mapping = parse(file.read_text(encoding="utf-8"), file.name).data
    return data


def _beside(file: Path) -> dict[str, bytes]:
    return {other.name: other.read_bytes() for other in file.parent.glob("*.csv")}


def _others() -> Iterator[Mapping]:
    """What the written scenes lack: tables, rotations, attachments, seabeds' laws, soil of tetrahedra and of a file."""
    yield parse(GOOD, "good").data
    yield touchdown(LAY, heave(0.2))
    yield touchdown(LAY, kind="tet")
    yield _with(touchdown(LAY), soil={**touchdown()["soil"], "mesh": {"file": "block.msh"}, "block": None})
    yield in_waves(0.1, 22.0)
    yield _with(_dry(LAY, heave(0.2)), **_laden())
    yield _dry(LAY, dynamic(0.3, 0.1, motion={"end": {"table": "motion.csv"}}))
    yield _dry(LAY, heave(0.3) | {"time_step": "auto"})
    law = {"kind": "aubeny-biscontin", "su": 2.0e3, "su_gradient": 1.5e3}
    yield _with(_dry(LAY, heave(0.2)), seabed={"kind": "hysteretic", "law": law, "slope_deg": 2.0})
    yield _with(_dry(LAY), seabed={"kind": "rigid", "profile": [[-9.0, 0.0], [9.0, 0.0], [40.0, -1.0]]})
    yield _turning()


def _dry(*stages: Mapping) -> Mapping:
    return {key: value for key, value in touchdown(*stages).items() if key != "soil"}


def _laden() -> Mapping:
    scene = _dry()
    riser = scene["riser"] | {"attachments": [{"at": [5.0, 20.0], "mass": 9.0, "volume": 0.1, "drag_area": 0.2}]}
    contact = {"friction": {"axial": 0.4, "lateral": 0.6}, "suction": {"cap": 50.0, "reach": 0.1}, "stiffness": 1.0e5}
    pipe = scene["line_types"]["flexible"] | {"damping": {"ratio": 0.02, "frequency": 1.0}, "rotary_inertia": True}
    return {"riser": riser, "contact": contact, "line_types": {"flexible": pipe}}


def _turning() -> Mapping:
    turn = {"rotation": {"axis": [0, 1, 0], "amplitude_deg": 3.0, "period": 2.0, "ramp": 1.0}}
    load = {"at": "end", "force": [1.0, 0.0, -5.0], "history": [[0.0, 0.0], [0.5, 1.0]]}
    pipe = {key: IN_WAVES[key] for key in ("EA", "EI", "mass")}
    stages = static(loads=[load]), dynamic(0.3, 0.1, motion={"start": turn}, scheme={"newmark": {"beta": 0.25}})
    start = prescribed(0.0, 0.0, 0.0, rotation="fixed")
    return riser_scene(*stages, pipe=pipe, length=12.0, elements=6, start=start, end="free", gravity=9.81)


def _with(scene: Mapping, **sections: Any) -> Mapping:
    return {**scene, **sections}


def _short(data: Mapping) -> Mapping:
    """The scene with a few steps in each stage, and longer elements."""
    scene = deepcopy(data)
    for stage in scene["stages"]:
        step = stage.get("time_step")
        if "duration" in stage:
            stage["duration"] = STEPS * step if isinstance(step, float) else stage["duration"]
    for segment in scene["riser"]["segments"]:
        segment.pop("element_length", None)
        segment["elements"] = min(segment.get("elements", MOST_ELEMENTS), MOST_ELEMENTS)
    if "block" in scene.get("soil", {}) and "kind" in scene["soil"]["mesh"]:
        scene["soil"]["mesh"] |= {"size_at_riser": 1.0, "size_far": 2.0}
    return scene


def _box(nx: int, ny: int, nz: int) -> str:
    """A gmsh file (format 2.2) of hexahedra under the riser's touchdown zone."""
    points = [
        (2.0 + 7.0 * i / nx, -1.0 + 2.0 * j / ny, -1.0 + k / nz)
        for k in range(nz + 1)
        for j in range(ny + 1)
        for i in range(nx + 1)
    ]
    cells = [_corners(i, j, k, nx + 1, ny + 1) for k in range(nz) for j in range(ny) for i in range(nx)]
    nodes = [f"{n} {x:.6g} {y:.6g} {z:.6g}" for n, (x, y, z) in enumerate(points, start=1)]
    elements = [f"{n} 5 2 1 1 {' '.join(map(str, cell))}" for n, cell in enumerate(cells, start=1)]
    sections = {"MeshFormat": ["2.2 0 8"], "Nodes": [str(len(nodes)), *nodes]}
    sections["Elements"] = [str(len(elements)), *elements]
    return "".join(f"${name}\n" + "\n".join(lines) + f"\n$End{name}\n" for name, lines in sections.items())


def _corners(i: int, j: int, k: int, nx: int, ny: int) -> list[int]:
    first = 1 + i + nx * (j + ny * k)
    face = [first, first + 1, first + 1 + nx, first + nx]
    return [*face, *(node + nx * ny for node in face)]


BOX = _box(5, 2, 2)
