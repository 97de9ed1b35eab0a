"""Hydrodynamic load on the riser: the part "morison" of dynamic stages under water."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.arrays import Array
from riser_soil.part import Block, Energy, Forces, State, Weights, Work
from riser_soil.riser import stations
from riser_soil.riser.line import Line
from riser_soil.riser.trial import Trial
from riser_soil.sea import morison_law as law


class Flow(NamedTuple):
    """The pipe in the water, seen at the stations: rate, acceleration, unit tangent (ne, ng, d), stretch (ne, ng)."""

    v: Array
    a: Array
    tau: Array
    stretch: Array


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

    def element_forces(self, state: State) -> tuple[Array, Array]:
        """Element residuals (inertia, force), each (ne, 2 ndof)."""
        found: tuple[Array, Array] = self.line.trial(state).once((self, "element forces"), self._element_forces)
        return found

    def residual(self, state: State, forces: Forces) -> None:
        if self.line.active:
            inertia, force = self.element_forces(state)
            self.line.scatter(inertia, forces.inertia)
            self.line.scatter(force, forces.force)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        if not self.line.active:
            return
        trial, K = self.line.trial(state), values["riser"]
        q, rate, acceleration = trial.columns(weights)
        columns = stations.Columns(q.tangent, rate.tangent, acceleration.tangent, rate.shift, acceleration.shift)
        stations.add_tangent(K, self._at, self._derivatives(trial, weights), columns)
        inertia, force = self._q_forces(trial)
        trial.add_turning(K, 1.0, weights.inertia * inertia + weights.force * force)

    def _derivatives(self, trial: Trial, weights: Weights) -> stations.Derivatives:
        flow = self._flow(trial)
        by_v, by_tau = law.drag_derivatives(flow.v, flow.tau, weights.force * self._drag)
        by_a, added_by_tau = law.added_derivatives(flow.a, flow.tau, weights.inertia * self._mass)
        by_tau += added_by_tau
        by_slope = stations.follow_slope(by_tau, flow.tau, flow.stretch)
        return stations.Derivatives(np.zeros_like(by_v), by_slope, by_v, by_a)

    def energy(self, state: State) -> Energy:
        """Kinetic energy of the added mass."""
        if not self.line.active:
            return Energy()
        trial = self.line.trial(state)
        flow = self._flow(trial)
        momentum = stations.integrate(self._at, law.added(flow.v, flow.tau, self._mass))
        return Energy(kinetic=0.5 * float(np.sum(trial.q_rate * momentum)))

    def work(self, before: State, after: State) -> Work:
        """Drag dissipates; as the added mass turns with the pipe, the water does work on it."""
        if not self.line.active:
            return Work()
        increment = self.line.nodal(after.u) - self.line.nodal(before.u)
        dissipated = sum(0.5 * self._resisted(state, increment) for state in (before, after))
        return Work(dissipated=dissipated, external=self._turned(before, after))

    def _resisted(self, state: State, increment: Array) -> float:
        """Work of a step's increment against the drag at a state."""
        nodal = np.zeros(self.line.offset + self.line.size)
        self.line.scatter(self.element_forces(state)[1], nodal)
        return float(np.sum(self.line.nodal(nodal) * increment))

    def _turned(self, before: State, after: State) -> float:
        """What turning by dtau adds to the added mass's kinetic energy beyond the work of its force.

        That force is m(tau) a, so the remainder is 1/2 v.dm v = (Cat - Can) (v.tau) (v.dtau) per length. Written in
        rates alone it owes nothing to the accelerations, which generalised-alpha knows to first order only.
        """
        flows = [self._flow(self.line.trial(state)) for state in (before, after)]
        pull = 0.5 * sum(np.sum(flow.v * flow.tau, axis=-1, keepdims=True) * flow.v for flow in flows)
        excess = (self._mass[:, 1] - self._mass[:, 0])[:, None, None]
        turn = flows[1].tau - flows[0].tau
        return float(np.sum(stations.integrate(self._at, excess * pull * turn)[:, [0, 2]]))

    def commit(self, state: State) -> None:
        pass

    def _element_forces(self, trial: Trial) -> tuple[Array, Array]:
        inertia, force = self._q_forces(trial)
        return trial.pull_back(inertia), trial.pull_back(force)

    def _q_forces(self, trial: Trial) -> tuple[Array, Array]:
        """Residuals conjugate to q (ne, 4, d): inertia, drag."""
        forces: tuple[Array, Array] = trial.once((self, "q forces"), self._resist)
        return forces

    def _resist(self, trial: Trial) -> tuple[Array, Array]:
        flow = self._flow(trial)
        inertia = law.added(flow.a, flow.tau, self._mass)
        drag = law.drag(flow.v, flow.tau, self._drag)
        return stations.integrate(self._at, inertia), stations.integrate(self._at, drag)

    def _flow(self, trial: Trial) -> Flow:
        flow: Flow = trial.once((self, "flow"), self._see)
        return flow

    def _see(self, trial: Trial) -> Flow:
        v, a = (stations.interpolate(self._at, q) for q in (trial.q_rate, trial.q_acceleration))
        return Flow(v, a, *stations.unit_tangents(self._at, trial.chord, trial.turn.tangent))
