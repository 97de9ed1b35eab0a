"""Quadrature stations of the pipe, where the water acts on it, and of buoyancy modules and clump weights.

At velocity v and acceleration a, a module of drag area Cd A and volume V with added mass coefficient Ca resists with

    1/2 rho Cd A |v| v + Ca rho V a,

and in accelerating water it feels rho V (1 + Ca) u', as a pipe does (`morison`): its loads are those of a pipe
without a direction, given per module instead of per length, at one station each. In section forces, the water's force
on a module at the riser's very end counts with the last element.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.riser import stations
from riser_soil.riser.attachments import PointAttachment, places
from riser_soil.riser.line import Line


class PointsOnLine(NamedTuple):
    """Single points of a line: their elements (m,), which may repeat, and `stations.points` there."""

    element: IntArray
    at: stations.Stations


class Pipe:
    """Gauss stations of a line.

    points: m single points in the place of Gauss stations, each as if it were an element with one station; forces per
    length are then forces, and the arc length of a point is 1. What sits there is alike in all directions.
    """

    def __init__(self, line: Line, points: PointsOnLine | None = None) -> None:
        self.line, self._points = line, points
        self.at = stations.stations(line.length) if points is None else points.at

    @property
    def points_alone(self) -> bool:
        """Whether its stations are single points, not all along."""
        return self._points is not None

    @property
    def element(self) -> IntArray:
        """The line's element that each of its own is, or lies in (ne,)."""
        return np.arange(self.line.length.size) if self._points is None else self._points.element

    @cached_property
    def share(self) -> Array:
        """Arc length of each station (ne, ng) [m]: its share of the integral along the line."""
        if self._points is not None:
            return np.ones(self.at.N.shape[:2])
        return self.line.length[:, None] * stations.GAUSS

    @property
    def span(self) -> Array:
        """Widths (ne, ng) [m] of sections that get wet as lying ones do, see `waterline`: the diameter, but no less
        than the arc length of a station, along which an upright pipe gets wet.
        """
        return np.maximum(self.line.outer_diameter[:, None], self.share)


def pipe_at(line: Line, modules: Sequence[PointAttachment]) -> Pipe:
    """The pipe with stations at the modules (m,) alone: ne = m, ng = 1, forces in N instead of N/m."""
    element, xi = places(line, modules)
    return Pipe(line, PointsOnLine(element, stations.points(line.length[element], xi)))


def alike(coefficient: Array) -> Array:
    """Coefficients (m, 2) of `morison_law`, which are one (m,) in all directions."""
    return np.stack([coefficient, coefficient], axis=-1)


def diameters(modules: Sequence[PointAttachment]) -> Array:
    """Diameters (m,) [m] of spheres of the same volume, or of discs of the drag area where those are larger."""
    volume, area = (np.array([getattr(module, name) for module in modules]) for name in ("volume", "drag_area"))
    return np.asarray(np.maximum(np.cbrt(6.0 * volume / np.pi), np.sqrt(4.0 * area / np.pi)))
