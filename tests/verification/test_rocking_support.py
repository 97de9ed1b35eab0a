"""A pipe clamped to a support that rocks: the work of the support, plane and space, and springs instead of a clamp."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from tests.support.scenes import AVERAGE, dynamic, prescribed, riser_scene
from tests.support.stage_histories import StageHistory, distance, stage_histories

PIPE = {"EA": 1.0e7, "EI": 2.0e5, "GJ": 1.5e5, "mass": 40.0, "outer_diameter": 0.3, "rotary_inertia": True}
ARM = 8.0
ACROSS, OBLIQUE = [0.0, -1.0, 0.0], [0.3, -0.8, 0.5]


def rocked(
    time_step: float, axis: list[float], dimension: int = 3, rotation: Any = "fixed", **more: Any
) -> StageHistory:
    """The pipe sticks out along x from a support that turns by up to 60 degrees, for 4 s."""
    rocking = {"axis": axis, "amplitude_deg": 60.0, "period": 6.0, "ramp": 3.0}
    scene = riser_scene(
        dynamic(4.0, time_step, motion={"start": {"rotation": rocking}}, scheme=AVERAGE),
        pipe=PIPE,
        length=ARM,
        elements=4,
        start=prescribed(0.0, 0.0, 0.0, rotation=rotation),
        end="free",
        dimension=dimension,
        solver={"tolerance": 1e-11},
        **more,
    )
    return stage_histories(scene)[-1]


def missing(history: StageHistory) -> float:
    """Energy that no work accounts for, over the largest energy."""
    return float(np.abs(np.array(history.energy) - np.cumsum(history.work)).max() / max(history.energy))


@pytest.mark.parametrize("rotation", ["fixed", {"stiffness": 3.0e4}])
@pytest.mark.parametrize(("axis", "dimension"), [(ACROSS, 2), (ACROSS, 3), (OBLIQUE, 3)])
def test_work_of_the_turning_support_is_the_energy_of_the_pipe(
    rotation: Any, axis: list[float], dimension: int
) -> None:
    coarse, fine = (rocked(dt, axis, dimension, rotation) for dt in (0.04, 0.02))
    assert max(fine.energy) > 1e3
    assert missing(fine) < 2e-3
    assert missing(coarse) / missing(fine) == pytest.approx(4.0, rel=0.3)


def tip(history: StageHistory) -> Array:
    return np.array(history.position)[:, -1]


@pytest.mark.parametrize("rotation", ["fixed", {"stiffness": 3.0e4}])
def test_plane_and_space_agree(rotation: Any) -> None:
    plane, space = (rocked(0.04, ACROSS, n, rotation) for n in (2, 3))
    assert distance(tip(plane), tip(space)) < 1e-8 * ARM


@pytest.mark.parametrize(("axis", "dimension"), [(ACROSS, 2), (OBLIQUE, 3)])
def test_a_stiff_spring_is_a_clamp(axis: list[float], dimension: int) -> None:
    clamp = tip(rocked(0.04, axis, dimension))
    apart = [distance(tip(rocked(0.04, axis, dimension, {"stiffness": k})), clamp) for k in (1e7, 1e8)]
    assert apart[1] < 0.02 * ARM
    assert apart[0] / apart[1] == pytest.approx(10.0, rel=0.2)
