"""The line summary of `check`: masses and weights by their formulas; tensions and touchdown by hand, of a cable."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.assembly import build
from riser_soil.assembly.shape import tensions_of_taut
from riser_soil.checks.by_hand import by_hand
from riser_soil.checks.check import line_summary
from riser_soil.checks.plausibility import physical_warnings
from riser_soil.errors import SceneError
from riser_soil.riser.attachments import PointAttachment
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from tests.support.scenes import Mapping, prescribed, riser_scene, static
from tests.support.stage_histories import stage_histories

PIPE: Mapping = {"outer_diameter": 0.3, "inner_diameter": 0.2, "mass": 120.0, "EA": 3.0e8, "EI": 5.0e4}
FLOAT: Mapping = PIPE | {"outer_diameter": 0.6, "mass": 180.0}
FULL = 120.0 + 850.0 * np.pi * 0.01  # kg/m
WET = 9.81 * (FULL - 1000.0 * np.pi * 0.0225)  # N/m


def scene(*segments: Mapping, end: tuple[float, float, float] = (80.0, 0.0, 100.0), **riser: Any) -> Scene:
    made = riser_scene(
        static(), pipe=PIPE, length=150.0, elements=50, start=prescribed(0.0, 0.0, 0.15), end=prescribed(*end),
        gravity=9.81, water={"density": 1000.0}, seabed={"kind": "spring", "stiffness": 1e5},
        riser={"contents": {"density": 850.0}} | riser,
    )  # fmt: skip
    made["line_types"]["float"] = dict(FLOAT)
    if segments:
        made["riser"]["segments"] = list(segments)
    return scene_from_mapping(made)


def part(length: float, line_type: str = "pipe") -> Mapping:
    return {"line_type": line_type, "length": length, "elements": round(length / 2.0)}


LAZY = part(60.0), part(20.0, "float"), part(70.0)


def warned(given: Scene) -> list[str]:
    return line_summary(build(given, MPI.COMM_SELF).riser)


def hand_checked(given: Scene) -> list[str]:
    return [*by_hand(build(given, MPI.COMM_SELF).riser)]


def numbers(line: str) -> list[float]:
    return [float(x) for x in re.findall(r"(?<![\w.])-?\d+\.?\d*(?:e[+-]\d+)?", line)]


def test_weights_of_a_segment() -> None:
    _, row, whole, *_ = warned(scene())
    assert numbers(row) == pytest.approx([0, 150, 0.3, 0.2, 120, FULL, 9.81 * FULL, WET, 3e8, 5e4], rel=5e-4)
    assert numbers(whole) == pytest.approx([150, 0.15 * FULL, 0.15 * 9.81 * FULL, 0.15 * WET], rel=5e-4)


def test_tension_by_hand_beside_the_cable() -> None:
    """T = H + w h over the touchdown point (Irvine, Cable Structures, 1981), and the riser's own is near."""
    given = scene()
    at_rest, top, _ = hand_checked(given)
    cable, _, w, h, formula = numbers(top)
    H, level = numbers(at_rest)
    assert (w, h, level) == pytest.approx((WET / 1e3, 99.85, 0.15), rel=1e-3)
    assert formula == pytest.approx(H + w * h, rel=1e-3)
    assert cable == pytest.approx(formula, rel=1e-3)
    assert top.startswith("  hang-off (end B): ")
    (run,) = stage_histories(given)
    assert run.end.effective_tension[-1] == pytest.approx(1e3 * cable, rel=5e-3)


def test_tension_by_hand_of_a_lazy_wave_with_attachments() -> None:
    row = {"from": 100.0, "to": 120.0, "spacing": 5.0, "mass": 100.0, "volume": 0.3}
    _, top, touchdown = hand_checked(scene(*LAZY, attachments=[row]))
    cable, formula = numbers(top)[0], numbers(top)[-1]
    assert cable == pytest.approx(formula, rel=5e-3)
    assert "TDP at arc" in touchdown


def test_touchdown_by_hand_of_a_catenary() -> None:
    """a = H/w, s = sqrt(h^2 + 2 a h) of pipe hang, over a asinh(s/a) in plan (Irvine); stretch is neglected."""
    at_rest, _, touchdown = hand_checked(scene())
    a = 1e3 * numbers(at_rest)[0] / WET
    s = np.sqrt(99.85**2 + 2.0 * a * 99.85)
    arc, plan, carried, hangs, before = (x for x in numbers(touchdown) if x != 2.0)  # the squares of its formula
    assert (arc, plan, hangs) == pytest.approx((150.0 - s, a * np.arcsinh(s / a), s), abs=0.05)
    assert carried == pytest.approx(WET * s / 1e3, rel=1e-3)
    assert before == pytest.approx(np.sqrt(5.0e4 / (WET * a)), rel=5e-3)


def test_touchdown_of_the_start_where_it_hangs() -> None:
    """A line that is given from its other end."""
    arc, plan, *_ = numbers(hand_checked(scene())[-1])
    turned = scene(end=(80.0, 0.0, 0.15), start={"position": [0.0, 0.0, 100.0]})
    _, top, touchdown = hand_checked(turned)
    assert top.startswith("  hang-off (end A): ")
    assert numbers(touchdown)[:2] == pytest.approx((150.0 - arc, plan), abs=0.02)


