"""How the line's ends are held, and how their supports move and turn."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from riser_soil.core.arrays import Array

Kinematics = tuple[Array, Array, Array]
Motion = Callable[[float], Kinematics]
"""Seconds since the stage began (load factor in statics) -> position, velocity, acceleration (3,) in global
axes.
"""


class Turning(NamedTuple):
    """A support turned from where it is at the stage's beginning, each (3,) in global axes.

    rotation: rotation vector [rad]; about one axis it may count whole turns. angular_velocity [rad/s],
    angular_acceleration [rad/s2].
    """

    rotation: Array
    angular_velocity: Array
    angular_acceleration: Array


@dataclass
class End:
    """How an end is held.

    motion, when given, moves a held position; without it the end stays where it is. turning, of the seconds since the
    stage began, turns the support: a fixed rotation turns with it, and so does the direction in which a spring is at
    rest. A free rotation knows nothing of it.
    """

    held: bool
    rotation_fixed: bool = False
    motion: Motion | None = None
    turning: Callable[[float], Turning] | None = None
