"""Several lines of which one lies on soil: as a riser by itself, in balance with all that hangs on it, on ranks."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.assembly import build
from riser_soil.checks.check import describe
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.errors import SceneError
from riser_soil.results.read import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.stages import lay
from riser_soil.whole_run import run
from tests.support.line_scenes import RHO, G, as_line, hung_over_clay, mooring, shaken
from tests.support.run_on_ranks import COMPARED
from tests.support.run_on_ranks import ran as ran_on
from tests.support.scenes import LAY, heave, touchdown

SECTIONS = {"model": "sections"}
SLOPE = {"kind": "spring", "stiffness": 1e5, "slope_deg": -3.0}
PROFILE = {"kind": "spring", "stiffness": 1e5, "profile": [[0.0, 0.0], [10.0, -0.4], [30.0, -0.6]]}


def ran(scene: Mapping[str, Any], folder: Path) -> Run:
    run(scene_from_mapping(dict(scene)), folder)
    return Run(folder)


def of_touchdown(**soil: Any) -> dict[str, Any]:
    scene = touchdown(LAY, heave(0.3), dimension=3)
    return scene | {"soil": scene["soil"] | soil}


def as_by_itself(alone: Mapping[str, Any], by_name: Mapping[str, Any], folder: Path) -> tuple[Run, Run]:
    """Runs of a riser and of the same as a line by name, once they are seen to agree to round-off."""
    one, other = ran(alone, folder / "riser"), ran(by_name, folder / "line").of_line("only")
    for name in (name for name in one.variables if one[name].dtype.kind == "f"):
        scale = np.nanmax(np.abs(one[name]), initial=0.0)
        np.testing.assert_allclose(other[name], one[name], rtol=0.0, atol=1e-9 * scale + 1e-8, err_msg=name)
    return one, other


@pytest.mark.parametrize("soil", [pytest.param({}, marks=pytest.mark.verify), SECTIONS], ids=["block", "sections"])
def test_a_line_on_soil_is_a_riser_on_soil(soil: dict[str, Any], tmp_path: Path) -> None:
    """All that is recorded: the soil's settlement beside the line's own results, and the soil's frames."""
    alone = of_touchdown(**soil)
    one, other = as_by_itself(alone, as_line(alone), tmp_path)
    assert np.nanmax(one["soil_settlement"]) > 1e-3
    assert other.has("settlement_across")
    for name, values in one.soil_frame().fields.items():
        assert other.soil_frame().fields[name] == pytest.approx(values, abs=1e-9 * np.abs(values).max())


@pytest.mark.parametrize("seabed", [SLOPE, PROFILE], ids=["slope", "profile"])
def test_a_line_on_a_slope_is_a_riser_on_a_slope(seabed: dict[str, Any], tmp_path: Path) -> None:
    """Turned by 40 degrees, so that nothing of it runs along x."""
    alone = touchdown(LAY, heave(0.3), dimension=3) | {"seabed": seabed, "soil": None}
    turned = [22.5 * np.cos(np.radians(40.0)), 22.5 * np.sin(np.radians(40.0)), 15.0]
    alone["riser"]["end"]["position"] = turned
    as_by_itself(alone, as_line(alone | {"seabed": seabed | {"direction_deg": 40.0}}), tmp_path)


def heave_of_top() -> dict[str, Any]:
    stage = dict(heave(0.3))
    return stage | {"lines": {"upper": {"motion": stage.pop("motion")}}}


@pytest.mark.verify
def test_all_weight_is_borne(tmp_path: Path) -> None:
    """Soil and seabed, supports and the buoy bear all weight, at rest, but for what the soil's last move leaves out of
    balance.
    """
    hung = ran(hung_over_clay(heave_of_top()), tmp_path)
    at = int(np.searchsorted(hung["stage"], 1)) - 1
    up, weight = 0.0, 0.0
    for name in ("lower", "upper"):
        line = hung.of_line(name)
        own = build(scene_from_mapping(hung_over_clay()), MPI.COMM_SELF).lines[name]
        weight += float(own.elements.weight @ own.elements.length)
        up += float(line["contact_force_sum"][at, 2])
    borne = hung.of_line("lower")["start_force"][at, 2] + hung.of_line("upper")["end_force"][at, 2]
    buoy = (1.8 * RHO - 300.0) * G
    assert up + borne + buoy == pytest.approx(weight, rel=3e-4)
    assert np.nanmax(hung.of_line("lower")["soil_settlement"][at]) > 1e-3
    assert up > 0.2 * weight


