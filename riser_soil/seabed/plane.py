"""A level seabed without dofs."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Plane:
    """Level plane that pushes up by the smoothed penalty law of `riser_soil.contact.law`.

    A rigid plane takes a penalty stiffness, whose penetration is an error; a linear spring seabed takes the
    ground's stiffness, whose penetration is settlement. The law is the same.

    level: height z of the plane [m]. stiffness: force per length of riser per penetration [N/m2].
    smoothing: half width of the law's rounded corner [m].
    """

    level: float
    stiffness: float
    smoothing: float = 0.0
