"""The inventory has the parts that stages are really solved with, and reasons for all others."""

from __future__ import annotations

import pytest

from riser_soil.checks.inventory import BODY_REASONS, CALLED, LINE_REASONS, Inventory, inventory
from tests.support.driven_stage import built
from tests.support.line_scenes import mooring, shaken
from tests.support.scenes import LAY, Mapping, heave, static, touchdown

ELASTIC = {"kind": "linear-elastic", "E": 1.0e6, "nu": 0.4}
CURRENT = {"profile": [[0.0, 0.5, 0.0], [60.0, 1.0, 0.0]]}
WAVES = {"surface_level": 60.0, "waves": {"airy": {"height": 1.0, "period": 6.0}}, "current": CURRENT}
IN_SPACE = {"dimension": 3, "contact": {"method": "surface", "friction": {"axial": 0.3}}}
LOADED = static("pull", loads=[{"at": "end", "force": [0.0, 0.0, 1.0e3]}])

SCENES: dict[str, Mapping] = {
    "clay": touchdown(LAY, heave(0.3)),
    "elastic soil": touchdown(LAY, heave(0.3)) | {"soil": touchdown()["soil"] | {"law": ELASTIC}},
    "friction in space, in waves": touchdown(LAY, heave(0.3)) | IN_SPACE | {"water": WAVES},
    "a load at rest": touchdown(LAY, LOADED) | {"soil": None},
    "buoy on lines": mooring(shaken()),
}


def known(scene: Mapping) -> Inventory:
    return inventory(built(scene))


@pytest.mark.parametrize("name", SCENES)
def test_parts_are_those_of_the_stages(name: str) -> None:
    assembly = built(SCENES[name])
    names = {part.name for stage in assembly.scene.stages for part in assembly.begin(stage).parts}
    assert names == assembly.part_names
    everything, parts = {*LINE_REASONS, *BODY_REASONS}, inventory(assembly)
    expected = {CALLED.get(part, part) for part in names} & everything
    assert {*parts.built} - {"contact"} == expected - {"contact"}
    assert all(parts.left_out.values())


def test_added_mass_does_nothing_in_a_steady_current() -> None:
    """At rest it is drag alone that a current pushes by."""
    scene = touchdown(LAY) | {"soil": None, "water": {"current": CURRENT}}
    assert "morison" in known(scene).built
    del scene["line_types"]["flexible"]["drag"]
    assert "drag" in known(scene).left_out["morison"]


def test_contact_at_nodes_makes_no_new_mesh() -> None:
    scene = touchdown(LAY) | {"contact": {"method": "node"}}
    assert "node cells stay" in known(scene).left_out["new mesh"]
    moved = scene | {"soil": scene["soil"] | {"strain": "large"}}
    assert "nodes makes none" in known(moved).left_out["new mesh"]
    assert "new_mesh" not in known(moved).dissipating


def test_a_bodys_drag_needs_motion() -> None:
    """No part acts on a body that rests in still water."""
    assert "body drag" in known(mooring(shaken())).built
    assert "body drag" in known(mooring()).left_out
