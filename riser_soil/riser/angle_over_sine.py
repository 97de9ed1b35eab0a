"""The function g = theta/sin(theta) and its derivatives by c = cos(theta), for angles from their sines.

Near theta = 0 the closed form loses digits; there g is the sum of (2 n)!!/(2 n + 1)!! x^n, x = sin^2(theta/2).
"""

import math

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit

SERIES_BELOW = 0.05  # 1 - cos(theta) under which closed forms lose digits and the series has converged
SERIES: Array = np.cumprod([1.0] + [2.0 * n / (2.0 * n + 1.0) for n in range(1, 13)])[::-1].copy()


@njit
def angle_over_sine(cosine: float, sine: float) -> tuple[float, float, float]:
    """g and its first two derivatives by the cosine, for theta below pi; sine: not negative."""
    g, slope, bend = 0.0, 0.0, 0.0
    if 1.0 - cosine < SERIES_BELOW:
        x = 0.5 * (1.0 - cosine)
        for coefficient in SERIES:
            bend = bend * x + 2.0 * slope
            slope = slope * x + g
            g = g * x + coefficient
        return g, -0.5 * slope, 0.25 * bend
    g = math.atan2(sine, cosine) / sine
    slope = (cosine * g - 1.0) / (sine * sine)
    return g, slope, (g + 3.0 * cosine * slope) / (sine * sine)
