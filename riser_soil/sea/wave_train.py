"""Wave components prepared for many evaluations, and where they are in their cycles at a time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.compiled import njit
from riser_soil.sea.components import Components


class WaveTrain(NamedTuple):
    """Components (m,) by direction, and by increasing wave number k [rad/m] within each of the g directions.

    first: (g + 1,) the first component of each direction, and m. toward: (g, 2) unit vectors. amplitude [m], w [rad/s],
    phase [rad]. speed: a w/(1 - exp(-2 k h)) [m/s]. turned: (m, 2) cosine and sine of phase - w t at the time that the
    train has been brought to. depth: h [m], which may be inf.
    """

    first: IntArray
    toward: Array
    amplitude: Array
    w: Array
    k: Array
    phase: Array
    speed: Array
    turned: Array
    depth: float


def train(waves: Components, h: float) -> WaveTrain:
    """The components prepared for water of depth h [m]."""
    a, w, k, d, phase = (part[np.lexsort((waves.wave_number, waves.direction))] for part in waves)
    directions, first = np.unique(d, return_index=True)
    toward = np.stack([np.cos(directions), np.sin(directions)], axis=-1)
    speed = a * w / -np.expm1(-2.0 * k * h)
    return WaveTrain(np.append(first, k.size), toward, a, w, k, phase, speed, np.full((k.size, 2), np.nan), h)


@njit
def turn(waves: WaveTrain, t: float) -> None:
    """Bring the train to a time of its clock [s]."""
    for j in range(waves.k.size):
        angle = waves.phase[j] - np.remainder(waves.w[j] * t, 2.0 * np.pi)
        waves.turned[j, 0], waves.turned[j, 1] = np.cos(angle), np.sin(angle)
