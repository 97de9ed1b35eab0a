"""Position, velocity and acceleration of the pipe at its quadrature stations, where the water acts on it."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Weights
from riser_soil.riser import stations
from riser_soil.riser.line import Line
from riser_soil.riser.trial import Trial


class StationFlow(NamedTuple):
    """Velocity v and acceleration a (ne, ng, d) of the pipe, unit tangent tau (ne, ng, d) and stretch |x'| (ne, ng)."""

    v: Array
    a: Array
    tau: Array
    stretch: Array


class PointsOnLine(NamedTuple):
    """Single points of a line: their elements (m,), which may repeat, and `stations.points` there."""

    element: IntArray
    at: stations.Stations


class Pipe:
    """Gauss stations of a line, and the pipe's motion at them; in the line's axes.

    points: seen at these m points instead, each as if it were an element with one station; forces per length are then
    forces, and the arc length that a point stands for is 1. What sits there is alike in all directions: tau is zero.
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

    def _own(self, values: Array) -> Array:
        """The elements' values at the stations."""
        return values if self._points is None else values[self._points.element]

    def _gather(self, values: Array) -> Array:
        """Sums over the stations' elements, for all elements."""
        if self._points is None:
            return values
        total = np.zeros((self.line.length.size, *values.shape[1:]))
        np.add.at(total, self._points.element, values)
        return total

    def position(self, trial: Trial) -> Array:
        """(ne, ng, d) [m]; the height is the last coordinate."""
        found: Array = trial.once((self, "position"), lambda trial: stations.interpolate(self.at, self._own(trial.q)))
        return found

    def flow(self, trial: Trial) -> StationFlow:
        """The pipe's own motion, relative to still water."""
        flow: StationFlow = trial.once((self, "flow"), self._evaluate)
        return flow

    def _evaluate(self, trial: Trial) -> StationFlow:
        seen = (trial.q_rate, trial.q_acceleration, trial.chord, trial.turn.tangent)
        flow = StationFlow(*stations.motion(self.at, *(self._own(values) for values in seen)))
        return flow if self._points is None else flow._replace(tau=np.zeros_like(flow.tau))

    def integrate(self, density: Array) -> Array:
        """Residual conjugate to q (ne, 4, d) of a force per length (ne, ng, d)."""
        return self._gather(stations.integrate(self.at, density))

    def total(self, f: Array, g: Array) -> float:
        """Integral over the line of f . g, of densities (ne, ng, d)."""
        return stations.inner(self.share, f, g)

    def add_tangent(self, K: Array, trial: Trial, weights: Weights, by: stations.Derivatives) -> None:
        """Add to K (ne, n, n) the tangent of a force per length with these derivatives, directors held constant."""
        q, rate, acceleration = trial.columns(weights)
        own = K if self._points is None else np.zeros((len(self.at.N), *K.shape[1:]))
        first, second, third = (self._own(c.tangent) for c in (q, rate, acceleration))
        by_dofs = stations.DofDerivatives(first, second, third, rate.shift, acceleration.shift)
        stations.add_tangent(own, self.at, by, by_dofs)
        if self._points is not None:
            np.add.at(K, self._points.element, own)

    def taken(self, force: Callable[[Trial], Array], first: Trial, last: Trial) -> float:
        """Work [J] against the mean of residuals conjugate to q (ne, 4, d) at the ends of a step."""
        return 0.5 * float(np.vdot(force(first) + force(last), last.q - first.q))
