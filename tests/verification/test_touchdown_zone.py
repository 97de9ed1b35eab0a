"""What a run tells of the touchdown zone: where and how deep the riser lies, how tightly it is bent."""

from __future__ import annotations

import re
from pathlib import Path

import h5py
import numpy as np
import pytest

from riser_soil.contact.touchdown import ContactInterval, merged, touchdown_arc, touchdown_points
from riser_soil.errors import ResultsError
from riser_soil.results import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.whole_run import run
from tests.support.scenes import LAY, Mapping, dynamic, prescribed, riser_scene, static, touchdown

EI, ALLOWED, RADIUS = 2.0e4, 4.0, 0.1
PIPE: Mapping = {"EA": 1e7, "EI": EI, "mass": 60.0, "outer_diameter": 2.0 * RADIUS, "submerged_weight": 300.0}


def sagging(stiffness: float = 1e5, **more: object) -> Mapping:
    """Held at both ends 8 m above a bed of springs on which its middle lies; one end then moves up and down."""
    motion = {"end": {"harmonic": {"amplitude": [0.0, 0.0, 1.0], "period": 4.0, "ramp": 2.0}}}
    return riser_scene(
        static("lay"),
        dynamic(4.0, 0.1, "heave", motion=motion),
        pipe=PIPE | {"min_bend_radius": ALLOWED},
        length=60.0,
        elements=80,
        start=prescribed(0.0, 0.0, 8.0),
        end=prescribed(48.0, 0.0, 8.0),
        seabed={"kind": "spring", "stiffness": stiffness},
        gravity=9.81,
        **more,
    )