def test_touchdown_of_a_lazy_wave_is_behind_its_hog() -> None:
    """Three places carry V: the sag is no touchdown. The pipe of a run lies on the ground up to there."""
    given = scene(*LAZY)
    touchdown = numbers(hand_checked(given)[-1])[0]
    (run,) = stage_histories(given)
    lies = build(given, MPI.COMM_SELF).riser.line.arc[run.position[-1][:, 2] < 0.16]
    assert touchdown == pytest.approx(lies.max(), abs=5.0)


def test_a_line_that_touches_nothing_has_no_touchdown() -> None:
    lifted = scene(start={"position": [0.0, 0.0, 70.0]})
    assert not [line for line in hand_checked(lifted) if "TDP" in line]


def test_a_taut_vertical_riser_begins_in_balance() -> None:
    """Straight, stretched by T l/EA, whatever the types of its segments; it is not laid, nor called slack."""
    given = scene(part(80.0), part(20.0, "float"), end=(0.0, 0.0, 100.3))
    assembly = build(given, MPI.COMM_SELF)
    assert assembly.laying is None
    (run,) = stage_histories(given)
    first, last = numbers([*by_hand(assembly.riser)][-1])[-2:]
    assert [first, last] == pytest.approx(run.end.effective_tension[[0, -1]] / 1e3, rel=1e-3)
    assert run.position[-1] == pytest.approx(assembly.riser.line.to_global(assembly.riser.line.x), abs=1e-9)


def test_a_riser_that_its_weight_stretches_to_its_ends_is_not_taut() -> None:
    """Pulled straight, its lower part would be pressed: w L^2/(2 EA) = 12 mm, more than the 5 that the ends ask for."""
    assembly = build(scene(part(100.0), end=(0.0, 0.0, 100.155)), MPI.COMM_SELF)
    assert WET * 100.0**2 / (2.0 * PIPE["EA"]) > 0.005
    assert assembly.riser.catenary is not None


def test_a_level_riser_as_long_as_its_span_is_taut_whatever_the_round_off() -> None:
    elements = build(scene(), MPI.COMM_SELF).riser.elements
    for span in (150.0 - 3e-14, 150.0, 150.0 + 3e-14):
        tension = tensions_of_taut(elements, np.zeros(3), np.array([span, 0.0, 0.0]))
        assert tension == pytest.approx(0.0, abs=1e-6)
    assert tensions_of_taut(elements, np.zeros(3), np.array([149.999, 0.0, 0.0])) is None


def floating(given: Scene) -> list[str]:
    return [warning for warning in physical_warnings(build(given, MPI.COMM_SELF)) if "floats" in warning]


def test_meant_buoyancy_is_not_warned_of() -> None:
    assert floating(scene(*LAZY)) == []
    assert len(floating(scene(part(130.0), part(20.0, "float")))) == 1, "at the riser's end it is a mistake, likely"
    assert len(floating(scene(part(30.0), part(100.0, "float"), part(20.0)))) == 1, "the whole riser floats"


def test_a_line_in_air_does_not_float() -> None:
    """A light line between two decks above the surface; with an end in the water that end is told of."""
    for level, count in ((-1.0, 0), (150.0, 1), (50.0, 1)):
        made = riser_scene(
            static(), pipe=FLOAT, length=128.5, elements=20, start=prescribed(0.0, 0.0, 10.0),
            end=prescribed(80.0, 0.0, 110.0), gravity=9.81, water={"density": 1000.0, "surface_level": level},
        )  # fmt: skip
        made["line_types"]["pipe"]["mass"] = 100.0
        assert len(floating(scene_from_mapping(made))) == count, level


def test_a_row_of_attachments() -> None:
    row = {"from": 10.0, "to": 10.7, "spacing": 0.1, "mass": 5.0}
    given = scene(attachments=[row])
    assert given.line.attachments[0].arcs == pytest.approx(10.0 + 0.1 * np.arange(8))
    last: PointAttachment = build(given, MPI.COMM_SELF).riser.attachments[-1]
    assert (last.arc, last.mass) == (10.7, 5.0)
    again = scene(attachments=[row | {"to": 10.69}])
    assert len(again.line.attachments[0].arcs) == 7
    assert "from: 10.0" in dump_scene(given)


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ({"from": 1.0, "to": 2.0}, "a row lacks spacing"),
        ({"at": 1.0, "from": 1.0, "to": 2.0, "spacing": 0.5}, "the places are given twice"),
        ({}, "the place is missing"),
        ({"from": 2.0, "to": 1.0, "spacing": 0.5}, "must not be less than from"),
        ({"from": 1.0, "to": 2.0, "spacing": 1e-5}, "more than 10000 of them"),
        ({"from": 1.0, "to": 200.0, "spacing": 1.0}, r"attachments.0.to.* must not exceed the riser's length"),
    ],
)
def test_rows_that_are_none(row: Mapping, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        scene(attachments=[row | {"mass": 1.0}])
