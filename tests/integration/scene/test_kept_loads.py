"""A load that stays after its stage, as large as it was at the end."""

from __future__ import annotations

from typing import Any

import pytest

from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.stages import loads_in
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene, static
from tests.support.stage_histories import stage_histories

ROD: Mapping = {"EA": 1.0e6, "EI": 1.0e3, "mass": 1.0}
L = 10.0


def pulled(*stages: Mapping) -> Mapping:
    start = prescribed(0.0, 0.0, 0.0, rotation="fixed")
    return riser_scene(*stages, pipe=ROD, length=L, elements=2, start=start, end="free")


def force(size: float, **more: Any) -> Mapping:
    return {"at": "end", "force": [size, 0.0, 0.0], **more}


def test_a_kept_load_stays_in_static_and_dynamic_stages() -> None:
    """N = F: the first by its history's end, 0.4 times 1 kN; then 2 kN more; then at rest in time."""
    first = force(1000.0, keep=True, history=[[0.0, 0.0], [0.5, 1.0], [1.5, -0.2]])
    scene = pulled(
        static("some", loads=[first]),
        static("more", loads=[force(2000.0, keep=True)]),
        dynamic(0.2, 0.1, loads=[force(0.0)]),
    )
    some, more, still = stage_histories(scene)
    for history, tension in ((some, 400.0), (more, 2400.0), (still, 2400.0)):
        assert history.end.effective_tension == pytest.approx(tension, rel=1e-6)
        assert history.position[-1][-1, 0] == pytest.approx(L * (1.0 + tension / ROD["EA"]), rel=1e-9)


def test_a_load_that_is_not_kept_ends() -> None:
    loaded, bare = stage_histories(pulled(static("loaded", loads=[force(1000.0)]), static("bare")))
    assert loaded.end.effective_tension == pytest.approx(1000.0, rel=1e-6)
    assert abs(bare.end.effective_tension).max() < 1e-3


def test_a_dynamic_load_is_kept_as_at_its_duration() -> None:
    load = force(100.0, keep=True, history=[[0.0, 0.0], [4.0, 1.0]])
    stages = scene_from_mapping(pulled(dynamic(1.0, 0.1, "on", loads=[load]), dynamic(1.0, 0.1, "after"))).stages
    (kept,) = loads_in(stages, stages[1])
    assert kept.history == ((0.0, 0.25), (1.0, 0.25))
    assert loads_in(stages, stages[0]) == stages[0].loads
