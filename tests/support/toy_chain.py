"""A chain of point masses on springs above a floor: the smallest model that exercises the system and the time loop."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext

import numpy as np

from riser_soil.core.arrays import Array, BoolArray, IntArray
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Traits, Weights, Work
from riser_soil.core.saved_state import Saved


class Chain:
    """Field of n heights z; the first may be prescribed."""

    name, space = "chain", "chain"

    def __init__(self, z: Array, prescribed: bool = False, owner: bool = True) -> None:
        self.z: Array = np.asarray(z, dtype=float)
        self.size, self.offset = len(self.z), 0
        self.global_index: IntArray = np.arange(self.size)
        self.owned: BoolArray = np.full(self.size, owner)
        self.prescribed: BoolArray = np.zeros(self.size, dtype=bool)
        self.prescribed[0] = prescribed

    lever = 1.0
    turns_axes = False

    def predict(self, guess: State) -> Array:
        return guess.u

    def all_prescribed(self) -> AbstractContextManager[None]:
        return nullcontext()

    def inadmissible(self, state: State, before: State | None = None) -> str:
        return ""

    def in_new_axes(self, conjugate: Array, increments: Array) -> Array:
        return conjugate

    def free_turns(self, state: State) -> Array:
        return np.zeros((0, self.size))

    def in_newtons(self, forces: Array) -> Array:
        return forces

    @property
    def translation_dofs(self) -> IntArray:
        return np.asarray(self.offset + np.arange(self.size)[:, None], dtype=np.int64)

    def prescribe(self, t: float, u: Array, v: Array, a: Array) -> None:
        u[self.prescribed] = v[self.prescribed] = a[self.prescribed] = 0.0

    def heights(self, state: State) -> Array:
        return self.z + state.u[self.offset : self.offset + self.size]

    def magnitudes(self, state: State) -> Array:
        return np.abs(self.heights(state))

    def commit(self, state: State) -> None:
        self.z = self.heights(state)

    def state(self) -> Saved:
        return {"z": self.z}

    def restore(self, saved: Saved) -> None:
        self.z = saved["z"]

    def describe(self, entry: int) -> str:
        return f"mass {entry}"

    def pairs(self) -> MatrixBlock:
        nodes = self.offset + np.arange(self.size)
        rows = np.stack([nodes[:-1], nodes[1:]], axis=1)
        return MatrixBlock(rows, rows)


class Inertia:
    name, traits = "inertia", Traits("I", symmetric=True)
    active = True

    def __init__(self, chain: Chain, mass: float) -> None:
        self.chain, self.mass = chain, mass / 2.0

    def blocks(self) -> dict[str, MatrixBlock]:
        return {"chain": self.chain.pairs()}

    def nodal(self) -> Array:
        count = np.full(self.chain.size, 2.0)
        count[[0, -1]] = 1.0
        return self.mass * count

    def residual(self, state: State, forces: Forces) -> None:
        forces.inertia += self.nodal() * state.a

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        values["chain"] += weights.inertia * weights.shift_a * self.mass * np.eye(2)

    def energy(self, state: State) -> Energy:
        return Energy(kinetic=0.5 * float(self.nodal() @ state.v**2))

    def work(self, before: State, after: State) -> Work:
        return Work()

    def commit(self, state: State) -> None:
        pass


class Springs:
    """Forces k e + c e^3 in the stretches e beyond the rest lengths, and weight."""

    name, traits = "springs", Traits("F", symmetric=True)
    active = True

    def __init__(self, chain: Chain, rest: float, k: float, cubic: float = 0.0, weight: float = 0.0) -> None:
        self.chain, self.rest, self.k, self.cubic, self.weight = chain, rest, k, cubic, weight

    def blocks(self) -> dict[str, MatrixBlock]:
        return {"chain": self.chain.pairs()}

    def _stretch(self, state: State) -> Array:
        return np.diff(self.chain.heights(state)) - self.rest

    def residual(self, state: State, forces: Forces) -> None:
        e = self._stretch(state)
        f = self.k * e + self.cubic * e**3
        on_chain = forces.force[self.chain.offset : self.chain.offset + self.chain.size]
        on_chain[:-1] -= f
        on_chain[1:] += f
        on_chain += self.weight

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        k = self.k + 3.0 * self.cubic * self._stretch(state) ** 2
        values["chain"] += weights.force * k[:, None, None] * np.array([[1.0, -1.0], [-1.0, 1.0]])

    def energy(self, state: State) -> Energy:
        e = self._stretch(state)
        strain = float((0.5 * self.k * e**2 + 0.25 * self.cubic * e**4).sum())
        return Energy(strain=strain, potential=float(self.weight * self.chain.heights(state).sum()))

    def work(self, before: State, after: State) -> Work:
        return Work()

    def commit(self, state: State) -> None:
        pass


class Floor:
    """Penalty contact with the plane z = 0, fully implicit."""

    name, traits = "contact", Traits("E", symmetric=True)
    active = True

    def __init__(self, chain: Chain, stiffness: float) -> None:
        self.chain, self.stiffness = chain, stiffness

    def blocks(self) -> dict[str, MatrixBlock]:
        nodes = (self.chain.offset + np.arange(self.chain.size))[:, None]
        return {"floor": MatrixBlock(nodes, nodes)}

    def _penetration(self, state: State) -> Array:
        return np.maximum(-self.chain.heights(state), 0.0)

    def residual(self, state: State, forces: Forces) -> None:
        forces.end -= self.stiffness * self._penetration(state)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        values["floor"][:, 0, 0] += self.stiffness * (self._penetration(state) > 0.0)

    def energy(self, state: State) -> Energy:
        return Energy(strain=0.5 * self.stiffness * float((self._penetration(state) ** 2).sum()))

    def work(self, before: State, after: State) -> Work:
        released = self.stiffness * float(self._penetration(after) @ after.u)
        return Work(dissipated=-released - (self.energy(after).strain - self.energy(before).strain))

    def commit(self, state: State) -> None:
        pass
