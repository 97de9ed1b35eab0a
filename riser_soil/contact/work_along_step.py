"""Work of a contact law along a step: what the ground takes, apart from what a force at the step's end takes."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.seabed.law import NormalLaw

PANELS = 4  # of the way above the undisturbed ground, and of that below it
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(3)
#: Places 0 to 1 along a way in panels, and their weights, which add up to 1.
_PLACES = ((np.arange(PANELS)[:, None] + 0.5 * (_GAUSS + 1.0)) / PANELS).ravel()
_SHARES = np.tile(0.5 * _WEIGHTS / PANELS, PANELS)


def work_along_step(law: NormalLaw, before: Array, after: Array, history: Array) -> Array:
    """Work per length (...) [N] of the force against the penetration, from `before` to `after` (...) [m] by one way.

    history (..., nh): at the beginning. Without a history the force has a potential and the work is its change, so
    that such ground dissipates nothing. Else the law is integrated by Gauss points, in panels above the ground and
    below it, from where there is a force.
    """
    if not law.columns:
        return np.asarray(law.update(after, history).stored - law.update(before, history).stored)
    first, last = (np.maximum(z, -law.reach) for z in (before, after))
    turn = np.clip(0.0, np.minimum(first, last), np.maximum(first, last))
    return _between(law, first, turn, history) + _between(law, turn, last, history)


def _between(law: NormalLaw, first: Array, last: Array, history: Array) -> Array:
    z = first + _PLACES.reshape(-1, *(1,) * first.ndim) * (last - first)
    force = law.update(z, np.broadcast_to(history, (*z.shape, history.shape[-1]))).force
    return np.asarray(np.tensordot(_SHARES, force, 1) * (last - first))
