"""Features of a block's top along the riser: a trench, or the groove of an embedded pipe. Lengths in m.

A feature lies along x or y; `along` counts on that axis, `across` from the riser's line, z from the block's level.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array

FEWEST_STRIPS = 9


@dataclass(frozen=True)
class TrenchSpec:
    """depth: of the floor. width: of the floor. side: horizontal length of each side. along: floor's ends, None:
    beyond the block. ramp: horizontal length of the ends' ramps.
    """

    depth: float
    width: float
    side: float
    along: tuple[float, float] | None = None
    ramp: float = 1.0

    @property
    def half_width(self) -> float:
        """Half width at the seabed."""
        return 0.5 * self.width + self.side

    def finest(self, size: float) -> float:
        """Size of the cells under the riser."""
        return min(size, self.width)

    def corners(self, ends: tuple[float, float]) -> Array:
        """What is dug out, and as much above: corners (2, 4, 3) of floor and lid in along, across, z, each in a cycle;
        ends: of the block.
        """
        length = ends[1] - ends[0]
        first, last = self.along or (ends[0] - length, ends[1] + length)
        ramp = self.ramp if self.along else 0.25 * length
        half = 0.5 * self.width
        floor = [first, last, half, -self.depth]
        lid = [first - 2.0 * ramp, last + 2.0 * ramp, half + 2.0 * self.side, self.depth]
        return np.array([[(a, -t, z), (b, -t, z), (b, t, z), (a, t, z)] for a, b, t, z in (floor, lid)])


@dataclass(frozen=True)
class GrooveSpec:
    """depth: of the pipe's underside below the seabed, at most the radius of the pipe."""

    depth: float
    radius: float

    @property
    def half_angle(self) -> float:
        """Angle from the bottom of the pipe to where it leaves the soil [rad]."""
        return float(np.arccos(1.0 - self.depth / self.radius))

    def strips(self, size: float) -> int:
        """Plane strips that make up the groove, an odd number: one is level."""
        return 2 * int(np.ceil(0.5 * max(FEWEST_STRIPS, 2.0 * self.half_angle * self.radius / size) - 0.5)) + 1

    @property
    def half_width(self) -> float:
        """Half width at the seabed, of the finest strips."""
        return float(self.radius * np.sin(self.half_angle))

    def finest(self, size: float) -> float:
        """Size of the cells in the groove."""
        return min(size, 2.0 * self.half_angle * self.radius / self.strips(size))

    def section(self, size: float) -> Array:
        """Corners (strips + 1, 2) of the groove's section across and in z: each strip touches the pipe in its middle,
        so that the pipe lies in the groove without pressing on it. The first and last corners are at the seabed.
        """
        n, axis = self.strips(size), self.radius - self.depth
        step = 2.0 * self.half_angle / n
        angle = -self.half_angle + step * np.arange(1, n)
        corner = self.radius / np.cos(0.5 * step) * np.column_stack((np.sin(angle), -np.cos(angle)))
        middle = self.half_angle - 0.5 * step  # of the last strip, which goes on to the seabed
        end = (self.radius - axis * np.cos(middle)) / np.sin(middle)
        return np.vstack(((-end, 0.0), corner + np.array([0.0, axis]), (end, 0.0)))


FeatureSpec = TrenchSpec | GrooveSpec
