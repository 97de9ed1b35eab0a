"""Forces that follow from the velocity through the water, and their derivatives, at one station."""

from __future__ import annotations

from typing import Any

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import fixed
from riser_soil.sea.moving_water_kernels import FlowWorkspace
from riser_soil.sea.stream_kernels import END
from riser_soil.sea.through_kernels import write_derivatives, write_resistance


def resistance(law: Any, v: Array, tau: Array) -> Array:
    """Resistance of a law (d,) where a step ends, at the velocity v (d,) of a pipe along tau (d,)."""
    at = FlowWorkspace(*np.empty((7, v.size)))._replace(through=v, tau=tau)
    write_resistance.kernels[type(law)](law, END, 0, 0, at, fixed(v.size))
    return at.force


def derivatives(law: Any, v: Array, tau: Array) -> tuple[Array, Array]:
    """Derivatives by v and by the axis' slope, each (d, d), of an unstretched pipe."""
    by_v, by_slope = np.empty((2, v.size, v.size))
    write_derivatives.kernels[type(law)](law, 0, 0, v, tau, 1.0, 1.0, by_v, by_slope, fixed(v.size))
    return by_v, by_slope
