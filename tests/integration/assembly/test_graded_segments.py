"""Elements whose lengths grow geometrically along a segment."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from riser_soil.assembly.riser import elements_of
from riser_soil.errors import SceneError
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.riser import graded_lengths
from tests.support.said import telling
from tests.support.scenes import prescribed, riser_scene, static


def test_doubling() -> None:
    assert graded_lengths(15.0, 1.0, 8.0) == pytest.approx((1.0, 2.0, 4.0, 8.0), rel=1e-15)
    assert graded_lengths(15.0, 8.0, 1.0) == pytest.approx((8.0, 4.0, 2.0, 1.0), rel=1e-15)


@pytest.mark.parametrize(("first", "last"), [(0.2, 2.0), (2.0, 0.2), (0.5, 0.500001), (0.03, 7.0), (1.0, 1.0)])
@pytest.mark.parametrize("length", [0.9, 13.0, 148.0])
def test_a_geometric_series_of_the_given_length(length: float, first: float, last: float) -> None:
    lengths = graded_lengths(length, first, last)
    n = len(lengths)
    assert sum(lengths) == pytest.approx(length, rel=1e-13)
    if n > 1:
        ratio = (last / first) ** (1.0 / (n - 1))
        assert [b / a for a, b in pairwise(lengths)] == pytest.approx([ratio] * (n - 1), rel=1e-12)
        assert (1.0 - 1.0 / n if n > 2 else 0.0) <= lengths[0] / first <= 1.0 + 1e-9
        assert lengths[-1] / last == pytest.approx(lengths[0] / first, rel=1e-12)


@pytest.mark.parametrize("length", [8.0, 8.1, 0.3, 0.5])
def test_equal_lengths_are_those_of_one_number(length: float) -> None:
    n = int(np.ceil(length / 0.5 - 1e-9))
    assert graded_lengths(length, 0.5, 0.5) == (length / n,) * n


def test_many_elements_are_counted_as_the_series_says() -> None:
    """n elements from a to b with quotient r add up to (b r - a)/(r - 1)."""
    a, b, n = 0.1, 3.0, 400
    r = (b / a) ** (1.0 / (n - 1))
    assert len(graded_lengths((b * r - a) / (r - 1.0), a, b)) == n


PIPE = {"EA": 1.0e8, "EI": 1.0e4, "submerged_weight": 0.0}


def graded(load_at: float) -> dict[str, Any]:
    """Elements of 1, 2, 4 and 8 m, then two of 2.5 m; a moment somewhere."""
    load = {"at": load_at, "moment": [0.0, 1.0, 0.0]}
    start = prescribed(0.0, 0.0, 0.0, rotation="fixed")
    scene = riser_scene(static(loads=[load]), pipe=PIPE, length=15.0, elements=1, start=start, end="free")
    scene["riser"]["segments"] = [
        {"line_type": "pipe", "length": 15.0, "element_length": [1.0, 8.0]},
        {"line_type": "pipe", "length": 5.0, "element_length": 2.5},
    ]
    return scene


def test_checks_and_elements_agree_on_the_nodes() -> None:
    scene = scene_from_mapping(graded(load_at=7.0))
    assert scene.line.node_arcs == pytest.approx([0.0, 1.0, 3.0, 7.0, 15.0, 17.5, 20.0], rel=1e-14)
    assert elements_of(scene).arc.tolist() == scene.line.node_arcs


def test_a_moment_between_graded_nodes_is_sent_to_the_nearest() -> None:
    with pytest.raises(SceneError, match=telling("nearest", "at 7 m")):
        scene_from_mapping(graded(load_at=7.5))
