"""Law of friction: Coulomb's return mapping with an elastic mobilisation length, and adhesion of clay.

Traction t (..., r) on the riser per length in r directions along the ground [N/m]; ds (..., r) its movement in
the step. With the normal force N >= 0 at the end of the step, coefficients mu (r,) and the adhesion A, infinite where
there is none, the limits are L_i = min(mu_i N, A), 0 where N = 0 even of coefficients without a bound, and

    t* = t_n - k ds;   m = sqrt(sum (t*_i/L_i)^2);   t = t* where m <= 1,  else t*/m.

Stored are t.t/(2 k). A step extracts -t.ds from the riser; less the change of the energy stored, that is
|t - t_n|^2/(2 k) + (m - 1) t.t/k >= 0, whatever t_n, ds and L are: friction dissipates in every step, and no closed
path gains work. The stiffness k is the same in all directions, so that their rotation with the riser does not change
the energy stored.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from riser_soil.core.compiled import njit
from riser_soil.seabed.bearing import Strength
from riser_soil.seabed.pipe_bearing import strength_at

Pair = tuple[float, float]  # along both directions, or along one and 0


@njit
def limits(N: float, slope: float, mu: Pair, most: Pair) -> tuple[Pair, Pair]:
    """L at one point and its derivative by the penetration; most: adhesion and its derivative. 0 where N <= 0."""
    if N <= 0.0:
        return (0.0, 0.0), (0.0, 0.0)
    first, second = mu[0] * N < most[0], mu[1] * N < most[0]
    limit = mu[0] * N if first else most[0], mu[1] * N if second else most[0]
    return limit, (mu[0] * slope if first else most[1], mu[1] * slope if second else most[1])


@njit
def return_map(elastic: Pair, limit: Pair, rise: Pair) -> tuple[Pair, tuple[Pair, Pair], Pair]:
    """t at one point from t* and L, its derivative by t*, and that by the penetration, by which that of L is `rise`."""
    (a, b), (p, q) = elastic, limit
    if p <= 0.0 or q <= 0.0:
        return (0.0, 0.0), ((0.0, 0.0), (0.0, 0.0)), (0.0, 0.0)
    level = math.hypot(a / p, b / q)
    if level <= 1.0:
        return elastic, ((1.0, 0.0), (0.0, 1.0)), (0.0, 0.0)
    c, d = a / p / level, b / q / level  # t over the limit, a unit vector
    turned = ((d * d / level, -c * d * (p / q) / level), (-c * d * (q / p) / level, c * c / level))
    pushed = c * (c * c * rise[0] + d * d * (p / q) * rise[1]), d * (c * c * (q / p) * rise[0] + d * d * rise[1])
    return (c * p, d * q), turned, pushed


class Adhesion(NamedTuple):
    """The share of the clay's undrained shear strength that holds a pipe of a diameter [m]; 0 where nothing limits
    friction but the pressure.
    """

    share: float = 0.0
    strength: Strength = Strength(0.0)
    diameter: float = 0.0


@njit
def adhesion_at(clay: Adhesion, penetration: float) -> Pair:
    """Adhesion per length [N/m] and its derivative by the penetration: that of su at the pipe's bottom, over the arc
    that lies below the seabed, half of its circumference at most.
    """
    if clay.share == 0.0:
        return math.inf, 0.0
    z, D = max(penetration, 0.0), clay.diameter
    deep = min(2.0 * z / D, 1.0)
    arc = 2.0 * D * math.asin(math.sqrt(0.5 * deep))
    widening = 2.0 / math.sqrt(deep * (2.0 - deep)) if 0.0 < deep < 1.0 else 0.0
    su = strength_at(clay.strength, z)
    return clay.share * su * arc, clay.share * (clay.strength.gradient * arc + su * widening)
