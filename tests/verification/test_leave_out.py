"""What a scene doesn't need is neither imported, built, nor solved for."""

from __future__ import annotations

import json
import subprocess
import sys
from cProfile import Profile
from operator import call
from pathlib import Path
from types import CodeType
from typing import Any

import numpy as np
import pytest

from benchmarks.iteration_counter import IterationCounter
from benchmarks.parts import mapping
from riser_soil.assembly import Assembly
from riser_soil.core.part import State
from riser_soil.core.system import System, Timer
from riser_soil.stages import run_stage
from tests.support.driven_stage import built
from tests.support.on_ranks import HANGS, ROOT, environment
from tests.support.scenes import LAY, Mapping, heave, touchdown

FOR_SOIL = {"dolfinx", "dolfinx_cpp", "ufl", "ffcx", "basix", "gmsh"}
FOR_PICTURES = {"pyvista", "vtk", "vtkmodules", "matplotlib"}
SLOW_TO_IMPORT = {"pandas", "xarray", "typer"} | {
    f"scipy.{name}" for name in ("fft", "integrate", "interpolate", "optimize", "signal", "spatial", "special", "stats")
}
OWN_FOR_SOIL = {"riser_soil.soil.soil", "riser_soil.soil.surface", "riser_soil.soil.dolfinx_compat"} | {
    f"riser_soil.{name}" for name in ("contact.soil_contact", "contact.ground", "contact.facets", "checks.soil_edge")
}
OWN_FOR_OTHERS = {  # for waves, vortices, code checks, marine growth and bend stiffeners
    *(f"riser_soil.{name}" for name in ("sea.components", "sea.vortex_law", "riser.additions")),
    *(f"riser_soil.checks.{name}" for name in ("wave_plausibility", "code_plausibility")),
}
FOR_HEAVE = {False: set[str](), True: {"riser_soil.motion.prescribed"}}
NODES = 37
FORMULAS = {"riser", "sea", "seabed", "contact", "soil", "motion"}


def hanging(*stages: Mapping, dimension: int = 2) -> Mapping:
    """The touchdown scene's riser, hanging freely; nothing else."""
    scene = touchdown(*stages, dimension=dimension)
    del scene["soil"], scene["seabed"]
    scene["riser"]["end"]["position"] = [15.0, 0.0, 15.0]
    return scene


def over_springs(*stages: Mapping, dimension: int = 2) -> Mapping:
    """A riser that comes down on a seabed of springs."""
    scene = touchdown(*stages, dimension=dimension)
    del scene["soil"]
    return scene


def ran(name: str, folder: Path) -> dict[str, Any]:
    """What a process has imported that has run a scene, and how many kernels it has compiled."""
    scenes = {
        "hanging, static": hanging(LAY),
        "hanging, dynamic": hanging(LAY, heave(0.2)),
        "over springs": over_springs(LAY, heave(0.2)),
        "on soil": touchdown(LAY),
    }
    (folder / "scene.yaml").write_text(json.dumps(scenes[name]), encoding="utf-8")
    script = ROOT / "tests/support/imports_of_run.py"
    call = [sys.executable, str(script), str(folder / "scene.yaml"), str(folder)]
    subprocess.run(call, env=environment(), check=True, capture_output=True, timeout=HANGS)
    data: dict[str, Any] = json.loads((folder / "found.json").read_text(encoding="utf-8"))
    return data


def imported(name: str, folder: Path) -> set[str]:
    """Imported packages, and the project's modules by their full names."""
    modules = ran(name, folder)["modules"]
    return {m.split(".")[0] for m in modules} | {m for m in modules if m.startswith("riser_soil.")}


@pytest.mark.parametrize("name", ["hanging, static", "hanging, dynamic", "over springs"])
def test_without_soil_its_libraries_are_not_imported(name: str, tmp_path: Path) -> None:
    modules = imported(name, tmp_path)
    assert not modules & (FOR_SOIL | FOR_PICTURES | OWN_FOR_SOIL | OWN_FOR_OTHERS)
    assert ("riser_soil.contact.seabed_contact" in modules) == (name == "over springs")
    assert ("riser_soil.sea.morison" in modules) == (name != "hanging, static")
    assert ("riser_soil.riser.inertia" in modules) == (name != "hanging, static")
    assert "riser_soil.riser.loads" not in modules
    assert not {m for m in modules if m.startswith("riser_soil.code_checks")}
    assert not {m for m in modules if m.startswith("riser_soil.motion.")} - FOR_HEAVE[name != "hanging, static"]


def test_with_soil_they_are(tmp_path: Path) -> None:
    """The names looked for are those that a soil imports; pictures are none of a run's business."""
    modules = imported("on soil", tmp_path)
    assert modules >= {"dolfinx", "ufl", "basix", "gmsh"}
    assert modules >= OWN_FOR_SOIL
    assert not modules & FOR_PICTURES


def test_hanging_riser_starts_at_once(tmp_path: Path) -> None:
    """It waits neither for a compiler, once its kernels are there, nor for parts of libraries that it doesn't use."""
    ran("hanging, static", tmp_path)
    again = ran("hanging, static", tmp_path)
    assert again["compiled"] == 0
    assert "riser_soil.riser.beam2d" in again["modules"]
    assert not SLOW_TO_IMPORT & set(again["modules"])


