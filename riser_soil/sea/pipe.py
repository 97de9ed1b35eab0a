"""The pipe seen at the stations of its line, where the water acts on it."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from riser_soil.arrays import Array
from riser_soil.part import State, Weights
from riser_soil.riser import stations
from riser_soil.riser.line import Line
from riser_soil.riser.trial import Trial


class Flow(NamedTuple):
    """Velocity v and acceleration a (ne, ng, d) of the pipe, unit tangent tau (ne, ng, d) and stretch |x'| (ne, ng)."""

    v: Array
    a: Array
    tau: Array
    stretch: Array


class Pipe:
    """Gauss stations of a line, and the pipe's motion at them; in the line's axes."""

    def __init__(self, line: Line) -> None:
        self.line, self.at = line, stations.stations(line.length)

    @property
    def share(self) -> Array:
        """Arc length that each station stands for (ne, ng) [m]."""
        return self.line.length[:, None] * stations.GAUSS

    def position(self, trial: Trial) -> Array:
        """(ne, ng, d) [m]; the height is the last coordinate."""
        found: Array = trial.once((self, "position"), lambda trial: stations.interpolate(self.at, trial.q))
        return found

    def flow(self, trial: Trial) -> Flow:
        """The pipe's own motion, as still water meets it."""
        flow: Flow = trial.once((self, "flow"), self._see)
        return flow

    def _see(self, trial: Trial) -> Flow:
        v, a = (stations.interpolate(self.at, q) for q in (trial.q_rate, trial.q_acceleration))
        return Flow(v, a, *stations.unit_tangents(self.at, trial.chord, trial.turn.tangent))

    def integrate(self, density: Array) -> Array:
        """Residual conjugate to q (ne, 4, d) of a force per length (ne, ng, d)."""
        return stations.integrate(self.at, density)

    def total(self, density: Array) -> float:
        """Integral over the line of a density (ne, ng, d), its components summed."""
        return float(self.integrate(density)[:, [0, 2]].sum())

    def add_tangent(self, K: Array, trial: Trial, weights: Weights, by: stations.Derivatives) -> None:
        """Add to K (ne, n, n) what a force per length with these derivatives has as tangent, directors held."""
        q, rate, acceleration = trial.columns(weights)
        columns = stations.Columns(q.tangent, rate.tangent, acceleration.tangent, rate.shift, acceleration.shift)
        stations.add_tangent(K, self.at, by, columns)

    def taken(self, force: Callable[[State], Array], before: State, after: State) -> float:
        """Work [J] against the mean of element residuals (ne, 2 ndof) at the ends of a step."""
        moved = self.line.nodal(after.u) - self.line.nodal(before.u)
        element = np.concatenate([moved[:-1], moved[1:]], axis=1)
        return 0.5 * float(np.sum((force(before) + force(after)) * element))
