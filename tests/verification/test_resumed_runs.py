"""A run that is left between two steps and goes on from its saved state in things built anew gives what it would have
given, to the last bit: riser, forces, energy ledger, extremes, sizes of steps.
"""

from __future__ import annotations

from copy import deepcopy
from pathlib import Path

import pytest

from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.scene import Scene, Solver
from tests.support.interrupted_run import differing, differing_rows, resumed, summary, whole
from tests.support.line_scenes import RIGID, mooring, shaken
from tests.support.scenes import LAY, heave, touchdown
from tests.support.sinking_pipe import sinking, sinking_into_tetrahedra

ROOT = Path(__file__).parents[2]
MIDPOINT = "stages.1.scheme={midpoint: {}}"
IN_SPACE = ("dimension=3", "line_types.flexible.GJ=4.0e4")
SHAKEN = "line_types.flexible.vortex_force={in_line: {coefficient: 0.2}}"
VORTICES = ("water.current={profile: [[0.0, 0.8, 0.1]]}", SHAKEN)
SLUG = "slugs: [{density: 800.0, length: 12.0, spacing: 40.0, front: 90.0}]"
SLUGS = f"riser.contents={{density: 90.0, speed: 8.0, {SLUG}}}"
STORM = ("water.waves.jonswap.components=10", "water.waves.ramp=1.0", "output.xdmf_interval=0.4")
DEMO, SHORT_BLOCK, SECTIONS = "demos/touchdown_clay/scene.yaml", "soil.block.x=[25.5,29.5]", "soil.model=sections"
HALF = (SHORT_BLOCK, "soil.mesh={size_at_riser: {along: 1.0, across: 0.15, strip: 0.3}, size_far: 1.0}")
COARSE = ("soil.mesh.size_at_riser=1.0", "soil.mesh.size_far=2.0", "stages.1.time_step=0.2")


def shortened(file: str, duration: float, *overrides: str) -> Scene:
    """A scene of two stages, the second of which lasts so long [s]."""
    return read_scene(ROOT / file, (f"stages.1.duration={duration}", *overrides))


def two_storms() -> Scene:
    """The vessel goes on in the second one where it was at the end of the first."""
    scene = shortened("demos/waves/scene.yaml", 0.8, *STORM)
    hang, storm = scene.stages
    return scene.model_copy(update={"stages": (hang, storm, storm.model_copy(update={"name": "storm on"}))})


def plastic_clay_in_space() -> Scene:
    return scene_from_mapping(touchdown(LAY, heave(0.6), dimension=3))


def surface_on_clay() -> Scene:
    scene = touchdown(LAY, heave(0.6), su=1000.0)
    return scene_from_mapping(scene | {"contact": {"method": "surface", "smoothing": 1e-3}})


def kept_factors() -> Scene:
    """Resumed with factors that are older than the step before."""
    return surface_on_clay().model_copy(update={"solver": Solver(linear="kept")})


def condensed_soil() -> Scene:
    """With all that contact keeps of points."""
    scene = touchdown(LAY, heave(0.6))
    scene["soil"]["law"] = {"kind": "linear-elastic", "E": 4.0e5, "nu": 0.45}
    contact = {"friction": {"axial": 0.3, "lateral": 0.6}, "suction": {"cap": 200.0, "reach": 0.02}}
    return scene_from_mapping(scene | {"contact": {"method": "surface", "smoothing": 1e-3} | contact})


def laid_and_lifted_on_clay() -> Scene:
    """A resumed stage takes the load steps that it would have taken: they follow from how far the whole stage moves the
    end.
    """
    lift = {"name": "lift", "kind": "static", "move": {"end": [22.5, 0.0, 15.3]}}
    return scene_from_mapping(touchdown(LAY, lift, su=1000.0))


def clay_with_inertia() -> Scene:
    scene = touchdown(LAY, heave(0.6), su=1000.0)
    scene["soil"] |= {"inertia": True, "absorbing": True}
    return scene_from_mapping(scene | {"contact": {"method": "surface", "smoothing": 1e-3}})


def sinks_into_clay() -> Scene:
    """On new meshes before and after it is left."""
    law = {"kind": "kinematic-hardening", "su": 5.0e3, "E_over_su": 400.0, "elastic_share": 0.1}
    friction = {"friction": {"axial": 0.3, "lateral": 0.3}}
    return scene_from_mapping(sinking(6, 0.2, 16, law, contact=friction, submerged_unit_weight=5.0e3))