def test_level_ground_asks_for_no_more_than_the_arithmetic(tmp_path: Path) -> None:
    """Splines are for profiles of the seabed and tables of motion."""
    assert not SLOW_TO_IMPORT & set(ran("over springs", tmp_path)["modules"])


#: Packages of the formulas that a stage in motion calls, by scene; a seabed, and a law of contact, is numbers alone.
AT_WORK = {
    "hanging, heaved": {"riser", "motion"},
    "and damped": {"riser", "motion"},
    "in water": {"riser", "motion", "sea"},
    "on springs": {"riser", "motion", "sea", "contact"},
    "on elastic soil": {"riser", "motion", "sea", "contact", "soil"},
}


@pytest.mark.parametrize("name", AT_WORK)
def test_what_a_scene_lacks_takes_part_in_no_step(name: str) -> None:
    """No function of an absent part is called from the beginning of a stage to its end, not even to find that out: it
    costs the others nothing.
    """
    scene = mapping(name)
    scene["stages"][1]["duration"] = 0.5
    if "soil" in scene:
        scene["soil"]["mesh"]["size_at_riser"] = 1.0
    profile = Profile()
    for do in (call, profile.runcall):  # in a profile it takes five times as long to compile kernels
        assembly = built(scene)
        first, second = assembly.scene.stages
        before = run_stage(assembly, first, State.at_rest(0.0, assembly.size), IterationCounter(), Timer.new())
        do(run_stage, assembly, second, before, IterationCounter(), Timer.new())
    called = {Path(entry.code.co_filename) for entry in profile.getstats() if isinstance(entry.code, CodeType)}
    own = {path.relative_to(ROOT / "riser_soil").parts[0] for path in called if ROOT / "riser_soil" in path.parents}
    assert own & FORMULAS == AT_WORK[name]


def system(assembly: Assembly, stage: int) -> System:
    return System(assembly.comm, assembly.begin(assembly.scene.stages[stage]), Timer.new())


@pytest.mark.parametrize(("dimension", "dofs"), [(2, 3), (3, 6)])
@pytest.mark.parametrize("scene", [hanging, over_springs])
def test_matrix_holds_the_free_dofs_alone(scene: Any, dimension: int, dofs: int) -> None:
    """Held are the ends' positions and, in space, the spin that nothing else holds at rest; contact adds no row."""
    assembly = built(scene(LAY, heave(0.2), dimension=dimension))
    for stage, spin in ((0, dimension == 3), (1, False)):
        rows, columns = system(assembly, stage).matrix.mat.getSize()
        assert rows == columns == dofs * NODES - 2 * dimension - spin


def test_hanging_riser_has_no_entries_for_contact() -> None:
    """Each node couples with itself and its neighbours, on springs as well: they add to entries that are there."""
    hung, sprung = (system(built(s(LAY)), 0).matrix.mat for s in (hanging, over_springs))
    indptr, _, _ = hung.getValuesCSR()
    assert np.diff(indptr).max() == 3 * 3
    assert sprung.getInfo()["nz_used"] == hung.getInfo()["nz_used"]


def names(assembly: Assembly, stage: int) -> list[str]:
    return [part.name for part in assembly.begin(assembly.scene.stages[stage]).parts]


def test_static_stages_build_nothing_of_dynamics() -> None:
    assembly = built(touchdown(LAY, heave(0.2)))
    assert names(assembly, 0) == ["riser", "soil", "contact", "seabed", "cushion", "new mesh"]
    assert names(assembly, 1) == ["riser", "inertia", "morison", "soil", "contact", "seabed", "new mesh"]


def test_water_is_built_as_far_as_it_goes() -> None:
    """A current loads static stages, waves dynamic ones, and a surface both."""
    sea = {"surface_level": 60.0, "waves": {"airy": {"height": 1.0, "period": 6.0}}}
    current = {"current": {"profile": [[0.0, 1.0, 0.0]]}}
    built_of = {"sea": ["riser", "buoyancy"], "current": ["riser", "morison"]}
    for name, water in (("sea", sea), ("current", current)):
        assembly = built(hanging(LAY, heave(0.2)) | {"water": water})
        assert names(assembly, 0) == built_of[name]
        assert names(assembly, 1) == ["riser", "inertia", "morison", *(["buoyancy"] if name == "sea" else [])]


def test_without_water_nothing_of_the_sea() -> None:
    scene = hanging(LAY, heave(0.2))
    line = scene["line_types"]["flexible"]
    del scene["water"], line["drag"], line["added_mass"]
    assembly = built(scene)
    assert names(assembly, 1) == ["riser", "inertia"]
    assert assembly.soil is None
    assert assembly.contacts == []


def test_motion_is_smooth_unless_something_may_jump() -> None:
    """Then steps continue the motion before them and hand tangents on: springs at the ends don't change that."""
    stages, sprung = (LAY, heave(0.2)), hanging(LAY, heave(0.2))
    sprung["riser"]["start"]["rotation"] = {"stiffness": 1.0e4}
    assert system(built(sprung), 1).smooth
    assert not system(built(over_springs(*stages)), 1).smooth
    assert not system(built(touchdown(*stages)), 1).smooth


def test_symmetric_where_nothing_makes_it_unsymmetric() -> None:
    assembly = built(touchdown(LAY, heave(0.2)))
    assert system(assembly, 0).symmetric
    assert not system(assembly, 1).symmetric
