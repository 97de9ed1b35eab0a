"""Chain and rope without bending stiffness, longer than they need be: they go slack, hang straight down, and lie in a
heap, and bear no compression.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from ruamel.yaml import YAML

from riser_soil.results import Run
from riser_soil.riser.catenary import catenary
from tests.support.on_ranks import mpirun
from tests.support.runs import run_of
from tests.support.said import lines_with
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene, static

W, SPAN, HEIGHT = 1400.0, 170.0, 115.0
CHAIN = {"EA": 6e8, "EI": 0.0, "GJ": 1.0, "submerged_weight": W, "outer_diameter": 0.15, "mass": 165.0}
SPRING = {"kind": "spring", "level": 0.0, "contact_at": "axis", "stiffness": 4e5}
RIGID = {"kind": "rigid", "level": 0.0, "contact_at": "axis"}
CLAY: Mapping = {"kind": "randolph-quiggin", "su": 4e3, "su_gradient": 1.2e3}
HYSTERETIC = {"kind": "hysteretic", "level": 0.0, "contact_at": "axis", "law": CLAY}
PULLS = 3e-4  # of the weight that hangs: what a slack chain pulls at its anchor
HEAVE: Mapping = {"end": {"harmonic": {"amplitude": [0.0, 0.0, 1.0], "period": 9.0, "ramp": 4.5}}}


def slack(length: float, elements: int, turned: bool = False, **more: Any) -> Mapping:
    """A chain from the seabed to a place over it; turned: from there to the seabed."""
    stages = more.pop("stages", (static(),))
    low, high = prescribed(0.0, 0.0, 0.0), prescribed(SPAN, 0.0, HEIGHT)
    ends: Mapping = {"start": high, "end": low} if turned else {"start": low, "end": high}
    options: Mapping = {"pipe": CHAIN, "length": length, "elements": elements, "gravity": 9.81, "seabed": SPRING}
    return riser_scene(*stages, **(options | ends | more))


@pytest.mark.parametrize(
    ("length", "elements", "more"),
    [
        (SPAN + HEIGHT, 40, {}),
        (1.01 * (SPAN + HEIGHT), 10, {"dimension": 3}),
        (1.3 * (SPAN + HEIGHT), 10, {"turned": True}),
        (1.3 * (SPAN + HEIGHT), 100, {"dimension": 3, "seabed": RIGID}),
        (2.0 * (SPAN + HEIGHT), 23, {"seabed": RIGID}),
        (2.0 * (SPAN + HEIGHT), 400, {}),
        (3.0 * (SPAN + HEIGHT), 10, {"seabed": HYSTERETIC}),
        (3.0 * (SPAN + HEIGHT), 40, {"turned": True, "dimension": 3}),
    ],
)
def test_a_heaped_chain_hangs_by_its_own_weight(
    length: float, elements: int, more: dict[str, Any], tmp_path: Path
) -> None:
    """The top bears what hangs down to the seabed, whatever the mesh, the anchor nothing, and no node pushes."""
    run = run_of(slack(length, elements, **more), tmp_path)
    ends = ("start_force", "end_force") if more.get("turned") else ("end_force", "start_force")
    top, anchor = (run[name][-1] for name in ends)
    assert top[2] == pytest.approx(W * HEIGHT, rel=1e-3)
    assert np.abs([top[0], top[1], anchor[0], anchor[1]]).max() < PULLS * length / SPAN * W * HEIGHT
    assert run["effective_tension"][-1].min() > -1e-4 * W * HEIGHT
    position = run["position"][-1]
    hangs = position[:, 2] > 0.01 * HEIGHT
    assert np.abs(position[hangs, 0] - SPAN).max() < 0.02 * HEIGHT
    assert position[:, 2].min() > -0.5


WATER, GRAVITY = 1025.0, 9.81


def hung(arc: float, net: float) -> Mapping:
    """A clump, or a float where its net weight [N] is negative, at an arc length [m]."""
    return {"at": arc} | ({"mass": net / GRAVITY} if net > 0.0 else {"volume": -net / (GRAVITY * WATER)})


@pytest.mark.parametrize("elements", [8, 30])
@pytest.mark.parametrize(("length", "hangs"), [(230.0, [(150.0, -9e4)]), (250.0, [(100.0, -2e5), (160.0, 4e4)])])
def test_floats_and_clumps_make_kinks(
    length: float, hangs: list[tuple[float, float]], elements: int, tmp_path: Path
) -> None:
    """Tensions are the cable's, which turns by about a right angle at what hangs there. With the elements as asked for
    the top bears 3.6 and 3.9 % less.
    """
    scene = dict(slack(length, elements, water={"density": WATER}))
    scene["riser"] |= {"attachments": [hung(*each) for each in hangs]}
    run = run_of(scene, tmp_path)
    ends = np.array([0.0, 0.0, 0.0]), np.array([SPAN, 0.0, HEIGHT])
    cable = catenary(np.linspace(0.0, length, 2), *ends, W, CHAIN["EA"], level=0.0, points=np.array(hangs))
    assert np.linalg.norm(run["end_force"][-1]) == pytest.approx(cable.tension[-1], rel=1.5e-3)
    assert run["end_force"][-1][0] == pytest.approx(cable.H, rel=3e-3)


@pytest.mark.parametrize(
    ("span", "length", "elements", "more"),
    [
        (0.0, 0.99999, 1, {"pipe": {"EA": 1e6}}),
        (0.0, 1.0, 1, {}),
        (0.0, 1.0, 3, {"turned": True}),
        (0.0, 1.001, 10, {"pipe": {"EA": 1e6}}),
        (0.0, 1.02, 1, {}),
        (0.0, 1.0, 1, {"dimension": 3}),
        (0.0, 1.0, 3, {"pipe": {"submerged_weight": -300.0}}),
        (0.0, 1.3, 10, {}),
        (0.001, 1.3, 2, {}),
        (0.0, 3.0, 1, {"dimension": 3}),
        (0.02, 3.0, 40, {"turned": True}),
    ],
)
def test_a_slack_line_between_ends_above_each_other_hangs_in_two_legs(
    span: float, length: float, elements: int, more: dict[str, Any], tmp_path: Path
) -> None:
    """The higher end bears the longer leg, the lower one what hangs from it, or nothing: neither pushes."""
    more = dict(more)
    pipe: Mapping = CHAIN | more.pop("pipe", {})
    low, high = (0.0, 0.0, 0.0), (span, 0.0, 1.0)
    names = ("end", "start") if more.pop("turned", False) else ("start", "end")
    ends: Mapping = {name: prescribed(*at) for name, at in zip(names, (low, high), strict=True)}
    scene = riser_scene(static(), pipe=pipe, length=length, elements=elements, gravity=9.81, **ends, **more)
    run = run_of(scene, tmp_path)
    lower, upper = (
        run[f"{name}_force"][-1][2] for name in (names if pipe["submerged_weight"] > 0.0 else names[::-1])
    )
    weight, below = pipe["submerged_weight"], max(0.0, 0.5 * (length - 1.0))
    assert upper == pytest.approx(weight * (length - below), rel=1e-3)
    assert lower == pytest.approx(weight * below, abs=1e-3 * abs(weight) * length)
    assert run["effective_tension"][-1].min() > -1e-3 * abs(weight) * length
    with (tmp_path / "summary.json").open() as file:
        assert "laying" not in json.load(file)


@pytest.mark.parametrize(
    "more",
    [
        {"riser": {"attachments": [{"at": 40.0, "mass": 2000.0}]}},
        {"riser": {"attachments": [{"at": 240.0, "mass": 2000.0}]}, "dimension": 3},
        {"contact": {"friction": {"axial": 0.5, "lateral": 0.7, "mobilisation": 0.02}}},
    ],
)
def test_what_lies_in_the_heap_does_not_count_at_the_top(more: dict[str, Any], tmp_path: Path) -> None:
    """A clump sinks in, friction holds what lies; the top bears what hangs."""
    run = run_of(slack(1.3 * (SPAN + HEIGHT), 40, **more), tmp_path)
    assert run["end_force"][-1][2] == pytest.approx(W * HEIGHT, rel=1e-3)


@pytest.mark.verify
def test_a_heap_is_the_same_on_two_ranks(tmp_path: Path) -> None:
    alone = run_of(slack(1.3 * (SPAN + HEIGHT), 10), tmp_path / "1")
    with (tmp_path / "scene.yaml").open("w") as file:
        YAML().dump(slack(1.3 * (SPAN + HEIGHT), 10), file)
    ended = mpirun(2, "-m", "riser_soil", "run", "scene.yaml", "-o", "2", folder=tmp_path)
    assert ended.returncode == 0, ended.stderr
    both = Run(tmp_path / "2")
    for name, scale in (("position", HEIGHT), ("effective_tension", W * HEIGHT), ("end_force", W * HEIGHT)):
        np.testing.assert_allclose(both[name], alone[name], rtol=0.0, atol=1e-6 * scale, err_msg=name)


def heaved(elements: int, folder: Path) -> Run:
    """A heap in water whose top heaves for a period and a half."""
    stages = static(), dynamic(13.5, 0.1, motion=HEAVE) | {"time_step": "auto"}
    drag: Mapping = {"drag": {"normal": 1.2, "tangential": 0.1}, "added_mass": {"normal": 1.0, "tangential": 0.1}}
    water = {"surface_level": 130.0, "depth": 130.0}
    return run_of(slack(1.3 * (SPAN + HEIGHT), elements, stages=stages, pipe=CHAIN | drag, water=water), folder)


# N, of what hangs
INERTIA = (CHAIN["mass"] + 0.1 * 1025.0 * np.pi / 4.0 * 0.15**2) * HEIGHT * (2.0 * np.pi / 9.0) ** 2


def test_a_heap_under_a_mildly_moving_end_runs_to_its_end(tmp_path: Path) -> None:
    """The top bears what hangs, within a percent at rest, and in motion its inertia, with what comes down."""
    run = heaved(10, tmp_path)
    assert run["time"][-1] == pytest.approx(13.5)
    top = run["end_force"][:, 2]
    assert top[0] == pytest.approx(W * HEIGHT, rel=1.5e-2)
    assert np.abs(top - W * HEIGHT).max() < 4.0 * INERTIA
    assert np.ptp(top) > INERTIA


@pytest.mark.verify
def test_short_elements_that_snap_under_a_moving_end_are_warned_of(tmp_path: Path) -> None:
    """They are picked up one by one, by the wave of their speed: the top's tension is several times what it should."""
    run = heaved(100, tmp_path)
    assert np.abs(run["end_force"][:, 2] - W * HEIGHT).max() > 4.0 * INERTIA
    warnings = run.summary["stages"][1]["warnings"]
    for words in ("the line is compressed by", "the energy balance is"):
        assert lines_with(warnings, words)


