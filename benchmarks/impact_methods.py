"""Ways to integrate impact in time that the package does not offer, for comparison with its own.

All stand on its own parts: the contact's force is weighed as the riser's other forces, or follows another law.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from riser_soil.contact.law import Penalty, PenaltyData, ramp
from riser_soil.contact.seabed_contact import SeabedContact
from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Traits, Weights, Work
from riser_soil.core.roles import Predictor
from riser_soil.seabed.compiled_law import CompiledLaw, answer, may_act

NEAR = 1e-8  # m: below it a difference quotient of the potential is round-off


class Averaged:
    """Contact in group F: its force counts as the time scheme weighs those of the riser, not at the step's end."""

    traits = Traits("FE", symmetric=True, roles=(Predictor,))  # E, as the force may jump
    active = True

    def __init__(self, contact: SeabedContact) -> None:
        self._contact, self.name = contact, contact.name

    def blocks(self) -> dict[str, MatrixBlock]:
        return self._contact.blocks()

    def residual(self, state: State, forces: Forces) -> None:
        self._contact.residual(state, Forces(forces.inertia, forces.force, end=forces.force))

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        own = {key: np.zeros_like(value) for key, value in values.items()}
        self._contact.tangent(state, weights, own)
        for key, value in own.items():
            values[key] += weights.force * value

    def energy(self, state: State) -> Energy:
        return self._contact.energy(state)

    def work(self, before: State, after: State) -> Work:
        return self._contact.work(before, after)

    def commit(self, state: State) -> None:
        self._contact.commit(state)

    def predict(self, guess: State) -> Array:
        return self._contact.predict(guess)


class DiscreteData(NamedTuple):
    """Kernel data of `DiscreteGradient`."""

    penalty: PenaltyData


@may_act.of(DiscreteData)
def _may_act(law: DiscreteData, penetration: float, history: Array) -> bool:
    return max(penetration, history[0]) > -law.penalty.smoothing


@answer.of(DiscreteData)
def _answer(law: DiscreteData, penetration: float, history: Array, after: Array) -> tuple[float, float, float]:
    before, way = history[0], penetration - history[0]
    after[0] = penetration
    force, _, stored = ramp(law.penalty, penetration)
    if abs(way) < NEAR:
        middle, rise, _ = ramp(law.penalty, 0.5 * (penetration + before))
        return middle, 0.5 * rise, stored
    quotient = (stored - ramp(law.penalty, before)[2]) / way
    return quotient, (force - quotient) / way, stored


@dataclass(frozen=True)
class DiscreteGradient(CompiledLaw):
    """The penalty's potential over a step, difference by difference: f = (psi(d1) - psi(d0))/(d1 - d0).

    Its work over the step is the change of the potential, so that with accelerations of the mean velocity (2 beta = 1,
    gamma = 1, as contact has them) impact neither takes nor gives energy. O. Gonzalez, Computer Methods in Applied
    Mechanics and Engineering 190 (2000). History (..., 1): the penetration d0 [m] at the start of the step.
    """

    penalty: Penalty
    columns: tuple[str, ...] = ("penetration",)
    capacity: float = math.inf

    @property
    def kernel_data(self) -> DiscreteData:
        return DiscreteData(self.penalty.kernel_data)

    @property
    def start(self) -> float:
        return self.penalty.start

    @property
    def reach(self) -> float:
        return self.penalty.reach

    def initial_history(self, shape: tuple[int, ...]) -> Array:
        return np.full((*shape, 1), -1e3)
