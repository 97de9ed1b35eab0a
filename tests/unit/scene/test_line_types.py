"""Line types of a scene as the elements get them."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

from riser_soil.assembly.riser import elements_of
from riser_soil.checks.inventory import inventory
from riser_soil.riser.sections import Elements
from riser_soil.scene.line_types import LineType
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from tests.support.driven_stage import built_of
from tests.support.scenes import dynamic, prescribed, riser_scene, static

PIPE = {"EA": 1.0e8, "EI": 1.0e4, "GJ": 1.0e4, "mass": 50.0, "outer_diameter": 0.4, "inner_diameter": 0.2}


def scene(**pipe: object) -> Scene:
    ends = prescribed(0.0, 0.0, 0.0), prescribed(9.0, 0.0, 0.0)
    stages = static(), dynamic(1.0, 0.1)
    return scene_from_mapping(
        riser_scene(*stages, pipe=PIPE | pipe, length=9.0, elements=3, start=ends[0], end=ends[1], gravity=9.81)
    )


@pytest.mark.parametrize(("given", "expected"), [(False, 0.0), (True, 50.0 * 0.2 / 16.0), (3, 3.0), (0, 0.0)])
def test_rotary_inertia(given: bool | float, expected: float) -> None:
    made = scene(rotary_inertia=given)
    assert elements_of(made).rotary_inertia == pytest.approx(np.full(3, expected))
    assert ("rotary inertia" in inventory(built_of(made)).built) == (expected > 0.0)


def test_damping() -> None:
    """Stiffness-proportional: beta w / 2 is the ratio at w = 2 pi frequency."""
    made = scene(damping={"ratio": 0.02, "frequency": 0.5})
    assert 0.5 * elements_of(made).damping * (2.0 * np.pi * 0.5) == pytest.approx(np.full(3, 0.02))
    assert "structural damping" in inventory(built_of(made)).built
    assert inventory(built_of(scene(damping={"ratio": 0.0, "frequency": 0.5}))).left_out["structural damping"]


IN_WALL = ("wall_outer_diameter", "wall_inner_diameter", "allowable_stress")
GIVEN = {
    "EA": 2.0e8,
    "GJ": 3.0e4,
    "outer_diameter": 0.5,
    "inner_diameter": 0.3,
    "mass": 60.0,
    "min_bend_radius": 4.0,
    "max_tension": 5.0e5,
    "submerged_weight": 70.0,
}


def test_properties_of_the_same_name_reach_the_elements() -> None:
    """Each by itself, and all that a line type and the elements call alike."""
    made = elements_of(scene(**GIVEN))
    for name in GIVEN.keys() - {"submerged_weight"}:
        assert getattr(made, name).tolist() == [GIVEN[name]] * 3, name
    assert made.weight.tolist() == [GIVEN["submerged_weight"]] * 3
    alike = {each.name for each in fields(Elements)}
    formed = {"EI_y", "EI_z", "drag", "added_mass", "damping", "rotary_inertia", "pipe_diameter"}
    assert alike & LineType.model_fields.keys() == GIVEN.keys() - {"submerged_weight"} | formed


def test_what_is_not_given_is_the_elements_default() -> None:
    bare = scene(GJ=None, outer_diameter=None, inner_diameter=0.0, submerged_weight=10.0)
    made = elements_of(bare)
    assert not made.damping.any()
    assert not made.added_mass.any()
    for name in ("GJ", "outer_diameter", "inner_diameter", "min_bend_radius", "max_tension", *IN_WALL, "drag"):
        assert not getattr(made, name).any(), name
    assert made.EI_y.tolist() == made.EI_z.tolist() == [1.0e4] * 3


def test_a_wall_has_the_line_type_s_diameters_unless_it_has_its_own() -> None:
    for wall, expected in (
        ({}, (0.4, 0.2, 0.0)),
        ({"outer_diameter": 0.3, "yield_stress": 4.0e8}, (0.3, 0.2, 4.0e8)),
        ({"inner_diameter": 0.25, "yield_stress": 4.0e8, "design_factor": 0.6}, (0.4, 0.25, 2.4e8)),
    ):
        made = elements_of(scene(wall=wall))
        for name, value in zip(IN_WALL, expected, strict=True):
            assert getattr(made, name) == pytest.approx(np.full(3, value)), name
