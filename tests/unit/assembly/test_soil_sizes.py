"""Automatic block and mesh of the soil: sizes from what touches, the block around the touchdown points."""

from __future__ import annotations

from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.assembly import sized
from riser_soil.assembly.contact_laws import contact_width
from riser_soil.assembly.motions import end_places
from riser_soil.assembly.riser import elements_of
from riser_soil.assembly.scales import Scales
from riser_soil.assembly.sea import sea_of
from riser_soil.assembly.soil_sizes import bending_on_soil, touching_width
from riser_soil.assembly.touchdown_forecast import forecast
from riser_soil.checks.estimate import size_of
from riser_soil.errors import SceneError
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.scene.soil import Block, CellSizes, GeneratedMesh
from riser_soil.soil.linear_elastic import LinearElastic
from riser_soil.soil.von_mises import VonMises
from tests.support.said import telling
from tests.support.scenes import LAY, ON_BLOCK, Mapping, heave, touchdown

CLAY = VonMises(kind="von-mises", su=4.0e3, su_gradient=0.0, E_over_su=300.0, nu=0.49)
SOFT = LinearElastic(kind="linear-elastic", E=1.2e6, nu=0.49)


def automatic(*stages: Mapping, **changes: Any) -> Scene:
    scene = touchdown(*stages)
    scene["soil"] |= {"block": "auto", "mesh": "auto"}
    scene["contact"] = {"method": "surface"}
    for key, value in changes.items():
        part = scene
        *path, last = key.split("__")
        for name in path:
            part = part[name]
        part[last] = value
    return scene_from_mapping(scene)


def chosen(scene: Scene) -> tuple[Block, GeneratedMesh, CellSizes]:
    soil = sized(scene).soil
    assert soil is not None
    assert isinstance(soil.block, Block)
    assert isinstance(soil.mesh, GeneratedMesh)
    assert isinstance(soil.mesh.size_at_riser, CellSizes)
    return soil.block, soil.mesh, soil.mesh.size_at_riser


@pytest.mark.parametrize("shift", [0.0, -110.0, 95.0])
def test_the_block_reaches_as_far_on_both_sides(shift: float) -> None:
    """Also where its ends have other numbers of figures: half of the soil is enough."""
    scene = touchdown(LAY)
    for end in ("start", "end"):
        scene["riser"][end]["position"][0] += shift
    scene["soil"] |= {"block": "auto", "mesh": "auto"}
    scene["contact"] = {"method": "surface"}
    block, _, _ = chosen(scene_from_mapping(scene))
    assert block.y[0] == -block.y[1]
    assert block.x[0] < block.x[1]


def test_a_light_pipe_touches_as_hertz_says_a_heavy_one_as_clay_bears() -> None:
    light, heavy = Scales(20.0, 0.3, 1.0), Scales(3000.0, 0.3, 1.0)
    assert touching_width(light, SOFT) == contact_width(light, 1.2e6) == touching_width(light, CLAY)
    assert touching_width(heavy, CLAY) == pytest.approx(3000.0 / ((2.0 + np.pi) * 4.0e3), rel=1e-9)
    assert touching_width(Scales(1e5, 0.3, 1.0), CLAY) == pytest.approx(0.3)


@pytest.mark.parametrize(("su", "cells", "strip"), [(6000.0, 4.0, 2.0), (600.0, None, 1.25)])
def test_cells_follow_from_what_touches_and_from_what_bends(su: float, cells: float | None, strip: float) -> None:
    """A light pipe has four across the width that touches; a heavy one, which sinks in, D/16. They don't grow
    within eight of them, and not within 1.25 of that width, as clay heaves beside it.
    """
    scene = automatic(soil__law__su=su)
    block, mesh, sizes = chosen(scene)
    assert scene.soil is not None
    elements = elements_of(scene)
    law, width = scene.soil.top_law, touching_width(Scales(float(elements.weight.max()), 0.3, 1.0), scene.soil.top_law)
    assert sizes.across == pytest.approx(0.3 / 16.0 if cells is None else width / cells, rel=1e-3)
    assert sizes.strip == pytest.approx(strip * width, rel=1e-3)
    assert sizes.along == pytest.approx(0.55 * bending_on_soil(elements, law), rel=1e-3)
    assert mesh.size_far == pytest.approx(0.6 * block.depth, rel=1e-3)
    assert bending_on_soil(elements, SOFT) == pytest.approx((4.0 * 5.0e4 / 1.2e6) ** 0.25)


def test_soil_without_a_mesh_has_automatic_cells() -> None:
    scene = touchdown(LAY)
    scene["soil"].pop("mesh")
    scene["contact"] = {"method": "surface"}
    default, asked = (scene_from_mapping(scene | {"soil": scene["soil"] | more}) for more in ({}, {"mesh": "auto"}))
    assert sized(default) == sized(asked)


def test_a_trench_needs_sizes_of_tetrahedra() -> None:
    trench = {"depth": 0.5, "width": 1.0, "along": [12.0, 28.0]}
    with pytest.raises(SceneError, match=telling("soil.mesh:", "tetrahedra", "{kind: tet")):
        automatic(LAY, soil__block={"x": [10.0, 30.0], "y": [-2.0, 2.0], "depth": 1.5, "trench": trench})


def test_the_block_lies_around_the_touchdown_points() -> None:
    """The touchdown point is that of the catenary at rest: a parabola nearly, x_end - x_0 = (H/w) arcosh(1 + w z/H)."""
    scene = automatic(LAY)
    predicted = forecast(scene, elements_of(scene), list(end_places(scene, sea_of(scene))))
    assert predicted is not None
    w = float(elements_of(scene).weight[0])
    assert len(predicted.points) == 1
    H = predicted.H
    assert predicted.points[0, 0] == pytest.approx(22.5 - H / w * np.arccosh(1.0 + w * 14.85 / H), abs=0.05)
    block, _, _ = chosen(scene)
    assert block.x[0] < predicted.points[0, 0] < block.x[1]
    assert np.mean(block.x) == pytest.approx(predicted.points[0, 0], abs=0.1)
    assert block.y == pytest.approx((-2.4, 2.4))
    assert block.depth == pytest.approx(2.4)


