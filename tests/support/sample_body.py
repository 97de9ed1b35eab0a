"""A body in general position, with all that a rigid body or a point may have, and states around it."""

from __future__ import annotations

import numpy as np

from riser_soil.bodies.body import BodyProperties, MovingBody
from riser_soil.core.part import State

RHO = 1025.0


def properties(turns: bool = True) -> BodyProperties:
    """Properties of a rigid body with all that it may have, or of a point."""
    none, ca = np.zeros(3), np.array([0.4, 0.9, 1.6])
    if not turns:
        return BodyProperties(300.0, none, none, 0.5, none, np.full(3, 0.8), none, np.full(3, 0.5 * RHO * 0.5), none)
    return BodyProperties(
        300.0, np.array([40.0, 55.0, 90.0]), np.array([0.1, -0.3, -0.5]), 0.5, np.array([-0.2, 0.1, 0.4]),
        np.array([0.8, 1.5, 2.1]), np.array([0.3, 0.2, 0.7]), ca * RHO * 0.5, np.array([15.0, 5.0, 30.0]),
    )  # fmt: skip


def body(turns: bool = True, z: float = -5.0) -> MovingBody:
    """In general position: after two steps."""
    made = MovingBody("buoy", np.array([1.0, 2.0, z]), turns, 1.3)
    for seed in range(2):
        made.commit(shaken(made, seed, 0.4))
    made.x[0, 2] = z
    return made


def shaken(made: MovingBody, seed: int = 7, size: float = 0.3) -> State:
    u, v, a = np.random.default_rng(seed).normal(size=(3, made.offset + made.size))
    return State(0.6, size * u, 1.5 * v, 3.0 * a, dt=0.1)
