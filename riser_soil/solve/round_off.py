"""Round-off of the residual: where Newton's method ends because nothing is left that it could improve.

The residual of a stiff line or contact is a small difference of large numbers: some eps EA of a bar that has turned,
eps k z of a penalty k at a height z, eps EI phi/L^2 of an element that has turned by an angle phi. The coordinates x
that the forces follow from are known to a rounding each, so that a row i of the residual can't be told from

    eps sum_j |K_ij| |x_j|,

summed over the elements, their tangents K at held rates: a bound of the error of a sum of products in floating point
(Higham, Accuracy and Stability of Numerical Algorithms, 2002, 3.1), here with a factor for the few roundings of each
term. Where that is above what is allowed, the norms of the residual stay as they are. A load or time step that stops so
is solved as far as it can be told; a larger floor for the residual would hide small loads on long lines instead.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

STALLED = 0.5  # the norm of a residual that falls by less in each of two iterations stays as it is
EPS = float(np.finfo(float).eps)
ROUND_OFF = 8.0 * EPS  # of the sum of sizes; residuals that stayed were found at up to 2 eps of it


def stays(norms: Sequence[float]) -> bool:
    """Whether the last two iterations have left the residual's norm as it is, of all its norms so far."""
    return len(norms) > 2 and all(after > STALLED * before for before, after in pairwise(norms[-3:]))
