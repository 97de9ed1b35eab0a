"""A sea as a sum of long-crested waves."""

from __future__ import annotations

from typing import NamedTuple

from riser_soil.arrays import Array


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