@pytest.fixture(scope="module")
def sag(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("sag")
    run(scene_from_mapping(sagging()), folder)
    return Run(folder)


def test_a_sag_has_two_touchdown_points(sag: Run) -> None:
    np.testing.assert_array_equal(sag["touchdown_points"], 2)
    final = sag.summary["stages"][0]["final"]
    assert final["touchdown_points"] == 2
    lying = sag.arc[sag["contact_force"][0] > 0.0]
    assert lying.mean() == pytest.approx(30.0, abs=0.1), "as long on either side"
    assert 0.0 < lying.max() - final["touchdown_arc"] < 2.0


def test_touchdown_point_is_on_the_riser(sag: Run) -> None:
    """Between the nodes beside it, and as high as the pipe's radius but for the penetration and its lift-off."""
    place, arc = sag["touchdown_position"], sag["touchdown_arc"]
    for row, position in enumerate(sag["position"]):
        near = [np.interp(arc[row], sag.arc, position[:, i]) for i in range(3)]
        np.testing.assert_allclose(place[row], near, atol=3e-3)
    np.testing.assert_allclose(place[:, 2], RADIUS, atol=0.02)
    assert sag.summary["stages"][1]["final"]["touchdown_position"] == place[-1].tolist()
    extremes = sag.summary["stages"][1]["extremes"]["touchdown_position"]
    assert extremes["max"][0] == place[:, 0].max()
    assert extremes["t_max"][0] == pytest.approx(sag.time[place[:, 0].argmax()])


def test_penetration_is_the_underside_below_the_bed(sag: Run) -> None:
    expected = np.maximum(0.0, RADIUS - sag["position"][:, :, 2])
    np.testing.assert_allclose(sag["penetration"], expected, atol=1e-12)
    assert expected.max() > 1e-3


def test_embedment_is_the_greatest_penetration_so_far(sag: Run) -> None:
    expected = np.maximum.accumulate(sag["penetration"], axis=0)
    np.testing.assert_array_equal(sag["embedment"], expected)
    assert expected[-1].max() > sag["penetration"][-1].max()
    final = sag.summary["stages"][1]["final"]["max_embedment"]
    assert final == {"value": expected[-1].max(), "arc": sag.arc[expected[-1].argmax()]}


def test_least_tension_and_bend_radius_are_those_of_the_fields(sag: Run) -> None:
    for row, (tension, curvature) in enumerate(zip(sag["effective_tension"], sag["curvature"], strict=True)):
        assert sag["min_effective_tension"][row] == tension.min()
        assert sag["min_effective_tension_arc"][row] == sag.arc[tension.argmin()]
        assert 0.95 / curvature.max() < sag["min_bend_radius"][row] <= 1.0 / curvature.max()
        beside = np.abs(sag.arc - sag["min_bend_radius_arc"][row]) <= np.diff(sag.arc).max()
        assert curvature[beside].max() > 0.99 * curvature.max()
    np.testing.assert_allclose(sag["bend_utilisation"], ALLOWED * sag["curvature"], rtol=1e-12)


def test_the_warning_tells_where_and_when_the_pipe_is_bent_most(sag: Run) -> None:
    lay, heave = sag.summary["stages"]
    used, largest = sag["bend_utilisation"], heave["extremes"]["max_bend_utilisation"]
    row, node = np.unravel_index(used.argmax(), used.shape)
    assert lay["warnings"] == []
    assert 1.0 < used.max() <= largest["max"] < 1.01 * used.max()
    assert largest["t_max"] == sag.time[row]
    match = re.fullmatch(
        rf"the pipe is bent beyond its min_bend_radius: {largest['max']:.4g} times the limit at arc (\S+) m and "
        rf"{sag.time[row]:.5g} s, where the bend radius is {ALLOWED / largest['max']:.4g} m",
        heave["warnings"][0],
    )
    assert match is not None
    assert abs(float(match[1]) - sag.arc[node]) < 0.75


def test_units(sag: Run) -> None:
    units = {"touchdown_position": "m", "touchdown_points": "1", "penetration": "m", "embedment": "m"}
    units |= {"min_effective_tension": "N", "min_bend_radius": "m", "bend_utilisation": "1"}
    with h5py.File(sag.folder / "results.nc") as file:
        assert {name: file[name].attrs["units"] for name in units} == units


def test_only_what_is_asked_and_known(tmp_path: Path) -> None:
    scene = sagging(output={"fields": ["curvature", "penetration"]})
    del scene["line_types"]["pipe"]["min_bend_radius"], scene["stages"][1]
    run(scene_from_mapping(scene), tmp_path)
    assert Run(tmp_path)["penetration"].max() > 0.0
    for name in ("embedment", "bend_utilisation"):
        with pytest.raises(ResultsError, match=f"no {name};"):
            Run(tmp_path)[name]
    assert not {"max_embedment", "max_bend_utilisation"} & {*Run(tmp_path).summary["stages"][0]["final"]}


def test_where_line_types_meet_the_one_nearer_to_its_limit_counts(tmp_path: Path) -> None:
    """A cantilever of two pipes: the moment at the joint is one, the curvatures are M/EI of either pipe."""
    soft, stiff = PIPE | {"min_bend_radius": 3.0}, PIPE | {"EI": 4.0 * EI, "min_bend_radius": 10.0}
    clamped = prescribed(0, 0, 0, rotation="fixed")
    scene = riser_scene(static(), pipe=soft, length=2.0, elements=4, start=clamped, end="free")
    scene["line_types"]["stiff"] = stiff
    scene["riser"]["segments"].insert(0, {"line_type": "stiff", "length": 2.0, "elements": 4})
    scene["riser"]["initial"] = "straight"
    run(scene_from_mapping(scene | {"dimension": 2, "gravity": 9.81}), tmp_path / "soft_governs")
    results = Run(tmp_path / "soft_governs")
    M, used = results["bending_moment"][-1], results["bend_utilisation"][-1]
    assert used[4] == pytest.approx(M[4] * 3.0 / EI, rel=1e-9)
    assert used[3] == pytest.approx(M[3] * 10.0 / (4.0 * EI), rel=1e-9)


def test_embedment_in_soil_counts_from_where_it_lay(tmp_path: Path) -> None:
    scene = touchdown(LAY, su=1000.0)
    scene["soil"]["strain"] = "small"
    run(scene_from_mapping(scene), tmp_path)
    results = Run(tmp_path)
    settlement = -results.soil_frame().fields["displacement"][:, 2].min()
    on_soil = (results["position"][-1, :, 0] > 2.5) & (results["position"][-1, :, 0] < 8.5)
    embedment, penetration = results["embedment"][-1, on_soil], results["penetration"][-1, on_soil]
    assert settlement > 1e-3
    assert penetration.max() < 0.3 * settlement
    assert embedment.max() == pytest.approx(settlement, rel=0.2)
    assert results["touchdown_points"][-1] == 1
    tell_of_the_trough(results)


@pytest.mark.verify
def test_the_soil_gets_what_the_ends_do_not_bear(tmp_path: Path) -> None:
    """By contact and friction together, where the block reaches beyond the riser's start, after its end was moved.

    Level forces of contact alone are a hundred times less. The records look along the directions in which the next
    step slides: friction in them differs from that in balance by some 1e-5.
    """
    scene = touchdown(LAY, static("aside", move={"end": [22.6, 0.1, 15.0]}), su=6000.0, dimension=3, tolerance=1e-10)
    del scene["seabed"]
    scene["soil"]["block"]["x"] = [-1.0, 9.0]
    scene["contact"] = {"friction": {"axial": 0.4, "lateral": 0.6}}
    run(scene_from_mapping(scene), tmp_path)
    results = Run(tmp_path)
    length = np.diff(results.arc, prepend=results.arc[0], append=results.arc[-1])
    on_soil = 0.5 * (length[:-1] + length[1:]) @ results["force_on_soil"][-1]
    ends = (results["start_force"] + results["end_force"])[-1]
    assert ends[1] > 30.0
    np.testing.assert_allclose(on_soil[:2], ends[:2], atol=1e-4 * ends[1])
    assert np.abs(results["contact_force_sum"][-1, :2]).max() < 0.03 * ends[1]


def tell_of_the_trough(run: Run) -> None:
    """Along the riser where it touches the soil alone, and in the section at the touchdown point."""
    sunk = run["embedment"][-1] - run["penetration"][-1]
    alone = (run["force_on_soil"][-1, :, 2] < 0.0) & (np.abs(run["position"][-1, :, 0] - 5.0) < 2.5)
    assert np.count_nonzero(alone) > 5
    in_plane = np.linalg.norm(run["force_on_soil"][-1, :, ::2], axis=1)  # the mesh's two halves are no mirror images
    np.testing.assert_allclose(in_plane[alone], run["contact_force"][-1, alone], rtol=1e-9)
    touching = alone & (run["penetration"][-1] > 0.0)  # a node has its share of what elements beside it press on
    assert np.count_nonzero(touching) > 5
    np.testing.assert_allclose(run["soil_settlement"][-1, touching], sunk[touching], rtol=1e-9)
    assert np.isnan(run["soil_settlement"][-1, run["position"][-1, :, 0] > 9.5]).all()
    assert run["section_arc"][-1, 0] == run["touchdown_arc"][-1]
    np.testing.assert_array_equal(run["section_position"][-1, 0], run["touchdown_position"][-1])
    np.testing.assert_allclose(run["section_direction"][-1, 0], [0.0, 1.0, 0.0], atol=1e-12)
    trough, offset = run["settlement_across"][-1, 0], run["offset"]
    assert (offset[0], offset[-1], len(offset)) == pytest.approx((-0.9, 0.9, 61))
    assert trough[30] == pytest.approx(trough.max(), rel=1e-6)
    np.testing.assert_allclose(trough, trough[::-1], rtol=1e-6, atol=1e-9)
    assert trough[30] > 2.0 * trough[0]


def test_ground_after_ground_is_one_stretch() -> None:
    on_seabed, on_soil = ContactInterval(0.0, 10.0, True, False), ContactInterval(10.4, 20.0, False, False)
    far = ContactInterval(25.0, 30.0, False, True)
    one, other = merged([far, on_soil, on_seabed], near=0.5)
    assert one == (0.0, 20.0, True, False)
    assert other == far
    assert (touchdown_arc([one, other]), touchdown_points([one, other])) == (25.0, 2)
    (whole,) = merged([far, on_soil, on_seabed], near=5.0)
    assert whole == (0.0, 30.0, True, True)
    assert (touchdown_arc([whole]), touchdown_points([whole])) == (30.0, 0)
    assert len(merged([on_seabed, on_soil], near=0.3)) == 2
    assert merged([], near=1.0) == []


@pytest.mark.parametrize("elements", [61, 62, 66])
def test_a_line_from_the_floater_down_comes_down_at_one_place_whatever_its_mesh(elements: int, tmp_path: Path) -> None:
    """It lies to its end, whose arc length sums of elements and of stations' shares give with different round-off."""
    scene = riser_scene(
        static("lay"),
        pipe=PIPE,
        length=41.7,
        elements=elements,
        start=prescribed(0.0, 0.0, 12.0),
        end=prescribed(36.0, 0.0, RADIUS),
        seabed={"kind": "spring", "stiffness": 1.0e5},
        gravity=9.81,
    )
    run(scene_from_mapping(scene), tmp_path)
    final = Run(tmp_path).summary["stages"][0]["final"]
    assert final["touchdown_points"] == 1
    assert 15.0 < final["touchdown_arc"] < 30.0
