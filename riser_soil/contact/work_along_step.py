"""Work of a contact law along a step: what the ground takes, apart from what a force at the step's end takes."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.seabed.law import NormalLaw

#: Panels of the way within the ground, where the laws are smooth, and of that above it, where suction has corners.
WITHIN, ABOVE = 2, 4
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(3)


def work_along_step(law: NormalLaw, before: Array, after: Array, history: Array) -> Array:
    """Work per length (...) [N] of the force against the penetration, from `before` to `after` (...) [m] by one way.

    history (..., nh): at the beginning. Without a history the force has a potential and the work is its change, so
    that such ground dissipates nothing. Else the law is integrated by Gauss points, in panels within the ground and
    above it, as far as there is a force.
    """
    if not law.columns:
        return np.asarray(law.update(after, history).stored - law.update(before, history).stored)
    work = _between(law, np.maximum(before, 0.0), np.maximum(after, 0.0), history, WITHIN)
    if law.reach > 0.0:
        first, last = (np.clip(z, -law.reach, 0.0) for z in (before, after))
        work += _between(law, first, last, history, ABOVE)
    return work


def _between(law: NormalLaw, first: Array, last: Array, history: Array, panels: int) -> Array:
    places = ((np.arange(panels)[:, None] + 0.5 * (_GAUSS + 1.0)) / panels).ravel()
    z = first + places.reshape(-1, *(1,) * first.ndim) * (last - first)
    force = law.update(z, np.broadcast_to(history, (*z.shape, history.shape[-1]))).force
    return np.asarray(np.tensordot(np.tile(0.5 * _WEIGHTS / panels, panels), force, 1) * (last - first))
