"""Settings of scenes: which ones a scene has, and what is left as it was when one is turned."""

from __future__ import annotations

from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest

from riser_soil.assembly import sized
from riser_soil.assembly.riser import elements_of
from riser_soil.assembly.scales import scales_of
from riser_soil.errors import SceneError
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.scene.soil import CellSizes, GeneratedMesh
from riser_soil.scene.stages import DynamicStage
from riser_soil.variants.settings import SETTINGS, Setting, is_firm, resolved, settings_of, varied
from tests.support.said import telling
from tests.support.scenes import LAY, Mapping, heave, touchdown

ELEMENTS, TIME, SOIL, PENALTY = SETTINGS


def scene(*stages: Mapping, without: tuple[str, ...] = (), **more: Any) -> Scene:
    data = touchdown(*stages)
    return scene_from_mapping({key: value for key, value in data.items() if key not in without} | deepcopy(more))


def differing(a: Any, b: Any, path: str = "") -> set[str]:
    """Paths at which two plain values differ."""
    if isinstance(a, dict) and isinstance(b, dict) and a.keys() == b.keys():
        return {key_path for key in a for key_path in differing(a[key], b[key], f"{path}.{key}".lstrip("."))}
    if isinstance(a, list | tuple) and isinstance(b, list | tuple) and len(a) == len(b):
        pairs = enumerate(zip(a, b, strict=True))
        return {key_path for n, (x, y) in pairs for key_path in differing(x, y, f"{path}.{n}")}
    return set() if a == b else {path}


def changed(before: Scene, after: Scene) -> set[str]:
    return differing(before.model_dump(), after.model_dump())


@pytest.mark.parametrize(
    ("given", "names"),
    [
        (scene(LAY, heave(1.0)), ["elements", "time_step", "soil_mesh", "penalty"]),
        (scene(LAY), ["elements", "soil_mesh", "penalty"]),
        (scene(LAY, without=("soil",)), ["elements"]),
        (scene(LAY, without=("soil", "seabed")), ["elements"]),
        (scene(LAY, without=("soil",), seabed={"kind": "rigid"}), ["elements", "penalty"]),
        (scene(heave(1.0), without=("soil",)), ["elements", "time_step"]),
    ],
)
def test_a_scene_has_the_settings_of_its_parts(given: Scene, names: list[str]) -> None:
    assert [setting.name for setting in settings_of(given)] == names


def test_a_mesh_file_is_no_setting() -> None:
    given = scene(LAY)
    assert given.soil is not None
    file = Path(__file__)
    mesh = {"mesh": {"file": file}, "block": None}
    soil = type(given.soil).model_validate(given.soil.model_dump() | mesh, context={"folder": file.parent})
    assert [setting.name for setting in settings_of(given.model_copy(update={"soil": soil}))] == ["elements", "penalty"]


@pytest.mark.parametrize(
    ("setting", "paths"),
    [
        (ELEMENTS, {"riser.segments.0.elements", "riser.segments.1.elements"}),
        (TIME, {"stages.1.time_step"}),
        (SOIL, {"soil.mesh.size_at_riser", "soil.mesh.size_far"}),
        (PENALTY, {"contact.stiffness"}),
    ],
)
def test_a_setting_turns_what_is_its_own_and_is_as_much_finer_as_asked(setting: Setting, paths: set[str]) -> None:
    given = scene(LAY, heave(1.0), contact={"stiffness": 2.0e6})
    for factor in (0.5, 2.0):
        turned = varied(given, setting, factor)
        assert changed(given, turned) == paths
        assert setting.fineness(turned) / setting.fineness(given) == pytest.approx(factor)
        assert scene_from_mapping(turned.model_dump(by_alias=True)) == turned
        assert setting.in_words(turned) != setting.in_words(given)
    assert varied(given, setting, 1.0) is given


def test_given_and_graded_lengths_of_elements() -> None:
    data = touchdown(LAY)
    data["riser"]["segments"][0] = {"line_type": "flexible", "length": 12.0, "element_length": [0.2, 1.0]}
    data["riser"]["segments"][1] = {"line_type": "flexible", "length": 18.0, "element_length": 1.5}
    turned = varied(scene_from_mapping(data), ELEMENTS, 2.0)
    assert [segment.element_length for segment in turned.line.segments] == [(0.1, 0.5), 0.75]
    assert varied(scene_from_mapping(data), ELEMENTS, 1e-3).line.element_count == 2
    lengths = turned.line.segments[0].element_lengths
    assert lengths[-1] / lengths[0] == pytest.approx(5.0)


