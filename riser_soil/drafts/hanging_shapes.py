"""Shapes of drafts: arcs of catenaries with one horizontal tension, from the seabed up to the hang-off.

An arc of weight w under the horizontal tension H = w a has the slope t = s/a at the arc length s from its lowest point,
the height a (c - 1) with c = sqrt(1 + t^2), and the distance a asinh t from there. A lazy wave follows its lower, its
buoyant and its upper stretch from slope to slope. The tension is H c; it lengthens the arc by the integral of H c/EA,
H a (t c + asinh t)/2 EA.
"""

from __future__ import annotations

import math
from typing import NamedTuple

SAG, HOG = 0.35, 0.5  # heights of a lazy wave's sag and hog, over the hang-off's


class Stretch(NamedTuple):
    """A piece of the line: name of its line type, unstressed length [m]."""

    line_type: str
    length: float


class Hanging(NamedTuple):
    """A line that hangs: its stretches from the seabed up, the distance that they cover [m], and a = H/w [m]."""

    stretches: tuple[Stretch, ...]
    across: float
    a: float


class HangingLine(NamedTuple):
    """What hangs: name of the line type, weight in water [N/m], EA [N]."""

    name: str
    weight: float
    EA: float

    def arc(self, H: float, *slopes: float) -> Stretch:
        """Arc lengths from the seabed's or an extreme's level to each of the slopes."""
        a = H / abs(self.weight)
        return Stretch(self.name, a * sum(t - 0.5 * H / self.EA * _of_tension(t) for t in slopes))


def _of_tension(t: float) -> float:
    return t * math.sqrt(1.0 + t * t) + math.asinh(t)


def free_hanging(line: HangingLine, height: float, angle: float) -> Hanging:
    """A catenary that rises by `height` [m] from its touchdown point and leaves at an angle [rad] from the vertical."""
    a, t = height / (1.0 / math.sin(angle) - 1.0), 1.0 / math.tan(angle)
    return Hanging((line.arc(line.weight * a, t),), a * math.asinh(t), a)


def lazy_wave(line: HangingLine, floats: HangingLine, height: float, angle: float) -> Hanging:
    """A lazy wave that rises by `height` [m] from its touchdown point and leaves at an angle [rad] from the vertical:
    from the seabed up, a hog where a stretch floats, then a sag.
    """
    top = 1.0 / math.sin(angle)
    a = (1.0 - SAG) * height / (top - 1.0)
    H = line.weight * a
    b = H / -floats.weight
    hog, sag = (1.0 + part * height / (a + b) for part in (HOG, HOG - SAG))
    up, down, last = (math.sqrt(c * c - 1.0) for c in (hog, sag, top))
    stretches = line.arc(H, up), floats.arc(H, up, down), line.arc(H, down, last)
    across = (a + b) * (math.asinh(up) + math.asinh(down)) + a * math.asinh(last)
    return Hanging(stretches, across, a)
