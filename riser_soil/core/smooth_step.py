"""Smooth step: ramp from 0 to 1 in a given time, twice continuously differentiable."""


def smooth_step(t: float, ramp: float) -> tuple[float, float, float]:
    """10 x^3 - 15 x^4 + 6 x^5 of x = t/ramp, 0 before and 1 after, with its first two derivatives in t.

    A ramp of 0 has the value 1 from t = 0 on.
    """
    if t >= ramp:
        return 1.0, 0.0, 0.0
    if t <= 0.0:
        return 0.0, 0.0, 0.0
    x = t / ramp
    value = x**3 * (10.0 - 15.0 * x + 6.0 * x * x)
    slope = 30.0 * x * x * (1.0 - x) ** 2 / ramp
    return value, slope, 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / ramp**2
