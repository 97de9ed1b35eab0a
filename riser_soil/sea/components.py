"""Wave components: a sea state as a sum of long-crested linear waves."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.sea.dispersion import wave_number


class Components(NamedTuple):
    """Waves (n,): amplitude a [m], angular frequency w [rad/s], wave number k [rad/m], direction towards which they
    travel [rad] from x towards y, and phase [rad].

    The surface rises by the sum of a cos(k (x cos direction + y sin direction) - w t + phase); x, y from the global
    origin, t from the beginning of the run's first dynamic stage.
    """

    amplitude: Array
    frequency: Array
    wave_number: Array
    direction: Array
    phase: Array


def regular(height: float, period: float, direction: float, phase: float, g: float, h: float) -> Components:
    """A single wave from trough to crest of `height` [m], with `period` [s], in water of depth h [m]; angles in rad."""
    w = np.array([2.0 * np.pi / period])
    return Components(np.array([0.5 * height]), w, wave_number(w, g, h), np.array([direction]), np.array([phase]))
