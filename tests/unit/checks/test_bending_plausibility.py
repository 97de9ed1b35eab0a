"""Elements that `check` proposes: as the bend asks for, right by far finer ones, and nothing where they are right."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from mpi4py import MPI

from riser_soil.assembly import build
from riser_soil.checks.bending_plausibility import asked_lengths, proposal, segments_for
from riser_soil.checks.check import describe
from riser_soil.commands.scenes import placed_in
from riser_soil.errors import SceneError
from riser_soil.scene.document import parse
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.riser import Segment
from riser_soil.scene.scene import Scene
from riser_soil.variants.key_results import key_results
from riser_soil.variants.peaks import peaks_of
from tests.support.said import line_with

ROOT = Path(__file__).parents[3]
FIRST = ROOT / "demos/first_scene.yaml"


def of(scene: Scene) -> tuple[Segment, ...] | None:
    asked = asked_lengths(build(scene, MPI.COMM_SELF).riser)
    return None if asked is None else segments_for(scene, *asked)


def cut(scene: Scene, segments: tuple[Segment, ...]) -> Scene:
    return scene.model_copy(update={"riser": scene.line.model_copy(update={"segments": segments})})


def hung(**more: Any) -> Scene:
    """A line of 200 N/m between two ends on one level, 100 m long and 80 m apart."""
    line: dict[str, Any] = {"mass": 20.0, "EA": 1e9, "EI": 1e3} | more.pop("line", {})
    riser: dict[str, Any] = {
        "segments": [{"line_type": "pipe", "length": 100.0, "elements": 10}],
        "start": {"position": [0.0, 0.0, 0.0]},
        "end": {"position": [80.0, 0.0, 0.0]},
    }
    stages = [{"name": "hang", "kind": "static"}]
    given = {"title": "Hung", "gravity": 10.0, "line_types": {"pipe": line}, "riser": riser | more, "stages": stages}
    return scene_from_mapping(given)


def test_shortest_elements_of_a_catenary() -> None:
    """2 H/w sinh(w h/(2 H)) is its length; at its lowest point k = w/H and k'' = 2 w^3/H^3. An element there may miss
    a hundredth of the largest moment.
    """
    w, h, length = 200.0, 80.0, 100.0
    low, high = 1.0, 1e5
    for _ in range(100):
        H = 0.5 * (low + high)
        low, high = (H, high) if 2.0 * H / w * math.sinh(0.5 * w * h / H) > length else (low, H)
    moment, second = 1e3 * w / H, 2.0 * w**3 / H**3
    shortest = (384.0 * 0.01 * moment / (H * second)) ** 0.25
    segments = of(hung())
    assert segments is not None
    least = min(x for each in segments for x in each.element_lengths)
    assert 0.75 * shortest < least <= shortest  # each stretch holds a whole number of them


def test_lengths_grow_steadily_to_the_riser_s_end() -> None:
    segments = of(read_scene(FIRST))
    assert segments is not None
    lengths = [x for each in segments for x in each.element_lengths]
    assert sum(lengths) == pytest.approx(148.0, rel=1e-12)
    assert max(max(a / b, b / a) for a, b in pairwise(lengths)) < 2.0


def test_a_third_of_the_elements_of_the_first_scene_keep_its_figures_to_one_per_cent() -> None:
    scene = read_scene(FIRST, ["stages.1.duration=10.0"])
    segments = of(scene)
    assert segments is not None
    finer = tuple(s.model_copy(update={"element_length": tuple(x / 3 for x in ends(s))}) for s in segments)
    rough, fine = (
        key_results(peaks_of(cut(scene, each), MPI.COMM_SELF).as_summary("peaks")) for each in (segments, finer)
    )
    assert 3 * sum(each.element_count for each in segments) < scene.line.element_count
    for key, key_result in fine.items():
        assert rough[key].value == pytest.approx(key_result.value, rel=0.01), key


def ends(segment: Segment) -> tuple[float, float]:
    return segment.element_lengths[0], segment.element_lengths[-1]


def test_elements_as_proposed_need_no_word() -> None:
    scene = read_scene(FIRST)
    segments = of(scene)
    assert segments is not None
    text = proposal(build(scene, MPI.COMM_SELF).riser, "riser")
    line_with(text, "elements graded", "bend", "1%", "largest moment")
    assert not proposal(build(cut(scene, segments), MPI.COMM_SELF).riser, "riser")


def test_the_words_are_segments_of_a_scene() -> None:
    from ruamel.yaml import YAML

    scene = read_scene(FIRST)
    text = proposal(build(scene, MPI.COMM_SELF).riser, "riser").split("\n", 1)[1]
    segments = tuple(Segment(**each) for each in YAML(typ="safe").load(text))
    assert sum(each.length for each in segments) == pytest.approx(scene.line.length, rel=1e-5)
    assert not proposal(build(cut(scene, segments), MPI.COMM_SELF).riser, "riser")
    assert text in describe(scene)


def test_clamped_ends_are_boundary_layers() -> None:
    free, clamped = (
        of(hung(start={"position": [0.0, 0.0, 0.0], "rotation": rotation})) for rotation in ("free", "fixed")
    )
    assert free is not None
    assert clamped is not None
    assert clamped[0].element_lengths[0] < 0.5 * free[0].element_lengths[0]


def test_there_are_nodes_where_something_is_attached() -> None:
    segments = of(hung(attachments=[{"at": 37.0, "mass": 10.0}]))
    assert segments is not None
    places = [sum(each.length for each in segments[:i]) for i in range(len(segments))]
    assert min(abs(place - 37.0) for place in places) < 1e-9


def test_a_chain_has_no_bend() -> None:
    """So it has no more than the dozen elements that any riser has."""
    segments = of(hung(line={"EI": 0.0}))
    assert segments is not None
    assert 12 <= sum(each.element_count for each in segments) <= 13


def test_what_is_no_cable_gets_no_proposal() -> None:
    assert of(hung(initial="straight", end="free")) is None
    assert of(read_scene(ROOT / "demos/touchdown_clay/scene.yaml")) is None


def test_lengths_scale_with_the_unit_of_length() -> None:
    """A riser of another size is cut into as many elements."""
    counts = []
    for scale in (1e-3, 1.0, 1e3):
        scene = hung(
            line={"EI": 1e3 * scale**3, "EA": 1e9 * scale},
            segments=[{"line_type": "pipe", "length": 100.0 * scale, "elements": 10}],
            end={"position": [80.0 * scale, 0.0, 0.0]},
        )
        segments = of(scene)
        assert segments is not None
        counts.append([each.element_count for each in segments])
    assert counts[0] == counts[1] == counts[2]


def test_a_bend_that_no_riser_has_elements_for_is_told() -> None:
    """EI of 1e-9 N.m2, clamped: layers of 3e-7 m; check ends as ever, and says why it proposes nothing."""
    thin = hung(line={"EI": 1e-9}, start={"position": [0.0, 0.0, 0.0], "rotation": "fixed"})
    line_with(describe(thin), "elements graded as the riser's bend asks for: none", "more than 1000000", "check EI")
    with pytest.raises(SceneError, match=r"^riser\.segments: .* more than 1000000"):
        of(thin)


def test_a_model_that_the_program_makes_out_of_bounds_is_an_error_of_a_line() -> None:
    document = parse("title: a", "scene.yaml")
    with pytest.raises(SceneError) as error, placed_in(lambda: document):
        Segment(line_type="pipe", length=-1.0, elements=3)
    line_with([str(error.value)], "Segment: length: value -1.0", "check the sizes that it follows from")
    with pytest.raises(ValueError, match="another"), placed_in(lambda: document):
        raise ValueError("another")
