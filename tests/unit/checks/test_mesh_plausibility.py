"""Warnings of the soil's mesh and block: long elements and cells, oblique risers, a block that is left or too small."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest

from riser_soil.checks.mesh_plausibility import mesh_warnings, missed, resolution_in_words
from riser_soil.checks.settlement import Settled, predicted_settlement
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.soil import GeneratedMesh
from riser_soil.whole_run import run
from tests.support.driven_stage import built
from tests.support.said import line_with
from tests.support.scenes import LAY, Mapping, heave, touchdown


def on_block(*stages: Mapping, su: float = 6000.0, **soil: Any) -> Mapping:
    scene = touchdown(*stages, su=su)
    scene["soil"] |= soil
    scene["contact"] = {"method": "surface"}
    return scene


def sizes(along: float, across: float) -> Mapping:
    return {"kind": "hex", "size_at_riser": {"along": along, "across": across}, "size_far": 1.0}


def warned(scene: Mapping) -> list[str]:
    return list(mesh_warnings(built(scene).riser))


def test_cells_and_elements_that_suit_are_not_reported() -> None:
    assert warned(on_block(LAY, mesh=sizes(0.5, 0.012))) == []


def test_cells_and_elements_longer_than_the_bend_on_soil_are_reported() -> None:
    """(4 EI/E)^(1/4) = (2e5/1.8e6)^(1/4) = 0.58 m."""
    (warning,) = warned(on_block(LAY, mesh=sizes(1.0, 0.012)))
    line_with([warning], "soil.mesh cells", "1 m", "long", "0.577 m")
    scene = on_block(LAY, mesh=sizes(0.5, 0.012))
    scene["riser"]["segments"][0]["elements"] = 12
    (warning,) = warned(scene)
    line_with([warning], "elements", "over the soil", "1 m", "long", "0.577 m", "at most 0.29 m")


def test_sections_deep_beside_the_bend_on_soil_are_reported() -> None:
    """3 m below a bend of 0.58 m; the block's depth of 1 m has no more effect than the sections' own."""
    block = {"x": [2.0, 9.0], "y": [-1.0, 1.0], "depth": 3.0}
    (warning,) = warned(on_block(LAY, mesh=sizes(0.5, 0.012), model="sections", block=block))
    excess = math.log(3.0 / (2.516 * 0.577)) / (math.log(12.0 / 0.0236) - 0.5)
    line_with([warning], "0.577 m", "3 m of soil", "settles", f"{excess:.0%} more")
    assert warned(on_block(LAY, mesh=sizes(0.5, 0.012), block=block)) == []
    assert warned(on_block(LAY, mesh=sizes(0.5, 0.012), model="sections")) == []


@pytest.mark.parametrize("mesh", [sizes(0.5, 0.012), "auto"])
def test_chain_on_soil_has_no_bend_to_be_resolved(mesh: Mapping | str) -> None:
    """Without bending stiffness: nothing is divided by it, cells are four diameters long, no warning names a bend."""
    scene = on_block(LAY, mesh=mesh, model="sections")
    scene["line_types"]["flexible"] |= {"EI": 0.0}
    assembly = built(scene)
    assert list(mesh_warnings(assembly.riser)) == []
    settled = predicted_settlement(assembly.riser)
    assert settled is not None
    assert (settled.overshoot, settled.deepest) == (1.0, settled.by_weight)
    assert assembly.scene.soil is not None
    assert isinstance(assembly.scene.soil.mesh, GeneratedMesh)
    assert assembly.scene.soil.mesh.along == pytest.approx(1.2 if mesh == "auto" else 0.5)


def test_long_cells_under_an_oblique_riser_are_reported() -> None:
    scene = on_block(LAY, mesh=sizes(0.5, 0.25))
    scene["riser"]["end"]["position"] = [18.0, 13.5, 15.0]
    scene["soil"]["block"]["y"] = [-1.0, 8.0]
    line_with(warned(scene), "soil.mesh.size_at_riser.along 0.5 m", "no effect")


def test_a_block_that_the_touchdown_point_will_leave_is_reported() -> None:
    block = {"x": [7.0, 8.5], "y": [-1.0, 1.0], "depth": 1.0}
    (warning,) = (
        warning for warning in warned(on_block(LAY, heave(3.0, amplitude=2.0), block=block)) if "leaves" in warning
    )
    assert "take block: auto" in warning
    assert not [warning for warning in warned(on_block(LAY, heave(3.0, amplitude=0.01))) if "leaves" in warning]


def test_fine_cells_that_the_touchdown_point_will_leave_are_reported() -> None:
    def warned_of(low: float, high: float) -> list[str]:
        mesh = {**sizes(0.5, 0.012)}
        mesh["size_at_riser"] = {**mesh["size_at_riser"], "touchdown": [low, high]}
        return [each for each in warned(on_block(LAY, heave(3.0, amplitude=0.3), mesh=mesh)) if "touchdown is" in each]

    assert warned_of(3.0, 15.0) == []
    (warning,) = warned_of(3.0, 7.0)
    line_with(warning, "soil.mesh.size_at_riser.touchdown is x from 3 to 7 m", "comes to x from", "longer than 0.5 m")


def test_what_cells_miss_grows_with_their_size() -> None:
    fine, half = Settled(0.01, 0.01, 1.0), Settled(0.005, 0.005, 1.0)
    assert missed(fine, fine) == pytest.approx(0.02)
    assert missed(half, fine) == pytest.approx(0.52)
    assert missed(Settled(0.0, 0.0, 1.0), Settled(0.0, 0.0, 1.0)) == 0.0
    words = resolution_in_words(built(on_block(LAY, mesh=sizes(0.5, 0.012))).riser)
    assert words is not None
    line_with(words, "0.5 m along", "0.012 m across", "0.0236 m touch", "2% less")
    wide = resolution_in_words(built(on_block(LAY, mesh=sizes(0.5, 0.05))).riser)
    assert wide is not None
    assert int(wide.rsplit("%")[0].rsplit(" ")[-1]) > 20
    assert resolution_in_words(built({**touchdown(LAY), "contact": {"method": "node"}}).riser) is None


def stage_warnings(scene: Mapping, folder: Path) -> list[str]:
    run(scene_from_mapping(scene), folder)
    stages = json.loads((folder / "summary.json").read_text())["stages"]
    return [warning for stage in stages for warning in stage["warnings"]]


def test_a_block_too_shallow_and_narrow_is_reported_after_the_run(tmp_path: Path) -> None:
    block = {"x": [4.0, 7.0], "y": [-0.6, 0.6], "depth": 0.6}
    scene = touchdown(LAY, su=6000.0)
    scene["soil"] |= {"block": block, "mesh": {"kind": "hex", "size_at_riser": 0.2, "size_far": 0.3}}
    bottom, sides = [
        warning for warning in stage_warnings(scene, tmp_path) if "changes the soil's stress" in warning
    ]
    line_with([bottom], "block's bottom", "deeper")
    line_with([sides], "sides along the riser", "wider", "15%")


def test_a_block_that_was_left_is_reported_after_the_run(tmp_path: Path) -> None:
    block = {"x": [2.0, 5.0], "y": [-1.0, 1.0], "depth": 1.0}
    scene = touchdown(LAY, su=6000.0)
    scene["soil"]["block"] = block
    line_with(stage_warnings(scene, tmp_path), "left the soil's block", "seabed bears")
