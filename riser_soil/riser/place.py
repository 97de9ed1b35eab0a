"""A place on the riser by its arc length: position and direction of the axis."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser import hermite
from riser_soil.riser.line import Line


def axis_at(line: Line, state: State, arc: float) -> tuple[Array, Array]:
    """Position of the axis (3,) [m] and its derivative by the arc length (3,), global axes, at an arc length [m]."""
    e = min(max(int(np.searchsorted(line.arc, arc)) - 1, 0), line.length.size - 1)
    length = float(line.length[e])
    xi, q = (arc - float(line.arc[e])) / length, line.trial(state).q[e]
    N, dN = hermite.shape(xi, length), hermite.slope(xi, length)
    return line.to_global(np.array(N) @ q), np.asarray(line.basis @ (np.array(dN) @ q))