@pytest.mark.parametrize(
    ("span", "length", "elements", "more"),
    [
        (0.0, 1.3, 10, {}),
        (0.0, 3.0, 40, {"dimension": 3, "seabed": RIGID}),
        (0.1, 1.1, 100, {"turned": True}),
        (1.0, 2.0, 400, {"seabed": RIGID}),
        (3.0, 1.3, 40, {"dimension": 3}),
        (8.0, 1.3, 10, {}),
    ],
)
def test_a_heap_lies_right_under_its_top(
    span: float, length: float, elements: int, more: dict[str, Any], tmp_path: Path
) -> None:
    """At any mesh, however near the ends are; the anchor in the heap bears nothing. length: over the height."""
    low, high = prescribed(0.0, 0.0, 0.0), prescribed(span, 0.0, HEIGHT)
    more = dict(more)
    turned = more.pop("turned", False)
    ends: Mapping = {"start": high, "end": low} if turned else {"start": low, "end": high}
    run = run_of(heap_under(length * HEIGHT, elements, **ends, **more), tmp_path)
    top, anchor = (run[f"{name}_force"][-1] for name in (("start", "end") if turned else ("end", "start")))
    assert top[2] == pytest.approx(W * HEIGHT, rel=1e-3)
    assert np.linalg.norm(anchor) < PULLS * W * HEIGHT
    assert run["effective_tension"][-1].min() > -PULLS * W * HEIGHT


