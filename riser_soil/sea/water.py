"""Water motion at given points: the interface between current or waves and the loads that they cause."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from riser_soil.core.arrays import Array


class WaterMotion(NamedTuple):
    """The undisturbed water at points (n, 3), global axes.

    velocity [m/s] and acceleration [m/s2]: (n, 3). velocity_gradient [1/s], acceleration_gradient [1/s2]: (n, 3, 3),
    [i, j] being the derivative of component i by x_j; exact derivatives of what is returned.
    immersion: (n,) height of the water's surface above the point [m], negative above the surface; inf where the water
    has no surface. immersion_gradient: (n, 3).
    """

    velocity: Array
    acceleration: Array
    velocity_gradient: Array
    acceleration_gradient: Array
    immersion: Array
    immersion_gradient: Array


Water = Callable[[float, Array], WaterMotion]
"""Seconds since the stage began (load factor in statics), points (n, 3) -> the water's motion there."""
