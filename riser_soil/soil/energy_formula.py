"""Formula of an energy of one's own: stress and moduli by UFL's derivatives of psi(eps), compiled by FFCx.

eps is the strain since the start, and psi the energy that it stores beyond what the initial stress does.
"""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.soil import energy_kernel
from riser_soil.soil.law import PLACES, STRESS
from riser_soil.soil.law_source import LawError
from riser_soil.soil.own_formula import OwnFormula, call_user_code

STRAIN = tuple(f"strain_{place}" for place in PLACES)
ZERO_STRESS = 1e-9  # stresses below this share of the moduli count as zero


class EnergyFormula(OwnFormula):
    """Law by a user's class with an energy density psi(eps) or psi(eps, depth) [J/m3]. History: stress and strain."""

    columns = (*STRESS, *STRAIN)
    symmetric = True
    by_rate = False

    def __init__(self, law: Any, depth: Array, initial: Array, label: str) -> None:
        super().__init__(law, depth, initial, label)
        arguments = call_user_code(lambda: len(inspect.signature(law.psi).parameters))
        if arguments not in (1, 2):
            raise LawError("psi must take the strain, or strain and depth: psi(self, eps) or psi(self, eps, depth)")
        psi = law.psi if arguments == 2 else lambda eps, depth: law.psi(eps)
        self._energy = call_user_code(lambda: energy_kernel.EnergyKernel(psi, depth))
        _, stress, moduli = self._energy.at(np.zeros((len(depth), 6)))
        if depth.size and not np.abs(stress).max() <= ZERO_STRESS * np.abs(moduli).max():
            raise LawError(f"psi has a stress of {np.abs(stress).max():.4g} Pa where there is no strain; it must be 0")

    def response(self, increment: Array, history: Array, dt: float) -> Sequence[Array]:
        strain = history[:, 6:] + increment
        stored, stress, moduli = self._energy.at(strain)
        stress = history[:, :6] + stress - self._energy.at(history[:, 6:])[1]
        return stress, moduli, np.column_stack((stress, strain)), stored, strain
