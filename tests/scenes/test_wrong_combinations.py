"""Wrong scenes that take several changes of the good one: the message points at the place and says what is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from riser_soil.errors import SceneError
from riser_soil.scene.reader import read_scene
from tests.support.bad_scenes import GOOD

Changes = tuple[tuple[str, str], ...]

POINTS = "initial: {points: [[0, 0, 0.15], [80, 0, 100]]}"
NO_DIAMETER = ("    outer_diameter: 0.3\n", "")
NO_DRAG = ("    drag: {normal: 1.1, tangential: 0.05}\n", "")
GIVEN_WEIGHT = ("    GJ", "    submerged_weight: 500.0\n    GJ")
NO_SEABED = ("seabed: {kind: spring, level: 0.0, stiffness: 1.0e5}\n", "")
NO_SOIL = (GOOD[GOOD.index("soil:") : GOOD.index("contact:")], "")
STATIC_ALONE = (GOOD[GOOD.index("  - name: heave") : GOOD.index("solver:")], "")
SAND = (
    GOOD[GOOD.index("  law:", GOOD.index("soil:")) : GOOD.index("contact:")],
    "  law: {kind: drucker-prager, friction_angle_deg: 30.0, cohesion: 200.0, E: 1.0e7}\n"
    "  submerged_unit_weight: 9.0e3\n",
)
SECTIONS = ("{interval: 0.1}", "{interval: 0.1, sections: {arcs: [20.0, 900.0]}}")
NO_WATER = ("water: {density: 1025.0}\n", "")


def rough(friction: str, method: str = "") -> tuple[str, str]:
    return "method: node", f"{method}friction: {{{friction}}}"


def attached(values: str) -> tuple[str, str]:
    return "  contents:", f"  attachments: [{{at: 20.0, {values}}}]\n  contents:"


def waves(more: str, **water: float) -> tuple[str, str]:
    """Waves of 2 m and 8 s in water with a surface."""
    keys = "".join(f", {key}: {value}" for key, value in water.items())
    sea = f"surface_level: 100.0{keys}, waves: {{airy: {{height: 2.0, period: 8.0{more}}}}}"
    return "{density: 1025.0}", f"{{density: 1025.0, {sea}}}"


def arc(values: str) -> Changes:
    return (("  initial: catenary", f"  initial: catenary\n  unstressed: {{arc: {{{values}}}}}"),)


def history(values: str) -> Changes:
    return (("kind: static}", f"kind: static, loads: [{{distributed: [0, 0, 1], history: {values}}}]}}"),)


CASES: list[tuple[Changes, str, str]] = [
    ((("method: node", "method: surface"), NO_SOIL), "contact.method", "surface is contact with soil"),
    ((rough("mobilisation: 0.01"),), "contact.friction.axial: missing", "add axial, adhesion or both"),
    ((rough("adhesion: 1.0, lateral: 0.5"),), "contact.friction.lateral", "is given without axial"),
    ((rough("adhesion: 1.2"),), "contact.friction.adhesion", "1"),
    ((rough("adhesion: 1.0, axial: 0.5"), NO_SOIL), "contact.friction.adhesion", "the spring seabed has none"),
    ((rough("adhesion: 1.0, axial: 0.5", "method: node, "),), "contact.friction.adhesion", "seabed has none"),
    ((rough("adhesion: 1.0"),), "contact.friction.adhesion", "beside the clay the spring seabed has none; give axial"),
    ((rough("adhesion: 1.0"), NO_SEABED, SAND), "contact.friction.adhesion", "soil that is drucker-prager has none"),
    (
        (("method: node", "method: surface"), ("stiffness: 1.0e5}", "stiffness: 1.0e5, contact_at: axis}")),
        "seabed.contact_at",
        "the axis has no surface to touch the soil with",
    ),
    ((("    mass: 120.0\n", ""), STATIC_ALONE), "line_types.pipe.mass: missing", "the weight follows from the mass"),
    ((NO_DIAMETER, GIVEN_WEIGHT), "line_types.pipe.outer_diameter: missing", "drag, added mass and vortices follow"),
    (
        (NO_DIAMETER, NO_DRAG, GIVEN_WEIGHT, ("    EA:", "    rotary_inertia: true\n    EA:")),
        "line_types.pipe.outer_diameter: missing",
        "rotary inertia follows",
    ),
    ((NO_DIAMETER, NO_DRAG, GIVEN_WEIGHT), "line_types.pipe.outer_diameter: missing", "outer surface touches"),
    (
        (GIVEN_WEIGHT, ("gravity: 9.81", "gravity: 0"), ("initial: catenary", POINTS)),
        "line_types.pipe.submerged_weight: value 500",
        "nothing weighs where gravity is 0",
    ),
    (
        (NO_WATER, NO_DRAG, attached("mass: 90.0, volume: 0.1")),
        "riser.attachments.0.volume: value 0.1",
        "the scene has no water",
    ),
    (
        (NO_WATER, NO_DRAG, attached("mass: 90.0, drag_area: 0.3")),
        "riser.attachments.0.drag_area: value 0.3",
        "the scene has no water",
    ),
    (
        (("    time_step: 0.1", "    time_step: 0.1\n    scheme: {midpoint: {}}"),),
        "stages.1.scheme: value {",
        "the midpoint rule would make energy out of contact",
    ),
    (
        (
            *(NO_SEABED, NO_SOIL, (GOOD[GOOD.index("contact:") : GOOD.index("stages:")], "")),
            ("100.0], rotation: free", "100.0], rotation: fixed"),
            ("    time_step: 0.1", "    time_step: 0.1\n    scheme: {midpoint: {}}"),
            ("ramp: 5.0}}", "ramp: 5.0}, rotation: {axis: [0, 1, 0], amplitude_deg: 3.0, period: 9.0, ramp: 9.0}}"),
        ),
        "stages.1.scheme: value {",
        "the midpoint rule can't turn a fixed end, and the riser's end turns",
    ),
    ((NO_SOIL, SECTIONS), "output.sections: value {", "settlement is that of soil"),
    ((SECTIONS,), "output.sections.arcs.1: value 900", "must not exceed the riser's length (148 m)"),
    ((NO_SEABED, NO_SOIL), "contact: value {", "there is nothing to touch"),
    (
        (("initial: catenary", "initial: straight"), ("length: 148.0", "length: 100.0")),
        "riser.end.position",
        "127.945 m",
    ),
    (arc("centre: [0, 0, 9], from: [0, 0, 0], angle_deg: 9, axis: [0, 0, 0]"), "riser.unstressed.arc.axis", "zero"),
    (arc("centre: [0, 0, 9], from: [0, 0, 0.15], angle_deg: 9"), "riser.unstressed.arc.from", "on the circle's axis"),
    (
        arc("centre: [0, 0, 9], from: [0, 0, 0], angle_deg: 9, axis: [0, 1, 0]"),
        "riser.unstressed.arc",
        "1.41372 m long",
    ),
    ((("{kind: hex, size_at_riser: 0.5, size_far: 1.5}", "{file: case.yaml}"),), "soil.block", "replaces the block"),
    ((("  block: {x: [10.0, 50.0], y: [-2.5, 2.5], depth: 2.5}\n", ""),), "soil.block: missing", "the box of soil"),
    (history("[[0, 1], [0, 2]]"), "stages.0.loads.0.history", "times must increase"),
    (history("[[0, 1]]"), "stages.0.loads.0.history", "at least two points"),
    (history("[[0], [1, 2]]"), "stages.0.loads.0.history.0", "must be a list of 2 values"),
    (
        (("initial: catenary", "initial: {points: [[0, 0, 0]]}"),),
        "riser.initial.points",
        "must have at least 2 entries",
    ),
    (
        (("gravity: 9.81", "gravity: 0"), ("initial: catenary", POINTS), waves("")),
        "water.waves: value {",
        "there are no waves without gravity",
    ),
    ((waves("", depth=2.0),), "water.waves.airy.height: value 2.0", "higher waves of 8 s in 2 m of water break"),
    (
        (("title: base", "dimension: 2"), waves(", direction_deg: 90.0")),
        "water.waves.airy.direction_deg: value 90.0",
        "leaves the riser's vertical plane",
    ),
    (
        (("title: base", "dimension: 2"), ("{density: 1025.0}", "{current: {profile: [[0, 1, 0], [9, 1, 0.1]]}}")),
        "water.current.profile.1: value [9, 1, 0.1]",
        "leaves the riser's vertical plane",
    ),
]


@pytest.mark.parametrize(("changes", "place", "says"), CASES, ids=lambda x: x if isinstance(x, str) else "")
def test_combination_is_reported(changes: Changes, place: str, says: str, tmp_path: Path) -> None:
    text = GOOD
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    file = tmp_path / "case.yaml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        read_scene(file)
    (line,) = str(caught.value).splitlines()
    assert f": {place}" in line
    assert says in line
    assert "; " in line