def test_automatic_steps_are_turned_by_their_tolerance() -> None:
    stage = heave(1.0) | {"time_step": "auto"}
    turned = varied(scene(LAY, stage), TIME, 2.0)
    last = turned.stages[1]
    assert isinstance(last, DynamicStage)
    assert last.time_step == "auto"
    assert last.tolerance == pytest.approx(0.02 * 0.3 / 8.0)
    assert TIME.fineness(turned) / TIME.fineness(scene(LAY, stage)) == pytest.approx(2.0)


def test_a_step_is_no_longer_than_its_stage() -> None:
    last = varied(scene(LAY, heave(0.3)), TIME, 0.1).stages[1]
    assert isinstance(last, DynamicStage)
    assert last.time_step == 0.3


def test_the_strip_of_fine_cells_keeps_its_width() -> None:
    data = touchdown(LAY)
    data["soil"]["mesh"] |= {"size_at_riser": {"along": 0.6, "across": 0.1}}
    turned = varied(scene_from_mapping(data), SOIL, 2.0).soil
    assert turned is not None
    assert isinstance(turned.mesh, GeneratedMesh)
    assert turned.mesh.size_at_riser == CellSizes(along=0.3, across=0.05, strip=0.8)


def test_automatic_sizes_and_penalties_are_turned_as_the_numbers_that_they_stand_for() -> None:
    data = touchdown(LAY)
    data["soil"] |= {"block": "auto", "mesh": "auto"}
    data["contact"] = {"method": "surface"}
    given = scene_from_mapping(data)
    assert changed(sized(given), resolved(given)) == {"contact.stiffness"}
    turned = varied(given, SOIL, 1.25)
    assert SOIL.fineness(turned) / SOIL.fineness(given) == pytest.approx(1.25)
    before = sized(given).soil
    assert turned.soil is not None
    assert before is not None
    assert turned.soil.block == before.block
    stiff = varied(given, PENALTY, 10.0)
    assert PENALTY.fineness(stiff) == pytest.approx(10.0 * PENALTY.fineness(given))
    assert "stiffness: auto" not in dump_scene(stiff)


def test_a_penalty_on_soil_gets_no_stiffer_than_a_firm_one() -> None:
    """Fifty times the automatic one: some 2e-4 of a pipe's settlement is left to it. A firmer one that is given stays,
    and a rigid floor has no such limit.
    """
    given = scene(LAY, contact={"method": "surface"})
    automatic = PENALTY.fineness(given)
    assert PENALTY.fineness(varied(given, PENALTY, 40.0)) == pytest.approx(40.0 * automatic)
    firm = varied(given, PENALTY, 1000.0)
    assert PENALTY.fineness(firm) == pytest.approx(50.0 * automatic)
    assert (is_firm(given), is_firm(varied(given, PENALTY, 20.0)), is_firm(firm)) == (False, False, True)
    firmer = scene(LAY, contact={"method": "surface", "stiffness": 60.0 * automatic})
    assert PENALTY.fineness(varied(firmer, PENALTY, 2.0)) == pytest.approx(60.0 * automatic)
    assert PENALTY.fineness(varied(firmer, PENALTY, 0.5)) == pytest.approx(30.0 * automatic)
    floor = scene(LAY, without=("soil",), seabed={"kind": "rigid"})
    assert PENALTY.fineness(varied(floor, PENALTY, 1000.0)) == pytest.approx(1000.0 * PENALTY.fineness(floor))
    assert not is_firm(varied(floor, PENALTY, 1000.0))
    both = scene(LAY, seabed={"kind": "rigid"}, contact={"method": "surface"})
    assert PENALTY.fineness(varied(both, PENALTY, 1000.0)) == pytest.approx(1000.0 * PENALTY.fineness(both))
    assert not is_firm(varied(both, PENALTY, 1000.0))


def test_more_elements_than_a_riser_may_have_are_refused() -> None:
    with pytest.raises(SceneError, match=telling("elements of the riser", "1e+06 times", "more than 1000000")):
        varied(scene(LAY), ELEMENTS, 1e6)


def test_a_very_stiff_floor_has_a_corner_no_wider_than_what_the_riser_sinks_in() -> None:
    given = scene(LAY, without=("soil",), seabed={"kind": "rigid"})
    stiff, stiffer = varied(given, PENALTY, 2.0), varied(given, PENALTY, 200.0)
    assert stiff.contact is not None
    assert stiffer.contact is not None
    weight = scales_of(elements_of(given)).weight
    assert stiff.contact.smoothing == "auto"
    assert stiffer.contact.smoothing == pytest.approx(weight / float(stiffer.contact.stiffness))
    again = varied(stiffer, PENALTY, 3.0).contact
    assert again is not None
    assert again.smoothing == pytest.approx(float(stiffer.contact.smoothing) / 3.0)
    given = scene(LAY, without=("soil",), seabed={"kind": "rigid"}, contact={"smoothing": 1.0e-3})
    assert changed(resolved(given), varied(given, PENALTY, 200.0)) == {"contact.stiffness"}
