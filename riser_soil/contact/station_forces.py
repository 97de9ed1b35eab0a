"""Contact forces per length at quadrature stations, assembled to the line's dofs."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.riser import stations
from riser_soil.riser.line import Line
from riser_soil.riser.trial import Trial


class StationForces:
    """Forces of a part with a resistance (m, ng, d) [N/m] at the stations `at` of some elements (m,); kept by trial."""

    def __init__(self, line: Line, at: stations.Stations) -> None:
        self._line, self._at = line, at

    def in_elements(self, trial: Trial, elements: IntArray, resistance: Array) -> Array:
        """Element residuals (ne, 2 ndof)."""
        found: Array = trial.once(
            (self, "element forces"), lambda trial: trial.pull_back(self._F(trial, elements, resistance))
        )
        return found

    def add_tangent(self, K: Array, trial: Trial, elements: IntArray, resistance: Array, by_position: Array) -> None:
        """Add to K (ne, n, n), unweighted, what a resistance with the derivative (m, ng, d, d) by the position has."""
        if elements.size == 0:
            return
        stations.add_stiffness(K, self._at, elements, by_position, trial.turn.P)
        trial.add_turning(K, 1.0, self._F(trial, elements, resistance))

    def _F(self, trial: Trial, elements: IntArray, resistance: Array) -> Array:
        """Residual conjugate to q (ne, 4, d)."""
        found: Array = trial.once((self, "F"), lambda _: self._integrated(elements, resistance))
        return found

    def _integrated(self, elements: IntArray, resistance: Array) -> Array:
        F = np.zeros((self._line.length.size, 4, self._line.dimension))
        F[elements] = stations.integrate(self._at.of(elements), resistance)
        return F
