"""A flex joint whose neutral angle is not that of the first shape: a rigid bar on it, and a hanging riser."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.hang_off import from_vertical
from riser_soil.riser import rotations
from riser_soil.riser.part_kernels import add_energy
from riser_soil.riser.springs import PlanarSpring, SpatialSpring
from tests.support.scenes import Mapping, prescribed, riser_scene, static
from tests.support.stage_histories import stage_histories

pytestmark = pytest.mark.usefixtures("uncompiled")

ROD: Mapping = {"EA": 1.0e9, "EI": 1.0e10, "GJ": 1.0e10}
L, K = 10.0, 5.0e3


def joint(angle: float, stiffness: float = K) -> Mapping:
    return {"stiffness": stiffness, "neutral_angle": angle}


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("upper", ["start", "end"])
def test_a_rigid_bar_turns_to_the_neutral_angle(dimension: int, upper: str) -> None:
    """The bar turns from upright to 20 degrees, whichever end it hangs from; then a force balances k times the turn."""
    foot, top = [0.0, 0.0, 0.0], [0.0, 0.0, L]
    force = 400.0
    lateral = static("pushed", loads=[{"at": "end" if upper == "start" else "start", "force": [force, 0.0, 0.0]}])
    ends: dict[str, Any] = {upper: prescribed(*top, rotation=joint(20.0))}
    ends["end" if upper == "start" else "start"] = "free"
    points = [top, foot] if upper == "start" else [foot, top]
    scene = riser_scene(
        static(), lateral, pipe=ROD, length=L, elements=2, riser={"unstressed": {"points": points}},
        dimension=dimension, **ends,
    )  # fmt: skip
    rest, pushed = stage_histories(scene)
    side = 1.0 if upper == "end" else -1.0
    free = 0 if upper == "end" else -1
    theta = np.radians(20.0)
    assert rest.position[-1][free] == pytest.approx([-side * L * np.sin(theta), 0.0, L - L * np.cos(theta)], abs=1e-5)
    x, _, z = pushed.position[-1][free]
    turned = np.arctan2(-side * x, L - z)
    assert K * (turned - theta) == pytest.approx(-side * force * (L - z), rel=1e-5)
    assert pushed.energy[-1] == pytest.approx(0.5 * K * (turned - theta) ** 2, rel=1e-4)


def test_the_joint_of_a_hanging_riser() -> None:
    """The joint's moment is its stiffness times the riser's angle less the neutral one."""
    pipe: Mapping = {"EA": 1.0e8, "EI": 1.0e5, "submerged_weight": 300.0}
    scene = riser_scene(
        static(), pipe=pipe, length=60.0, elements=60, gravity=9.81,
        start=prescribed(0.0, 0.0, 0.0), end=prescribed(30.0, 0.0, 40.0, rotation=joint(2.0, 2.0e4)),
    )  # fmt: skip
    (run,) = stage_histories(scene)
    turn = np.radians(from_vertical(run.end.end_tangent) - 2.0)
    assert abs(turn) > 0.02
    assert run.end.end_moment == pytest.approx([0.0, -2.0e4 * turn, 0.0], rel=1e-6)


class Turned(NamedTuple):
    """What a spring sees of a line of one node: its angle in a plane, its frame in space."""

    angle: Array
    frames: Array


def test_energy_in_the_loop_is_that_of_the_turn_from_the_support() -> None:
    support, turn = np.array([0.3, -0.5, 0.2]), np.array([0.4, 0.6, -1.2])
    first, then = (np.array(rotations.exp(tuple(each))) for each in (support, turn))
    at, stored = Turned(np.array([1.7]), (then @ first)[None]), np.zeros((2, 3))
    add_energy.kernels[PlanarSpring](PlanarSpring(0, K, *(np.array([0.3]) for _ in range(2))), at, stored[0])
    add_energy.kernels[SpatialSpring](SpatialSpring(0, K, first, first), at, stored[1])
    assert stored == pytest.approx(0.5 * K * np.array([[0.0, 1.4**2, 0.0], [0.0, 1.4**2, 0.0]]))
