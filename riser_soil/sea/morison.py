"""Hydrodynamic load on the riser: the part "morison" of dynamic stages under water."""

from __future__ import annotations

import numpy as np

from riser_soil.arrays import Array
from riser_soil.part import Block, Energy, Forces, State, Weights, Work
from riser_soil.riser import hermite
from riser_soil.riser.line import EMPTY, Line, LoadTangent, Trial
from riser_soil.sea import morison_law as law

POINTS = 0.5 + np.sqrt(0.6) * np.array([-0.5, 0.0, 0.5])
GAUSS = np.array([5.0, 8.0, 5.0]) / 18.0


class Morison:
    """Drag (group F) and added mass (group I) of the turned pipe in still water, three Gauss points per
    element.

    line: the riser's field. drag, mass: coefficients (ne, 2), normal and tangential, of
    `morison_law.drag_coefficients` [kg/m2] and `morison_law.added_masses` [kg/m].
    """

    name = "morison"
    symmetric = False

    def __init__(self, line: Line, drag: Array, mass: Array) -> None:
        self.line, self._drag, self._mass = line, drag[:, None], mass[:, None]
        self._N = np.stack(
            [hermite.shapes(np.full(line.length.size, p), line.length) for p in POINTS], axis=1
        )
        self._dN = np.stack(
            [hermite.slopes(np.full(line.length.size, p), line.length) for p in POINTS], axis=1
        )
        weight = GAUSS[:, None] * line.length[:, None, None]
        self._test = np.ascontiguousarray(np.swapaxes(weight * self._N, 1, 2))
        self._NN = self._products(self._N)
        self._NdN = self._products(self._dN)

    def _products(self, trial: Array) -> Array:
        """Weighted N_a times shape functions of the trial (ne, 16, 3)."""
        products = self._test[:, :, None, :] * np.swapaxes(trial, 1, 2)[:, None]
        return np.ascontiguousarray(products.reshape(-1, 16, POINTS.size))

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
        trial = self.line.trial(state)
        tau, stretch = self._tangents(trial)
        inertia, force = self._q_forces(trial)
        by_rate, by_tau = law.drag_derivatives(self._N @ trial.q_rate, tau, self._drag)
        load = LoadTangent(force, self._by_q(by_tau, tau, stretch), self._by_rate(by_rate), EMPTY)
        trial.add_tangent(values["riser"], weights.force, weights, load)
        by_rate, by_tau = law.added_derivatives(self._N @ trial.q_acceleration, tau, self._mass)
        load = LoadTangent(inertia, self._by_q(by_tau, tau, stretch), EMPTY, self._by_rate(by_rate))
        trial.add_tangent(values["riser"], weights.inertia, weights, load)

    def energy(self, state: State) -> Energy:
        """Kinetic energy of the added mass."""
        if not self.line.active:
            return Energy()
        trial = self.line.trial(state)
        momentum = law.added(self._N @ trial.q_rate, self._tangents(trial)[0], self._mass)
        return Energy(kinetic=0.5 * float(np.sum(trial.q_rate * (self._test @ momentum))))

    def work(self, before: State, after: State) -> Work:
        """Drag dissipates. The added mass turns with the pipe, so its force does other work than its kinetic
        energy
        takes up; the difference counts as the water's work."""
        if not self.line.active:
            return Work()
        increment = self.line.nodal(after.u) - self.line.nodal(before.u)
        gained = self.energy(after).kinetic - self.energy(before).kinetic
        resisted = [self._mean_work(group, before, after, increment) for group in (0, 1)]
        return Work(dissipated=resisted[1], external=gained - resisted[0])

    def _mean_work(self, group: int, before: State, after: State, increment: Array) -> float:
        """Work against the mean resistance of a group over the step."""
        total = 0.0
        for state in (before, after):
            nodal = np.zeros(self.line.offset + self.line.size)
            element = self.element_forces(state)[group]
            assert element is not None
            self.line.scatter(element, nodal)
            total += 0.5 * float(np.sum(self.line.nodal(nodal) * increment))
        return total

    def commit(self, state: State) -> None:
        pass

    def _q_forces(self, trial: Trial) -> tuple[Array, Array]:
        """Residuals conjugate to q (ne, 4, d): inertia, drag."""
        tau = self._tangents(trial)[0]
        inertia = law.added(self._N @ trial.q_acceleration, tau, self._mass)
        drag = law.drag(self._N @ trial.q_rate, tau, self._drag)
        return self._test @ inertia, self._test @ drag

    def _tangents(self, trial: Trial) -> tuple[Array, Array]:
        """Unit tangents at the points (ne, 3, d) and the stretch |x'| there (ne, 3, 1)."""
        dN, directors = self._dN, trial.turn.tangent
        along = dN[:, :, 2:3] * trial.chord[:, None] + dN[:, :, 1::2] @ directors
        stretch = np.linalg.norm(along, axis=-1, keepdims=True)
        return along / stretch, stretch

    def _by_rate(self, derivative: Array) -> Array:
        """Blocks of q' or q'' (ne, 4, 4, d, d) from derivatives at the points (ne, 3, d, d)."""
        d = derivative.shape[-1]
        return np.asarray((self._NN @ derivative.reshape(-1, 3, d * d)).reshape(-1, 4, 4, d, d))

    def _by_q(self, derivative: Array, tau: Array, stretch: Array) -> Array:
        """Blocks of q from derivatives by tau, which follows x' = sum of dN q by (I - tau tau)/|x'|."""
        d = derivative.shape[-1]
        lengthwise = np.sum(derivative * tau[..., None, :], axis=-1)
        turning = (derivative - lengthwise[..., None] * tau[..., None, :]) / stretch[..., None]
        return np.asarray((self._NdN @ turning.reshape(-1, 3, d * d)).reshape(-1, 4, 4, d, d))
