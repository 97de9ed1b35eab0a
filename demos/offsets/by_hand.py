"""The steel catenary riser by hand: an inextensible cable on a level bed, and the bending where it leaves the bed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene


@dataclass(frozen=True)
class LaidCable:
    """A cable of submerged weight w [N/m] and length L [m] that hangs from a height z [m] over its bed, with a bending
    stiffness EI [N.m2] that does not change its shape.
    """

    w: float
    L: float
    z: float
    EI: float

    def hung(self, H: float) -> float:
        """The length [m] that hangs with a horizontal tension H [N]: s = sqrt(z^2 + 2 a z), a = H/w."""
        return float(np.sqrt(self.z**2 + 2.0 * self.z * H / self.w))

    def layback(self, H: float) -> float:
        """Horizontal distance of the ends [m]: L - s + a asinh(s/a)."""
        s, a = self.hung(H), H / self.w
        return self.L - s + float(a * np.arcsinh(s / a))

    def at_angle(self, angle: float) -> float:
        """H [N] with which the top is at an angle [deg] from the vertical: tan = H/(w s)."""
        return self._solved(lambda H: np.degrees(np.arctan2(H, self.w * self.hung(H))) - angle)

    def at_layback(self, x: float) -> float:
        """H [N] with which the ends are x [m] apart."""
        return self._solved(lambda H: self.layback(H) - x)

    def touchdown(self, H: float) -> float:
        """Arc length [m] at which it leaves the bed."""
        return self.L - self.hung(H)

    def top_tension(self, H: float) -> float:
        """H + w z [N]."""
        return H + self.w * self.z

    def moment(self, H: float) -> float:
        """The largest bending moment [N.m] near the touchdown point: EI times the cable's curvature a/(a^2 + s^2), to
        which a pipe on a stiff bed comes as 1 - exp(-s/l), l = sqrt(EI/H).
        """
        a, length = H / self.w, np.sqrt(self.EI / H)
        s = np.linspace(0.0, 40.0 * length, 4001)
        return float((self.EI * a / (a**2 + s**2) * (1.0 - np.exp(-s / length))).max())

    def _solved(self, miss: Callable[[float], float]) -> float:
        return float(brentq(miss, 1e-3 * self.w * self.z, 10.0 * self.w * self.z, xtol=1e-6))


def cable_of(scene: Scene) -> LaidCable:
    """The cable of the demo's riser."""
    riser, water = scene.line, scene.water
    pipe = scene.line_types[riser.segments[0].line_type]
    outer, inner, contents = pipe.outer_diameter, pipe.inner_diameter, riser.contents
    assert outer is not None
    assert inner is not None
    assert pipe.mass is not None
    assert contents is not None
    assert water is not None
    mass = pipe.mass + 0.25 * np.pi * (contents.density * inner**2 - water.density * outer**2)
    start, end = riser.start, riser.end
    assert isinstance(start, Support)
    assert isinstance(end, Support)
    height = end.position[2] - start.position[2]
    return LaidCable(float(mass * scene.gravity), riser.length, height, max(pipe.bending_stiffness))
