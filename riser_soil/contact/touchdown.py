"""Where the riser comes down."""

from __future__ import annotations

import numpy as np

from riser_soil.arrays import Array


def touchdown(arc: Array, clearance: Array) -> float:
    """Arc length [m] where the contact force ends, towards the riser's end; nan where nothing touches.

    arc (n,): of points along the riser, growing [m]. clearance (n,): their gap less that at which the force begins [m].
    Where the riser's end itself touches, but not all of the riser, it is where the force begins, coming from the
    start. The clearance is interpolated between the outermost touching point and the next.
    """
    touching = np.flatnonzero(clearance < 0.0)
    if len(touching) == 0:
        return float("nan")
    i, last = int(touching[-1]), len(arc) - 1
    j = i + 1
    if i == last and len(touching) <= last:
        i = int(np.flatnonzero(clearance >= 0.0)[-1]) + 1
        j = i - 1
    if i == last == j - 1 or not np.isfinite(clearance[j]):
        return float(arc[i])
    return float(arc[i] + (arc[j] - arc[i]) * clearance[i] / (clearance[i] - clearance[j]))
