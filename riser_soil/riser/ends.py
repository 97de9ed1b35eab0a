"""End conditions of the line: which dofs are prescribed, and the prescribed motion of the supports."""

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


class SupportRotation(NamedTuple):
    """A support turned from where it is at the stage's beginning, each (3,) in global axes.

    rotation: rotation vector [rad]; about one axis it may count whole turns. angular_velocity [rad/s],
    angular_acceleration [rad/s2].
    """

    rotation: Array
    angular_velocity: Array
    angular_acceleration: Array


@dataclass
class End:
    """Boundary condition of an end.

    motion, when given, moves the prescribed position; without it the end stays where it is. turning, of the seconds
    since the stage began, turns the support: a fixed rotation turns with it, and so does the rest direction of a
    rotational spring. A free rotation is not affected. heaves: whether a prescribed end is free to move up and down, so
    that the horizontal part of its motion alone moves it.
    """

    prescribed: bool
    rotation_fixed: bool = False
    motion: Motion | None = None
    turning: Callable[[float], SupportRotation] | None = None
    heaves: bool = False

    def held(self, dimension: int) -> int:
        """How many of its coordinates are prescribed, the vertical one being the last."""
        return (dimension - self.heaves) if self.prescribed else 0
