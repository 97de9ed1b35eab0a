"""What `check` tells of a scene: parts, unknowns, memory, and physical warnings with their numbers."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from meshes.block import main as mesh
from riser_soil.checks.check import describe
from riser_soil.checks.inventory import inventory
from riser_soil.scene.reader import scene_from_mapping
from tests.support.driven_stage import built_of
from tests.support.said import line_with, lines_with
from tests.support.scenes import LAY, Mapping, heave, prescribed, riser_scene, touchdown

# Of the small scenes, whose cells are wide beside what touches them, and whose clay is soft beside their springs.
KNOWN = "at its nodes only", "soil.mesh.size_at_riser", "seabed beside the soil"


def report(mapping: Mapping) -> str:
    return describe(scene_from_mapping(mapping))


def warnings(mapping: Mapping) -> list[str]:
    """But for those that these scenes have."""
    lines = [line for line in report(mapping).splitlines() if line.startswith("warning: ")]
    return [line for line in lines if not any(known in line for known in KNOWN)]


def without_soil(*stages: Mapping) -> Mapping:
    return {key: value for key, value in touchdown(*stages).items() if key != "soil"}


def with_value(mapping: Mapping, *path: str | int, value: Any) -> Mapping:
    inner: Any = mapping
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    return mapping


def test_a_whole_scene() -> None:
    mapping = touchdown(LAY, heave(1.0))
    lines, parts = report(mapping).splitlines(), inventory(built_of(scene_from_mapping(mapping)))
    assert line_with(lines, "2 load steps", "riser", "2 dimensions").startswith(mapping["title"])
    assert parts.built == ("riser", "inertia", "morison", "seabed", "soil", "new mesh", "cushion", "contact")
    assert lines[1].startswith("by hand, at rest as a cable: H = ")
    assert lines[-2] == "model: riser, inertia, drag and added mass, seabed, soil, large strain of soil, " + (
        "laying on a cushion, contact"
    )
    assert [*parts.left_out][:2] == ["springs", "attachments"]
    assert lines[-1].startswith("not in the model: rotational springs at the ends, attachments, internal flow, ")
    assert lines[-1].endswith(f", true wall tension ({parts.left_out['wall tension']})")
    line_with(lines, "riser:", "36 elements", "0.5 to 1.5 m", "107 unknowns")  # 37 nodes of 3, less two positions
    line_with(lines, "contact stiffness", "seabed", "1e+05 N/m2")
    line_with(lines, "warning:", "soil.mesh.size_at_riser 0.5 m", "2.1 times", "0.234 m")
    assert "2 warnings" in lines
    places = [lines.index(line_with(lines, word)) for word in ("TDP", "2 warnings", "estimated time:", "model: riser,")]
    assert places == sorted(places)
    at_nodes = report({**touchdown(LAY, heave(1.0)), "contact": {"method": "node"}}).splitlines()
    line_with(at_nodes, "warning:", "at its nodes only", "0.5 m apart", "cells of 0.5 m")


def test_strain_of_the_soil_is_reported_with_its_reason() -> None:
    clay = {**touchdown(), "contact": {"method": "surface"}}
    line_with(report(clay), "soil:", "large strain", "yields")
    line_with(report(with_value(clay, "soil", "strain", value="small")), "soil:", "small strain:", "soil.strain: small")
    law = {"kind": "linear-elastic", "E": 1e6, "nu": 0.4}
    line_with(report(with_value(clay, "soil", "law", value=law)), "soil:", "small strain:", "elastic")


def test_a_scene_without_doubts() -> None:
    assert "no warnings" in report(without_soil(LAY, heave(1.0))).splitlines()


def test_unknowns_of_the_soil_are_those_that_are_free() -> None:
    """A block of one cell: of its 8 nodes the bottom is fixed, the top slides down its sides; half of it are images."""
    one_cell = with_value(touchdown(), "soil", "mesh", value={"kind": "hex", "size_at_riser": 9.0, "size_far": 9.0})
    line_with(report(one_cell), "soil:", "1 cells", "2 unknowns")
    line_with(report(with_value(one_cell, "soil", "symmetry", value="whole")), "soil:", "1 cells", "4 unknowns")


def reasons(mapping: Mapping) -> Mapping:
    """Why parts are left out."""
    return inventory(built_of(scene_from_mapping(mapping))).left_out


def test_reasons_of_what_is_left_out() -> None:
    left_out = reasons(without_soil())
    line_with([left_out["soil"]], "no soil")
    line_with([left_out["inertia"]], "no stage", "dynamic")
    line_with([left_out["morison"]], "no stage", "dynamic", "still water")


def test_a_dry_riser_has_no_hydrodynamics() -> None:
    dry = without_soil(heave(1.0))
    del dry["water"], dry["line_types"]["flexible"]["drag"], dry["line_types"]["flexible"]["added_mass"]
    line_with([reasons(dry)["morison"]], "no water")


def test_a_smooth_riser_has_no_hydrodynamics() -> None:
    smooth = without_soil(heave(1.0))
    del smooth["line_types"]["flexible"]["drag"], smooth["line_types"]["flexible"]["added_mass"]
    line_with([reasons(smooth)["morison"]], "line type", "drag", "added mass", "attachment")


def test_vortices_are_shed_in_motion_and_make_the_scene_spatial() -> None:
    shed = with_value(without_soil(heave(1.0)), "line_types", "flexible", "vortex_force", value={})
    line_with([reasons(without_soil(heave(1.0)))["vortices"]], "line type", "vortex_force")
    spatial = with_value(shed, "dimension", value="auto")
    assert {"morison", "vortices"} <= {*inventory(built_of(scene_from_mapping(spatial))).built}
    assert "riser in 3 dimensions" in report(spatial)
    line_with([reasons(with_value(shed, "stages", value=[LAY]))["vortices"]], "no stage", "dynamic")


@pytest.mark.parametrize(
    ("water", "parts"),
    [
        ({}, ("riser", "seabed", "contact")),
        ({"surface_level": 50.0}, ("riser", "buoyancy", "seabed", "contact")),
        ({"current": {"profile": [[0.0, 1.0, 0.0]]}}, ("riser", "morison", "seabed", "contact")),
    ],
)
def test_statics_have_what_their_water_does(water: Mapping, parts: tuple[str, ...]) -> None:
    scene = with_value(without_soil(), "water", value=water)
    assert inventory(built_of(scene_from_mapping(scene))).built == parts
    if not water:
        line_with([reasons(scene)["buoyancy"]], "no surface", "submerged")


def test_springs_and_loads_are_built_when_asked_for() -> None:
    lift = {"name": "lift", "kind": "static", "loads": [{"at": 10.0, "force": [0.0, 0.0, 1.0e3]}]}
    sprung = with_value(without_soil(lift), "riser", "end", "rotation", value={"stiffness": 1.0e4})
    assert inventory(built_of(scene_from_mapping(sprung))).built == ("riser", "springs", "loads", "seabed", "contact")


def test_attachments_are_counted_and_weighed() -> None:
    attached = [{"at": [5.0, 6.0], "mass": 100.0, "volume": 0.2}, {"at": 9.0, "mass": 50.0}]
    laden = with_value(without_soil(), "riser", "attachments", value=attached)
    net = 9.81 * (250.0 - 0.4 * 1025.0)
    line_with(report(laden), "3 attachments:", "less buoyancy", f"{net:.4g} N")


def test_memory_grows_with_the_soil() -> None:
    fine = {"kind": "hex", "size_at_riser": 0.2, "size_far": 0.5}
    scenes = without_soil(), touchdown(), with_value(touchdown(), "soil", "mesh", value=fine)
    memory = [re.findall(r"estimated memory: (\d+) MB on 1 rank", report(scene)) for scene in scenes]
    bare, small, large = (float(number) for (number,) in memory)
    assert 50.0 < bare < small < large


def test_long_elements_at_touchdown_are_reported_with_the_boundary_layer() -> None:
    segments = [{"line_type": "flexible", "length": 30.0, "elements": 6}]
    coarse = with_value(without_soil(), "riser", "segments", value=segments)
    (warning,) = warnings(coarse)
    layer, H, most = (float(x) for x in re.findall(r"(?:= |at most )([\d.]+)", warning))
    assert "at the touchdown point" in warning
    assert "are 5 m long" in warning
    assert layer == pytest.approx(np.sqrt(5.0e4 / H), rel=1e-3)
    assert most == pytest.approx(0.5 * layer, rel=1e-2)


def test_long_elements_at_a_clamped_end_are_reported() -> None:
    clamped = with_value(without_soil(), "riser", "end", "rotation", value="fixed")
    clamped["line_types"]["flexible"]["EI"] = 500.0
    line_with(warnings(clamped), "elements at the end", "1.5 m long")


def test_elements_of_very_different_lengths_are_reported_where_waves_meet_them() -> None:
    segments: list[Mapping] = [{"line_type": "flexible", "length": 15.0, "elements": n} for n in (50, 10)]
    uneven = with_value(without_soil(heave(1.0)), "riser", "segments", value=segments)
    line_with(warnings(uneven), "meet at arc 15 m", "0.3 m and 1.5 m", "about 9 m")
    still = with_value(without_soil(), "riser", "segments", value=segments)
    assert not lines_with(warnings(still), "meet at arc")
    segments[1] = {"line_type": "flexible", "length": 15.0, "element_length": [0.3, 1.5]}
    graded = with_value(without_soil(heave(1.0)), "riser", "segments", value=segments)
    assert not lines_with(warnings(graded), "meet at arc")


def test_a_floating_pipe_is_reported_with_its_weight() -> None:
    floating = without_soil()
    floating["line_types"]["flexible"]["submerged_weight"] = -30.0
    floating["riser"]["initial"] = "straight"
    floating["riser"]["end"]["position"] = [30.0, 0.0, 0.15]
    line_with(warnings(floating), "submerged weight", "negative", "-30 N/m", "arc 0 m")


@pytest.mark.parametrize(
    ("stiffness", "says"),
    [
        (1.0e4, ("contact.stiffness 1e+04 N/m2", "below", "Young's modulus", "1.8e+05 Pa")),
        (1.0e10, ("contact.stiffness 1e+10 N/m2", "5.6e+04 times", "Young's modulus")),
    ],
)
def test_penalty_far_from_the_soil_is_reported(stiffness: float, says: tuple[str, ...]) -> None:
    (warning,) = warnings({**touchdown(), "contact": {"stiffness": stiffness, "smoothing": 0.0}})
    line_with([warning], *says)


def test_a_stiff_penalty_rounded_over_a_long_way_is_reported() -> None:
    (warning,) = warnings({**touchdown(), "contact": {"stiffness": 1.0e8, "smoothing": 1.0e-3}})
    line_with([warning], "2.5e+04 N/m", "moment of touching")


def test_a_riser_that_lies_beyond_the_soil_is_reported() -> None:
    alone = touchdown()
    del alone["seabed"]
    (warning,) = warnings(alone)
    line_with([warning], "nodes", "arc 0 to 1.5 m", "beyond the soil")
    alone["soil"]["block"]["x"] = [-1.0, 12.0]
    assert not warnings(alone)


def test_several_warnings_are_counted() -> None:
    soft = {**touchdown(), "contact": {"stiffness": 1.0e4}}
    soft["line_types"]["flexible"]["EI"] = 500.0  # bends where a stiff pipe would not: twice told beside the soil
    lines = report(soft).splitlines()
    assert "6 warnings" in lines
    assert len(warnings(soft)) == 4


def long_riser(elements: int) -> Mapping:
    """Nothing of it touches down, nothing is clamped; its largest moment is 264.4 N.m."""
    pipe: Mapping = {"EA": 1.0e9, "EI": 1.0e6, "mass": 120.0, "submerged_weight": 500.0}
    ends = prescribed(0.0, 0.0, 0.0), prescribed(7000.0, 0.0, 6000.0)
    return riser_scene(
        LAY, pipe=pipe, length=1.0e4, elements=elements, start=ends[0], end=ends[1], gravity=9.81
    )


def test_long_elements_in_a_bend_are_reported_with_the_error_of_the_moment() -> None:
    (warning,) = warnings(long_riser(40))
    line_with([warning], "250 m", "arc 875 m", "too long", "bend")
    numbers = r"= ([\d.]+) N\.m, ([\d.]+)% of the largest, ([\d.]+) N\.m: take at most ([\d.]+)"
    error, share, largest, longest = (float(x) for x in re.findall(numbers, warning)[0])
    assert largest == pytest.approx(264.4, rel=0.01)
    assert error == pytest.approx(0.01 * share * largest, rel=0.01)
    assert longest == pytest.approx(250.0 * (9.0 / share) ** 0.25, rel=0.01)
    assert not warnings(long_riser(int(1.0e4 / longest) + 1))


@pytest.mark.parametrize(("key", "given"), [("friction", {"axial": 0.3}), ("suction", {"cap": 50.0, "reach": 0.1})])
def test_nodes_without_friction_or_suction_on_soil_are_reported(key: str, given: Mapping) -> None:
    rough = {**touchdown(), "contact": {"method": "node", key: given}}
    warning, strains = warnings(rough)
    line_with([warning], f"contact.{key}", "seabed only", "2 to 9 m", "-1 to 1 m")
    assert "small strain" in strains
    rough["contact"]["method"] = "auto"
    assert not warnings(rough)
    del rough["soil"]
    assert not warnings(rough)


def test_soil_that_the_riser_does_not_reach_is_reported() -> None:
    aside = with_value(touchdown(), "soil", "block", "x", value=[18.0, 21.0])
    (warning,) = warnings(aside)
    gap = float(re.findall(r"hangs ([\d.]+) m above it", warning)[0])
    assert 6.0 < gap < 8.0
    line_with([warning], "ends move", "0 m")
    for stages, count in (([LAY, heave(3.0)], 1), ([LAY, heave(3.0, amplitude=2.0)], 0)):
        assert len(lines_with(warnings(aside | {"stages": stages}), "does not reach")) == count
    pushed = {"name": "push", "kind": "static", "loads": [{"distributed": [0.0, 0.0, -1.0e3]}]}
    line_with(warnings(aside | {"stages": [pushed]}), "does not reach")
    gentle = with_value(touchdown(pushed), "soil", "block", "x", value=[10.0, 13.0])
    assert not warnings(gentle)


def test_soil_beside_the_riser_is_reported() -> None:
    beside = with_value(touchdown(), "soil", "block", "y", value=[3.0, 5.0])
    beside["riser"] |= {"initial": {"points": [[0.0, 0.0, 0.15], [10.0, 0.0, 0.15], [22.5, 0.0, 15.0]]}}
    line_with(warnings(beside), "does not reach", "3 to 5 m", "first shape", "not above")


@pytest.mark.parametrize(("level", "count"), [(0.0, 0), (0.3, 1)])
def test_a_mesh_whose_top_is_off_the_seabed_is_reported(level: float, count: int, tmp_path: Path) -> None:
    box = ["--x", "2", "9", "--y", "-1", "1", "--depth", "1", "--size", "0.5", "--size-far", "1"]
    mesh([str(tmp_path / "soil.msh"), *box, "--level", str(level)])
    scene = with_value(touchdown(), "soil", "mesh", value={"file": str(tmp_path / "soil.msh")})
    del scene["soil"]["block"]
    assert len(lines := lines_with(warnings(scene), "nowhere at the seabed")) == count
    assert len(lines_with(lines, "soil's top", "0.3 to 0.3 m", "z = 0 m")) == count


def test_static_loads_that_end_with_their_stage_are_reported() -> None:
    lift: Mapping = {"at": 20.0, "force": [0.0, 0.0, 1.0e3]}
    lifted = {"name": "lift", "kind": "static", "loads": [lift]}

    def warned(*stages: Mapping) -> list[str]:
        return lines_with(warnings(without_soil(*stages)), "ends with its stage")

    (line,) = warned(LAY, lifted, heave(1.0))
    assert line.startswith("warning: stages.1.loads.0: force [0.0, 0.0, 1000.0] N")
    line_with([line], "at 20.0", "heave", "springs back", "keep: true")
    line_with(warned(lifted, LAY)[:1], "lay", "comes back")
    assert not warned(LAY, lifted)
    assert not warned(lifted, heave(1.0) | {"loads": [lift | {"history": [[0.0, 1.0], [1.0, 0.5]]}]})
    assert warned(lifted, heave(1.0) | {"loads": [lift | {"at": 10.0}]})
    let_go = lifted | {"loads": [lift | {"history": [[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]]}]}
    assert not warned(let_go, heave(1.0))
