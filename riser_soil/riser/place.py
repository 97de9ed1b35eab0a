"""A place on the riser by its arc length: position and direction of the axis."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser import stations
from riser_soil.riser.line import Line


def axis_at(line: Line, state: State, arc: float) -> tuple[Array, Array]:
    """Position of the axis (3,) [m] and its derivative by the arc length (3,), global axes, at an arc length [m]."""
    e = int(np.clip(np.searchsorted(line.arc, arc) - 1, 0, line.length.size - 1))
    length = line.length[e : e + 1]
    at = stations.points(length, (arc - line.arc[e]) / length)
    q = line.trial(state).q[e : e + 1]
    slope = np.einsum("ga,gai->gi", at.dN[:, 0], q)[0]
    return line.to_global(stations.interpolate(at, q)[0, 0]), np.asarray(slope @ line.basis.T)
