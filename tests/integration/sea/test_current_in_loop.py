"""Current under a surface, without waves, in the line solver and by SNES: the same motion."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests.support.scenes import IN_WAVES, dynamic, prescribed, riser_scene, static
from tests.support.stage_histories import stage_histories

STEADY = {"profile": [[0.0, 0.2, 0.0], [20.0, 1.5, 0.0]]}
CHANGING = {"history": [{"time": 0.0, **STEADY}, {"time": 2.0, "profile": [[0.0, -0.5, 0.0]]}]}
STILL = {"profile": [[0.0, 0.0, 0.0]]}
MODULE = [{"at": 12.0, "mass": 50.0, "volume": 0.1, "drag_area": 0.6, "added_mass": 0.5}]


def end_of(current: Any, newton: str, attachments: Any) -> np.ndarray:
    scene = riser_scene(
        static("hang"),
        dynamic(2.0, 0.1),
        pipe=IN_WAVES,
        length=26.0,
        elements=8,
        start=prescribed(0.0, 0.0, 3.0),
        end=prescribed(14.0, 0.0, 21.0),
        water={"surface_level": 20.0, "current": current},
        gravity=9.81,
        solver={"tolerance": 1e-10, "newton": newton},
        riser={"attachments": attachments},
    )
    return np.asarray(stage_histories(scene)[-1].position[-1])


@pytest.mark.parametrize("current", [STEADY, CHANGING], ids=["steady", "changing"])
@pytest.mark.parametrize("attachments", [[], MODULE], ids=["pipe", "module"])
def test_both_solvers_see_the_current(current: Any, attachments: Any) -> None:
    compiled, snes = (end_of(current, newton, attachments) for newton in ("compiled", "snes"))
    assert compiled == pytest.approx(snes, abs=1e-7)
    assert np.abs(compiled - end_of(STILL, "compiled", attachments)).max() > 0.01