def test_the_block_follows_the_reach_of_the_motion() -> None:
    """The block reaches 1.25 times as far as catenaries between the moved ends say."""
    moving = automatic(LAY, heave(3.0, amplitude=1.0))
    predicted = forecast(moving, elements_of(moving), list(end_places(moving, sea_of(moving))))
    assert predicted is not None
    still, block = chosen(automatic(LAY))[0], chosen(moving)[0]
    reach = predicted.points[:, 0] - predicted.points[0, 0]
    assert reach.min() < -0.3
    assert reach.max() > 0.3
    assert np.subtract(block.x, still.x) == pytest.approx([1.25 * reach.min(), 1.25 * reach.max()], abs=0.1)


def test_cells_of_a_block_grow_where_the_riser_does_not_touch_down() -> None:
    """Cells stay small from three bending lengths before the touchdown points of the motion to a cell beyond; sections
    stay alike.
    """
    scene = automatic(LAY, heave(3.0, amplitude=1.0))
    predicted = forecast(scene, elements_of(scene), list(end_places(scene, sea_of(scene))))
    assert predicted is not None
    assert predicted.ahead == pytest.approx([1.0, 0.0])
    first = predicted.points[0, 0]
    reach = first + 1.25 * (predicted.points[:, 0] - first)
    low, high = reach.min(), reach.max()
    bending = np.sqrt(elements_of(scene).EI_y.max() / predicted.H)
    block, _, sizes = chosen(scene)
    assert sizes.touchdown is not None
    assert sizes.touchdown == pytest.approx((low - 3.0 * bending, high + sizes.along), abs=0.06)
    assert block.x[0] < sizes.touchdown[0] < sizes.touchdown[1] < block.x[1]
    assert chosen(automatic(LAY, soil__model="sections"))[2].touchdown is None


def test_a_riser_that_comes_down_the_other_way_has_its_cells_there() -> None:
    there = automatic(LAY)
    back = automatic(LAY, riser__end__position=[-22.5, 0.0, 15.0])
    ranges = [chosen(each)[2].touchdown for each in (there, back)]
    assert np.array(ranges[1]) == pytest.approx(-np.array(ranges[0])[::-1], abs=1e-6)


def test_a_chain_has_fine_cells_for_its_touchdown_point_at_rest() -> None:
    """Nothing bends and nothing moves: three cells before it, as far as there is a block, and one beyond."""
    scene = automatic(LAY, line_types__flexible__EI=0.0)
    predicted = forecast(scene, elements_of(scene), list(end_places(scene, sea_of(scene))))
    assert predicted is not None
    block, _, sizes = chosen(scene)
    at = predicted.points[0, 0]
    assert sizes.touchdown == pytest.approx((max(at - 3.0 * sizes.along, block.x[0]), at + sizes.along), abs=0.06)


def test_a_riser_along_y_has_its_block_and_cells_along_y() -> None:
    along_x, along_y = automatic(LAY), automatic(LAY, riser__end__position=[0.0, 22.5, 15.0])
    one, other = chosen(along_x)[0], chosen(along_y)[0]
    assert other.y == pytest.approx(one.x, abs=1e-6)
    assert other.x == pytest.approx(one.y, abs=1e-6)
    assert size_of(along_x).cells == size_of(along_y).cells


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"riser__end": "free", "riser__initial": "straight"}, "soil.block: auto: the touchdown point is not known"),
        ({"riser__end__position": [18.0, 13.5, 15.0]}, "soil.mesh: auto: cells are long along x or y"),
    ],
)
def test_where_nothing_can_be_chosen_one_line_says_so(changes: Mapping, message: str) -> None:
    with pytest.raises(SceneError, match=message) as caught:
        sized(automatic(LAY, **changes))
    assert "\n" not in str(caught.value)
    assert "give " in str(caught.value)


def test_strength_that_ends_within_the_block_is_refused() -> None:
    law = {"kind": "von-mises", "su": 600.0, "su_gradient": -300.0, "E_over_su": 300.0}
    with pytest.raises(SceneError, match=r"^soil\.block: auto: 2\.4 m .*soil\.law: su .*positive"):
        sized(automatic(LAY, soil__law=law))


def test_the_resolved_scene_tells_the_sizes_and_reads_back(tmp_path: Path) -> None:
    scene = sized(automatic(LAY))
    text = dump_scene(scene)
    assert "auto" not in text.partition("soil:")[2].partition("law:")[0]
    (tmp_path / "scene.yaml").write_text(text)
    assert read_scene(tmp_path / "scene.yaml", []).soil == scene.soil
    assert sized(scene) is scene


def test_half_of_the_demo_stays_below_thirty_thousand_unknowns() -> None:
    scene = read_scene(ON_BLOCK, ["contact.method=surface", "soil.mesh=auto", "soil.block=auto"])
    assert 15e3 < size_of(scene).soil_unknowns < 30e3
    block = chosen(scene)[0]
    assert block.x == pytest.approx((16.4, 41.9))


def test_a_block_of_ones_own_keeps_its_size() -> None:
    given = deepcopy(touchdown()["soil"]["block"])
    block, _, sizes = chosen(automatic(LAY, soil__block=given))
    assert (list(block.x), list(block.y), block.depth) == (given["x"], given["y"], given["depth"])
    assert sizes.across < 0.06
