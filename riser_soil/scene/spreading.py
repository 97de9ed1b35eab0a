"""Directional spreading of a sea: cos^2s of half the angle from its mean direction, in directions of equal energy."""

import math
from bisect import bisect_left
from functools import cache
from itertools import accumulate, pairwise

_STEPS = 4096  # of the half circle, by the trapezoidal rule


@cache
def relative_directions(s: float, count: int) -> tuple[float, ...]:
    """Directions (count,), an even number of them, from the mean [rad], increasing: one for each of `count` sectors of
    equal energy, its cosine being the mean of the sector's.

    The energy in a direction goes with cos^2s(theta/2) (Mitsuyasu et al., Journal of Physical Oceanography 5 (1975)
    750-760, equation 6). So the mean of cos theta is s/(s + 1), and that of sin theta is 0, as over all directions.
    """
    edges = [_within(s, 2.0 * n / count) for n in range(count // 2 + 1)]
    to_one_side = [math.acos((c1 - c0) / (e1 - e0)) for (e0, c0), (e1, c1) in pairwise(edges)]
    return (*(-angle for angle in reversed(to_one_side)), *to_one_side)


def _within(s: float, share: float) -> tuple[float, float]:
    """Energy, and its moment with cos theta, from the mean to the angle within which a share (0 to 1) of it lies."""
    energy, moment = _integrals(s)
    n = bisect_left(energy, share * energy[-1], 1, _STEPS)
    part = (share * energy[-1] - energy[n - 1]) / (energy[n] - energy[n - 1])
    return share * energy[-1], moment[n - 1] + part * (moment[n] - moment[n - 1])


@cache
def _integrals(s: float) -> tuple[list[float], list[float]]:
    """From 0 to each angle of an even grid to pi: of the energy, of any size, and of its moment with cos theta."""
    angles = [math.pi * n / _STEPS for n in range(_STEPS + 1)]
    density = [math.cos(0.5 * angle) ** (2.0 * s) for angle in angles]
    moment = [d * math.cos(angle) for d, angle in zip(density, angles, strict=True)]
    energy, first = (list(accumulate((0.5 * (a + b) for a, b in pairwise(q)), initial=0.0)) for q in (density, moment))
    return energy, first
