"""Quadrature stations of the pipe, where the water acts on it."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.riser import stations
from riser_soil.riser.line import Line


class PointsOnLine(NamedTuple):
    """Single points of a line: their elements (m,), which may repeat, and `stations.points` there."""

    element: IntArray
    at: stations.Stations


class Pipe:
    """Gauss stations of a line.

    points: seen at these m points instead, each as if it were an element with one station; forces per length are then
    forces, and the arc length that a point stands for is 1. What sits there is alike in all directions.
    """

    def __init__(self, line: Line, points: PointsOnLine | None = None) -> None:
        self.line, self._points = line, points
        self.at = stations.stations(line.length) if points is None else points.at

    @property
    def points_alone(self) -> bool:
        """Whether it is seen at single points, not all along."""
        return self._points is not None

    @property
    def element(self) -> IntArray:
        """The line's element that each of its own is, or lies in (ne,)."""
        return np.arange(self.line.length.size) if self._points is None else self._points.element

    @cached_property
    def share(self) -> Array:
        """Arc length that each station stands for (ne, ng) [m]."""
        if self._points is not None:
            return np.ones(self.at.N.shape[:2])
        return self.line.length[:, None] * stations.GAUSS

    @property
    def span(self) -> Array:
        """Widths (ne, ng) [m] of sections that get wet as lying ones do, see `wet_section`: the diameter, but no less
        than the arc length that a station stands for, along which an upright pipe gets wet.
        """
        return np.maximum(self.line.outer_diameter[:, None], self.share)
