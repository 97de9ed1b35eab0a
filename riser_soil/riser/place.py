"""A place on the riser by its arc length: position and direction of the axis."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.riser import hermite


def axis_at(nodes: Array, position: Array, tangent: Array, arc: float) -> tuple[Array, Array]:
    """Position of the axis (3,) [m] and its derivative by the arc length (3,), global axes, at an arc length [m].

    Of the nodes arc lengths (nn,) and positions (nn, 3); tangent (ne, 2, 3): of the elements' ends.
    """
    e = min(max(int(np.searchsorted(nodes, arc)) - 1, 0), nodes.size - 2)
    length = float(nodes[e + 1] - nodes[e])
    xi, q = (arc - float(nodes[e])) / length, np.array([position[e], tangent[e, 0], position[e + 1], tangent[e, 1]])
    return np.array(hermite.shape(xi, length)) @ q, np.array(hermite.slope(xi, length)) @ q
