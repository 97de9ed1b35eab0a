"""Depth at which a pipe comes to rest on ground that has never been touched."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.seabed.law import NormalLaw

DEEPEST = 10.0  # diameters, beyond which nothing is taken to rest
HALVINGS = 60


def depth_at_rest(law: NormalLaw, weight: Array, diameter: float) -> Array:
    """Penetration (n,) [m] at which the law bears weights (n,) [N/m], > 0; inf where it does not."""
    low, high = np.full(weight.shape, -law.reach), np.full(weight.shape, DEEPEST * diameter)
    bears = _force(law, high) >= weight
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        holds = _force(law, middle) >= weight
        low, high = np.where(holds, low, middle), np.where(holds, middle, high)
    return np.where(bears, high, np.inf)


def _force(law: NormalLaw, penetration: Array) -> Array:
    return law.update(penetration, law.initial_history(penetration.shape)).force