def sinks_into_tetrahedra() -> Scene:
    friction = {"friction": {"axial": 0.3, "lateral": 0.3}}
    return scene_from_mapping(sinking_into_tetrahedra(4, 0.1, 12, contact=friction))


def moored_rigid_body() -> Scene:
    return scene_from_mapping(mooring(shaken(0.5) | {"scheme": {"midpoint": {}}}, body=RIGID))


SHORT = {
    "first scene": (lambda: shortened("demos/first_scene.yaml", 1.0), (5,)),
    "catenary": (lambda: shortened("demos/catenary/scene.yaml", 1.0), (1, 6)),
    "catenary, static stages": (lambda: read_scene(ROOT / "demos/catenary/three_stages.yaml"), (2,)),
    "tank": (lambda: shortened("demos/tank/scene.yaml", 0.5), (6,)),
    "waves": (two_storms, (4, 7)),
    "touchdown on clay": (lambda: shortened("tests/scenes/touchdown_on_block.yaml", 1.0, *COARSE), (4,)),
    "touchdown in sections": (lambda: shortened(DEMO, 0.4, SHORT_BLOCK, SECTIONS), (4,)),
    "touchdown on half a block": (lambda: shortened(DEMO, 0.4, *HALF), (3,)),
    "plastic clay in space": (plastic_clay_in_space, (4,)),
    "surface contact on plastic clay": (surface_on_clay, (4, 10)),
    "kept factors": (kept_factors, (4, 10, 12)),
    "condensed soil": (condensed_soil, (4, 10)),
    "clay with inertia": (clay_with_inertia, (4, 10)),
    "laid and lifted on clay": (laid_and_lifted_on_clay, (10,)),
    "sinks into clay": (sinks_into_clay, (5, 12)),
    "sinks into tetrahedra": (sinks_into_tetrahedra, (5, 9)),
    "midpoint rule": (lambda: shortened("demos/catenary/scene.yaml", 1.0, MIDPOINT), (6,)),
    "midpoint rule in space": (lambda: shortened("demos/catenary/scene.yaml", 1.0, MIDPOINT, *IN_SPACE), (6,)),
    "midpoint rule of a rigid body": (moored_rigid_body, (5, 9)),
    "automatic steps": (lambda: shortened("demos/catenary/scene.yaml", 2.0, "stages.1.time_step=auto"), (7,)),
    "automatic steps on a seabed": (lambda: shortened("demos/first_scene.yaml", 1.0, "stages.1.time_step=auto"), (12,)),
    "vortices": (lambda: shortened("tests/scenes/catenary.yaml", 1.0, *IN_SPACE, *VORTICES), (4,)),
    "slugs": (lambda: shortened("tests/scenes/catenary.yaml", 1.0, SLUGS), (4,)),
    "friction on hysteretic clay": (lambda: shortened("tests/scenes/hysteretic.yaml", 1.5, *IN_SPACE), (8,)),
}


#: To compute, or to compile.
LONG = (
    *("waves", "vortices", "slugs", "plastic clay in space", "touchdown in sections", "kept factors"),
    *("laid and lifted on clay", "sinks into tetrahedra", "midpoint rule", "midpoint rule in space"),
    *("friction on hysteretic clay", "midpoint rule of a rigid body", "sinks into clay"),
    "surface contact on plastic clay",
)
NAMES = [pytest.param(name, marks=[pytest.mark.verify] if name in LONG else []) for name in SHORT]


@pytest.mark.parametrize("name", NAMES)
def test_a_resumed_run_goes_on_to_the_last_bit(name: str, tmp_path: Path) -> None:
    make, after = SHORT[name]
    scene = make()
    alone = whole(scene, tmp_path / "alone", after)
    for step in after:
        saved = alone.states[step]
        untouched = deepcopy(saved)
        rest = resumed(scene, tmp_path / f"from {step}", saved)
        assert rest.steps == alone.steps - step > 0
        assert differing(alone.last, rest.last) == []
        assert differing_rows(tmp_path / "alone", tmp_path / f"from {step}") == []
        assert summary(tmp_path / "alone") == summary(tmp_path / f"from {step}")
        assert differing(untouched, saved) == []
