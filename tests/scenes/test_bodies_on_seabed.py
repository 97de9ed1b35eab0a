"""Runs of bodies that touch the seabed: against closed forms, from checkpoints, on ranks, and what is built."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI
from scipy.optimize import brentq

from riser_soil.assembly import build
from riser_soil.bodies.seabed_contact import BodyContact
from riser_soil.checks.check import describe
from riser_soil.checks.inventory import inventory
from riser_soil.checks.plausibility import physical_warnings
from riser_soil.errors import SceneError
from riser_soil.results.read import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.whole_run import run
from tests.support.catenaries import pulls
from tests.support.driven_stage import built_of
from tests.support.left_run import leave_after
from tests.support.line_scenes import lines_scene, mooring, pin
from tests.support.run_on_ranks import ran as ran_on
from tests.support.runs import run_of
from tests.support.said import line_with
from tests.support.scenes import dynamic, line

DEPTH, G = 30.0, 9.81
WET = 600.0  # N/m, of the chain
CHAIN: dict[str, Any] = {
    "EA": 2.0e8, "EI": 0.0, "GJ": 1.0e3, "mass": 70.0, "outer_diameter": 0.08, "submerged_weight": WET,
}  # fmt: skip
CLUMP: dict[str, Any] = {"kind": "point", "mass": 4000.0, "volume": 0.5}
RHO = 1025.0
NET = G * (CLUMP["mass"] - RHO * CLUMP["volume"])  # N
BED = 5.0e5  # N/m2
LIES = {"radius": 0.04, "stiffness": NET / (WET / BED)}  # of a clump that sinks in as its chains do beside it

LONG = 59.5  # of chains that lift the clump in part, m
HEAVY = 200.0  # kg
BALL: dict[str, Any] = {"kind": "point", "mass": HEAVY, "volume": 0.1}


def between_chains(
    *stages: Mapping[str, Any], span: float, length: float, elements: int = 30, contact: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """A clump on the bed amid two chains of a length, whose tops are at z = 0 and that far to its sides."""
    tops = [{"position": [x, 0.0, 0.0]} for x in (-span, span)]
    touch = {} if contact is None else {"contact": dict(contact)}
    return lines_scene(
        *stages,
        line_types={"chain": CHAIN},
        lines={
            "left": line("chain", length, elements, tops[0], "free"),
            "right": line("chain", length, elements, "free", tops[1]),
        },
        bodies={"clump": {"position": [0.0, 0.0, 0.5 - DEPTH], **CLUMP, **touch}},
        joints={"left_end": pin("left", "end", "clump"), "right_end": pin("right", "start", "clump")},
        water={"density": RHO},
        seabed={"kind": "spring", "level": -DEPTH, "stiffness": BED},
        contact={},
    )


def let_go(
    bodies: Mapping[str, Mapping[str, Any]], duration: float, time_step: float, **more: Any
) -> dict[str, Any]:
    """Bodies without lines, from their places at rest on, in air; a short rope hangs high above. more: of the scene."""
    ends = ({"position": [x, 0.0, 50.0]} for x in (0.0, 1.9))
    sections = {
        "line_types": {"rope": {"EA": 1.0e6, "EI": 10.0, "GJ": 10.0, "mass": 1.0, "outer_diameter": 0.02}},
        "bodies": {name: dict(body) for name, body in bodies.items()},
        "seabed": {"kind": "rigid", "level": 0.0},
        "contact": {},
        "stages": [dynamic(duration, time_step, "fall")],
    }
    return lines_scene(lines={"rope": line("rope", 2.0, 2, *ends)}, **sections) | more


def force_under(run: Run, body: str) -> np.ndarray:
    return np.asarray(run[f"bodies/{body}/contact_force"][-1])


def lying(span: float, length: float, height: float) -> float:
    """H [N] of an inextensible chain that lies on the bed for a while and rises to a height [m] at a span [m].

    The part in the water is s = sqrt(h (h + 2 H/w)) long and reaches H/w asinh(w s/H) far.
    """

    def beyond(H: float) -> float:
        s = math.sqrt(height * (height + 2.0 * H / WET))
        return length - s + H / WET * math.asinh(WET * s / H) - span

    return float(brentq(beyond, 1.0, 1e6))


def test_a_clump_between_two_chains_that_lie_on_the_bed(tmp_path: Path) -> None:
    """Top tensions are those of chains that end in a lying part, H + w h; the clump rests with all of its weight."""
    span, length, height = 50.0, 66.0, DEPTH - 0.5 * CHAIN["outer_diameter"]
    run = run_of(between_chains(span=span, length=length, contact=LIES, elements=60), tmp_path)
    H = lying(span, length, height)
    for name, top in (("left", 0), ("right", -1)):
        tension = run.of_line(name)["effective_tension"][-1]
        assert tension[top] == pytest.approx(H + WET * height, rel=1e-3)
        assert tension[top] - tension[-1 - top] == pytest.approx(WET * height, rel=1e-3)
    assert force_under(run, "clump") == pytest.approx([0.0, 0.0, NET], rel=1e-3, abs=1.0)
    x, y, z = run["bodies/clump/position"][-1]
    assert (x, y) == pytest.approx((0.0, 0.0), abs=1e-6)
    assert z == pytest.approx(LIES["radius"] - DEPTH - NET / LIES["stiffness"], abs=5e-4)


def test_a_clump_that_taut_chains_lift_in_part(tmp_path: Path) -> None:
    """Its reaction is its weight less what elastic catenaries from its place pull up; it sinks in by that over k D.

    It begins below the bed.
    """
    scene = between_chains(span=50.0, length=LONG)
    scene["bodies"]["clump"]["position"] = [0.0, 0.0, -DEPTH - 0.3]
    run = run_of(scene, tmp_path)
    place, pressed = run["bodies/clump/position"][-1], force_under(run, "clump")
    _, top = pulls(np.array([0.0, place[2]]), np.array([50.0, 0.0]), WET, CHAIN["EA"], LONG)
    lifted = WET * LONG + top[1]  # what the top does not bear
    assert lifted < -1.0e3
    assert pressed == pytest.approx([0.0, 0.0, NET + 2.0 * lifted], rel=2e-3, abs=1.0)
    radius = (3.0 * 0.5 / (4.0 * math.pi)) ** (1.0 / 3.0)
    sunk = run["bodies/clump/penetration"][-1]
    assert pressed[2] == pytest.approx(BED * 2.0 * radius * sunk, rel=1e-6)
    assert place[2] == pytest.approx(radius - sunk - DEPTH, abs=1e-9)


def test_friction_holds_a_body_on_a_slope_below_its_angle(tmp_path: Path) -> None:
    """Above it a body slides with g (sin - mu cos); on one that holds it creeps by less than the mobilisation."""
    angle, duration = math.radians(15.0), 1.0
    up, sunk = np.array([-math.sin(angle), 0.0, math.cos(angle)]), 1.0e-3 * math.cos(angle)

    def ball(y: float, mu: float) -> dict[str, Any]:
        """At the depth to which its weight presses it in."""
        touch = {"radius": 0.5, "width": 1.0, "stiffness": 1.0e3 * HEAVY * G, "friction": mu}
        place = (0.5 - sunk) * up + [0.0, y, 0.0]
        return BALL | {"position": place.tolist(), "contact": touch}

    ground = {
        "seabed": {"kind": "rigid", "level": 0.0, "slope_deg": 15.0, "direction_deg": 0.0},
        "contact": {"friction": {"axial": 0.1, "mobilisation": 1.0e-6}},
    }
    bodies = {"held": ball(0.0, 0.30), "slides": ball(5.0, 0.20), "smooth": ball(-5.0, 0.0)}
    run = run_of(let_go(bodies, duration, 0.005, **ground), tmp_path)
    for name, mu in (("slides", 0.2), ("smooth", 0.0)):
        way = run[f"bodies/{name}/position"][-1] - run[f"bodies/{name}/position"][0]
        slid = 0.5 * G * (math.sin(angle) - mu * math.cos(angle)) * duration**2
        assert float(np.linalg.norm(way)) == pytest.approx(slid, rel=0.03), name
        along = force_under(run, name) @ [math.cos(angle), 0.0, math.sin(angle)]
        assert along == pytest.approx(mu * HEAVY * G * math.cos(angle), rel=0.01, abs=1.0)
    positions = run["bodies/held/position"]
    assert float(np.linalg.norm(positions[-1] - positions[0])) < 2.0e-6
    energy = run.summary["stages"][0]["energy"]
    assert energy["dissipated_by"]["body_friction"] > 0.0
    assert abs(energy["relative_residual"]) < 1e-6


def test_bodies_that_fall_onto_the_bed_come_to_rest_and_no_energy_is_made(tmp_path: Path) -> None:
    """A ball, and a sled that lands on one foot first; the penalty is stiff, and steps are long beside its period."""
    feet = [[1.0, 0.8, -0.5], [-1.0, 0.8, -0.5], [1.0, -0.8, -0.5], [-1.0, -0.8, -0.5]]
    sled = {"kind": "rigid", "mass": 500.0, "inertia": [90.0, 120.0, 160.0], "position": [10.0, 0.0, 1.0]}
    sled |= {"centre_of_gravity": [0.1, 0.05, 0.0], "contact": {"points": feet}}
    ball = BALL | {"position": [0.0, 0.0, 1.5]}
    humps = tmp_path / "humps.csv"
    rows = [f"{x},{y},{0.1 * (x > 10.5)}" for x in range(-5, 21) for y in range(-5, 6)]
    humps.write_text("x [m],y [m],z [m]\n" + "\n".join(rows) + "\n")
    rough = {"friction": {"axial": 0.5, "mobilisation": 1.0e-4}}
    ground = {"seabed": {"kind": "rigid", "grid": str(humps)}, "contact": rough}
    run = run_of(let_go({"ball": ball, "sled": sled}, 4.0, 0.01, **ground), tmp_path / "run")
    radius = (3.0 * 0.1 / (4.0 * math.pi)) ** (1.0 / 3.0)
    assert run["bodies/ball/position"][-1][2] == pytest.approx(radius, abs=2e-3)
    for name, mass in (("ball", 200.0), ("sled", 500.0)):
        assert force_under(run, name)[2] == pytest.approx(mass * G, rel=1e-3), name
        assert np.abs(run[f"bodies/{name}/velocity"][-1]).max() < 1e-3
    assert np.abs(run["bodies/sled/rotation"][-1]).max() > 0.02  # it stands on the step
    total = run["kinetic_energy"] + run["strain_energy"] + run["potential_energy"]
    start = float(total[0])
    assert (total - np.minimum.accumulate(total)).max() < 1e-5 * start  # the scheme's own, of the rope that swings
    energy = run.summary["stages"][0]["energy"]
    assert energy["dissipated_by"]["body_contact_time_scheme"] > 0.5 * 200.0 * G
    assert abs(energy["relative_residual"]) < 1e-3


def on_clay(*more: dict[str, Any]) -> dict[str, Any]:
    """The clump on clay with memory and friction, shaken by a chain."""
    heave = {"amplitude": [0.3, 0.2, 0.2], "period": 2.0, "ramp": 0.4}
    shake = {"lines": {"left": {"motion": {"start": {"harmonic": heave}}}}}
    stage = {"name": "shaken", "kind": "dynamic", "duration": 0.2, "time_step": 0.02, **shake}
    law = {"kind": "aubeny-biscontin", "su": 4.0e3, "su_gradient": 1.5e3}
    scene = between_chains(stage, span=50.0, length=LONG, elements=12)
    ground = {"seabed": {"kind": "hysteretic", "level": -DEPTH, "law": law}, "contact": {"friction": {"axial": 0.3}}}
    return scene | ground


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """The run on clay, on one rank and without a break."""
    return run_of(on_clay(), tmp_path_factory.mktemp("whole"))


def test_a_run_goes_on_from_its_checkpoint_with_what_clay_and_friction_remember(whole: Run, tmp_path: Path) -> None:
    scene = scene_from_mapping(on_clay())
    leave_after(7, scene, tmp_path / "left")
    run(scene, tmp_path / "left", restart=True)
    resumed = Run(tmp_path / "left")
    for key in ("position", "contact_force", "penetration"):
        assert np.array_equal(whole[f"bodies/clump/{key}"], resumed[f"bodies/clump/{key}"]), key
    assert np.ptp(whole["bodies/clump/contact_force"][:, 0]) > 10.0  # it is dragged


def test_two_ranks_find_the_same(whole: Run, tmp_path: Path) -> None:
    other = ran_on(on_clay(), tmp_path / "2", 2)
    assert (whole.summary["ranks"], other.summary["ranks"]) == (1, 2)
    for key, least in (("position", 1e-7), ("contact_force", 1.0), ("penetration", 1e-7)):
        path = f"bodies/clump/{key}"
        assert other[path][-1] == pytest.approx(whole[path][-1], rel=1e-5, abs=least), key


def contacts_of(scene: dict[str, Any]) -> dict[str, BodyContact]:
    bodies_and_joints = build(scene_from_mapping(scene), MPI.COMM_SELF).bodies_and_joints
    assert bodies_and_joints is not None
    return bodies_and_joints.contacts


def test_nothing_is_built_for_bodies_that_can_not_get_to_the_bed() -> None:
    """A buoy that bears more than all lines weigh, and a clump that hangs on lines that are too short."""
    bed = {"seabed": {"kind": "rigid", "level": -100.5}, "contact": {}}
    assert contacts_of(mooring() | bed) == {}
    floats = scene_from_mapping(mooring() | bed)
    assert "floats" in inventory(built_of(floats)).left_out["body contact"]
    assert "body contact" not in line_with(describe(floats).splitlines(), "model: riser,")
    hangs = between_chains(span=50.0, length=LONG) | {"seabed": {"kind": "rigid", "level": -400.0}}
    assert "too short" in inventory(built_of(scene_from_mapping(hangs))).left_out["body contact"]
    assert contacts_of(hangs) == {}
    assert [*contacts_of(between_chains(span=50.0, length=LONG))] == ["clump"]
    touches = scene_from_mapping(between_chains(span=50.0, length=LONG))
    assert "body contact" not in inventory(built_of(touches)).left_out
    assert inventory(built_of(touches)).left_out["body friction"] == "no friction is asked for"


def contact_of(scene: dict[str, Any]) -> BodyContact:
    (contact,) = contacts_of(scene).values()
    return contact


def test_sizes_that_are_not_given_follow_from_volume_mass_and_lines() -> None:
    sphere = (3.0 * 0.5 / (4.0 * math.pi)) ** (1.0 / 3.0)
    scene = between_chains(span=50.0, length=LONG)
    contacts = contact_of(scene)
    assert (contacts.radius, contacts.length) == pytest.approx((sphere, 2.0 * sphere))
    assert contact_of(scene | {"seabed": scene["seabed"] | {"contact_at": "axis"}}).radius == 0.0
    rigid = contact_of(scene | {"seabed": {"kind": "rigid", "level": -DEPTH}})
    assert rigid.sunk_by(4000.0 * G) == pytest.approx(2e-3 * sphere, rel=0.02)
    scene["bodies"]["clump"]["volume"] = 0.0
    contacts = contact_of(scene)
    assert contacts.radius == pytest.approx(0.5 * CHAIN["outer_diameter"])
    assert contacts.length == pytest.approx((6.0 * 4000.0 / (math.pi * 1025.0)) ** (1.0 / 3.0))


def test_check_says_how_bodies_touch_and_warns_of_those_that_sink() -> None:
    scene = between_chains(span=50.0, length=LONG, contact={"stiffness": 1.0e5, "friction": 0.5})
    line = line_with(describe(scene_from_mapping(scene)).splitlines(), "body clump: touches")
    assert f"sinks in by {NET / 1.0e5:.3f}"[:18] in line
    assert "friction coefficient 0.5" in line
    soft = between_chains(span=50.0, length=LONG, contact={"stiffness": 1.0e4})
    warned = line_with(physical_warnings(build(scene_from_mapping(soft), MPI.COMM_SELF)), "bodies.clump.contact")
    assert f"{NET:.4g} N" in warned


def test_what_begins_below_the_seabed_is_refused_by_its_own_key() -> None:
    scene = between_chains(span=50.0, length=LONG)
    scene["bodies"]["clump"]["position"] = [0.0, 0.0, -DEPTH - 1.0]
    warned = line_with(physical_warnings(build(scene_from_mapping(scene), MPI.COMM_SELF)), "bodies.clump.position")
    assert "begins 1.492 m below" in warned  # springs bear at any depth
    scene["seabed"] = {"kind": "rigid", "level": -DEPTH}
    with pytest.raises(SceneError, match=r"bodies.clump.position: .*must not lie below the seabed \(z = -30 m\)"):
        scene_from_mapping(scene)
    (left, right), scene["bodies"] = (joint["between"][0] for joint in scene["joints"].values()), {}
    scene["joints"] = {"middle": {"kind": "pinned", "between": [left, right], "position": [0.0, 0.0, -DEPTH - 1.0]}}
    with pytest.raises(SceneError, match=r"joints.middle.position: .*must not lie below the seabed"):
        scene_from_mapping(scene)


@pytest.mark.parametrize(
    ("contact", "more", "said"),
    [
        ({"points": [[0.0, 0.0, 0.0]]}, {}, "bodies.clump.contact.points: .*make it rigid"),
        ({"stiffness": 1e5}, {"seabed": on_clay()["seabed"]}, "bodies.clump.contact.stiffness: .*give width"),
        ({"radius": 0.1}, {"seabed": None, "contact": None}, "bodies.clump.contact: .*add seabed"),
        ({"radius": -0.1}, {}, "bodies.clump.contact.radius: .*"),
        ({"length": 0.1}, {}, "bodies.clump.contact.length: .*no such key"),
    ],
)
def test_what_a_body_can_not_have_is_refused(contact: dict[str, Any], more: dict[str, Any], said: str) -> None:
    scene = between_chains(span=50.0, length=LONG, contact=contact) | more
    with pytest.raises(SceneError, match=said):
        scene_from_mapping({key: value for key, value in scene.items() if value is not None})
