"""A heave-compensated top tension: a constant upward force on an end that is held horizontally alone."""

from __future__ import annotations

import numpy as np
import pytest

from riser_soil.errors import SceneError
from riser_soil.scene.reader import scene_from_mapping
from tests.support.said import telling
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene, static
from tests.support.stage_histories import stage_histories

W, L, EA, T = 400.0, 50.0, 1.0e7, 4.0e4
PIPE: Mapping = {"EA": EA, "EI": 1.0e4, "GJ": 1.0e4, "mass": 60.0, "submerged_weight": W}
MOTION: Mapping = {"amplitude": [0.1, 0.0, 2.0], "period": 8.0, "ramp": 4.0}


def scene(*stages: Mapping, tensioned: str = "end", **more: object) -> Mapping:
    top, foot = prescribed(0.0, 0.0, L + 0.1) | {"tensioner": {"tension": T}}, prescribed(0.0, 0.0, 0.0)
    ends = {"start": foot, "end": top} if tensioned == "end" else {"start": top, "end": foot}
    return riser_scene(*stages, pipe=PIPE, length=L, elements=20, gravity=9.81, **ends, **more)


@pytest.mark.parametrize(("dimension", "tensioned"), [(2, "end"), (3, "start")])
def test_an_upright_riser_hangs_from_its_tension(dimension: int, tensioned: str) -> None:
    """T at the top, T - wL at the foot, stretched by (T - wL/2) L/EA; the support bears nothing at the top."""
    (run,) = stage_histories(scene(static(), tensioned=tensioned, dimension=dimension))
    top, foot = (-1, 0) if tensioned == "end" else (0, -1)
    assert run.end.effective_tension[[foot, top]] == pytest.approx([T - W * L, T], rel=1e-8)
    assert run.position[-1][top] == pytest.approx([0.0, 0.0, L + (T - 0.5 * W * L) * L / EA], abs=1e-7)
    assert np.abs(run.end.end_force if tensioned == "end" else run.end.start_force).max() < 1e-4 * T


def test_heave_does_not_reach_the_riser() -> None:
    """Surge moves the end, heave does not: the force at the top stays T, where a held end would stretch by 2 m."""
    _, moved = stage_histories(scene(static(), dynamic(6.0, 0.1, motion={"end": {"harmonic": MOTION}})))
    at_top = np.array([position[-1] for position in moved.position])
    assert np.ptp(at_top[:, 0]) > 0.08
    assert np.ptp(at_top[:, 2]) < 0.005, "by what surge bends it"
    assert moved.end.effective_tension[-1] == pytest.approx(T, rel=0.005)


def test_somebody_must_hold_the_height() -> None:
    given = scene(static())
    given["riser"]["start"]["tensioner"] = {"tension": 1.0}
    with pytest.raises(SceneError, match=telling("nothing holds", "riser's height")):
        scene_from_mapping(given)
