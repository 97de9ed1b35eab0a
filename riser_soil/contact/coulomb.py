"""Return mapping of Coulomb friction with an elastic mobilisation length, point by point.

Traction t (..., r) on the riser per length in r directions along the ground [N/m]; ds (..., r) its movement in
the step. With the normal force N >= 0 at the end of the step and coefficients mu (r,):

    t* = t_n - k ds;   m = sqrt(sum (t*_i/mu_i)^2);   t = t* where m <= N,  else N t*/m.

Stored are t.t/(2 k). A step extracts -t.ds from the riser; less the change of the energy stored, that is
|t - t_n|^2/(2 k) + (m/N - 1) t.t/k >= 0, whatever t_n, ds and N are: friction dissipates in every step, and no closed
path gains work. The stiffness k is the same in all directions, so that their rotation with the riser does not change
the energy stored.
"""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array


def traction(elastic: Array, N: Array, mu: Array) -> tuple[Array, Array, Array]:
    """t (..., r) from t* and N (...), and its derivatives by t* (..., r, r) and by N (..., r)."""
    level = np.sqrt(np.sum((elastic / mu) ** 2, axis=-1))
    slips = level > N
    safe = np.where(slips, level, 1.0)
    share = np.where(slips, N / safe, 1.0)[..., None]
    direction = np.where(slips, 1.0 / safe, 0.0)[..., None] * elastic
    turning = direction[..., :, None] * (direction / mu**2)[..., None, :]
    return share * elastic, share[..., None] * (np.eye(elastic.shape[-1]) - turning), direction
