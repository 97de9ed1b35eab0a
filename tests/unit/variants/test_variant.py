"""Variants by values at key paths: the base scene stays as it is, and a key tells runs with other results apart."""

from __future__ import annotations

from pathlib import Path

import pytest

from riser_soil.errors import SceneError
from riser_soil.variants.variant import BaseScene, variant_of
from tests.support.case_files import SMALL
from tests.support.said import telling


@pytest.fixture
def base(tmp_path: Path) -> BaseScene:
    (tmp_path / "small.yaml").write_text(SMALL, encoding="utf-8")
    return BaseScene.read(tmp_path / "small.yaml", ["gravity=9.7"])


def test_values_are_those_of_one_variant_alone(base: BaseScene) -> None:
    position = [8.5, 0.0, 4.0]
    first = base.with_values({"riser.end.position": position, "line_types.pipe.EI": 300.0}, "a")
    position[0] = 7.0
    second = base.with_values({"line_types.pipe.EI": 400.0}, "b")
    assert [each.model_dump()["riser"]["end"]["position"][0] for each in (first, second)] == [8.5, 9.0]
    assert [each.line_types["pipe"].EI for each in (first, second)] == [300.0, 400.0]
    assert [each.gravity for each in (first, second)] == [9.7, 9.7]


def test_a_value_that_is_overridden_already_needs_leave(base: BaseScene) -> None:
    with pytest.raises(SceneError, match=telling("case a: gravity=9.8", "undoes --set gravity=9.7")):
        base.with_values({"gravity": 9.8}, "case a:")
    assert base.with_values({"gravity": 9.8}, "--fit", again=True).gravity == 9.8


def test_a_wrong_value_is_named_by_its_place(base: BaseScene) -> None:
    with pytest.raises(SceneError, match=telling("--fit line_types.pipe.EA=-1.0", "line_types.pipe.EA: value -1.0")):
        base.with_values({"line_types.pipe.EA": -1.0}, "--fit")


def test_the_key_is_of_the_scene_alone(base: BaseScene) -> None:
    """Not of where its results go."""
    elsewhere = base.with_values({"output.directory": "elsewhere"}, "a")
    here, other = base.with_values({}, ""), base.with_values({"line_types.pipe.EI": 300.0}, "a")
    assert variant_of(elsewhere) == variant_of(here)
    assert variant_of(other).key != variant_of(here).key