def test_what_lies_on_no_soil_records_none(tmp_path: Path) -> None:
    """At rest, on cells that are coarse."""
    scene = hung_over_clay(model="sections")
    scene["soil"]["mesh"]["size_at_riser"] |= {"along": 1.5, "across": 0.03}
    hung = ran(scene, tmp_path)
    assert not hung.of_line("upper").has("soil_settlement")
    assert hung.of_line("lower").has("soil_settlement")
    assert not hung.of_line("upper").has_soil
    assert hung.of_line("lower").has_soil
    assert hung.of_line("lower").summary["stages"][-1]["soil"]["max_settlement"]["value"] > 1e-3


def test_soil_is_as_it_was_until_lines_and_bodies_hang_as_they_will() -> None:
    """They are laid on a cushion, and the buoy let go there, before clay, whose path counts, is there."""
    assembly = build(scene_from_mapping(hung_over_clay(model="sections")), MPI.COMM_SELF)
    assert assembly.bodies_and_joints is not None
    place = assembly.bodies_and_joints.bodies["buoy"].x.copy()
    before, counter = lay(assembly, Timer.new())
    assert counter is not None
    assert counter.steps > 1
    assert np.abs(assembly.bodies_and_joints.bodies["buoy"].x - place).max() > 0.1
    assert assembly.soil is not None
    assert before.u.size == assembly.size
    assert assembly.soil.whole.energy(State.at_rest(0.0, assembly.size)).strain == 0.0


@pytest.mark.verify
@pytest.mark.parametrize("model", ["block", "sections"])
def test_two_ranks_find_the_same_on_soil(model: str, tmp_path: Path) -> None:
    scene = hung_over_clay(heave_of_top(), model=model)
    scene["water"] |= {"current": {"profile": [[0.0, 0.0, 0.1], [15.0, 0.0, 0.3]]}}  # to one side, not to either
    one, other = (ran_on(scene, tmp_path / str(ranks), ranks) for ranks in (1, 2))
    assert other.summary["ranks"] == 2
    for line in ("lower", "upper"):
        for name in COMPARED:
            values = one.of_line(line)[name]
            value = other.of_line(line)[name]
            np.testing.assert_allclose(value, values, rtol=0.0, atol=2e-6 * np.abs(values).max(), err_msg=name)
    for name in ("bodies/buoy/position", "joints/lower_hung/force"):
        np.testing.assert_allclose(other[name], one[name], rtol=0.0, atol=2e-6 * np.abs(one[name]).max())


@pytest.mark.verify
def test_two_ranks_find_the_same(tmp_path: Path) -> None:
    one, other = (ran_on(mooring(shaken(0.2), elements=8), tmp_path / str(ranks), ranks) for ranks in (1, 2))
    assert other.summary["ranks"] == 2
    for name in ("bodies/buoy/position", "bodies/buoy/velocity", "joints/east_top/force"):
        np.testing.assert_allclose(other[name], one[name], rtol=0.0, atol=1e-6 * np.abs(one[name]).max(), err_msg=name)


def test_check_tells_of_the_soil_under_its_line() -> None:
    said = describe(scene_from_mapping(hung_over_clay())).splitlines()
    begins = "lower: 36", "soil: ", "upper: 10"  # elements
    lower, soil, upper = (next(n for n, line in enumerate(said) if line.startswith(each)) for each in begins)
    assert lower < soil < upper
    assert sum("soil:" in line and "cells" in line for line in said) == 1


REFUSED = [
    (hung_over_clay() | {"soil": touchdown(LAY)["soil"]}, "soil.line: missing: must be one of lines .lower, upper."),
    (hung_over_clay() | {"soil": touchdown(LAY)["soil"] | {"line": "lowr"}}, "soil.line: value .lowr.: .*mean .lower"),
    (touchdown(LAY) | {"soil": touchdown(LAY)["soil"] | {"line": "a"}}, "soil.line: .*the scene has riser, not lines"),
    (mooring(seabed=SLOPE), "seabed.direction_deg: missing: seabed.slope_deg needs it"),
    (mooring(seabed=PROFILE), "seabed.direction_deg: missing: seabed.profile needs it"),
    (touchdown(LAY) | {"soil": None, "seabed": SLOPE | {"direction_deg": 3.0}}, "run along the riser's plane"),
]


@pytest.mark.parametrize(("scene", "message"), REFUSED)
def test_what_is_refused(scene: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError, match=message):
        scene_from_mapping(scene)
