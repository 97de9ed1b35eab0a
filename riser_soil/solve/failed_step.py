"""Why Newton's method failed, in words: where the largest residual sits."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.communicator import all_of
from riser_soil.core.system import System
from riser_soil.solve.solution import largest_at


def place_of_largest(system: System, residual: Array, first: int) -> str:
    """The row with the largest residual, in words; collective.

    residual: this rank's [N], moments over the lever; its rows begin with `first`.
    """
    values = np.abs(residual)
    if not all_of(system.comm, bool(np.isfinite(values).all())):
        return "the residual is not finite"
    k = int(np.argmax(values)) if len(values) else -1
    mine = (float(values[k]), first + k) if k >= 0 else (-1.0, -1)
    worst, row = max(system.comm.allgather(mine))
    return largest_at(worst, system.describe(row))
