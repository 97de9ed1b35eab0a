"""Closed forms of lines: the elastic catenary, hanging or touching down; they share nothing with the package."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq, fsolve


class HangingLine(NamedTuple):
    """Horizontal force, and tension and vertical force at the end [N]."""

    H: float
    T_end: float
    V_end: float


def hanging(span: float, rise: float, length: float, w: float, EA: float) -> HangingLine:
    """Elastic catenary between two points (Irvine 1981, section 2.2); unknown H and the vertical force V at the start.

    x = H L/EA + H/w [asinh((V + w L)/H) - asinh(V/H)],
    z = V L/EA + w L^2/2EA + H/w [sqrt(1 + ((V + w L)/H)^2) - sqrt(1 + (V/H)^2)].
    """

    def misses(unknown: np.ndarray) -> list[float]:
        H, V = np.exp(unknown[0]) * w * length, unknown[1] * w * length
        a, b = V / H, (V + w * length) / H
        x = H * length / EA + H / w * (np.arcsinh(b) - np.arcsinh(a))
        z = (V + 0.5 * w * length) * length / EA + H / w * (np.hypot(1.0, b) - np.hypot(1.0, a))
        return [(x - span) / length, (z - rise) / length]

    slack = max(length / np.hypot(span, rise) - 1.0, 1e-6)
    guess = np.array([np.log(0.3 * span / length / np.sqrt(slack)), 0.5 * (rise / length - 1.0)])
    solution, _, flag, text = fsolve(misses, guess, xtol=1e-13, full_output=True)
    assert flag == 1 or np.abs(misses(solution)).max() < 1e-10, text
    H, V = np.exp(solution[0]) * w * length, solution[1] * w * length + w * length
    return HangingLine(float(H), float(np.hypot(H, V)), float(V))


class LandedLine(NamedTuple):
    """Horizontal force, tension at the top [N], arc length of the touchdown point from the start [m]."""

    H: float
    T_end: float
    touchdown: float


def landed(span: float, height: float, length: float, w: float, EA: float) -> LandedLine:
    """Elastic catenary that comes down on a frictionless floor, on which its start lies, `height` below its end.

    Hanging part l: height = w l^2/2EA + H/w [sqrt(1 + (w l/H)^2) - 1], span = (L - l)(1 + H/EA) + H l/EA + H/w
    asinh(w l/H).
    """

    def part(H: float) -> float:
        def rises(s: float) -> float:
            return float(0.5 * w * s * s / EA + H / w * (np.hypot(1.0, w * s / H) - 1.0) - height)

        return float(brentq(rises, height * 1e-3, 1e4 * length, xtol=1e-14 * length))

    def misses(logarithm: float) -> float:
        H = float(np.exp(logarithm)) * w * height
        s = part(H)
        return (length - s) * (1.0 + H / EA) + H * s / EA + H / w * float(np.arcsinh(w * s / H)) - span

    H = float(np.exp(brentq(misses, -12.0, 8.0, xtol=1e-14))) * w * height
    s = part(H)
    return LandedLine(H, float(np.hypot(H, w * s)), length - s)