@pytest.mark.parametrize(("span", "elements"), [(0.0, 10), (1.0, 100)])
def test_two_legs_hang_side_by_side_to_one_heap(span: float, elements: int, tmp_path: Path) -> None:
    """Each bears its own weight down to the seabed."""
    ends: Mapping = {"start": prescribed(0.0, 0.0, HEIGHT), "end": prescribed(span, 0.0, HEIGHT)}
    run = run_of(heap_under(2.5 * HEIGHT, elements, **ends), tmp_path)
    for name in ("start", "end"):
        assert run[f"{name}_force"][-1][2] == pytest.approx(W * HEIGHT, rel=1e-3)


@pytest.mark.parametrize(("span", "elements", "dimension"), [(0.0, 10, 2), (0.1, 40, 3)])
def test_a_rope_that_floats_lies_in_a_heap_over_its_anchor(
    span: float, elements: int, dimension: int, tmp_path: Path
) -> None:
    """The anchor bears its buoyancy less weight, up to the water's surface."""
    rope: Mapping = {"EA": 6e7, "EI": 0.0, "GJ": 1.0, "outer_diameter": 0.25, "mass": 20.0}
    water = {"surface_level": HEIGHT, "depth": HEIGHT, "density": WATER}
    ends: Mapping = {"start": prescribed(0.0, 0.0, 0.0), "end": prescribed(span, 0.0, HEIGHT)}
    run = run_of(heap_under(1.3 * HEIGHT, elements, **ends, pipe=rope, water=water, dimension=dimension), tmp_path)
    lift = GRAVITY * (WATER * np.pi / 4.0 * 0.25**2 - 20.0) * HEIGHT
    assert run["start_force"][-1][2] == pytest.approx(-lift, rel=1e-3)
    assert np.linalg.norm(run["end_force"][-1]) < PULLS * lift


def heap_under(length: float, elements: int, **more: Any) -> Mapping:
    """A chain over a seabed of springs, at rest."""
    options: Mapping = {"pipe": CHAIN, "length": length, "elements": elements, "gravity": GRAVITY, "seabed": SPRING}
    if "water" in more:
        del options["seabed"]
    return riser_scene(static(), **(options | more))
