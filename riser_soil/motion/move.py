"""Prescribed displacement of an end in a static stage, by the load factor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array


@dataclass(frozen=True, eq=False)
class SmoothMove:
    """Straight from `origin` to `target` (3,) [m] as the load factor grows from 0 to 1."""

    origin: Array
    target: Array

    def __call__(self, t: float) -> tuple[Array, Array, Array]:
        """Position [m] at the load factor t; there are no rates in statics."""
        return self.origin + t * (self.target - self.origin), np.zeros(3), np.zeros(3)
