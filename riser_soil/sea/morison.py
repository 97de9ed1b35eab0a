"""Hydrodynamic load on the riser: the part "morison" of dynamic stages under water."""

from __future__ import annotations

import numpy as np

from riser_soil.arrays import Array
from riser_soil.part import Block, Energy, Forces, State, Weights, Work
from riser_soil.riser import stations
from riser_soil.riser.line import Line
from riser_soil.riser.trial import Columns, Trial
from riser_soil.sea import morison_law as law


class Morison:
    """Drag (group F) and added mass (group I) of the turned pipe in still water, three Gauss points per
    element.

    line: the riser's field. drag, mass: coefficients (ne, 2), normal and tangential, of
    `morison_law.drag_coefficients` [kg/m2] and `morison_law.added_masses` [kg/m].
    """

    name = "morison"
    symmetric = False

    def __init__(self, line: Line, drag: Array, mass: Array) -> None:
        self.line, self._drag, self._mass = line, drag, mass
        self._at = stations.stations(line.length)

    def blocks(self) -> dict[str, Block]:
        return {"riser": self.line.element_block()} if self.line.active else {}

    def element_forces(self, state: State) -> tuple[Array | None, Array | None]:
        """Element residuals (inertia, force), each (ne, 2 ndof)."""
        trial = self.line.trial(state)
        inertia, force = self._q_forces(trial)
        return trial.pull_back(inertia), trial.pull_back(force)

    def residual(self, state: State, forces: Forces) -> None:
        if self.line.active:
            trial = self.line.trial(state)
            inertia, force = self._q_forces(trial)
            self.line.scatter(trial.pull_back(inertia), forces.inertia)
            self.line.scatter(trial.pull_back(force), forces.force)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        if not self.line.active:
            return
        trial, K = self.line.trial(state), values["riser"]
        tau, _ = self._tangents(trial)
        inertia, drag = self._q_forces(trial)
        _, rate, acceleration = trial.columns(weights)
        v, a = (stations.interpolate(self._at, q) for q in (trial.q_rate, trial.q_acceleration))
        self._add_group(trial, K, weights.force, drag, law.drag_derivatives(v, tau, self._drag), rate)
        by = law.added_derivatives(a, tau, self._mass)
        self._add_group(trial, K, weights.inertia, inertia, by, acceleration)

    def _add_group(
        self, trial: Trial, K: Array, weight: float, F: Array, by: tuple[Array, Array], columns: Columns
    ) -> None:
        """F: residual conjugate to q; by: derivatives at the stations by the rate with these columns, and by
        tau.
        """
        by_rate, by_tau = by
        P, at = trial.turn.P, self._at
        by_slope = stations.follow_slope(by_tau, *self._tangents(trial))
        trial.add_turning(K, weight, F)
        stations.add_tangent(K, weight, P, P, 1.0, at.weighted, at.dN, by_slope)
        stations.add_tangent(K, weight, P, columns.tangent, columns.shift, at.weighted, at.N, by_rate)

    def energy(self, state: State) -> Energy:
        """Kinetic energy of the added mass."""
        if not self.line.active:
            return Energy()
        trial = self.line.trial(state)
        rate = stations.interpolate(self._at, trial.q_rate)
        momentum = law.added(rate, self._tangents(trial)[0], self._mass)
        return Energy(kinetic=0.5 * float(np.sum(trial.q_rate * stations.integrate(self._at, momentum))))

    def work(self, before: State, after: State) -> Work:
        """Drag dissipates; as the added mass turns with the pipe, the water does work on it."""
        if not self.line.active:
            return Work()
        increment = self.line.nodal(after.u) - self.line.nodal(before.u)
        dissipated = sum(0.5 * self._resisted(state, increment) for state in (before, after))
        return Work(dissipated=dissipated, external=self._turned(before, after))

    def _resisted(self, state: State, increment: Array) -> float:
        """Work of a step's increment against the drag at a state."""
        trial = self.line.trial(state)
        nodal = np.zeros(self.line.offset + self.line.size)
        self.line.scatter(trial.pull_back(self._q_forces(trial)[1]), nodal)
        return float(np.sum(self.line.nodal(nodal) * increment))

    def _turned(self, before: State, after: State) -> float:
        """What turning by dtau adds to the added mass's kinetic energy beyond the work of its force.

        That force is m(tau) a, so the remainder is 1/2 v.dm v = (Cat - Can) (v.tau) (v.dtau) per length. Written in
        rates alone it owes nothing to the accelerations, which generalised-alpha knows to first order only.
        """
        seen = [self.line.trial(state) for state in (before, after)]
        tau = [self._tangents(trial)[0] for trial in seen]
        rate = [stations.interpolate(self._at, trial.q_rate) for trial in seen]
        pull = 0.5 * sum(np.sum(v * t, axis=-1, keepdims=True) * v for v, t in zip(rate, tau, strict=True))
        excess = (self._mass[:, 1] - self._mass[:, 0])[:, None, None]
        return float(np.sum(stations.integrate(self._at, excess * pull * (tau[1] - tau[0]))[:, [0, 2]]))

    def commit(self, state: State) -> None:
        pass

    def _q_forces(self, trial: Trial) -> tuple[Array, Array]:
        """Residuals conjugate to q (ne, 4, d): inertia, drag."""
        tau, _ = self._tangents(trial)
        inertia = law.added(stations.interpolate(self._at, trial.q_acceleration), tau, self._mass)
        drag = law.drag(stations.interpolate(self._at, trial.q_rate), tau, self._drag)
        return stations.integrate(self._at, inertia), stations.integrate(self._at, drag)

    def _tangents(self, trial: Trial) -> tuple[Array, Array]:
        tau, stretch = stations.unit_tangents(self._at, trial.chord, trial.turn.tangent)
        return tau, stretch
