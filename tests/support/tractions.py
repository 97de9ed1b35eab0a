"""The law of friction for arrays of points, one by one by `coulomb`."""

from __future__ import annotations

import numpy as np

from riser_soil.contact.coulomb import limits, return_map
from riser_soil.core.arrays import Array, as_list


def traction(
    elastic: Array, N: Array, slope: Array, mu: Array, most: Array | float = np.inf, most_slope: Array | float = 0.0
) -> tuple[Array, Array, Array]:
    """t (..., r) from t*, N and adhesion `most` (...), and its derivatives by t* (..., r, r) and by the penetration
    (..., r), by which those of N and `most` are slope and most_slope (...); r is 1 or 2.
    """
    r = elastic.shape[-1]
    both, answers = (float(mu[0]), float(mu[-1])), list[tuple[Array, Array, Array]]()
    pushed = np.stack(np.broadcast_arrays(N, slope, most, most_slope), axis=-1).reshape(-1, 4)
    for guess, (force, rise, adhesion, widening) in zip(elastic.reshape(-1, r), as_list(pushed), strict=True):
        at = float(guess[0]), float(guess[-1]) if r > 1 else 0.0
        t, by_elastic, by_penetration = return_map(at, *limits(force, rise, both, (adhesion, widening)))
        answers.append((np.array(t)[:r], np.array(by_elastic)[:r, :r], np.array(by_penetration)[:r]))
    t, by_elastic, by_penetration = (np.array(each) for each in zip(*answers, strict=True))
    return t.reshape(elastic.shape), by_elastic.reshape(*elastic.shape, r), by_penetration.reshape(elastic.shape)
