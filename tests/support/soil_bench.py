"""A small serial Newton for the soil alone: prescribed displacements on some dofs, sparse direct solves."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.part import Forces, State, Weights
from riser_soil.soil.soil import Soil

WEIGHTS = Weights(inertia=0.0, force=1.0, shift_v=0.0, shift_a=0.0)


@dataclass
class Bench:
    """Steps a Soil through given increments (size,) of the `driven` dofs, seconds each; keeps the residual norms."""

    soil: Soil
    driven: BoolArray
    norms: list[float] = field(default_factory=list)
    increment: Array | None = None
    seconds: float = math.inf

    def step(self, given: Array, tolerance: float = 1e-8, most: int = 25) -> None:
        """Find the equilibrium after the increment `given` of the driven dofs, and accept it."""
        prescribed = self.driven | self.soil.field.prescribed
        free = np.flatnonzero(~prescribed)
        u = self._predict(np.where(prescribed, given, 0.0), prescribed, free)
        self.norms = []
        for _ in range(most):
            force = self.force(u)
            self.norms.append(float(np.linalg.norm(force[free]) / np.linalg.norm(force)))
            if self.norms[-1] < tolerance:
                self.increment = u
                return self._accept(u)
            change = np.zeros_like(u)
            change[free] = -self._solve(u, free, force)
            u = u + self._length(u, change) * change
        raise AssertionError(f"no convergence: {self.norms}")

    def _predict(self, given: Array, prescribed: BoolArray, free: IntArray) -> Array:
        """The last increment again; in the first step the elastic response."""
        if self.increment is not None:
            return np.where(prescribed, given, self.increment)
        guess = given.copy()
        start = np.zeros_like(given)
        load = self.force(start) + assemble(self.soil, self._state(start)) @ given
        guess[free] -= self._solve(start, free, load)
        return guess

    def _solve(self, u: Array, free: IntArray, force: Array) -> Array:
        K = assemble(self.soil, self._state(u))
        solution: Array = splu(K[free][:, free].tocsc()).solve(force[free])
        return solution

    def _length(self, u: Array, change: Array) -> float:
        """Step at which the force does no work along the change, by the secant rule (critical point)."""
        at_start, at_end = (float(change @ self.force(u + x * change)) for x in (0.0, 1.0))
        if abs(at_end) < 0.5 * abs(at_start):
            return 1.0
        return float(np.clip(at_start / (at_start - at_end), 0.1, 1.0))

    def force(self, u: Array) -> Array:
        """Internal force minus weight (size,) [N] after the increment u."""
        return self._force(self._state(u))

    def at_rest(self) -> Array:
        """The state of rest as an accepted one."""
        return self._force(State.at_rest(1.0, self.soil.field.size))

    def _force(self, state: State) -> Array:
        forces = Forces.zeros(len(state.u))
        self.soil.residual(state, forces)
        return forces.end

    def _accept(self, u: Array) -> None:
        self.soil.commit(self._state(u))
        self.soil.field.commit(self._state(u))

    def _state(self, u: Array) -> State:
        return State(1.0, u, np.zeros_like(u), np.zeros_like(u), dt=self.seconds)


def assemble(soil: Soil, state: State) -> sp.csr_matrix:
    """The soil's tangent as one matrix."""
    block = soil.blocks()["soil"]
    values = {"soil": block.zeros()}
    soil.tangent(state, WEIGHTS, values)
    rows = np.broadcast_to(block.rows[:, :, None], block.shape).ravel()
    cols = np.broadcast_to(block.cols[:, None, :], block.shape).ravel()
    size = soil.field.size
    return sp.coo_matrix((values["soil"].ravel(), (rows, cols)), shape=(size, size)).tocsr()


def force(soil: Soil, state: State) -> Array:
    """Forces (n,) of the soil that count at the end of a step [N]."""
    forces = Forces.zeros(soil.field.size)
    soil.residual(state, forces)
    return forces.end
