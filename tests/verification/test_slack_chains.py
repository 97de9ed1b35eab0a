"""Chain and rope without bending stiffness, longer than they need be: they go slack, hang straight down, and lie in a
heap, and bear no compression.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from riser_soil.results import Run
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.whole_run import run
from tests.support.coupled_scenes import Mapping
from tests.support.riser_scenes import prescribed, riser_scene, static

W, SPAN, HEIGHT = 1400.0, 170.0, 115.0
CHAIN = {"EA": 6e8, "EI": 0.0, "GJ": 1.0, "submerged_weight": W, "outer_diameter": 0.15, "mass": 165.0}
SPRING = {"kind": "spring", "level": 0.0, "contact_at": "axis", "stiffness": 4e5}
RIGID = {"kind": "rigid", "level": 0.0, "contact_at": "axis"}
CLAY: Mapping = {"kind": "randolph-quiggin", "su": 4e3, "su_gradient": 1.2e3}
HYSTERETIC = {"kind": "hysteretic", "level": 0.0, "contact_at": "axis", "law": CLAY}
PULLS = 3e-4  # of the weight that hangs: what a slack chain pulls at its anchor
HEAVE = {"end": {"harmonic": {"amplitude": [0.0, 0.0, 1.5], "period": 6.0, "ramp": 3.0}}}


def slack(length: float, elements: int, turned: bool = False, **more: Any) -> Mapping:
    """A chain from the seabed to a place over it; turned: from there to the seabed."""
    stages = more.pop("stages", (static(),))
    low, high = prescribed(0.0, 0.0, 0.0), prescribed(SPAN, 0.0, HEIGHT)
    ends: Mapping = {"start": high, "end": low} if turned else {"start": low, "end": high}
    options: Mapping = {"pipe": CHAIN, "length": length, "elements": elements, "gravity": 9.81, "seabed": SPRING}
    return riser_scene(*stages, **(options | ends | more))


def done(scene: Mapping, folder: Path) -> Run:
    run(scene_from_mapping(scene), folder)
    return Run(folder)


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
    found = done(slack(length, elements, **more), tmp_path)
    ends = ("start_force", "end_force") if more.get("turned") else ("end_force", "start_force")
    top, anchor = (found[name][-1] for name in ends)
    assert top[2] == pytest.approx(W * HEIGHT, rel=1e-3)
    assert np.abs([top[0], top[1], anchor[0], anchor[1]]).max() < PULLS * length / SPAN * W * HEIGHT
    assert found["effective_tension"][-1].min() > -1e-4 * W * HEIGHT
    position = found["position"][-1]
    hangs = position[:, 2] > 0.01 * HEIGHT
    assert np.abs(position[hangs, 0] - SPAN).max() < 0.02 * HEIGHT
    assert position[:, 2].min() > -0.5
