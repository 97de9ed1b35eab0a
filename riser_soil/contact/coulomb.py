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

import math

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit

Pair = tuple[float, float]  # along both directions, or along one and 0


def traction(elastic: Array, N: Array, mu: Array) -> tuple[Array, Array, Array]:
    """t (..., r) from t* and N (...), and its derivatives by t* (..., r, r) and by N (..., r); r is 1 or 2."""
    r = elastic.shape[-1]
    found = np.empty((N.size, r)), np.empty((N.size, r, r)), np.empty((N.size, r))
    _tractions(elastic.reshape(-1, r), N.reshape(-1), mu, *found)
    t, by_elastic, by_N = found
    return t.reshape(elastic.shape), by_elastic.reshape(*elastic.shape, r), by_N.reshape(elastic.shape)


def stuck(elastic: Array, N: Array) -> tuple[Array, Array, Array]:
    """As `traction` where nothing slides, however large t* is: of small motions about rest. None where nothing presses.
    """
    presses = (N > 0.0)[..., None]
    return elastic * presses, np.eye(elastic.shape[-1]) * presses[..., None], np.zeros_like(elastic)


@njit
def _tractions(elastic: Array, N: Array, mu: Array, t: Array, by_elastic: Array, by_N: Array) -> None:
    r = mu.size
    for i in range(N.size):
        guess, limits = (elastic[i, 0], elastic[i, r - 1] if r > 1 else 0.0), (mu[0], mu[r - 1])
        found, by_guess, by_normal = return_map(guess, N[i], limits)
        for j in range(r):
            t[i, j], by_N[i, j] = found[j], by_normal[j]
            for k in range(r):
                by_elastic[i, j, k] = by_guess[j][k]


@njit
def return_map(elastic: Pair, N: float, mu: Pair) -> tuple[Pair, tuple[Pair, Pair], Pair]:
    """t at one point from t* and N, and its derivatives by both."""
    (a, b), (p, q) = elastic, mu
    level = math.sqrt((a / p) ** 2 + (b / q) ** 2)
    if level <= N:
        return elastic, ((1.0, 0.0), (0.0, 1.0)), (0.0, 0.0)
    share, u, v = N / level, a / level, b / level
    x, y = u / p**2, v / q**2
    turned = ((share * (1.0 - u * x), -share * u * y), (-share * v * x, share * (1.0 - v * y)))
    return (share * a, share * b), turned, (u, v)
