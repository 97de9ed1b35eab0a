"""A riser that hardly resists twist moves in its plane as the same riser does in two dimensions."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from riser_soil.scene.reader import read_scene
from tests.support.stage_histories import StageHistory, stage_histories

FIRST_SCENE = Path(__file__).parents[2] / "demos" / "first_scene.yaml"
AGREEMENT = 1e-9  # m; Newton's tolerance leaves some of it, round-off the rest


def heaved(duration: float, dimension: int, GJ: float) -> StageHistory:
    """The first scene's heave."""
    changes = (f"dimension={dimension}", f"line_types.flexible.GJ={GJ}", f"stages.1.duration={duration}")
    return stage_histories(read_scene(FIRST_SCENE, (*changes, "solver.tolerance=1e-10")))[-1]


def require_same_motion(duration: float, GJ: float) -> None:
    flat, spatial = heaved(duration, 2, GJ), heaved(duration, 3, GJ)
    assert spatial.t == flat.t
    apart = np.abs(np.array(spatial.position) - np.array(flat.position))
    assert apart.max() < AGREEMENT
    assert apart[..., 1].max() < 1e-12


@pytest.mark.parametrize("GJ", [1e-3, 1e6])
def test_heave_with_any_torsional_stiffness(GJ: float) -> None:
    """Without inertia about its axis the softer riser winds up from round-off in the second second."""
    require_same_motion(3.0, GJ)


@pytest.mark.verify
@pytest.mark.parametrize("GJ", [1e-3, 1.0, 10.0, 1e3, 1e6])
def test_all_of_the_first_scene(GJ: float) -> None:
    require_same_motion(20.0, GJ)
